"""A local Slurm with two nodes that can be made to fail: munge and Slurm's daemons in a folder of their own."""
import contextlib
import os
import pathlib
import re
import signal
import socket
import subprocess
import tempfile

from shared_runs import program, skip, wait_until

NODES = ("one", "two")
# Tasks of a lost node are requeued only if the job requests it, after cred_expire seconds.
CONFIGURATION = """ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={ports[0]}
AuthType=auth/munge
AuthInfo=socket={folder}/munge.socket,cred_expire=5
SlurmUser=root
SlurmdUser=root
StateSaveLocation={folder}/state
SlurmdSpoolDir={folder}/spool.%n
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.%n.pid
SlurmdParameters=config_overrides
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_interval=1
ReturnToService=2
JobRequeue=0
MailProg=/bin/true
NodeName=one NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[1]} CPUs=2 State=UNKNOWN
NodeName=two NodeHostname={host} NodeAddr=127.0.0.1 Port={ports[2]} CPUs=2 State=UNKNOWN
PartitionName=short Nodes=one,two Default=NO MaxTime=INFINITE State=UP
PartitionName=other Nodes=one,two Default=YES MaxTime=INFINITE State=DOWN
"""


def free_ports(count):
    with contextlib.ExitStack() as open_sockets:
        sockets = [open_sockets.enter_context(socket.socket()) for _ in range(count)]
        for one in sockets:
            one.bind(("127.0.0.1", 0))
        return [one.getsockname()[1] for one in sockets]


@contextlib.contextmanager
def daemon(words, log, environment):
    with open(log, "a") as out:
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


def environment_of(process):
    """Environment of a process; empty if it has ended."""
    try:
        lines = pathlib.Path(f"/proc/{process}/environ").read_bytes().split(b"\0")
    except OSError:
        return {}
    return dict(line.decode(errors="replace").split("=", 1) for line in lines if b"=" in line)


def watcher_of(process):
    """The slurmstepd above the process; the process itself if that has ended."""
    above = process
    while above > 1:
        try:
            name, parent = re.match(r"\d+ \((.*)\) \S (\d+)", pathlib.Path(f"/proc/{above}/stat").read_text()).groups()
        except OSError:
            break
        if name == "slurmstepd":
            return above
        above = int(parent)
    return process


def kill(process):
    with contextlib.suppress(ProcessLookupError):
        os.kill(process, signal.SIGKILL)


class Cluster:
    def __init__(self):
        self.environment = {}  # environment for Slurm's commands
        self._nodes = {}       # slurmd processes

    @contextlib.contextmanager
    def running(self):
        packages = {"munged": "munge", "slurmctld": "slurm-wlm", "slurmd": "slurm-wlm", "sbatch": "slurm-wlm"}
        self._programs = {name: program(name, package) for name, package in packages.items()}
        if os.geteuid() != 0:
            skip("only root can start a Slurm of its own")
        with tempfile.TemporaryDirectory(prefix="mcdem-slurm-") as name, contextlib.ExitStack() as self._daemons:
            self._folder = pathlib.Path(name)
            self._start()
            yield

    def _start(self):
        folder = self._folder
        folder.chmod(0o755)  # munge requires that its socket is accessible
        (folder / "state").mkdir()
        (folder / "key").write_bytes(os.urandom(1024))
        (folder / "key").chmod(0o600)
        host = socket.gethostname().split(".")[0]
        (folder / "slurm.conf").write_text(CONFIGURATION.format(folder=folder, host=host, ports=free_ports(3)))
        self.environment["SLURM_CONF"] = str(folder / "slurm.conf")
        self._daemon("munged", "--foreground", "--force", f"--key-file={folder}/key", f"--socket={folder}/munge.socket",
                     f"--pid-file={folder}/munged.pid", f"--log-file={folder}/munged.log", f"--seed-file={folder}/seed")
        wait_until((folder / "munge.socket").exists, "munge")
        self._daemon("slurmctld", "-D")
        self.bring_back(*NODES)

    def _daemon(self, name, *words):
        return self._daemons.enter_context(daemon([self._programs[name], *words], self._folder / f"{name}.log",
                                                  {**os.environ, **self.environment}))

    def _ask(self, *words):
        return subprocess.run(words, env={**os.environ, **self.environment}, capture_output=True, text=True).stdout.strip()

    def node_of(self, process):
        """The node of a process of a job; None for other processes."""
        found = environment_of(process)
        return found.get("SLURMD_NODENAME") if found.get("SLURM_CONF") == self.environment["SLURM_CONF"] else None

    def _tasks_on(self, nodes):
        """Processes of jobs, by their slurmstepd."""
        tasks = {}
        for entry in pathlib.Path("/proc").iterdir():
            if entry.name.isdigit() and self.node_of(entry.name) in nodes:
                tasks.setdefault(watcher_of(int(entry.name)), []).append(int(entry.name))
        return tasks

    def lose(self, *nodes):
        """Kills everything on the node; tells Slurm at once what it would detect after SlurmdTimeout."""
        # A task that is being started does not have a process yet.
        running = lambda: self._ask("squeue", "--noheader", "--array", "--states=RUNNING", f"--nodelist={','.join(nodes)}")
        wait_until(lambda: len(self._tasks_on(nodes)) == len(running().splitlines()), "tasks that are started")
        for node in nodes:
            self._nodes[node].kill()
            self._nodes[node].wait()
        while tasks := self._tasks_on(nodes):
            for watcher, processes in tasks.items():
                for process in (watcher, *processes):  # in this order, so that nobody reports the end of a task
                    kill(process)
        for node in nodes:
            self._ask("scontrol", "update", f"nodename={node}", "state=down", "reason=lost")

    def jobs(self):
        """Numbers of the jobs in the queue, the oldest first."""
        return sorted(set(self._ask("squeue", "--noheader", "--format=%F").split()), key=int)

    def wait_for_jobs(self):
        """Waits until no job is running or pending: jobs would remain after their folder or Slurm is removed."""
        wait_until(lambda: not self._ask("squeue", "--noheader"), "the last job to end")

    def bring_back(self, *nodes):
        for node in nodes:
            self._nodes[node] = self._daemon("slurmd", "-D", "-N", node)

        def all_are_up():
            states = self._ask("sinfo", "--noheader", "--Node", "--format=%T", "--partition=short").split()
            return len(states) == len(NODES) and set(states) <= {"idle", "mixed", "allocated", "completing"}

        try:
            wait_until(all_are_up, "nodes that answer")
        except AssertionError:
            for log in self._folder.glob("*.log"):
                print(f"--- {log.name}\n{log.read_text()[-3000:]}")
            raise
