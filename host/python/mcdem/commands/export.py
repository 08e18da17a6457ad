"""mcdem export: grains and contacts of a run for ParaView or OVITO."""
import argparse
import os
from collections.abc import Sequence
from types import ModuleType

from ..errors import InputError
from ..results import Recording, read_run
from ..results.folder import result_files
from .command_line import output_path

EPILOG = """\
Needs positions and contacts in the run (output.positions, output.contacts: both on by default), and the Python package h5py.
Examples:
  mcdem export out/small --vtk --out out/paraview
  mcdem export out/small --vtk --replica 1 --scan 6 7 --out out/some
  mcdem export out/small --xyz --out out/ovito"""


def whole_number(text: str) -> int:
    try:
        return int(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"must be a whole number, got {text}") from None


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("RUN", help="Result folder or file")
    parser.add_argument("--vtk", action="store_true",
                        help="Write VTKHDF files: grains, contacts, forces and walls, one file of each per scan")
    parser.add_argument("--xyz", action="store_true",
                        help="Write extended XYZ of the grains and a LAMMPS local dump of the contacts, one file of each per replica")
    parser.add_argument("--replica", metavar="N", type=whole_number, nargs="+", action="extend", default=[],
                        help="Numbers of the replicas to export; default: all")
    parser.add_argument("--scan", metavar="N", type=whole_number, nargs="+", action="extend", default=[],
                        help="Numbers of the scans to export (column frame of plate.csv); default: all")
    parser.add_argument("--out", metavar="DIR", type=output_path, required=True, help="Folder for the exported files")


def run(options: argparse.Namespace) -> int:
    count = write_files(options)
    guides = ", ".join(f"{options.out}/{form.GUIDE_NAME}" for form in _formats(options))
    print(f"{count} files in {options.out}; how to view them: {guides}")
    return 0


def _formats(options: argparse.Namespace) -> list[ModuleType]:
    from ..exporting import vtk, xyz
    return [form for form, is_chosen in ((vtk, options.vtk), (xyz, options.xyz)) if is_chosen]


def write_files(options: argparse.Namespace) -> int:
    """Returns the number of files."""
    from ..exporting import export
    from ..look import is_link, is_there
    from ..outputs import output_folder, remove_temporaries
    formats = _formats(options)
    if not formats:
        raise InputError("export: choose a format: vtk, xyz or both")
    files = _checked_files(options)
    with output_folder(options.out) as folder:
        for entry in folder.glob("replica_*"):  # of earlier exports
            if not is_link(entry):
                remove_temporaries(entry)
        try:
            return int(export(files, folder, formats, options.replica, options.scan))
        except FileNotFoundError:
            if all(map(is_there, files)):
                raise
            raise InputError(f"{os.path.dirname(files[0])}: the run has ended meanwhile: repeat the command") from None


def _checked_files(options: argparse.Namespace) -> list[str]:
    """The files of the run, after all of it was read once: the exporting modules rely on its form."""
    recordings = read_run(options.RUN, contacts=True, positions=True).recordings
    for number in options.replica:
        if not 0 <= number < len(recordings):
            raise InputError(f"--replica: must be one of 0 to {len(recordings) - 1}, got {number}")
    chosen = [one for number, one in enumerate(recordings) if not options.replica or number in options.replica]
    _expect_positions(chosen, options.scan, options.RUN)
    return result_files(options.RUN)


def _expect_positions(recordings: Sequence[Recording], frames: Sequence[int], run: str) -> None:
    positions = [len(position) > 0 for one in recordings
                 for frame, position in zip(one.scans.frame.tolist(), one.scans.position, strict=True) if not frames or frame in frames]
    if frames and not positions:
        raise InputError(f"--scan: must be among the scans of {run} (column frame of plate.csv), got {', '.join(map(str, frames))}")
    if not any(positions):
        raise InputError(f"{run}: has no positions to export: run with output.positions = true")
