"""mcdem figures: figures for print of runs, or of a diagnosis."""
import argparse
import pathlib

from ..errors import InputError
from .command_line import output_path
from .sources import add_figure_options, add_reference_options, figure_options, load_runs, print_figures, reference_of

EPILOG = """\
PDF, PNG and SVG, 86 or 178 mm wide, without titles. Runs: top force, force distribution at one plate
displacement, Z without weak contacts, scaling law; programmes: forces, stresses and strains against
each other and against time. Diagnosis: location of the gap, candidate effects, gap reduction.
The values are in figures.json; the Python package mcdem.figures has one function per figure.
Examples:
  mcdem figures out/small --out out/figures
  mcdem figures out/small --out out/figures --against out/small --setting mc_dem"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("sources", metavar="RUN|DIAGNOSIS", nargs="+",
                        help="Result folders or files, or the folder of a diagnosis or its diagnosis.json")
    parser.add_argument("--out", metavar="DIR", type=output_path, required=True, help="Folder for the figures")
    add_reference_options(parser, "--against", "Experiment folder or run, drawn as points; several are combined")
    add_figure_options(parser)


def run(options: argparse.Namespace) -> int:
    from ..report.report_sources import diagnosis_file
    diagnoses = [file for source in options.sources if (file := diagnosis_file(source))]
    print_figures(_of_diagnosis(options, diagnoses[0]) if diagnoses else _of_runs(options), options.out)
    return 0


def _of_diagnosis(options: argparse.Namespace, file: str) -> list[pathlib.Path]:
    from ..outputs import output_folder
    from ..report.draw import draw_figures
    from ..report.diagnosis import read_diagnosis
    from ..report.diagnosis_values import diagnosis_figure_values
    if len(options.sources) > 1:
        raise InputError(f"{file}: cannot be combined with other runs or diagnoses")
    values = diagnosis_figure_values(read_diagnosis(file))
    with output_folder(options.out):
        return draw_figures(options.out, values)


def _of_runs(options: argparse.Namespace) -> list[pathlib.Path]:
    from ..report.draw import draw_runs
    from ..outputs import output_folder
    settings = load_runs(options.sources, contacts=True).settings
    reference = reference_of(options)
    with output_folder(options.out):
        return draw_runs(options.out, settings, reference, figure_options(options))
