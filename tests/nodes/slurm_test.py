"""Runs as Slurm job arrays, on a real Slurm of one node that this test starts: a worker killed in the middle, names that
a shell would stumble over, the bytes of one process.

slurm_test.py MCDEM; skipped (77) where a program is missing or this is not root.
"""
import contextlib
import os
import re
import socket
import subprocess
import tempfile
import pathlib

import shared_runs
from shared_runs import PARTS, PartsSeen, command_of, finish, kill_a_worker, program, skip, wait_until

CONFIGURATION = """ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
SlurmdPort={ports[1]}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmdParameters=config_overrides
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_interval=1
ReturnToService=2
MailProg=/bin/true
NodeName={host} NodeAddr=127.0.0.1 CPUs=4 State=UNKNOWN
PartitionName=short Nodes={host} Default=NO MaxTime=INFINITE State=UP
PartitionName=other Nodes={host} Default=YES MaxTime=INFINITE State=DOWN
"""
SLURM = {}  # what it takes to speak to it
ODD = "out $(touch hacked) `touch hacked` 'it''s' %j; touch hacked"
SUBMIT = ["--slurm", "--slurm-tasks", "3", "--slurm-partition", "short", "--slurm-time", "10", *PARTS]


def free_ports(count):
    with contextlib.ExitStack() as open_sockets:
        sockets = [open_sockets.enter_context(socket.socket()) for _ in range(count)]
        for one in sockets:
            one.bind(("127.0.0.1", 0))
        return [one.getsockname()[1] for one in sockets]


@contextlib.contextmanager
def daemon(words, log, environment):
    with open(log, "w") as out:
        process = subprocess.Popen(words, stdout=out, stderr=out, env=environment)
    try:
        yield process
    finally:
        process.terminate()
        try:
            process.wait(timeout=20)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


@contextlib.contextmanager
def slurm():
    """munged, slurmctld and slurmd of a cluster of this machine alone, in a folder of their own."""
    programs = [program(name, package) for name, package in
                (("munged", "munge"), ("slurmctld", "slurm-wlm"), ("slurmd", "slurm-wlm"), ("sbatch", "slurm-wlm"))]
    if os.geteuid() != 0:
        skip("only root can start a Slurm of its own")
    with tempfile.TemporaryDirectory(prefix="mcdem-slurm-") as name, contextlib.ExitStack() as running:
        folder = pathlib.Path(name)
        folder.chmod(0o755)  # munge wants its socket to be reached
        for part in ("state", "spool"):
            (folder / part).mkdir()
        (folder / "key").write_bytes(os.urandom(1024))
        (folder / "key").chmod(0o600)
        host = socket.gethostname().split(".")[0]
        (folder / "slurm.conf").write_text(CONFIGURATION.format(folder=folder, host=host, ports=free_ports(2)))
        SLURM["SLURM_CONF"] = str(folder / "slurm.conf")
        environment = {**os.environ, **SLURM}
        start = lambda words: running.enter_context(
            daemon(words, folder / f"{pathlib.Path(words[0]).name}.log", environment))
        start([programs[0], "--foreground", "--force", f"--key-file={folder}/key", f"--socket={folder}/munge.socket",
               f"--pid-file={folder}/munged.pid", f"--log-file={folder}/munged.log", f"--seed-file={folder}/seed"])
        wait_until((folder / "munge.socket").exists, "munge")
        start([programs[1], "-D"])
        start([programs[2], "-D"])
        ready = lambda: subprocess.run(["sinfo", "--noheader", "--format=%T", "--partition=short"], env=environment,
                                       capture_output=True, text=True).stdout.strip() == "idle"
        try:
            wait_until(ready, "an idle node")
        except AssertionError:
            for log in folder.glob("*.log"):
                print(f"--- {log.name}\n{log.read_text()[-3000:]}")
            raise
        yield
        # Jobs whose Slurm is gone would wait for it for good.
        wait_until(lambda: not subprocess.run(["squeue", "--noheader"], env=environment, capture_output=True).stdout.strip(),
                   "the last job to end")


def run_words(place, out, more=()):
    return place.start([place.mcdem, *command_of("sweep.toml", out), *SUBMIT, *more], SLURM)


def outlives_a_killed_worker(place):
    """The others do its part; parts are done once; nothing of a name is taken for a command."""
    place.run_alone()
    (place.path / "lines").write_text("#SBATCH --comment=mine\nexport MCDEM_TOLD=yes")
    process = run_words(place, ODD, ["--slurm-lines", "lines"])
    kill_a_worker(place.path / ODD / "parts")
    said = finish(process)
    assert "8 of 8 replicas done" in said and "3 workers" in said, said
    place.expect_like_alone(ODD)
    assert not (place.path / "hacked").exists() and not list(place.path.rglob("hacked"))
    script = (place.path / ODD / "slurm/job.sh").read_text()
    assert script.startswith("#!/bin/bash\n#SBATCH --comment=mine\nexport MCDEM_TOLD=yes\nexec "), script
    logs = list((place.path / ODD / "slurm").glob("*_*.log"))
    assert len(logs) == 3, logs


def goes_on_after_a_cancelled_job(place):
    """All workers are cancelled: the command says so, and given again does only what is missing."""
    place.run_alone()
    process = run_words(place, "jobs")
    parts = PartsSeen(place.path / "jobs/parts")
    wait_until(lambda: list(parts.folder.glob("*.h5")), "a part")
    parts.look()
    number = (place.path / "jobs/slurm/job").read_text().strip()
    place.run(["scancel", "--signal=KILL", "--full", number], SLURM)
    place.run(["scancel", number], SLURM)
    said = finish(process, exit_codes=(1,))
    assert f"job {number} has ended before the work was done" in said, said
    process = run_words(place, "jobs")
    parts.watch(process)
    finish(process)
    parts.expect_each_once()
    place.expect_like_alone("jobs")


def is_not_submitted_twice(place):
    """--no-wait returns at once; the same command then waits for that job."""
    place.run_alone()
    said = finish(run_words(place, "jobs", ["--no-wait"]))
    number = re.search(r"job (\d+)", said)[1]
    said = finish(run_words(place, "jobs"))
    assert f"job {number} of this work is still there" in said, said
    place.expect_like_alone("jobs")


def says_what_slurm_refuses(place):
    """A partition that is not there: exit code 2, and nothing waits."""
    said = finish(place.start([place.mcdem, *command_of("sweep.toml", "jobs"), "--slurm", "--slurm-partition", "none"],
                              SLURM), exit_codes=(2,))
    assert "sbatch has refused the job" in said and "nvalid partition" in said, said


def main():
    with slurm():
        shared_runs.run_tests([outlives_a_killed_worker, goes_on_after_a_cancelled_job, is_not_submitted_twice,
                               says_what_slurm_refuses])


main()
