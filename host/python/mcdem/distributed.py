"""Computes parts of a run, a challenge or a diagnosis as Dask tasks, on this machine or on any Dask cluster.

mcdem.distributed.run("scene.toml", "out/sweep")                           # one process per device of this machine
mcdem.distributed.run("scene.toml", "out/sweep", client=Client(cluster))   # any cluster: Slurm, PBS, LSF, Kubernetes, ..
mcdem.distributed.compute(["challenge", "run", ...])                           # any command that works in parts

Each task is a process `mcdem .. --part K`. All machines need the program and the folders under the same paths. If a worker is
lost, another one computes its part again: parts are bit-identical wherever they are computed.
"""
import contextlib
import os
import shutil
import subprocess
import sys
from typing import Any, Callable

from .command import ask, problems_of, program_path
from .errors import INTERRUPTED, InputError, RunError
from .look import is_there
from .toml import assignments

TRIES = 3  # per part, not counting lost workers


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

    `words`: the command line after `mcdem`. `client`: a distributed.Client; default: a local cluster with one worker
    per device. `folder`: working folder of the command. Raises InputError and RunError.
    """
    report = report or (lambda line: print(f"mcdem: {line}", file=sys.stderr, flush=True))
    work = Work([program_path(), *words], os.path.abspath(folder or "."), tries, report)
    with contextlib.ExitStack() as stack:
        client = client or stack.enter_context(local_client(work))
        report(f"dashboard: {client.dashboard_link}")
        work.compute(client)


@contextlib.contextmanager
def local_client(work):
    """A client of workers 0, 1, ..; the name is the index of the worker's device."""
    from distributed import Client, LocalCluster
    devices = ask(["devices", "--alike"], work.folder).split()
    with LocalCluster(n_workers=len(devices), threads_per_worker=1, processes=True) as cluster, Client(cluster) as client:
        yield client


class Work:
    def __init__(self, command, folder, tries, report):
        self.command, self.folder, self.tries, self.report = command, folder, tries, report

    def missing(self, workers):
        return [int(part) for part in ask([*self.command[1:], "--missing", "--workers", str(workers)], self.folder).split()]

    def compute(self, client):
        before = None
        while True:
            missing = self.missing(max(1, len(client.scheduler_info()["workers"])))
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
                raise RunError("no part could be finished: fix the errors above first")
            self.submit(client, missing)
            before = missing

    def submit(self, client, parts):
        """One task per part; waits for all. Raises InputError if the program refuses its input."""
        from distributed import as_completed
        futures = {client.submit(compute_part, self.command, self.folder, part, key=f"part-{part}-{os.urandom(4).hex()}",
                                 retries=self.tries - 1, pure=False): part for part in parts}
        try:
            for done, future in enumerate(as_completed(futures), 1):
                part = futures[future]
                if future.status != "finished":
                    self.report(f"part {part}: {future.exception()}")
                elif future.result():
                    raise InputError(problems_of(future.result()))
                else:
                    self.report(f"part {part}: {done} of {len(parts)}")
        finally:
            client.cancel(list(futures))


def compute_part(command, folder, part):
    """The task. Returns None, or the reason why the program refuses its input. Raises RuntimeError after a failure, for another try."""
    from distributed import get_worker
    words = [*command, "--part", str(part)]
    place = get_worker().name
    if isinstance(place, int):  # a cluster with one worker per device
        devices = subprocess.run([command[0], "devices", "--alike"], capture_output=True, text=True).stdout.split()
        if devices:
            words += ["--device", devices[place % len(devices)]]
    if shutil.which("setpriv"):  # ends the process with its worker
        words = ["setpriv", "--pdeathsig", "TERM", *words]
    done = subprocess.run(words, cwd=folder, stdin=subprocess.DEVNULL, capture_output=True, text=True, errors="replace")
    if done.returncode == 2:
        return done.stderr
    if done.returncode != 0:
        raise RuntimeError(f"exit code {done.returncode}: {done.stderr.strip()[-1000:]}")
    return None


def send_by_value():
    """Sends the code of the task to the workers, so that they do not need the package mcdem."""
    if __name__ != "__main__":
        import cloudpickle
        cloudpickle.register_pickle_by_value(sys.modules[__name__])


def client_of(scheduler):
    """Of a Dask scheduler that runs already, by its address or file."""
    import distributed
    try:
        return distributed.Client(scheduler_file=scheduler) if is_there(scheduler) else distributed.Client(scheduler)
    except (OSError, TypeError, ValueError) as error:
        raise InputError(f"--scheduler: must be the address or file of a Dask scheduler that answers, got {scheduler}: {error}")


def main():
    """What `mcdem distribute` starts (host/cli/parts/distribute.cpp): TRIES SCHEDULER WORD.., the second may be empty."""
    tries, scheduler, *words = sys.argv[1:]
    with contextlib.ExitStack() as stack:
        client = stack.enter_context(client_of(scheduler)) if scheduler else None
        compute(words, client=client, tries=int(tries))


if __name__ == "__main__":
    main()
else:
    with contextlib.suppress(ModuleNotFoundError):  # reported where it is used
        send_by_value()
