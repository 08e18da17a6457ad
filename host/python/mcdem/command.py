"""Calls the program `mcdem` from Python, and those of its commands that are written in Python."""
import argparse
import os
import pathlib
import shutil
import subprocess
import sys
from collections.abc import Sequence

from .errors import InputError, RunError
from .look import Path


def program_path() -> str:
    """MCDEM_PROGRAM, otherwise mcdem in the search path."""
    found = os.environ.get("MCDEM_PROGRAM") or shutil.which("mcdem")
    if not found:
        raise RunError("the program mcdem is not in the search path: name it by MCDEM_PROGRAM")
    return str(pathlib.Path(found).resolve())


def problems_of(messages: str) -> list[str]:
    return [line.removeprefix("mcdem: ") for line in messages.splitlines()]


def ask(words: Sequence[str], folder: Path | None = None) -> str:
    """Output of the program with these arguments; its messages go to standard error. Raises InputError and RunError."""
    done = subprocess.run([program_path(), *words], cwd=folder, capture_output=True, text=True, errors="replace")
    if done.returncode == 2:
        raise InputError(problems_of(done.stderr))
    if done.returncode != 0:
        raise RunError(f"exit code {done.returncode}: {done.stderr.strip()}")
    print(done.stderr, end="", file=sys.stderr, flush=True)
    return done.stdout


def folders(given: Path | Sequence[Path]) -> list[str]:
    return [os.fspath(given)] if isinstance(given, (str, os.PathLike)) else [os.fspath(one) for one in given]


def report(sources: Path | Sequence[Path], out: Path, *, against: Path | Sequence[Path] = (), setting: str = "",
           scans: int | None = None) -> pathlib.Path:
    """Writes the page of result folders and folders of diagnoses, as `mcdem report` does, and returns its path.

    `against`: experiments or runs that the runs are compared with, of which `setting` chooses one's; `scans`: most scans
    of a packing shown in space. Raises InputError, RunError, OSError.
    """
    if scans is not None and scans < 1:
        raise InputError(f"scans: must be at least 1, got {scans}")
    from .commands.report import write_report
    write_report(argparse.Namespace(sources=folders(sources), out=os.fspath(out), against=folders(against), setting=setting, discard=0,
                                    distribution_displacement=18e-3, threshold=0, scans=scans))
    return pathlib.Path(out)


def export(path: Path, folder: Path, *, vtk: bool = False, xyz: bool = False, replicas: Sequence[int] = (),
           scans: Sequence[int] = ()) -> int:
    """Writes grains and contacts of a result folder for ParaView (vtk) or OVITO (xyz), as `mcdem export` does.

    `replicas`, `scans`: their numbers; all where empty. Returns the number of files. Raises InputError, RunError, OSError.
    """
    from .commands.export import write_files
    return write_files(argparse.Namespace(RUN=os.fspath(path), out=os.fspath(folder), vtk=vtk, xyz=xyz, replica=list(replicas),
                                          scan=list(scans)))
