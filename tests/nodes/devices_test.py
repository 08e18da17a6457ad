"""Several devices of one machine: `mcdem distribute` uses all of them, and the result is that of one device.

devices_test.py MCDEM DEVICE_LAYER; the layer of tests/layers makes devices fail and blocks processes. PoCL provides two
devices (POCL_DEVICES).
"""
import os
import pathlib
import re
import signal
import sys
import time

import shared_runs
from shared_runs import PARTS, SWEEP, TWO_DEVICES, Hold, command_of, finish, skip


def all_devices(place, out, more=(), environment=None):
    words = [place.mcdem, "distribute", *command_of("sweep.toml", out), *PARTS, *more]
    return place.start(words, {**TWO_DEVICES, **(environment or {})})


def vanishing(attempts=2):
    """An environment in which devices fail; a part needs about this many attempts."""
    return {"OPENCL_LAYERS": str(pathlib.Path(sys.argv[2]).resolve()), "MCDEM_TEST_KERNELS": str(shared_runs.LAUNCHES // attempts)}


def device_of(process):
    return re.search(r"--device\0(\d+)", pathlib.Path(f"/proc/{process}/cmdline").read_text())[1]


def uses_all_of_them(place):
    """Two devices with one process each give the bytes of a single process."""
    place.run_alone()
    hold = Hold(place)
    process = all_devices(place, "both", environment=hold.environment)
    devices = {device_of(held) for held in hold.wait_for(2)}
    hold.end()
    said = finish(process)
    assert "2 devices, a process on each" in said and "8 of 8 replicas done" in said, said
    assert devices == {"0", "1"}, f"parts were computed on {devices}"
    place.expect_like_alone("both")
    assert "8 of 8 replicas done" in finish(all_devices(place, "both")), "a run that is done is told of again"


def refuses_another_run(place):
    """If the folder holds another run, this is reported once, not as done, and nothing is changed."""
    place.run_alone()
    before = (place.path / "alone/run.h5").read_bytes()
    said = finish(all_devices(place, "alone", ["--set", "protocol.scans_per_stroke=5"]), exit_codes=(2,))
    assert said.count("the scene it was begun with") == 1 and "done" not in said, said
    assert (place.path / "alone/run.h5").read_bytes() == before


def gives_up_a_part_that_kills_its_processes(place):
    """Every process of one part is killed: the other parts are computed, and the command reports the failure and
    continues later."""
    place.run_alone()
    # Each attempt continues from the last checkpoint: all together must not finish the part.
    hold = Hold(place, launches=shared_runs.LAUNCHES // 20)
    process = all_devices(place, "both", environment=hold.environment)
    killed = []
    while process.poll() is None:
        for file in shared_runs.files_in(place.path / "held", "*"):
            words = pathlib.Path(f"/proc/{file.name}/cmdline").read_text() if file.name not in killed else ""
            if "--part\x001/" in words:
                os.kill(int(file.name), signal.SIGKILL)
                killed.append(file.name)
            elif words:
                file.unlink(missing_ok=True)
        time.sleep(0.01)
    said = finish(process, exit_codes=(1,))
    # Three attempts in the pass that finishes the other parts, and in one that finishes none.
    assert len(killed) == 6 and "no part could be finished" in said, (killed, said)
    assert len(list((place.path / "both/parts").glob("*.h5"))) == 3
    place.run([place.mcdem, *command_of("sweep.toml", "both"), "--resume"])
    place.expect_like_alone("both")


def outlives_a_vanished_device(place):
    """One of two devices fails: its process reports it, and the other device computes the part."""
    place.run_alone()
    said = finish(all_devices(place, "both", environment={**vanishing(), "MCDEM_TEST_VICTIM": str(place.path / "victim")}))
    assert said.count("the device or its driver has failed") == 1 and "is left out from here on" in said, said
    assert "8 of 8 replicas done" in said, said
    place.expect_like_alone("both")


def goes_on_when_all_devices_vanished(place):
    """Both devices fail repeatedly: the same command continues from the finished work."""
    (place.path / "sweep.toml").write_text(SWEEP.replace("checkpoint_minutes = 5e-4", "checkpoint_minutes = 1e-6"))
    place.run_alone()
    for vanished in range(30):
        process = all_devices(place, "both", environment=vanishing(attempts=12))
        said = finish(process, exit_codes=(0, 1))
        if process.returncode == 0:
            break
        assert "the device or its driver has failed" in said and "the same command continues" in said, said
    assert vanished >= 1 and "8 of 8 replicas done" in said, f"{vanished}: {said}"
    place.expect_like_alone("both")


def an_interrupted_run_continues_in_one_process(place):
    """All processes are interrupted; a single one continues."""
    place.run_alone()
    hold = Hold(place, only_one=True)
    process = all_devices(place, "both", environment=hold.environment)
    held = hold.wait_for(1)[0]
    process.terminate()
    shared_runs.wait_until(lambda: shared_runs.is_told_to_end(held), "the signal to be passed on")
    hold.end()
    said = finish(process, exit_codes=(130,))
    assert "interrupted" in said, said
    assert not (place.path / "both/run.h5").exists()
    place.run([place.mcdem, *command_of("sweep.toml", "both"), "--resume"])
    place.expect_like_alone("both")


def main():
    with shared_runs.Place(sys.argv[1]) as place:
        two = shared_runs.has_two_devices(place)
    if not two:
        skip("this OpenCL has no two devices alike (PoCL makes them: POCL_DEVICES)")
    shared_runs.run_tests([uses_all_of_them, refuses_another_run, gives_up_a_part_that_kills_its_processes, outlives_a_vanished_device,
                           goes_on_when_all_devices_vanished, an_interrupted_run_continues_in_one_process])


main()
