"""mcdem challenge make: simulated experiments with hidden effects."""
import argparse
import os

from ..parts import interruptible
from ..progress import Progress
from .command_line import add_numbers, any_seed, any_whole, at_least_zero, given, names, number_in, output_path
from .scene_options import add_device_option, add_scene_options, read_scene

EPILOG = """\
The same command continues where an interrupted one stopped.
Example:
  mcdem challenge make scenes/challenge.toml --out out/challenge --truth out/truth.json"""

SIZES = {
    "none": (60, "N", any_whole, "Number of experiments without an effect"),  # the plan reports all that are too small together
    "per_effect": (8, "N", any_whole, "Number of experiments with each effect of the library"),
    "pairs": (20, "N", any_whole, "Number of experiments with two effects of the library"),
    "unknown": (40, "N", any_whole, "Number of experiments with an effect that the library does not have"),
    "outside": (20, "N", any_whole, "Number of experiments with modulus or strain zero far outside their uncertainty"),
    "packings": (24, "N", any_whole, "Number of different packings; even"),
}
MEASUREMENT = {  # the fields of Measurement
    "position_error": (1e-4, "M", at_least_zero, "Standard error of each coordinate of a centre [m]"),
    "diameter_error": (2e-5, "M", at_least_zero, "Standard error of a diameter [m]"),
    "force_error": (0.05, "FRACTION", number_in(0, 1), "Relative standard error of a contact force"),
    "force_threshold": (0.004, "N", at_least_zero, "Contacts below this force are not measured [N]"),
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_scene_options(parser)
    parser.add_argument("--out", metavar="DIR", type=output_path, required=True, help="Folder for the challenge")
    parser.add_argument("--truth", metavar="FILE", type=output_path, help="File for the truth; default: DIR/truth.json")
    parser.add_argument("--seed", metavar="S", type=any_seed,
                        help="Seed of all draws; default: drawn at random and not shown")
    parser.add_argument("--effects", metavar="NAME,..", type=names, action="extend", default=[],
                        help="Effects to hide; default: a dozen of all kinds")
    add_numbers(parser, SIZES | MEASUREMENT)
    add_measure(parser)
    add_device_option(parser)


def add_measure(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--measure", choices=("plate", "grains", "all"), default="all",
                        help="What is measured: the force on the plate; also diameters and positions of grains; also contact forces")


def run(options: argparse.Namespace) -> int:
    from ..challenge.make import Options, make_challenge
    from ..challenge.plan import ChallengeSize
    from ..experiment.experiment import Measurement
    scene = read_scene(options)
    truth = options.truth or os.path.join(options.out, "truth.json")
    wanted = Options(folder=options.out, truth=truth, seed=options.seed, effects=options.effects, device=options.device, measure=options.measure,
                     size=ChallengeSize(*given(options, SIZES).values()), measurement=Measurement(**given(options, MEASUREMENT)))
    with interruptible(), Progress() as progress:
        seal = make_challenge(scene, wanted, progress.show)
    print(f"{options.out}: the challenge is made\ntruth: {truth}\nits SHA-256: {seal}")
    return 0
