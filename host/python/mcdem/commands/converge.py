"""mcdem converge: influence of a scene's numerics on its results."""
import argparse

from ..parts import interruptible
from ..program import say
from ..progress import StageProgress
from .command_line import above_zero, add_numbers, any_seed, given, number_in, output_path, whole_in
from .scene_options import add_device_option, add_scene_options, read_scene

EPILOG = """\
Runs the scene as it stands and with finer numerics, all from the same jittered packings: the plate 2, 4
and 8 times slower (protocol.rate_tolerance is lowered with plate.speed), a quarter of the density, half
the time step, wider neighbour lists, double precision if the scene has single precision, and, if the
plate stops at scans, stricter settling and no stops. Errors are extrapolated to the limit. Reports for
every observable of the diagnosis the error with its standard error, its cause, the setting that
brings it below the limit, and how much longer runs take. If jittered copies hardly differ, every
replica is a new random packing. Simulations are kept in DIR/simulations: the same command continues
an interrupted one.
Example:
  mcdem converge scenes/small.toml --set contact.model=mc_dem --out out/converge --replicas 8"""


NUMBERS = {
    "replicas": (32, "N", whole_in(8, 10_000), "Number of jittered copies of the packing; comparisons are paired"),
    "jitter": (0.0, "M", number_in(0, 1), "Standard deviation of the jitter [m]; 0: half a per cent of a diameter"),
    "force_limit": (0.005, "X", above_zero, "Largest relative error allowed in forces"),
    "sd_limit": (0.5, "X", above_zero, "Largest error allowed in other observables, in standard deviations over the copies"),
    "seed": (1, "N", any_seed, "Seed of the jitter"),
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    add_scene_options(parser)
    parser.add_argument("--out", metavar="DIR", type=output_path, required=True,
                        help="Folder for the table, the figure and the simulations")
    add_numbers(parser, NUMBERS)
    add_device_option(parser)


def run(options: argparse.Namespace) -> int:
    from ..convergence.converge import Study
    from ..convergence.convergence_json import FILE, write_convergence
    from ..convergence.convergence_types import Limits
    from ..convergence.simulator import Simulator
    from ..outputs import CONVERGENCE, expect_replaceable, output_folder, remove_temporaries
    from ..report.draw import expect_replaceable_figures
    from ..report.present_convergence import present
    scene = read_scene(options)
    with output_folder(options.out) as folder:
        remove_temporaries(folder / "simulations")
        expect_replaceable(folder / FILE, CONVERGENCE)
        expect_replaceable_figures(folder, ("convergence",))
        with interruptible(), StageProgress() as stages:
            simulator = Simulator(scene, options.out, **given(options, ("replicas", "jitter", "seed", "device")))
            say(f"{scene.name} on {simulator.device_name}")
            if len(scene) > 1:
                say(f"the scene has {len(scene)} replicas; the first one is looked at: {scene.labels[0]}")
            limits = Limits(options.force_limit, options.sd_limit)
            convergence = Study(scene, simulator, options.jitter, limits, stages.show).run()
        write_convergence(convergence, folder)
        present(convergence, options.out)
    return 0
