"""Computes parts of a run, a challenge or a diagnosis on the devices of this machine, or as Dask tasks on any Dask cluster.

mcdem.distributed.run("scene.toml", "out/sweep")                           # one process per device of this machine
mcdem.distributed.run("scene.toml", "out/sweep", client=Client(cluster))   # any cluster: Slurm, PBS, LSF, Kubernetes, ..
mcdem.distributed.compute(["challenge", "run", ...])                           # any command that works in parts

Each part is a process `mcdem .. --part K/N`. On this machine nothing listens for others. With Dask all machines need the program and the
folders under the same paths. If a process or a worker is lost, its part is computed again: parts are bit-identical wherever they are
computed.
"""
import concurrent.futures
import contextlib
import os
import queue
import shutil
import subprocess
import sys
import threading
from typing import Any, Callable

from .command import ask, problems_of, program_path
from .errors import INTERRUPTED, InputError, RunError
from .look import is_there
from .program import say
from .toml import assignments

TRIES = 3  # per part, not counting lost workers
KEPT = "finished parts are kept, and the same command continues"


def run(scene: str | os.PathLike[str], out: str | os.PathLike[str], *, settings: dict[str, Any] | None = None,
        part_replicas: int | None = None, figures: bool = False, **how: Any) -> None:
    """Runs the replicas of a scene in parts into the folder `out`. `settings` overrides keys; `how`: see compute."""
    words = ["run", os.fspath(scene), "--out", os.fspath(out)] + ([] if figures else ["--no-figures"])
    for assignment in assignments(settings or {}):
        words += ["--set", assignment]
    if part_replicas:
        words += ["--part-replicas", str(part_replicas)]
    compute(words, **how)


def compute(words: list[str], *, client: Any = None, folder: str | os.PathLike[str] | None = None, tries: int = TRIES,
            report: Callable[[str], None] | None = None) -> None:
    """Computes the missing parts of a command and merges them. Calling it again continues where it stopped.

    `words`: the command line after `mcdem`. `client`: a distributed.Client; default: one process at a time on each
    device of this machine. `folder`: working folder of the command. Raises InputError and RunError.
    """
    report = report or say
    folder = os.path.abspath(folder or ".")
    if client:
        report(f"dashboard: {client.dashboard_link}")
    try:
        Work([program_path(), *words], folder, tries, report).compute(DaskWorkers(client) if client else LocalDevices(folder))
    except KeyboardInterrupt:
        report(f"interrupted; {KEPT}")
        raise


class Work:
    def __init__(self, command, folder, tries, report):
        self.command, self.folder, self.tries, self.report = command, folder, tries, report

    def missing(self, workers):
        """The parts as --part takes them."""
        return ask([*self.command[1:], "--missing", "--workers", str(workers)], self.folder).split()

    def compute(self, workers):
        before = None
        while True:
            missing = self.missing(max(1, workers.count()))
            if not missing:
                code = subprocess.run([*self.command, "--merge"], cwd=self.folder).returncode
                if code == 0:
                    return
                if code == INTERRUPTED:
                    raise KeyboardInterrupt
                missing = self.missing(1)  # damaged parts
                if not missing:
                    raise RunError(f"the parts could not be merged: exit code {code}")
            if missing == before:
                raise RunError("no part could be finished: fix the errors above first; " + KEPT)
            self.compute_parts(workers, missing)
            before = missing

    def compute_parts(self, workers, parts):
        """Waits for all. Raises InputError if the program refuses its input."""
        with contextlib.closing(workers.outcomes(self, parts)) as outcomes:
            for done, (part, future) in enumerate(outcomes, 1):
                if error := future.exception():
                    self.report(f"part {part}: {error}")
                elif future.result():
                    raise InputError(problems_of(future.result()))
                else:
                    self.report(f"part {part}: {done} of {len(parts)}")


class LocalDevices:
    """Computes one part at a time on each device of this machine. A device on which a process fails is left out while others remain."""

    def __init__(self, folder):
        self.devices = ask(["devices", "--alike"], folder).split()
        self.lock = threading.Lock()

    def count(self):
        return len(self.devices)

    def outcomes(self, work, parts):
        """Yields each part with its future when that is done."""
        self.free, self.running, self.is_ended = queue.SimpleQueue(), set(), threading.Event()
        for device in self.devices:
            self.free.put(device)
        if len(self.devices) > 1:
            work.report(f"{len(self.devices)} devices, a process on each")
        with concurrent.futures.ThreadPoolExecutor(len(self.devices)) as pool:
            futures = {pool.submit(self.compute, work, part): part for part in parts}
            try:
                for future in concurrent.futures.as_completed(futures):
                    yield futures[future], future
            finally:
                self.is_ended.set()
                pool.shutdown(wait=False, cancel_futures=True)
                for process in list(self.running):
                    process.terminate()

    def compute(self, work, part):
        """As compute_part, with several tries."""
        device = self.free.get()
        try:
            for more in reversed(range(work.tries)):
                try:
                    return compute_part(work.command, work.folder, part, device, self.started)
                except Killed:
                    if not more or self.is_ended.is_set():
                        raise
                except RuntimeError as error:
                    if not more or self.is_ended.is_set():
                        raise
                    if self.leaves_out(device):
                        work.report(f"part {part}: {error}; device {device} is left out from here on")
                        device = self.free.get()
        finally:
            self.free.put(device)

    def leaves_out(self, device):
        """Unless it is the last one."""
        with self.lock:
            is_one_of_many = len(self.devices) > 1
            if is_one_of_many:
                self.devices.remove(device)
            return is_one_of_many

    def started(self, process):
        self.running.add(process)
        if self.is_ended.is_set():
            process.terminate()


class DaskWorkers:
    """Workers of a Dask cluster. They get the code of the task, so that they do not need the package mcdem."""

    def __init__(self, client):
        import cloudpickle
        cloudpickle.register_pickle_by_value(sys.modules[__name__])
        self.client = client

    def count(self):
        return len(self.client.scheduler_info()["workers"])

    def outcomes(self, work, parts):
        """One task per part; yields each part with its future when that is done."""
        from distributed import as_completed
        futures = {self.client.submit(compute_task, work.command, work.folder, part, key=f"part-{part}-{os.urandom(4).hex()}",
                                      retries=work.tries - 1, pure=False): part for part in parts}
        try:
            for future in as_completed(futures):
                yield futures[future], future
        finally:
            self.client.cancel(list(futures))


class Killed(RuntimeError):
    """A signal ended the process of a part."""


def compute_part(command, folder, part, device="", started=lambda process: None):
    """Returns None, or the reason why the program refuses its input. Raises RuntimeError after a failure, for another try."""
    words = [*command, "--part", part] + (["--device", device] if device else [])
    if shutil.which("setpriv"):  # ends the process with this one
        words = ["setpriv", "--pdeathsig", "TERM", *words]
    with subprocess.Popen(words, cwd=folder, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True,
                          errors="replace") as process:
        started(process)
        said = process.stderr.read()
    if process.returncode == 2:
        return said
    if process.returncode < 0 or process.returncode == INTERRUPTED:
        raise Killed("ended by a signal" if process.returncode > 0 else f"ended by signal {-process.returncode}")
    if process.returncode != 0:
        raise RuntimeError(f"exit code {process.returncode}: {said.strip()[-1000:]}")
    return None


def compute_task(command, folder, part):
    """The task of a Dask worker. In a cluster with one worker per device the worker's name is the index of its device."""
    from distributed import get_worker
    place, devices = get_worker().name, []
    if isinstance(place, int):
        devices = subprocess.run([command[0], "devices", "--alike"], capture_output=True, text=True).stdout.split()
    return compute_part(command, folder, part, devices[place % len(devices)] if devices else "")


def client_of(scheduler: str) -> Any:
    """Of a Dask scheduler that runs already, by its address or file."""
    import distributed
    try:
        return distributed.Client(scheduler_file=scheduler) if is_there(scheduler) else distributed.Client(scheduler)
    except (OSError, TypeError, ValueError) as error:
        raise InputError(f"--scheduler: must be the address or file of a Dask scheduler that answers, got {scheduler}: {error}")
