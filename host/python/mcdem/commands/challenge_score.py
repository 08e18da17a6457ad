"""mcdem challenge score: comparison of the diagnoses of a challenge with its truth."""
import argparse
import os

from ..errors import InputError
from ..look import is_folder
from ..program import say
from ..progress import Progress
from .command_line import output_path

EPILOG = """\
A truth file whose SHA-256 is not the one in challenge.json is refused.
Example:
  mcdem challenge score out/challenge out/diagnoses"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("CHALLENGE", help="Folder of the challenge")
    parser.add_argument("DIAGNOSES", type=output_path, help="Folder of the diagnoses; the score is written to it")
    parser.add_argument("--truth", metavar="FILE", type=output_path, help="File with the truth (default: CHALLENGE/truth.json)")
    parser.add_argument("--no-figures", action="store_true", help="Do not draw figures")


def run(options: argparse.Namespace) -> int:
    from ..challenge.figure_values import score_figure_values
    from ..challenge.files import read_open_challenge
    from ..challenge.score import score_challenge
    from ..challenge.score_text import SCORE, SCORE_PAGE, score_json, score_markdown, table_of_arms, table_of_merits
    from ..challenge.truth import open_truth
    from ..outputs import expect_replaceable, output_folder, replace_own
    from ..report.draw import draw_figures, draw_if_possible
    from ..report.text_table import to_text
    challenge = read_open_challenge(options.CHALLENGE)
    truth = open_truth(options.truth or os.path.join(options.CHALLENGE, "truth.json"), challenge.sealed_sha256)
    if not is_folder(options.DIAGNOSES):
        raise InputError(f"{options.DIAGNOSES}: must be the folder of the diagnoses, got none")
    with output_folder(options.DIAGNOSES) as out:
        files = {out / "score.json": (SCORE, score_json), out / "score.md": (SCORE_PAGE, score_markdown)}
        for file, (kind, _) in files.items():
            expect_replaceable(file, kind)
        with Progress() as progress:
            score = score_challenge(truth, challenge, out, progress.show)
        for problem in score.not_diagnosed:
            say(f"not diagnosed: {problem}")
        for file, (kind, text_of) in files.items():  # before anything is printed, which may fail
            replace_own(file, kind, text_of(score).encode())
        print(f"{to_text(table_of_merits(score))}\n{to_text(table_of_arms(score))}")
        print(*(f"wrote {file}" for file in files), sep="\n", flush=True)
        if not options.no_figures:
            for figure in draw_if_possible(lambda: draw_figures(out, score_figure_values(score))):
                print(f"wrote {figure}")
    return 0
