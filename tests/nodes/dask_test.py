"""Runs and challenges by `mcdem distribute`: on the devices of this machine, where parts are killed and nothing listens, by a
Dask scheduler with TLS, and with a client of the user. The results have the bytes of a single process.

dask_test.py MCDEM DEVICE_LAYER; skipped (77) without python3-distributed; uses the Python that has it.
"""
import json
import os
import pathlib
import sys

import shared_challenge
import shared_runs
from shared_runs import ALONE, PARTS, TWO_DEVICES, Hold, command_of, finish, skip

try:
    import distributed  # noqa: F401
except ImportError:
    skip("the Python package distributed is not there (Debian package python3-distributed)")

PACKAGE = pathlib.Path(__file__).resolve().parents[2] / "host/python"
PYTHON = {"MCDEM_PYTHON": sys.executable}
BY_HAND = """
import mcdem.distributed
from distributed import Client, LocalCluster

if __name__ == "__main__":
    with LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=":0") as cluster, Client(cluster) as client:
        mcdem.distributed.run("sweep.toml", "dask", client=client, part_replicas=1)
        try:
            mcdem.distributed.run("sweep.toml", "dask", settings={"grains.friction": -7, "output.contacts": True}, client=client)
        except ValueError as error:
            print("refused:", error)
"""


def distribute(place, words, hold=None, more=None):
    environment = {**PYTHON, **(hold.environment if hold else {}), **(more or {})}
    return place.start([place.mcdem, "distribute", *words], environment)


def parent_of(process):
    return int(pathlib.Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[1])


def sockets_of(process):
    """Of the process: inodes of what it has open as sockets."""
    links = [os.readlink(file) for file in pathlib.Path(f"/proc/{process}/fd").iterdir() if file.is_symlink()]
    return [link for link in links if link.startswith("socket:")]


def outlives_a_killed_part(place):
    """It is computed again. The command listens nowhere: it has no socket at all."""
    place.run_alone()
    hold = Hold(place, only_one=True)
    process = distribute(place, [*command_of("sweep.toml", "dask"), *PARTS], hold, TWO_DEVICES)
    held = hold.wait_for(1)[0]
    for one in (process.pid, parent_of(held), held):
        assert not sockets_of(one), (one, sockets_of(one))
    hold.kill_one()
    hold.end()
    said = finish(process)
    assert "8 of 8 replicas done" in said and "dashboard" not in said, said
    place.expect_like_alone("dask")
    assert "8 of 8 replicas done" in finish(distribute(place, command_of("sweep.toml", "dask")))


def tries_a_failed_part_again(place):
    """A device fails in the middle of one part."""
    place.run_alone()
    vanishing = {"OPENCL_LAYERS": str(pathlib.Path(sys.argv[2]).resolve()), "MCDEM_TEST_KERNELS": "3000",
                 "MCDEM_TEST_VICTIM": str(place.path / "victim")}
    finish(distribute(place, [*command_of("sweep.toml", "dask"), *PARTS], more=vanishing))
    assert (place.path / "victim").exists()
    place.expect_like_alone("dask")


def goes_on_after_an_interruption(place):
    """Ctrl-C: finished parts are kept, and the same command computes the missing ones."""
    place.run_alone()
    words = [*command_of("sweep.toml", "dask"), *ALONE]
    hold = Hold(place)
    process = distribute(place, words, hold)
    hold.wait_for(1)
    process.terminate()
    hold.end()
    finish(process, exit_codes=(130,))
    assert not (place.path / "dask/run.h5").exists()
    finish(distribute(place, words))
    place.expect_like_alone("dask")


def uses_a_scheduler_with_tls(place):
    """Named by its address; certificates come from Dask's configuration. Whoever has none is refused."""
    place.run_alone()
    key, certificate = place.path / "key.pem", place.path / "certificate.pem"
    place.run(["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "1", "-subj", "/CN=mcdem", "-keyout", str(key),
               "-out", str(certificate)])
    tls = {"DASK_DISTRIBUTED__COMM__TLS__CA_FILE": str(certificate)}
    for who in ("SCHEDULER", "WORKER", "CLIENT"):
        tls |= {f"DASK_DISTRIBUTED__COMM__TLS__{who}__CERT": str(certificate), f"DASK_DISTRIBUTED__COMM__TLS__{who}__KEY": str(key)}
    scheduler = place.start([sys.executable, "-m", "distributed.cli.dask_scheduler", "--protocol", "tls", "--host", "127.0.0.1",
                             "--port", "0", "--dashboard-address", "127.0.0.1:0", "--scheduler-file", "dask.json"], tls)
    shared_runs.wait_until((place.path / "dask.json").exists, "the scheduler")
    address = json.loads((place.path / "dask.json").read_text())["address"]
    assert address.startswith("tls://"), address
    worker = place.start([sys.executable, "-m", "distributed.cli.dask_worker", address, "--nthreads", "1", "--no-dashboard"], tls)
    words = ["--scheduler", address, *command_of("sweep.toml", "dask")]
    said = finish(distribute(place, words, more={"DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT": "2s"}), exit_codes=(2,))
    assert "mcdem: --scheduler: must be" in said and "Traceback" not in said, said
    assert "8 of 8 replicas done" in finish(distribute(place, words, more=tls))
    place.expect_like_alone("dask")
    for process in (worker, scheduler):
        process.terminate()
        finish(process, exit_codes=range(-64, 256))


def works_from_python(place):
    """With a client of the user, and without the compiled module."""
    place.run_alone()
    (place.path / "by_hand.py").write_text(BY_HAND)
    said = place.run([sys.executable, "by_hand.py"], {"PYTHONPATH": str(PACKAGE), "MCDEM_PROGRAM": place.mcdem})
    assert "refused: " in said and "grains.friction" in said and "output.contacts" not in said, said
    place.expect_like_alone("dask")


def a_challenge_is_distributed(place):
    """Library and cases; a part is killed while the cases are diagnosed."""
    shared_challenge.run_alone(place)
    hold = shared_challenge.hold(place, "dask")
    process = distribute(place, shared_challenge.command_of("dask"), hold)
    hold.kill_one()
    hold.end()
    finish(process)
    shared_challenge.expect_like_alone(place, "dask")


def an_interrupted_merge_is_called_interrupted(place):
    """Parts are all there; the process that merges them is interrupted alone."""
    program = place.path / "interrupted"
    program.write_text("#!/bin/sh\ncase \"$*\" in *--merge*) exit 130;; *--alike*) echo 0;; esac\n")
    program.chmod(0o755)
    environment = {"PYTHONPATH": str(PACKAGE), "MCDEM_PROGRAM": str(program)}
    words = [sys.executable, "-m", "mcdem", "distribute", "run", "sweep.toml"]
    said = finish(place.start(words, environment), exit_codes=(130,))
    assert "could not be merged" not in said and "Traceback" not in said, said


def says_what_is_wrong(place):
    """Bad input, and the message if packages are missing."""
    for words, problem in ((["--bogus", *command_of("sweep.toml", "dask")], "a command is needed"),
                           ([*command_of("sweep.toml", "dask"), "--part", "1/2"], "--part: cannot be given here")):
        assert problem in finish(distribute(place, words), exit_codes=(2,)), words
    assert not (place.path / "dask").exists()
    said = finish(distribute(place, [*command_of("sweep.toml", "dask"), "--set", "nothing=1"]), exit_codes=(2,))
    assert "mcdem: " in said and "nothing" in said and "Traceback" not in said, said
    for scheduler in "tcp://127.0.0.1:1", "sweep.toml":
        said = finish(distribute(place, ["--scheduler", scheduler, *command_of("sweep.toml", "dask")],
                                 more={"DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT": "1s"}), exit_codes=(2,))
        assert "mcdem: --scheduler: must be" in said and "Traceback" not in said, said
    without = place.path / "python"
    without.write_text(f"#!/bin/sh\nexec {sys.executable} -S \"$@\"\n")
    without.chmod(0o755)
    said = finish(distribute(place, ["--scheduler", "tcp://127.0.0.1:1", *command_of("sweep.toml", "dask")],
                             more={"MCDEM_PYTHON": str(without)}), exit_codes=(1,))
    assert "install python3-distributed" in said, said


def main():
    shared_runs.run_tests([says_what_is_wrong, an_interrupted_merge_is_called_interrupted, outlives_a_killed_part,
                           tries_a_failed_part_again, goes_on_after_an_interruption, uses_a_scheduler_with_tls,
                           works_from_python, a_challenge_is_distributed])


main()
