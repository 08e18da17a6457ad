"""mcdem export: grains and contacts of a run for ParaView or OVITO."""
import argparse
from types import ModuleType

from ..errors import InputError
from .command_line import any_whole, output_path

EPILOG = """\
Needs positions and contacts in the run (output.positions, output.contacts: both on by default).
Examples:
  mcdem export out/small --vtk --out out/paraview
  mcdem export out/small --vtk --replica 1 --scan 6 7 --out out/some
  mcdem export out/small --xyz --out out/ovito"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("RUN", help="Result folder or file")
    parser.add_argument("--vtk", action="store_true",
                        help="Write VTKHDF files: grains, contacts, forces and walls, one file of each per scan")
    parser.add_argument("--xyz", action="store_true",
                        help="Write extended XYZ of the grains and a LAMMPS local dump of the contacts, one file of each per replica")
    parser.add_argument("--replica", metavar="N", type=any_whole, nargs="+", action="extend", default=[],
                        help="Numbers of the replicas to export; default: all")
    parser.add_argument("--scan", metavar="N", type=any_whole, nargs="+", action="extend", default=[],
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
    formats = _formats(options)
    if not formats:
        raise InputError("export: choose a format: vtk, xyz or both")
    return export(options.RUN, options.out, formats, options.replica, options.scan)
