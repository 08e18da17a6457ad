"""mcdem experiment from-run: a simulation as an experiment with measurement errors."""
import argparse
import re

from .challenge_make import MEASUREMENT, add_measure
from .command_line import add_numbers, any_seed, at_least_zero, given, number_in, output_path

EPILOG = """\
Materials are stated as in the run; its effects are not. Unstated errors act on the data but are not
written to experiment.toml, so that a diagnosis has to find them.
Examples:
  mcdem run scenes/small.toml --out out/begun --set protocol.scan_at_start=true
  mcdem experiment from-run out/begun --replica mc_dem --out out/measured"""


STATED = MEASUREMENT | {"diameter_error": (5e-5, *MEASUREMENT["diameter_error"][1:])}
# The other fields of Instrument (experiment/instrument.py); with effects' formulas of the diagnosis.
UNSTATED = {
    "force_bias": ("FRACTION", number_in(-0.5, 0.5), "relative error by which contact forces are measured too large"),
    "threshold_shift": ("N", number_in(-1, 1), "the true force threshold is higher by this [N]"),
    "position_bias": ("FRACTION", number_in(-0.05, 0.05), "relative error by which lengths are measured too large"),
    "strain_offset": ("M", number_in(-1, 1), "plate positions are measured too high by this [m]"),
    "gauge_drift": ("FRACTION", number_in(-0.5, 0.5), "relative error of the load cell's gain at the end of the last cycle; it grows in "
                    "proportion to the plate's path"),
    "zero_drift": ("FRACTION", number_in(-0.5, 0.5), "offset of the load cell at the end of the last cycle, over the maximum top force; it grows "
                   "in proportion to the plate's path"),
    "gauge_hysteresis": ("FRACTION", number_in(-0.5, 0.5), "excess of the top force during unloading, at half the maximum force, over the "
                         "maximum force"),
    "force_lag": ("M", at_least_zero, "plate travel by which the reading of the top force lags"),
    "guide_friction": ("FRACTION", number_in(0, 0.5), "friction of the plate's guide, which the load cell also reads, over the maximum "
                       "force"),
    "force_saturation": ("PER_N", at_least_zero, "a in f/(1 + a f), what is read of a contact force f"),
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser._negative_number_matcher = re.compile(r"-\.?\d")  # argparse takes -1e-3 for an option
    parser.add_argument("RUN", help="Result folder or file")
    parser.add_argument("--out", metavar="DIR", type=output_path, required=True, help="Folder to create")
    parser.add_argument("--replica", metavar="REPLICA", default="",
                        help="Label or number (from 0) of the replica; required if the run has several")
    parser.add_argument("--name", metavar="TEXT", default="", help="Name of the experiment (default: that of the run and the replica)")
    add_numbers(parser, STATED)
    add_numbers(parser, {name: (0.0, unit, check, f"Unstated error: {text}") for name, (unit, check, text) in UNSTATED.items()})
    parser.add_argument("--uncertainty", metavar="KEY=SIGMA", action="append", default=[],
                        help="Stated standard error of a material parameter, such as grains.youngs_modulus=500; may be repeated")
    parser.add_argument("--seed", metavar="N", type=any_seed, default=1, help="Seed of the noise")
    add_measure(parser)
    parser.add_argument("--gzip", action="store_true", help="Compress the tables with gzip")


def run(options: argparse.Namespace) -> int:
    from ..experiment.experiment import Measurement
    from ..experiment.from_run import Options, write_from_run
    from ..experiment.instrument import Instrument
    instrument = Instrument(Measurement(**given(options, STATED)), **given(options, UNSTATED))
    print(write_from_run(Options(run=options.RUN, out=options.out, replica=options.replica, name=options.name, seed=options.seed,
                                 instrument=instrument, uncertainty=options.uncertainty, gzip=options.gzip,
                                 measure=options.measure)))
    return 0
