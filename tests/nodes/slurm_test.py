"""Runs and challenges as Slurm job arrays, on a real local Slurm with two nodes: a killed task, lost nodes, names with
special characters; the bytes of a single process.

slurm_test.py MCDEM DEVICE_LAYER; skipped (77) if a program is missing or this is not root.
"""
import re
import subprocess
import sys

import own_slurm
import shared_challenge
import shared_runs
from shared_runs import PARTS, Hold, PartsSeen, command_of, finish

cluster = own_slurm.Cluster()
ODD = "out $(touch hacked) `touch hacked` 'it''s' %j; touch hacked"
SUBMIT = ["--slurm", "--slurm-tasks", "3", "--slurm-partition", "short", "--slurm-time", "10"]


def run_words(place, out, more=(), parts=PARTS, hold=None):
    return place.start([place.mcdem, *command_of("sweep.toml", out), *SUBMIT, *parts, *more],
                       {**cluster.environment, **(hold.environment if hold else {})})


def outlives_a_killed_task(place):
    """The job after the array resubmits its missing part; special characters in names are not interpreted by a
    shell."""
    place.run_alone()
    (place.path / "lines").write_text("#SBATCH --comment=mine\nexport MCDEM_TOLD=yes")
    hold = Hold(place, only_one=True)
    process = run_words(place, ODD, ["--slurm-lines", "lines"], hold=hold)
    hold.kill_one()
    said = finish(process)
    assert "8 of 8 replicas done" in said and "4 parts, 3 at a time" in said, said
    place.expect_like_alone(ODD)
    assert not (place.path / "hacked").exists() and not list(place.path.rglob("hacked"))
    script = (place.path / ODD / "slurm/job.sh").read_text()
    assert "\n#SBATCH --comment=mine\nexport MCDEM_TOLD=yes\nparts=(" in script, script
    logs = list((place.path / ODD / "slurm").glob("*_*.log"))
    assert len(logs) == 5, logs


def goes_on_after_a_cancelled_job(place):
    """The array is cancelled: nothing is resubmitted and the command says so. The same command computes what is
    missing."""
    place.run_alone()
    hold = Hold(place)
    process = run_words(place, "jobs", hold=hold)
    held = hold.wait_for(3)
    (place.path / "held" / str(held[0])).unlink()  # one part is finished
    parts = PartsSeen(place.path / "jobs/parts")
    shared_runs.wait_until(lambda: parts.look() or parts.inodes, "a part")
    array, following = cluster.jobs()
    place.run(["scancel", "--signal=KILL", "--full", array], cluster.environment)
    place.run(["scancel", array], cluster.environment)
    said = finish(process, exit_codes=(1,))
    assert f"job {array} has ended before the work was done" in said, said
    assert f"job {array} was cancelled" in (place.path / f"jobs/slurm/{following}.log").read_text()
    hold.end()
    process = run_words(place, "jobs")
    parts.watch(process)
    finish(process)
    parts.expect_each_once()
    place.expect_like_alone("jobs")


def is_not_submitted_twice(place):
    """--no-wait returns at once; the same command later waits for that job."""
    place.run_alone()
    said = finish(run_words(place, "jobs", ["--no-wait"]))
    number = re.search(r"job (\d+):", said)[1]
    said = finish(run_words(place, "jobs"))
    assert f"job {number} of this work is still pending or running" in said, said
    place.expect_like_alone("jobs")


def outlives_a_lost_node(place):
    """The node of a task loses power: the task is requeued on the other node."""
    place.run_alone()
    hold = Hold(place, only_one=True)
    process = run_words(place, "jobs", hold=hold)
    node = cluster.node_of(hold.wait_for(1)[0])
    cluster.lose(node)
    said = finish(process)
    assert "8 of 8 replicas done" in said, said
    place.expect_like_alone("jobs")
    cluster.bring_back(node)


def outlives_the_loss_of_all_nodes(place):
    """Slurm queues their tasks again, and the command that waits goes on waiting."""
    place.run_alone()
    hold = Hold(place)
    process = run_words(place, "jobs", hold=hold)
    hold.wait_for(3)
    cluster.lose(*own_slurm.NODES)
    assert not (place.path / "jobs/run.h5").exists()
    hold.end()
    cluster.bring_back(*own_slurm.NODES)
    said = finish(process)
    assert "8 of 8 replicas done" in said, said
    place.expect_like_alone("jobs")


def says_what_slurm_refuses(place):
    """An unknown partition: exit code 2, and nothing is waited for."""
    said = finish(place.start([place.mcdem, *command_of("sweep.toml", "jobs"), "--slurm", "--slurm-partition", "none"],
                              cluster.environment), exit_codes=(2,))
    assert "sbatch has refused the job" in said and "nvalid partition" in said, said


def a_challenge_is_shared(place):
    """A task is killed during the diagnoses; the answers are those of a single process."""
    shared_challenge.run_alone(place)
    hold = shared_challenge.hold(place, "jobs")
    process = place.start([place.mcdem, *shared_challenge.command_of("jobs"), *SUBMIT],
                          {**cluster.environment, **hold.environment})
    hold.kill_one()
    said = finish(process)
    assert "3 at a time" in said and "all cases are diagnosed" in said, said
    shared_challenge.expect_like_alone(place, "jobs")


def dask_computes_on_its_nodes(place):
    """Dask workers started by srun, one on each node; a node is lost, and the worker of the other computes its part."""
    if subprocess.run([sys.executable, "-c", "import distributed"], stderr=subprocess.DEVNULL).returncode != 0:
        print("left out: the Python package distributed is not there (Debian package python3-distributed)")
        return
    place.run_alone()
    hold = Hold(place, only_one=True)
    scheduler = place.start([sys.executable, "-m", "distributed.cli.dask_scheduler", "--port", "0", "--dashboard-address",
                             ":0", "--scheduler-file", "dask.json"])
    shared_runs.wait_until((place.path / "dask.json").exists, "the scheduler")
    worker = [sys.executable, "-m", "distributed.cli.dask_worker", "--scheduler-file", "dask.json", "--nthreads", "1",
              "--no-dashboard"]
    workers = [place.start(["srun", "--partition=short", f"--nodelist={node}", "--ntasks=1", *worker],
                           {**cluster.environment, **hold.environment}) for node in own_slurm.NODES]
    process = place.start([place.mcdem, "distribute", "--scheduler", "dask.json", *command_of("sweep.toml", "dask"), *PARTS],
                          {"MCDEM_PYTHON": sys.executable})
    node = cluster.node_of(hold.wait_for(1)[0])
    cluster.lose(node)
    hold.end()
    said = finish(process)
    assert "8 of 8 replicas done" in said, said
    place.expect_like_alone("dask")
    place.run(["scancel", "--user=root"], cluster.environment)
    scheduler.terminate()
    for ended in (scheduler, *workers):
        finish(ended, exit_codes=range(-64, 256))
    cluster.bring_back(node)


def main():
    with cluster.running():
        shared_runs.run_tests([outlives_a_killed_task, goes_on_after_a_cancelled_job, is_not_submitted_twice,
                               outlives_a_lost_node, outlives_the_loss_of_all_nodes, says_what_slurm_refuses,
                               a_challenge_is_shared, dask_computes_on_its_nodes], cluster.wait_for_jobs)


main()
