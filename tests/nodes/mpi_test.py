"""Runs and challenges over MPI: `mpirun -n 3`, a rank killed in the middle, the bytes of one process.

mpi_test.py MCDEM; skipped (77) where MPI is missing.
"""
import os
import signal
import sys
import threading

import shared_challenge
import shared_runs
from shared_runs import (PARTS, TWO_DEVICES, PartsSeen, command_of, files_in, finish, kill_a_worker, program, skip,
                         stop_a_worker, wait_until)

SURVIVE = ["--enable-recovery"]


def mpirun(place, words, options=(), environment=None):
    return place.start([program("mpirun", "openmpi-bin"), "--allow-run-as-root", "--oversubscribe", "-n", "3", *options,
                        place.mcdem, *words, "--mpi"], environment)


def run_words(out, parts=PARTS):
    return [*command_of("sweep.toml", out), *parts]


def survivors_do_the_work_of_a_killed_rank(place):
    """With --enable-recovery mpirun lets the others go on."""
    place.run_alone()
    process = mpirun(place, run_words("ranks"), SURVIVE)
    kill_a_worker(place.path / "ranks/parts")
    said = finish(process)
    assert said.count("8 of 8 replicas done") <= 1, f"more than one rank tells of it:\n{said}"
    place.expect_like_alone("ranks")


def the_same_command_goes_on(place):
    """Without it mpirun ends all ranks; what was done is not done again."""
    place.run_alone()
    process = mpirun(place, run_words("ranks"))
    parts = PartsSeen(place.path / "ranks/parts")
    victim = stop_a_worker(parts.folder)
    stop_a_worker(parts.folder, besides=[victim])  # The third may do the victim's part before it is ended too.
    wait_until(lambda: files_in(parts.folder, "*.h5"), "a part")
    parts.look()
    os.kill(victim, signal.SIGKILL)
    finish(process, exit_codes=range(1, 256))
    parts.look()
    assert not (place.path / "ranks/run.h5").exists(), "all was done before a rank was killed"
    process = mpirun(place, run_words("ranks"))
    watcher = threading.Thread(target=parts.watch, args=[process])
    watcher.start()
    said = finish(process)
    watcher.join()
    assert said.count("8 of 8 replicas done") == 1, said
    parts.expect_each_once()
    place.expect_like_alone("ranks")


def ranks_take_the_devices_in_turn(place):
    """Three ranks of a machine with two devices work on both."""
    if not shared_runs.has_two_devices(place):
        print("left out: this OpenCL has no two devices alike")
        return
    place.run_alone()
    process = mpirun(place, run_words("ranks", ["--part-replicas", "1"]), environment=TWO_DEVICES)
    devices = shared_runs.devices_of_parts(place.path / "ranks/parts", process)
    finish(process)
    assert {number for number, _ in devices} == {0, 1}, f"parts were computed on {devices}"
    place.expect_like_alone("ranks")


def a_challenge_is_shared(place):
    """A rank is killed while the cases are diagnosed; the answers are those of one process."""
    shared_challenge.run_alone(place)
    process = mpirun(place, shared_challenge.command_of("ranks"), SURVIVE)
    shared_challenge.kill_a_worker(place, "ranks")
    finish(process)
    shared_challenge.expect_like_alone(place, "ranks")


def main():
    program("mpirun", "openmpi-bin")
    with shared_runs.Place(sys.argv[1]) as place:
        built = finish(place.start([place.mcdem, *run_words("try"), "--mpi", "--set", "nothing=1"]), exit_codes=(2,))
        without = finish(place.start([place.mcdem, *run_words("try"), "--mpi"]), exit_codes=(0, 2))
    assert "nothing" in built
    if "built without MPI" in without:
        skip("mcdem was built without MPI (CMake found none: libopenmpi-dev)")
    shared_runs.run_tests([ranks_take_the_devices_in_turn, survivors_do_the_work_of_a_killed_rank,
                           the_same_command_goes_on, a_challenge_is_shared])


main()
