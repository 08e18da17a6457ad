"""Several devices of one machine: `--device all` uses them all, and the result is that of one.

devices_test.py MCDEM; PoCL stands for a machine with two devices (POCL_DEVICES).
"""
import re
import sys

import shared_runs
from shared_runs import PARTS, command_of, finish, kill_a_worker, skip

TWO = {"POCL_DEVICES": "pthread pthread", "MCDEM_DEVICE": ""}


def all_devices(place, out):
    return place.start([place.mcdem, *command_of("sweep.toml", out), "--device", "all", *PARTS], TWO)


def uses_all_of_them(place):
    """Two devices, a worker on each, the bytes of one process."""
    place.run_alone()
    process = all_devices(place, "both")
    claims = set()
    folder = place.path / "both/parts"
    while process.poll() is None:
        for claim in folder.glob("*.claim-*"):
            try:
                found = re.search(r'"process":(\d+)', claim.read_text())
            except OSError:
                continue
            claims.update(found.groups() if found else ())
    said = finish(process)
    assert "2 devices, a worker on each" in said and "8 of 8 replicas done" in said, said
    assert len(claims) >= 2, f"parts were claimed by {claims}"
    place.expect_like_alone("both")
    assert "8 of 8 replicas done" in finish(all_devices(place, "both")), "a run that is done is told of again"


def outlives_a_killed_worker(place):
    """One of two workers is killed: the other does its part."""
    place.run_alone()
    process = all_devices(place, "both")
    kill_a_worker(place.path / "both/parts")
    said = finish(process)
    assert "was ended by signal 9" in said, said
    place.expect_like_alone("both")


def goes_on_as_one(place):
    """All are interrupted; one process alone goes on."""
    place.run_alone()
    process = all_devices(place, "both")
    shared_runs.wait_until(lambda: shared_runs.holder_at_work(place.path / "both/parts"), "work")
    process.terminate()
    said = finish(process, exit_codes=(130,))
    assert "interrupted" in said, said
    assert not (place.path / "both/run.h5").exists()
    place.run([place.mcdem, *command_of("sweep.toml", "both"), "--resume"])
    place.expect_like_alone("both")


def main():
    with shared_runs.Place(sys.argv[1]) as place:
        devices = place.run([place.mcdem, "devices"], TWO)
    if len(re.findall(r"(?m)^ *\d+ ", devices)) < 2:
        skip("this OpenCL has no two devices alike (PoCL makes them: POCL_DEVICES)")
    shared_runs.run_tests([uses_all_of_them, outlives_a_killed_worker, goes_on_as_one])


main()
