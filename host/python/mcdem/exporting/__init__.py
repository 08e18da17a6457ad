"""Exports grains and contacts of a run for ParaView (vtk.py) and OVITO (xyz.py)."""
import os
from collections.abc import Collection, Sequence
from types import ModuleType

from ..errors import InputError
from ..files import write_whole
from ..look import Path, is_link, is_there
from ..outputs import Kind, expect_replaceable, output_folder, remove_temporaries
from ..results import read_run
from ..results.folder import result_files
from ..results.parameters import keys_that_vary
from .scans import Replica


def export(run: str, out: Path, formats: Sequence[ModuleType], replicas: Collection[int] = (), scans: Collection[int] = ()) -> int:
    """Exports a run (result folder or file) into the folder `out` by modules of this package: vtk, xyz. `replicas`, `scans`: their
    numbers; all where empty. Returns the number of files.

    Raises InputError, before anything is written, if a number is not there, no chosen scan has positions, or what is chosen is damaged;
    RunError and OSError.
    """
    files, recordings = result_files(run), read_run(run).recordings
    for number in replicas:
        if not 0 <= number < len(recordings):
            raise InputError(f"--replica: must be one of 0 to {len(recordings) - 1}, got {number}")
    everyone = [Replica(number, files, recording) for number, recording in enumerate(recordings)]
    chosen = [replica for replica in everyone if not replicas or replica.number in replicas]
    _expect_positions(run, chosen, scans)
    with output_folder(out) as folder:
        for entry in folder.glob("replica_*"):  # of earlier exports
            if not is_link(entry):
                remove_temporaries(entry)
        try:
            return _write(folder, formats, chosen, keys_that_vary([recording.parameters for recording in recordings]), scans)
        except InputError:
            if all(map(is_there, files)):
                raise
            raise InputError(f"{os.path.dirname(files[0])}: the run has ended meanwhile: repeat the command") from None


def _expect_positions(run, replicas, scans):
    """Reads all that is exported once, so that damage is found before anything is written."""
    positions = [scan.position is not None for replica in replicas for scan in replica.scans() if not scans or scan.frame in scans]
    if scans and not positions:
        raise InputError(f"--scan: must be among the scans of {run} (column frame of plate.csv), got {', '.join(map(str, scans))}")
    if not any(positions):
        raise InputError(f"{run}: has no positions to export: run with output.positions = true")


def _write(folder, formats, replicas, varying, scans):
    listed = "".join(replica.file_name + "".join(f"  {key} = {replica.parameters.get(key, '')}" for key in varying) + "\n"
                     for replica in replicas)
    count = 0
    for form in formats:
        guide = folder / form.GUIDE_NAME
        expect_replaceable(guide, Kind("the guide to an export", form.GUIDE[:60].encode()))
        write_whole(guide, (form.GUIDE + listed).encode("utf-8", "surrogateescape"))
        count += sum(form.export_replica(replica, folder, lambda scan: not scans or scan.frame in scans) for replica in replicas)
    return count
