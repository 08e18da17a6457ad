"""Parses the command line: `mcdem WORD OPTION..`."""
import argparse
import importlib
import os
import re
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, NoReturn

from ..command import ask, program_path
from ..problems import to_number
from ..program import say
from . import COMMANDS, PROGRAM_COMMANDS

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
        message = message.replace(": not allowed with argument ", " excludes ")
        message = re.sub(r"^unrecognized arguments: ", "The following argument was not expected: ", message)
        say(message)
        say(f"`{self.prog} --help` tells more")
        raise SystemExit(BAD_INPUT)


def number(accepts: Callable[[float], bool], what: str) -> Callable[[str], float]:
    """Converts a finite number that `accepts` takes; others must be `what`."""
    def convert(text: str) -> float:
        value = to_number(text)
        if value is None or not accepts(value):
            raise argparse.ArgumentTypeError(f"must be {what}, got {text}")
        return value

    return convert


def whole(accepts: Callable[[int], bool], what: str) -> Callable[[str], int]:
    """Converts a whole number, likewise."""
    def convert(text: str) -> int:
        if not (re.fullmatch(r"[+-]?\d{1,20}", text, re.ASCII) and accepts(int(text))):
            raise argparse.ArgumentTypeError(f"must be {what}, got {text}")
        return int(text)

    return convert


def number_in(low: float, high: float) -> Callable[[str], float]:
    """Converts a number in this range."""
    return number(lambda value: low <= value <= high, f"a number from {low:g} to {high:g}")


def whole_in(low: int, high: int) -> Callable[[str], int]:
    """Converts a whole number in this range."""
    return whole(lambda value: low <= value <= high, f"a whole number from {low} to {high}")


at_least_zero = number(lambda value: value >= 0, "a number >= 0")
above_zero = number(lambda value: value > 0, "a number > 0")
whole_at_least_zero = whole(lambda value: 0 <= value < 10**9, "a whole number >= 0")
any_whole = whole(lambda value: abs(value) < 10**9, "a whole number")


# Name of a field -> default, unit, check, help of its option.
Numbers = Mapping[str, tuple[float, str, Callable[[str], float], str]]
any_seed = whole_in(0, 2**64 - 1)


def add_numbers(parser: argparse.ArgumentParser, numbers: Numbers) -> None:
    """An option for each: --library-packings for library_packings."""
    for name, (value, unit, check, text) in numbers.items():
        parser.add_argument("--" + name.replace("_", "-"), metavar=unit, type=check, default=value, help=text)


def given(options: argparse.Namespace, numbers: Iterable[str]) -> dict[str, Any]:
    """The values of these fields."""
    return {name: getattr(options, name) for name in numbers}


def names(text: str) -> list[str]:
    """A,B,.."""
    return text.split(",")


def output_path(text: str) -> str:
    """Refuses an empty path, which would mean the current folder."""
    if not text:
        raise argparse.ArgumentTypeError("must be a path, got nothing")
    return text


def run_command(words: Sequence[str]) -> int:
    """Runs a command with its arguments and returns its exit code. The program answers what is no command of Python."""
    word = words[0] if words else ""
    if word == "complete":
        complete(words[1:])
        return 0
    if word not in COMMANDS or word in PROGRAM_COMMANDS:
        program = program_path()
        os.execv(program, [program, *words])
    command, arguments = command_of(words)
    if subcommands(command):
        return answer_without_subcommand(command, arguments)
    module = module_of(command)
    parse = getattr(module, "parse", Parser.parse_intermixed_args)
    return int(module.run(parse(parser_of(command, module), arguments)))


def subcommands(command: str) -> list[str]:
    """Of a command such as `experiment`, which has only these."""
    return [both.removeprefix(f"{command} ") for both in COMMANDS if both.startswith(f"{command} ")]


def command_of(words: Sequence[str]) -> tuple[str, Sequence[str]]:
    """The command, of one or two words, and its arguments."""
    length = 2 if " ".join(words[:2]) in COMMANDS else 1
    return " ".join(words[:length]), words[length:]


def module_of(command: str) -> Any:
    return importlib.import_module("." + re.sub("[ -]", "_", command), __package__)


def parser_of(command: str, module: Any) -> Parser:
    parser = Parser(prog=f"mcdem {command}", description=COMMANDS[command], epilog=getattr(module, "EPILOG", None), formatter_class=Help,
                    allow_abbrev=False)
    module.add_arguments(parser)
    return parser


def answer_without_subcommand(command: str, words: Sequence[str]) -> int:
    """Prints the help of a command that has only subcommands, or refuses the words."""
    texts = "".join(f"  {name:12}{COMMANDS[f'{command} {name}']}\n" for name in subcommands(command))
    parser = Parser(prog=f"mcdem {command}", usage=f"mcdem {command} [-h] SUBCOMMAND ..", description=COMMANDS[command],
                    epilog=f"Subcommands:\n{texts}\n{module_of(command).EPILOG}", formatter_class=Help)
    if not words:
        parser.error("A subcommand is required")
    if words[0] not in ("-h", "--help"):
        parser.error(f"there is no {'option' if words[0].startswith('-') else 'command'} {words[0]}")
    parser.print_help()
    return 0


def complete(words: Sequence[str]) -> None:
    """Prints what can follow the words of a command line, of which the last one may be incomplete.

    A line is a candidate, with its description after a tab, or `:files` or `:folders` for those that the shell finds.
    """
    *given, word = words
    command, before = command_of(given)
    if names := subcommands(command):
        offer(word, {name: COMMANDS[f"{command} {name}"] for name in names if not before})
        return
    actions = parser_of(command, module_of(command))._actions
    options = {name: action for action in actions for name in action.option_strings if action.help is not argparse.SUPPRESS}
    asked = options.get(before[-1]) if before else None
    if asked and asked.nargs != 0:
        if asked.metavar in ("DIR", "FILE"):
            print(":folders" if asked.metavar == "DIR" else ":files")
        if asked.metavar == "KEY=VALUE":
            print(ask(["complete", "--", "run", "--set", word]), end="")  # the program knows the keys of a scene
    elif word.startswith("-"):
        offer(word, {name: (action.help or "").splitlines()[0] for name, action in options.items()})
    elif choices := [choice for action in actions if not action.option_strings for choice in action.choices or ()]:
        offer(word, dict.fromkeys(choices, ""))
    else:
        print(":files")


def offer(word: str, candidates: Mapping[str, str]) -> None:
    """Prints the candidates that continue the word, with their descriptions."""
    for name, about in candidates.items():
        if name.startswith(word):
            print(f"{name}\t{about}" if about else name)
