"""mcdem challenge run: diagnoses of all experiments of a challenge."""
import argparse

from ..parts import SharedWork, add_sharing_options, interruptible, is_shared, share
from ..program import say
from ..progress import Progress
from .command_line import add_numbers, any_seed, given, names, output_path, whole_in
from .scene_options import add_scene_options, read_scene

EPILOG = """\
The same command continues where an interrupted one stopped.
Many devices or nodes compute it in parts (`mcdem distribute challenge run ..`): the simulations of the library,
then the cases.
Example:
  mcdem challenge run out/challenge --scene scenes/challenge.toml --library out/library.json --out out/diagnoses"""

NUMBERS = {
    "replicates": (8, "N", whole_in(1, 10_000), "Number of simulations of each experiment with the unchanged scene"),
    "confirmations": (4, "N", whole_in(0, 10_000), "Number of confirming simulations of each diagnosis"),
    "library_packings": (16, "N", whole_in(1, 10_000), "Number of packings of a new library"),
    "library_replicates": (4, "N", whole_in(1, 10_000), "Simulations per packing of a new library"),
    "library_pairs": (1, "N", whole_in(1, 10_000), "Simulations of a new library that are repeated with every effect"),
}


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("CHALLENGE", help="Folder of the challenge")
    add_scene_options(parser, "--scene", "Scene that the challenge was made with")
    parser.add_argument("--library", metavar="FILE", type=output_path, required=True,
                        help="File with the simulated changes by each effect; computed and written if it does not exist")
    parser.add_argument("--out", metavar="DIR", type=output_path, required=True, help="Folder for the diagnoses")
    add_numbers(parser, NUMBERS)
    parser.add_argument("--candidates", metavar="NAME,..", type=names, action="extend", default=[],
                        help="Effects of a new library; default: all")
    parser.add_argument("--seed", metavar="N", type=any_seed, default=1, help="Seed of all random numbers of the diagnoses")
    add_sharing_options(parser)


def run(options: argparse.Namespace) -> int:
    from ..challenge.run import Options, challenge_work, run_challenge
    wanted = Options(challenge=options.CHALLENGE, out=options.out, library=options.library, candidates=options.candidates,
                     seed=options.seed, device=options.device, **given(options, NUMBERS))
    scene = read_scene(options)

    def report() -> int:
        print(f"{options.out}: all cases are diagnosed")
        return 0

    if is_shared(options):
        return share(SharedWork(options.out, lambda _: challenge_work(scene, wanted, say, shared=True), report), options)
    with interruptible(), Progress() as progress:
        def tell(problem: str) -> None:
            progress.clear()
            say(problem)

        run_challenge(scene, wanted, progress.show, tell)
    return report()
