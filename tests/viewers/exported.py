"""Shared by the viewers' tests: a run, its export, and the values in the run's file."""
import pathlib
import subprocess
import sys
import tempfile

SKIPPED = 77


def skip(why):
    print(f"skipped: {why}")
    sys.exit(SKIPPED)


def missing(python, module):
    """Whether this Python lacks the module."""
    return subprocess.run([str(python), "-c", f"import {module}"], capture_output=True).returncode != 0


class Exported:
    """The run of a scene, a small one of two replicas if not stated, exported in one of the formats, in a temporary folder."""

    def __init__(self, program, source, form, scene="small.toml"):
        self._kept = tempfile.TemporaryDirectory(prefix=f"mcdem-{form}-")
        self.folder = pathlib.Path(self._kept.name)
        for words in (("run", source / "scenes" / scene, "--out", "run", "--no-figures"),
                      ("export", "run", f"--{form}", "--out", "view")):
            subprocess.run([str(word) for word in (program, *words)], cwd=self.folder, check=True, capture_output=True)
        self.view = self.folder / "view"

    def open(self):
        import h5py
        return h5py.File(self.folder / "run/run.h5")


def scan_of(file, replica, scan):
    """Positions, contacts and the row of observables of one scan, from run.h5."""
    offset = file[f"contacts/{replica}/offset"]
    return (file[f"particles/{replica}/position/value"][scan], file[f"contacts/{replica}/contact"][
        offset[scan]:offset[scan + 1]], file[f"observables/{replica}"][scan])


def arguments():
    """Arguments PROGRAM, SOURCE and the rest."""
    return pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2]).resolve(), sys.argv[3:]
