"""mcdem distribute: the parts of a command as processes of this machine, or as tasks of Dask."""
import argparse
import contextlib
import subprocess
from collections.abc import Sequence

from ..command import program_path
from ..errors import InputError
from ..program import raise_when_interrupted
from .command_line import Parser, whole_in

EPILOG = """\
COMMAND is `run`, `challenge run` or `diagnose`, with its options. Its parts become processes of this machine, or
tasks of the Dask scheduler that --scheduler names. A lost part is computed again, and the same command continues
with what is missing. The result equals that of one process bit for bit. Everybody who reaches a scheduler can run
code on its workers: protect it by TLS (host/ensemble/README.md). From Python: mcdem.distributed (host/python/README.md).
Examples:
  mcdem distribute run scenes/replicas.toml --out out/replicas
  mcdem distribute --scheduler tls://head:8786 run scenes/replicas.toml --out out/replicas"""

COMMANDS = (["run"], ["diagnose"], ["challenge", "run"])
OWN_OPTIONS = ("--device", "--part", "--merge", "--missing", "--workers")


def add_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("--scheduler", metavar="ADDRESS", default="",
                        help="Address (tls://.., tcp://..) or file of a running Dask scheduler, which needs python3-distributed; "
                             "default: one process at a time on each device of this machine")
    parser.add_argument("--tries", metavar="N", type=whole_in(1, 100), default=3, help="Number of attempts for a part that fails")
    parser.add_argument("words", metavar="COMMAND", nargs=argparse.REMAINDER, help="The command, with its options")


def parse(parser: Parser, words: Sequence[str]) -> argparse.Namespace:
    """From the first word that is no option, all words belong to the command."""
    options, unknown = parser.parse_known_args(words)
    options.words = unknown + options.words
    return options


def run(options: argparse.Namespace) -> int:
    _expect_command(options.words)
    if {"-h", "--help"} & {*options.words}:
        return subprocess.run([program_path(), *options.words]).returncode
    from ..distributed import client_of, compute
    with contextlib.ExitStack() as stack:
        client = stack.enter_context(client_of(options.scheduler)) if options.scheduler else None
        raise_when_interrupted()
        compute(options.words, client=client, tries=options.tries)
    return 0


def _expect_command(words: Sequence[str]) -> None:
    """Raises InputError unless the words are a command that works in parts, without the options that are given here."""
    if not any(words[:len(command)] == command for command in COMMANDS):
        got = f"; got {' '.join(words[:2])}" if words else ""
        raise InputError(f"a command is needed: run, challenge run or diagnose, with its options{got}")
    for word in words:
        if word.split("=")[0] in OWN_OPTIONS:
            raise InputError(f"{word}: cannot be given here, `mcdem distribute` sets it for each process")
