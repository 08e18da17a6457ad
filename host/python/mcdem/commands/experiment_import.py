"""mcdem experiment import: an experiment from the tables of a laboratory or another program."""
import argparse
import math
import os
import pathlib
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, NoReturn

from ..errors import InputError
from ..program import say
from .command_line import number, output_path

if TYPE_CHECKING:
    from ..experiment.experiment import Experiment
    from ..importing.assemble import Imported
    from ..importing.import_files import Attempt
    from ..importing.mapping import Known
    from ..problems import Problems

EPILOG = """\
Without --mapping the meaning and units of the columns are guessed, reported and written to
DIR/mapping.toml. If a guess is uncertain, nothing is imported (exit code 2): correct the lines with a
question mark and repeat the import with --mapping. Tables given with --mapping replace those it names, so one
mapping serves all experiments of a laboratory. The box must be given.
z points upwards; in the mapping a minus sign before a column's name reverses it: z = "-depth".
Examples:
  mcdem experiment import data/plate.csv data/grains.csv data/contacts.csv --set 'box.size=[0.165, 0.166]' \\
      --set grains.youngs_modulus=23300 --out out/lab
  mcdem experiment import --mapping out/lab/mapping.toml --metadata data/known.toml --out out/lab
  mcdem experiment import data/second/* --mapping out/lab/mapping.toml --metadata data/known.toml --out out/second"""

MAPPING = "mapping.toml"
PICTURE = "record.png"  # of a testing machine's record


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("TABLE", nargs="*",
                        help="Tables of the plate, the grains and the contacts: text, raw files of testing machines, dumps of LAMMPS and LIGGGHTS, text and VTK of Yade, "
                             "extended xyz, regions of scikit-image, trackpy's and SPAM's tables; any may be packed with gzip")
    parser.add_argument("--out", metavar="DIR", type=output_path, required=True, help="Folder to create")
    parser.add_argument("--mapping", metavar="FILE", default="",
                        help="Meaning of the columns: the mapping.toml written by an import without this option, corrected by hand")
    parser.add_argument("--set", metavar="KEY=VALUE", action="append", default=[], dest="overrides",
                        help="Set a key of experiment.toml that the tables do not contain, such as 'box.size=[0.165, 0.166]'; may be "
                             "repeated")
    parser.add_argument("--metadata", metavar="FILE", default="", help="The same from a file in the format of experiment.toml")
    parser.add_argument("--voxel-size", metavar="LENGTH", type=number(lambda edge: 0 < edge <= 1, "> 0 and <= 1 [m]"),
                        help="Edge length of a voxel [m], for tables of images in voxels")
    parser.add_argument("--area", metavar="M2", type=number(lambda area: 0 < area <= 400, "> 0 and <= 400 [m2]"),
                        help="Area on which pressures of the plate's table act [m2]; default: the container's cross-section")
    parser.add_argument("--mass", metavar="KG", type=number(lambda mass: mass > 0, "> 0 [kg]"),
                        help="Mass of all grains [kg], for tables with relative density, void ratio or porosity in place of a height; without "
                             "it plate.start is the height of the first row")
    parser.add_argument("--solid-density", metavar="KG/M3", type=number(lambda density: density > 0, "> 0 [kg/m3]"),
                        help="Density of the grains' material [kg/m3], required by --mass")
    parser.add_argument("--name", metavar="TEXT", default="",
                        help="Name of the experiment (default: that of the metadata, or of the folder)")
    parser.add_argument("--gzip", action="store_true", help="Compress the tables with gzip")


def run(options: argparse.Namespace) -> int:
    from ..experiment.publish import expect_free, work_folder
    from ..outputs import FIGURE, expect_replaceable
    from ..problems import Problems
    expect_free(options.out)
    expect_replaceable(os.path.join(options.out, PICTURE), FIGURE)
    problems = Problems()
    settings = _settings(options, problems)
    with work_folder(options.out) as folder:
        experiment = _import(options, settings, problems, folder / "experiment")
    scans = experiment.recording.scans
    measured, contacts = sum(len(one) > 0 for one in scans.position), sum(map(len, scans.contacts))
    print(f"{options.out}: {len(scans)} frames, {len(experiment.recording.diameter)} grains in {measured} of them, {contacts} contacts")
    return 0


def _settings(options: argparse.Namespace, problems: "Problems") -> "Experiment":
    """Values that are not in the tables; their problems are reported together with all others."""
    from ..experiment.settings import parse_settings
    from ..importing.read_mapping import small_file
    text = small_file(options.metadata, "a text") if options.metadata else b""
    settings = parse_settings(text, options.metadata or "--set", options.overrides, problems)
    return replace(settings, name=options.name or settings.name or os.path.basename(os.path.abspath(options.out)))


def _known(settings: "Experiment", options: argparse.Namespace) -> "Known":
    """What the import knows without the tables; where a value is missing, its default."""
    from ..importing.mapping import Known
    if (options.mass is None) != (options.solid_density is None):
        raise InputError("--mass: needs --solid-density, and the other way round: their ratio is the volume of the grains")
    known = {"area": options.area, "solid_volume": options.mass / options.solid_density if options.mass else None,
             "youngs_modulus": settings.materials.get("grains.youngs_modulus"), "poisson_ratio": settings.materials.get("grains.poisson_ratio"),
             "voxel_size": options.voxel_size}
    recording = settings.recording
    return Known(box=(recording.box.size_x, recording.box.size_y), shape=recording.box.shape, plate_start=recording.plate_start,
                 programme=recording.has_programme, **{name: value for name, value in known.items() if value is not None})


def _import(options: argparse.Namespace, settings: "Experiment", problems: "Problems", work: pathlib.Path) -> "Experiment":
    """Makes the experiment in the new folder `work` and moves it to the folder of --out."""
    from ..experiment.publish import publish, read_back
    from ..importing.import_files import import_files
    attempt = import_files(options.TABLE, _known(settings, options), os.path.join(options.out, MAPPING), options.mapping,
                           problems.lines())
    if not attempt.imported:
        _refuse(options, attempt, attempt.problems, attempt.has_wrong_rows)
    _write(work, attempt.mapping, attempt.imported, settings, options.gzip)
    try:
        experiment = read_back(work, options.out, "with this mapping the tables do not give a valid experiment:")
        publish(work, options.out)
    except InputError as error:
        if not options.mapping:
            _refuse(options, attempt, error.problems, True)
        raise
    _write_picture(options, attempt)
    for note in attempt.imported.notes:
        say(note)
    return experiment


def _write_picture(options: argparse.Namespace, attempt: "Attempt") -> None:
    from ..outputs import FIGURE, replace_own
    if attempt.picture:
        file = os.path.join(options.out, PICTURE)
        replace_own(file, FIGURE, attempt.picture)
        say(f"{file} shows what was understood of the record")


def _write(work: pathlib.Path, mapping: str, imported: "Imported", settings: "Experiment", gzip: bool) -> None:
    """All files of the experiment."""
    from ..experiment.settings import settings_text
    from ..experiment.write import SETTINGS_FILE, write_files
    from ..importing.assemble import write_tables
    if math.isnan(settings.recording.plate_start):
        settings = replace(settings, recording=replace(settings.recording, plate_start=imported.plate_start))
    work.mkdir()
    write_tables(imported, work, gzip)
    write_files(work, {MAPPING: mapping.encode(errors="surrogateescape"),
                       SETTINGS_FILE: (settings_text(settings) + imported.programme).encode(errors="surrogateescape")})


def _refuse(options: argparse.Namespace, attempt: "Attempt", problems: Sequence[str], wrong_rows: bool) -> NoReturn:
    """Reports all problems, with the mapping for the user to correct. Raises InputError."""
    from ..files import create_whole
    from ..outputs import make_folder
    file = os.path.join(options.out, MAPPING)
    make_folder(options.out)
    if not create_whole(file, attempt.mapping.encode(errors="surrogateescape")):
        raise InputError(f"{file}: another program has just written it")
    _write_picture(options, attempt)
    what = (f"repair the tables, remove {file} and import again; or correct the wrong entries of {file} and import with --mapping {file}"
            if wrong_rows else f"correct the entries of {file} that begin with a question mark, remove the marks, and import again with "
            f"--mapping {file}")
    raise InputError([*problems, f"nothing is imported: {what}"])
