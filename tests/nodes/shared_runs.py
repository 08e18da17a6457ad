"""Shared by the tests of several devices and nodes: a short sweep, its result by a single process, and a killed
process."""
import os
import pathlib
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

SKIPPED = 77
TIME_LIMIT = 1200  # seconds per command; only a hanging command takes that long

# 8 replicas in parts of 2; checkpoints are so frequent that a killed process leaves one.
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
checkpoint_minutes = 5e-4
[batch]
replicas = 2
[batch.vary]
"contact.model" = ["independent", "mc_dem"]
"grains.friction" = [0.01, 0.1]
"""
PARTS = ["--part-replicas", "2"]
ALONE = ["--part-replicas", "1"]
LAUNCHES = 11_000  # approximate number of kernel launches per part
TWO_DEVICES = {"POCL_DEVICES": "pthread pthread", "MCDEM_DEVICE": ""}  # PoCL provides two devices


def skip(reason):
    print(f"skipped: {reason}")
    sys.exit(SKIPPED)


def command_of(scene, out):
    return ["run", scene, "--out", out, "--no-figures"]


class Place:
    """A folder with the sweep, in which mcdem is run."""
    _alone = {}  # results of a single process, by sweep

    def __init__(self, mcdem):
        self.mcdem = str(pathlib.Path(mcdem).resolve())
        self.path = pathlib.Path(tempfile.mkdtemp(prefix="mcdem-nodes-"))
        (self.path / "sweep.toml").write_text(SWEEP)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        remove_until_gone(self.path)

    def start(self, words, environment=None):
        return subprocess.Popen(words, cwd=self.path, env={**os.environ, **(environment or {})}, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT)

    def run(self, words, environment=None):
        """Runs a command to its end; returns its output."""
        return finish(self.start(words, environment))

    def run_alone(self):
        """The result of a single process, shared by all tests with this sweep."""
        scene = (self.path / "sweep.toml").read_text()
        if scene not in self._alone:
            self.run([self.mcdem, *command_of("sweep.toml", "alone")])
            self._alone[scene] = {file.name: file.read_bytes() for file in (self.path / "alone").iterdir()}
        (self.path / "alone").mkdir(exist_ok=True)
        for name, content in self._alone[scene].items():
            (self.path / "alone" / name).write_bytes(content)

    def expect_like_alone(self, out):
        """Checks the bytes of the results, and that no folder of parts is left."""
        for name in ("run.h5", "plate.csv"):
            expected, got = ((self.path / folder / name).read_bytes() for folder in ("alone", out))
            assert expected == got, f"{out}/{name} differs{different_datasets(self.path, out)}"
        assert not (self.path / out / "parts").exists()


def different_datasets(path, out):
    """Names of the objects that differ between two files, for the message."""
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
    """Waits for a condition; returns its first true value."""
    end = time.monotonic() + TIME_LIMIT
    while time.monotonic() < end:
        value = condition()
        if value:
            return value
        time.sleep(0.002)
    raise AssertionError(f"waited in vain for {what}")


def remove_until_gone(folder):
    """Removes a folder to which others may still write."""
    def is_gone():
        shutil.rmtree(folder, ignore_errors=True)
        return not folder.exists()

    wait_until(is_gone, f"an end of {folder}")


def files_in(folder, pattern):
    """Files of a folder in which others create and remove files at the same time."""
    try:
        return list(folder.glob(pattern))
    except FileNotFoundError:
        return []


class Hold:
    """Blocks processes in the middle of their work (tests/layers/device_layer.cpp), so that they cannot finish before a
    test has done its part, whatever the speed of the machine: all of them or only the first, each after a number of
    kernel launches."""

    def __init__(self, place, launches=LAUNCHES // 2, only_one=False, after=None):
        self._folder = place.path / "held"
        self._folder.mkdir()
        self.environment = {"OPENCL_LAYERS": str(pathlib.Path(sys.argv[2]).resolve()), "MCDEM_TEST_KERNELS": str(launches),
                            "MCDEM_TEST_HOLD": str(self._folder)}
        if only_one:
            self.environment["MCDEM_TEST_VICTIM"] = str(place.path / "victim")
        if after:
            self.environment["MCDEM_TEST_AFTER"] = str(after)

    def wait_for(self, processes):
        """Waits until this number of processes is blocked; returns their process numbers."""
        files = wait_until(lambda: len(found := files_in(self._folder, "*")) >= processes and found, f"{processes} held")
        return sorted(int(file.name) for file in files)

    def kill_one(self):
        """kill -9 of a blocked process."""
        victim = self.wait_for(1)[0]
        os.kill(victim, signal.SIGKILL)
        return victim

    def end(self):
        """Releases them; no further process is blocked."""
        remove_until_gone(self._folder)


def is_told_to_end(process):
    """Whether the process has received SIGTERM, by its handler that works once."""
    caught = re.search(r"SigCgt:\s*([0-9a-f]+)", pathlib.Path(f"/proc/{process}/status").read_text())[1]
    return not int(caught, 16) >> (signal.SIGTERM - 1) & 1


def has_two_devices(place):
    devices = place.run([place.mcdem, "devices"], TWO_DEVICES)
    return len(re.findall(r"(?m)^ *\d+ ", devices)) >= 2


def run_tests(tests):
    """Runs each test in a folder of its own."""
    for test in tests:
        print(f"{test.__name__}: {test.__doc__}", flush=True)
        with Place(sys.argv[1]) as place:
            test(place)
