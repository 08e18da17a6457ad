"""Calls the program `mcdem` from Python."""
import os
import pathlib
import shutil
import subprocess
import sys

from .errors import InputError, RunError


def program_path():
    """MCDEM_PROGRAM, otherwise mcdem in the search path."""
    found = os.environ.get("MCDEM_PROGRAM") or shutil.which("mcdem")
    if not found:
        raise RunError("the program mcdem is not in the search path: name it by MCDEM_PROGRAM")
    return str(pathlib.Path(found).resolve())


def problems_of(messages):
    return [line.removeprefix("mcdem: ") for line in messages.splitlines()]


def ask(words, folder=None):
    """Output of the program with these arguments; its messages go to standard error. Raises InputError and RunError."""
    done = subprocess.run([program_path(), *words], cwd=folder, capture_output=True, text=True, errors="replace")
    if done.returncode == 2:
        raise InputError(problems_of(done.stderr))
    if done.returncode != 0:
        raise RunError(f"exit code {done.returncode}: {done.stderr.strip()}")
    print(done.stderr, end="", file=sys.stderr, flush=True)
    return done.stdout


def report(sources, out, *, against=(), setting="", scans=None):
    """Writes the page of result folders and folders of diagnoses, as `mcdem report` does, and returns its path.

    `against`: experiments or runs that the runs are compared with, of which `setting` chooses one's; `scans`: most scans
    of a packing shown in space.
    """
    def folders(given):
        return [os.fspath(given)] if isinstance(given, (str, os.PathLike)) else [os.fspath(one) for one in given]

    words = ["report", *folders(sources), "--out", os.fspath(out)]
    for folder in folders(against):
        words += ["--against", folder]
    words += ["--setting", setting] if setting else []
    words += ["--scans", str(scans)] if scans else []
    ask(words)
    return pathlib.Path(out)


def export(path, folder, *, vtk=False, xyz=False, replicas=(), scans=()):
    """Writes grains and contacts of a result folder for ParaView (vtk) or OVITO (xyz), as `mcdem export` does.

    `replicas`, `scans`: their numbers; all where empty. Returns the number of files.
    """
    words = ["export", os.fspath(path), "--out", os.fspath(folder)] + ["--vtk"] * bool(vtk) + ["--xyz"] * bool(xyz)
    words += [f"--replica={number}" for number in replicas] + [f"--scan={number}" for number in scans]
    return int(ask(words).split()[0])
