"""Parses the command line: `mcdem WORD OPTION..`."""
import argparse
import importlib
import math
import re
from collections.abc import Sequence
from typing import Any, NoReturn

from ..program import say
from . import COMMANDS

ABOUT = "Presents results of mcdem: dense packings of soft grains with multi-contact forces (MC-DEM)."
EXIT_CODES = "Exit codes: 0 success, 1 failure (also if output cannot be written), 2 invalid input, 130 interrupted."
BAD_INPUT = 2


class Help(argparse.RawDescriptionHelpFormatter):
    """Shows defaults."""

    def add_usage(self, usage: str | None, actions: Any, groups: Any, prefix: str | None = None) -> None:
        super().add_usage(usage, actions, groups, prefix or "Usage: ")

    def _get_help_string(self, action: argparse.Action) -> str:
        is_shown = action.option_strings and action.default not in (None, False, "", argparse.SUPPRESS, []) and action.nargs != 0
        return (action.help or "") + (" (default: %(default)s)" if is_shown else "")


class Parser(argparse.ArgumentParser):
    """Its errors are messages of mcdem."""

    def error(self, message: str) -> NoReturn:
        message = re.sub(r"^argument (\S+?)(/\S+)?: ", r"\1: ", message)
        message = re.sub(r"^the following arguments are required: ([^,]*).*", r"\1 is required", message)
        message = re.sub(r"^unrecognized arguments: ", "The following argument was not expected: ", message)
        say(message)
        say(f"`{self.prog} --help` tells more")
        raise SystemExit(BAD_INPUT)


def at_least_zero(text: str) -> float:
    """A finite number >= 0."""
    try:
        value = float(text.replace("_", "?"))
    except ValueError:
        value = math.nan
    if not (math.isfinite(value) and value >= 0):
        raise argparse.ArgumentTypeError(f"must be a number >= 0, got {text}")
    return value


def whole_at_least_zero(text: str) -> int:
    """A whole number >= 0."""
    value = at_least_zero(text)
    if not re.fullmatch(r"\+?\d{1,9}", text.strip(), re.ASCII):
        raise argparse.ArgumentTypeError(f"must be a whole number >= 0, got {text}")
    return int(value)


def output_path(text: str) -> str:
    """Refuses an empty path, which would mean the current folder."""
    if not text:
        raise argparse.ArgumentTypeError("must be a path, got nothing")
    return text


def general_help() -> str:
    width = max(map(len, COMMANDS)) + 2
    commands = "\n".join(f"  {word:{width}}{about}" for word, about in COMMANDS.items())
    return f"{ABOUT}\nUsage: mcdem COMMAND [OPTIONS]\n\nCommands:\n{commands}\n\n{EXIT_CODES}\n"


def run_command(words: Sequence[str]) -> int:
    """Runs a command with its arguments and returns its exit code."""
    word = words[0] if words else ""
    if word in ("-h", "--help"):
        print(general_help(), end="")
        return 0
    if word == "complete" and len(words) > 2:
        complete(words[1], words[2:])
        return 0
    if word not in COMMANDS:
        kind = "option" if word.startswith("-") else "command"
        say(f"there is no {kind} {word}" if word else "A subcommand is required")
        say("`mcdem --help` tells more")
        return BAD_INPUT
    command = importlib.import_module(f".{word}", __package__)
    return int(command.run(parser_of(word, command).parse_intermixed_args(words[1:])))


def parser_of(word: str, command: Any) -> Parser:
    """`command`: its module."""
    parser = Parser(prog=f"mcdem {word}", description=COMMANDS[word], epilog=getattr(command, "EPILOG", None), formatter_class=Help,
                    allow_abbrev=False)
    command.add_arguments(parser)
    return parser


def complete(command: str, words: Sequence[str]) -> None:
    """Prints what can follow the words of a command line, of which the last one may be incomplete (host/cli/shell/completion.cpp).

    A line is a candidate, with its description after a tab, or `:files` or `:folders` for those that the shell finds.
    """
    *before, word = words
    actions = parser_of(command, importlib.import_module(f".{command}", __package__))._actions
    options = {name: action for action in actions for name in action.option_strings if action.help is not argparse.SUPPRESS}
    asked = options.get(before[-1]) if before else None
    if asked and asked.nargs != 0:
        if asked.metavar in ("DIR", "FILE"):
            print(":folders" if asked.metavar == "DIR" else ":files")
    elif word.startswith("-"):
        for name, action in options.items():
            if name.startswith(word):
                print(f"{name}\t{(action.help or '').splitlines()[0]}")
    else:
        print(":files")
