"""What the tests of many devices and nodes share: a sweep of seconds, its result by one process, and a worker killed."""
import json
import os
import pathlib
import re
import signal
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
TIME_LIMIT = 300  # seconds for one command

# 8 replicas in parts of 2; checkpoints so often that a killed worker leaves one.
SWEEP = """name = "sweep"
[box]
size_x = 0.08
size_y = 0.08
[packing]
count = 60
packing_fraction = 0.55
[plate]
start = 0.09
end = 0.075
speed = 0.05
[protocol]
scans_per_stroke = 6
[output]
checkpoint_minutes = 0.002
[batch]
replicas = 2
[batch.vary]
"contact.model" = ["independent", "mc_dem"]
"grains.friction" = [0.01, 0.1]
"""
PARTS = ["--part-replicas", "2"]
TWO_DEVICES = {"POCL_DEVICES": "pthread pthread", "MCDEM_DEVICE": ""}  # PoCL stands for a machine with two


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def program(name, package):
    """The path of a program; without it the test is skipped."""
    for folder in [*os.environ["PATH"].split(":"), "/usr/sbin", "/sbin"]:
        if os.access(pathlib.Path(folder) / name, os.X_OK):
            return str(pathlib.Path(folder) / name)
    skip(f"{name} is not there (Debian package {package})")


def command_of(scene, out):
    return ["run", scene, "--out", out, "--no-figures"]


class Place:
    """A folder with the sweep in it, and mcdem run there."""

    def __init__(self, mcdem):
        self.mcdem = str(pathlib.Path(mcdem).resolve())
        self._temporary = tempfile.TemporaryDirectory(prefix="mcdem-nodes-")
        self.path = pathlib.Path(self._temporary.name)
        (self.path / "sweep.toml").write_text(SWEEP)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._temporary.cleanup()

    def start(self, words, environment=None):
        return subprocess.Popen(words, cwd=self.path, env={**os.environ, **(environment or {})}, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def run(self, words, environment=None):
        """Runs words to their end; what they said."""
        return finish(self.start(words, environment))

    def run_alone(self):
        self.run([self.mcdem, *command_of("sweep.toml", "alone")])

    def expect_like_alone(self, out):
        """The bytes of the result, and nothing beside it but what the caller knows of."""
        for name in ("run.h5", "plate.csv"):
            expected, got = ((self.path / folder / name).read_bytes() for folder in ("alone", out))
            assert expected == got, f"{out}/{name} differs{different_datasets(self.path, out)}"
        assert not (self.path / out / "parts").exists()


def different_datasets(path, out):
    """Which objects of the two files differ: for the message."""
    try:
        import h5py
    except ImportError:
        return ""
    differing = []
    with h5py.File(path / "alone/run.h5") as one, h5py.File(path / out / "run.h5") as other:
        def look(name, thing):
            if isinstance(thing, h5py.Dataset) and (name not in other or thing[()].tobytes() != other[name][()].tobytes()):
                differing.append(name)
        one.visititems(look)
    return f" in {differing[:5]}"


def finish(process, exit_codes=(0,)):
    try:
        said = process.communicate(timeout=TIME_LIMIT)[0]
    except subprocess.TimeoutExpired:
        process.kill()
        said = process.communicate()[0]
        raise AssertionError(f"{process.args}: longer than {TIME_LIMIT} s:\n{said}") from None
    assert process.returncode in exit_codes, f"{process.args}: exit code {process.returncode}:\n{said}"
    return said


def wait_until(condition, what):
    """The first true value of the condition."""
    end = time.monotonic() + TIME_LIMIT
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.002)
    raise AssertionError(f"waited in vain for {what}")


def files_in(folder, pattern):
    """What lies in a folder that others write to, and remove, at the same time."""
    try:
        return list(folder.glob(pattern))
    except FileNotFoundError:
        return []


def claim_of(file):
    """What a claim says; an empty one where another program has just moved or removed it."""
    try:
        return json.loads(file.read_text())
    except (OSError, ValueError):
        return {}


def holders_at_work(folder):
    """Numbers of the processes that hold a part in the folder and have left a checkpoint of it."""
    holders = set()
    for checkpoint in files_in(folder, "*.work-*/checkpoint.h5"):
        file = folder / checkpoint.parent.name.replace(".work-", ".claim-")
        claim = claim_of(file)
        if claim.get("state") == "held" and not (folder / f"{file.stem}.h5").exists():
            holders.add(claim["process"])
    return holders


def devices_of_parts(folder, process):
    """Numbers and names of the devices on which parts in the folder are computed until the process has ended."""
    devices = set()
    while process.poll() is None:
        for claim in map(claim_of, files_in(folder, "0*.claim-*")):
            if claim:
                devices.add((claim["device"]["number"], claim["device"]["name"]))
        time.sleep(0.002)
    return devices


def signal_a_worker(folder, number, besides=()):
    """To one that is in the middle of a part; its number."""
    victim = min(wait_until(lambda: holders_at_work(folder) - set(besides), "a worker with a checkpoint"))
    os.kill(victim, number)
    return victim


def kill_a_worker(folder):
    """kill -9 of one that is in the middle of a part."""
    return signal_a_worker(folder, signal.SIGKILL)


def stop_a_worker(folder, besides=()):
    """Holds one up that is in the middle of a part, so that this is not done before the worker is lost."""
    return signal_a_worker(folder, signal.SIGSTOP, besides)


def has_two_devices(place):
    devices = place.run([place.mcdem, "devices"], TWO_DEVICES)
    return len(re.findall(r"(?m)^ *\d+ ", devices)) >= 2


class PartsSeen:
    """Every part file that ever lay in the folder, by its inode: a part that is done twice has two."""

    def __init__(self, folder):
        self.folder, self.inodes = folder, {}

    def look(self):
        for file in files_in(self.folder, "*.h5"):
            try:
                self.inodes.setdefault(file.name, set()).add(file.stat().st_ino)
            except OSError:
                pass

    def watch(self, process):
        while process.poll() is None:
            self.look()
            time.sleep(0.01)

    def expect_each_once(self):
        assert self.inodes and all(len(inodes) == 1 for inodes in self.inodes.values()), self.inodes


def run_tests(tests):
    """Runs each of them on a place of its own."""
    for test in tests:
        print(f"{test.__name__}: {test.__doc__}", flush=True)
        with Place(sys.argv[1]) as place:
            test(place)
