"""mcdem export: grains and contacts of a run for ParaView or OVITO."""
import argparse
import os
from collections.abc import Sequence
from types import ModuleType

from ..errors import InputError
from ..results import read_run
from ..results.folder import result_files
from ..results.run_file import whole_scans
from .command_line import output_path

EPILOG = """\
Needs positions and contacts in the run (output.positions, output.contacts: both on by default).
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
    """The files of the run, after what is exported was read once: the exporting modules rely on its form."""
    recordings = read_run(options.RUN).recordings
    for number in options.replica:
        if not 0 <= number < len(recordings):
            raise InputError(f"--replica: must be one of 0 to {len(recordings) - 1}, got {number}")
    files = result_files(options.RUN)
    _expect_positions([one for file in files for one in _positions_of(file, options)], options)
    return files


def _positions_of(file: str, options: argparse.Namespace) -> list[bool]:
    """Whether each chosen scan has positions. Raises InputError if anything of the chosen replicas is damaged."""
    return [len(position) > 0 for scans in whole_scans(file, options.replica or True)
            for frame, position in zip(scans.frame.tolist(), scans.position, strict=True) if not options.scan or frame in options.scan]


def _expect_positions(positions: Sequence[bool], options: argparse.Namespace) -> None:
    if options.scan and not positions:
        raise InputError(f"--scan: must be among the scans of {options.RUN} (column frame of plate.csv), got "
                         f"{', '.join(map(str, options.scan))}")
    if not any(positions):
        raise InputError(f"{options.RUN}: has no positions to export: run with output.positions = true")
