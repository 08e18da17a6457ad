"""Runs and challenges with MPI: `mpirun -n 3`, a rank killed in the middle; the bytes of a single process.

mpi_test.py MCDEM DEVICE_LAYER; skipped (77) if MPI is missing.
"""
import re
import sys
import threading

import shared_challenge
import shared_runs
from shared_runs import ALONE, LAUNCHES, PARTS, TWO_DEVICES, Hold, PartsSeen, command_of, finish, program, skip


def mpirun(place, words, environment=None):
    return place.start([program("mpirun", "openmpi-bin"), "--allow-run-as-root", "--oversubscribe", "-n", "3",
                        place.mcdem, *words, "--mpi"], environment)


def run_words(out, parts=PARTS):
    return [*command_of("sweep.toml", out), *parts]


def the_same_command_goes_on(place):
    """mpirun ends all ranks when one is killed; the same command computes only the missing parts."""
    place.run_alone()
    hold = Hold(place, launches=LAUNCHES * 3 // 2)  # every rank is in its second part
    process = mpirun(place, run_words("ranks", ALONE), environment=hold.environment)
    hold.wait_for(3)
    parts = PartsSeen(place.path / "ranks/parts")
    parts.look()
    hold.kill_one()
    finish(process, exit_codes=range(1, 256))
    parts.look()
    hold.end()
    process = mpirun(place, run_words("ranks", ALONE))
    watcher = threading.Thread(target=parts.watch, args=[process])
    watcher.start()
    said = finish(process)
    watcher.join()
    assert said.count("8 of 8 replicas done") == 1, said
    parts.expect_each_once()
    place.expect_like_alone("ranks")


def ranks_take_the_devices_in_turn(place):
    """Three ranks on a machine with two devices use both of them."""
    if not shared_runs.has_two_devices(place):
        print("left out: this OpenCL has no two devices alike")
        return
    place.run_alone()
    hold = Hold(place)
    process = mpirun(place, run_words("ranks", ALONE), environment={**TWO_DEVICES, **hold.environment})
    hold.wait_for(3)
    hold.end()
    used = set(re.findall(r"part \d+: rank (\d), device (\d)", finish(process)))
    assert used == {("0", "0"), ("1", "1"), ("2", "0")}, used
    place.expect_like_alone("ranks")


def a_challenge_is_shared(place):
    """A rank is killed during the diagnoses; the same command ends with the answers of a single process."""
    shared_challenge.run_alone(place)
    hold = shared_challenge.hold(place, "ranks")
    process = mpirun(place, shared_challenge.command_of("ranks"), environment=hold.environment)
    hold.kill_one()
    finish(process, exit_codes=range(1, 256))
    hold.end()
    finish(mpirun(place, shared_challenge.command_of("ranks")))
    shared_challenge.expect_like_alone(place, "ranks")


def main():
    program("mpirun", "openmpi-bin")
    with shared_runs.Place(sys.argv[1]) as place:
        built = finish(place.start([place.mcdem, *run_words("try"), "--mpi", "--set", "nothing=1"]), exit_codes=(2,))
        without = finish(place.start([place.mcdem, *run_words("try"), "--mpi"]), exit_codes=(0, 2))
    assert "nothing" in built
    if "built without MPI" in without:
        skip("mcdem was built without MPI (CMake found none: libopenmpi-dev)")
    shared_runs.run_tests([ranks_take_the_devices_in_turn, the_same_command_goes_on, a_challenge_is_shared])


main()
