"""Exports grains and contacts of a run for ParaView (vtk.py) and OVITO (xyz.py). `mcdem export` runs it (host/cli/run/export.cpp)."""
import os
import pathlib

from ..errors import InputError, RunError
from ..files import expect_replaceable, output_folder, write_whole
from . import vtk as for_paraview
from . import xyz as for_ovito
from .run_file import RunFiles


def export(path, folder, *, vtk=False, xyz=False, replicas=(), scans=()):
    """Writes grains and contacts of a result folder for ParaView (vtk) or OVITO (xyz), as `mcdem export` does.
    `replicas`, `scans`: their numbers; all where empty. Returns the number of files."""
    formats = [for_paraview] * bool(vtk) + [for_ovito] * bool(xyz)
    if not formats:
        raise InputError("export: choose a format: vtk, xyz or both")
    run = RunFiles(pathlib.Path(path))
    for number in replicas:
        if not 0 <= number < len(run.replicas):
            raise InputError(f"--replica: must be one of 0 to {len(run.replicas) - 1}, got {number}")
    chosen = [replica for replica in run.replicas if not replicas or replica.number in replicas]
    try:
        with output_folder(folder) as folder:
            files = sum(write_format(form, run, chosen, folder, scans) for form in formats)
    except OSError as error:
        raise RunError(f"{error.filename or os.fspath(folder)}: cannot be written: {error.strerror or error}") from error
    if files == 0 and scans and not any(is_chosen(scan, scans) for replica in chosen for scan in replica.scans()):
        raise InputError(f"--scan: must be among the scans of {path} (column frame of plate.csv), got {', '.join(map(str, scans))}")
    if files == 0:
        raise InputError(f"{path}: has no positions to export: run with output.positions = true")
    return files


def is_chosen(scan, scans):
    return not scans or scan.frame in scans


def write_format(form, run, chosen, folder, scans):
    """The guide with a list of the replicas, and the files of the replicas, which are counted."""
    guide = folder / form.GUIDE_NAME
    expect_replaceable(guide, "the guide to an export", form.GUIDE[:60].encode())
    lines = [replica.file_name + "".join(f"  {key} = {replica.parameters.get(key, '')}" for key in run.varying_keys())
             for replica in chosen]
    write_whole(guide, (form.GUIDE + "".join(line + "\n" for line in lines)).encode("utf-8", "surrogateescape"))
    return sum(form.export_replica(replica, folder, lambda scan: is_chosen(scan, scans)) for replica in chosen)
