"""Several devices of one machine: `--device all` uses them all, and the result is that of one.

devices_test.py MCDEM DEVICE_LAYER; the layer of tests/layers makes devices vanish and holds workers; PoCL stands for a machine with two devices (POCL_DEVICES).
"""
import pathlib
import sys

import shared_runs
from shared_runs import PARTS, SWEEP, TWO_DEVICES, Hold, command_of, finish, skip


def all_devices(place, out, more=(), environment=None):
    words = [place.mcdem, *command_of("sweep.toml", out), "--device", "all", *PARTS, *more]
    return place.start(words, {**TWO_DEVICES, **(environment or {})})


def vanishing():
    """An environment in which a device stops answering in the middle of a part."""
    return {"OPENCL_LAYERS": str(pathlib.Path(sys.argv[2]).resolve()), "MCDEM_TEST_KERNELS": str(shared_runs.LAUNCHES // 2)}


def uses_all_of_them(place):
    """Two devices, a worker on each, the bytes of one process."""
    place.run_alone()
    hold = Hold(place)
    process = all_devices(place, "both", environment=hold.environment)
    hold.wait_for(2)
    devices = shared_runs.devices_at_work(place.path / "both/parts")
    hold.end()
    said = finish(process)
    assert "2 devices, a worker on each" in said and "8 of 8 replicas done" in said, said
    assert devices == {0, 1}, f"parts were computed on {devices}"
    place.expect_like_alone("both")
    assert "8 of 8 replicas done" in finish(all_devices(place, "both")), "a run that is done is told of again"


def refuses_another_run(place):
    """What lies in the folder is another run: told once, not reported as done, and left as it is."""
    place.run_alone()
    before = (place.path / "alone/run.h5").read_bytes()
    said = finish(all_devices(place, "alone", ["--set", "protocol.scans_per_stroke=5"]), exit_codes=(2,))
    assert said.count("the scene it was begun with") == 1 and "done" not in said, said
    assert (place.path / "alone/run.h5").read_bytes() == before


def outlives_a_killed_worker(place):
    """One of two workers is killed: the other does its part."""
    place.run_alone()
    hold = Hold(place, only_one=True)
    process = all_devices(place, "both", environment=hold.environment)
    hold.kill_one()
    said = finish(process)
    assert "was ended by signal 9" in said, said
    place.expect_like_alone("both")


def outlives_a_vanished_device(place):
    """One of two devices stops answering: its worker says so, the other does its part."""
    place.run_alone()
    said = finish(all_devices(place, "both", environment={**vanishing(), "MCDEM_TEST_VICTIM": str(place.path / "victim")}))
    assert said.count("the device or its driver has failed") == 1 and "other workers go on with it" in said, said
    assert "8 of 8 replicas done" in said, said
    place.expect_like_alone("both")


def goes_on_when_all_devices_vanished(place):
    """Again and again both stop answering: the same command goes on with what was done."""
    (place.path / "sweep.toml").write_text(SWEEP.replace("checkpoint_minutes = 1e-4", "checkpoint_minutes = 1e-6"))
    place.run_alone()
    for vanished in range(30):
        process = all_devices(place, "both", environment=vanishing())
        said = finish(process, exit_codes=(0, 1))
        if process.returncode == 0:
            break
        assert "the device or its driver has failed" in said and "the same command goes on" in said, said
    assert vanished >= 2 and "8 of 8 replicas done" in said, f"{vanished}: {said}"
    place.expect_like_alone("both")


def goes_on_as_one(place):
    """All are interrupted; one process alone goes on."""
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
    shared_runs.run_tests([uses_all_of_them, refuses_another_run, outlives_a_killed_worker, outlives_a_vanished_device,
                           goes_on_when_all_devices_vanished, goes_on_as_one])


main()
