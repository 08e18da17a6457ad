"""mcdem completion: scripts for shells, which ask `mcdem complete -- WORD..` for the words that can follow."""
import argparse
import pathlib

EPILOG = """\
Installed by `cmake --install`. Without installing, for the current shell:
  source <(mcdem completion bash)"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("SHELL", choices=("bash", "zsh", "fish"), help="bash, zsh or fish")


def run(options: argparse.Namespace) -> int:
    print(pathlib.Path(__file__).with_suffix(f".{options.SHELL}").read_text(), end="")
    return 0
