"""Exports grains and contacts of a run for ParaView (vtk.py) and OVITO (xyz.py)."""
import pathlib
from collections.abc import Collection, Sequence
from types import ModuleType

from ..files import write_whole
from ..outputs import Kind, expect_replaceable
from ..results.parameters import keys_that_vary
from .run_file import read_replicas


def export(files: Sequence[str], folder: pathlib.Path, formats: Sequence[ModuleType], replicas: Collection[int] = (),
           scans: Collection[int] = ()) -> int:
    """Exports a run, whose files have been checked, into a folder (pathlib.Path) by modules of this package: vtk, xyz.
    `replicas`, `scans`: their numbers; all where empty. Returns the number of files."""
    run = read_replicas(files)
    varying = keys_that_vary([replica.parameters for replica in run])
    chosen = [replica for replica in run if not replicas or replica.number in replicas]
    listed = "".join(replica.file_name + "".join(f"  {key} = {replica.parameters.get(key, '')}" for key in varying) + "\n"
                     for replica in chosen)
    count = 0
    for form in formats:
        guide = folder / form.GUIDE_NAME
        expect_replaceable(guide, Kind("the guide to an export", form.GUIDE[:60].encode()))
        write_whole(guide, (form.GUIDE + listed).encode("utf-8", "surrogateescape"))
        count += sum(form.export_replica(replica, folder, lambda scan: not scans or scan.frame in scans) for replica in chosen)
    return count
