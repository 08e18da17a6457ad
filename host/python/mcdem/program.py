"""Runs a module as a command of the program: MODULE ARGUMENT... (start.py).

Messages begin with `mcdem: `. Exit codes: 0 done, 1 failed, 2 bad input, 130 interrupted. An error that is not expected is one line,
or with MCDEM_DEBUG its traceback.
"""
import contextlib
import io
import os
import runpy
import signal
import sys
import time
import traceback
import warnings
from collections.abc import Callable
from types import FrameType
from typing import NoReturn, TextIO, cast

from .errors import INTERRUPTED, InputError, RunError
from .files import remove_unfinished

# Module -> Debian package, if its name is not python3-MODULE.
PACKAGES = {"PIL": "python3-pil"}

# Characters that a terminal obeys instead of showing them: C0 without tab and new line, C1 (also as bytes that are no UTF-8),
# separators of lines, and those that change the direction of the text around them. As blank_control in host/cli/shell/standard_streams.h.
CONTROL = [*range(0x20), *range(0x7f, 0xa0), *range(0xdc80, 0xdca0), 0x61c, 0x200e, 0x200f, *range(0x2028, 0x202f),
           *range(0x2066, 0x206a)]
BLANKS = dict.fromkeys(CONTROL, " ") | {ord("\n"): "\n", ord("\t"): "\t"}


class Shown(io.TextIOWrapper):
    """A stream to the user, with blanks for control characters: names come from files of others."""

    def write(self, text: str) -> int:
        super().write(text.translate(BLANKS))
        return len(text)


def shown(stream: TextIO, by_line: bool) -> Shown:
    return Shown(cast(io.TextIOWrapper, stream).detach(), encoding="utf-8", errors="surrogateescape", line_buffering=by_line)


def is_debugged() -> bool:
    return bool(os.environ.get("MCDEM_DEBUG"))


def say(text: object) -> None:
    with contextlib.suppress(OSError):  # nobody is left to be told
        for line in str(text).rstrip("\n").split("\n"):
            print(f"mcdem: {line}", file=sys.stderr)


def end_at_once(number: int, frame: FrameType | None) -> NoReturn:
    """Ends the command. An exception would not do: in the middle of an import or of a callback of a library it becomes another one,
    or is lost."""
    remove_unfinished()
    os._exit(INTERRUPTED)


def handle_signals(handler: Callable[[int, FrameType | None], object]) -> None:
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        if number != signal.SIGHUP or signal.getsignal(number) != signal.SIG_IGN:  # nohup
            signal.signal(number, handler)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})  # python_program.cpp holds it back until here


def raise_when_interrupted() -> None:
    """From now on the first signal raises KeyboardInterrupt: for a command that waits for others and has to end them."""
    first = list[float]()

    def interrupt(number: int, frame: FrameType | None) -> None:
        if not first:
            first.append(time.monotonic())
            raise KeyboardInterrupt
        if time.monotonic() - first[0] > 1:  # Ctrl-C arrives twice, from the terminal and from the program
            end_at_once(number, frame)

    handle_signals(interrupt)


def message_of(error: BaseException) -> str:
    """What the user is told of an error: one line for each problem."""
    if isinstance(error, InputError):
        return "\n".join(map(str, error.problems))
    if isinstance(error, ModuleNotFoundError) and error.name and not error.name.startswith("mcdem"):
        name = error.name.split(".")[0]
        return (f"the Python package {name} is not there for {sys.executable}: install {PACKAGES.get(name, f'python3-{name}')}, "
                "or name a Python 3 that has it by MCDEM_PYTHON")
    if isinstance(error, ImportError) and "_engine" in str(error):
        return ("the compiled module of mcdem is not there: in the sources `scripts/setup --python` builds it; otherwise install "
                f"python3-mcdem, or mcdem by pip ({error})")
    if isinstance(error, RunError):
        return str(error)
    if isinstance(error, MemoryError):
        return "not enough memory"
    if isinstance(error, OSError) and (error.strerror or error.args):
        return f"{error.filename}: {error.strerror}" if error.filename else str(error.strerror or error)
    what = " ".join(f"{type(error).__name__} {error}".split())
    return f"internal error: {what}; please report it, with what MCDEM_DEBUG=1 shows"


def exit_code_of(error: BaseException) -> int:
    """Prints the error and returns its exit code."""
    if isinstance(error, KeyboardInterrupt):
        return INTERRUPTED
    say(message_of(error))
    if isinstance(error, InputError):
        return 2
    if is_debugged():
        traceback.print_exception(error)
    return 1


def run(module: str, arguments: list[str]) -> int:
    sys.argv = [module, *arguments]
    try:
        runpy.run_module(module, run_name="__main__")
    except SystemExit as end:
        if end.code is None or isinstance(end.code, int):
            return end.code or 0
        say(end.code)
        return 1
    except BaseException as error:
        return exit_code_of(error)
    finally:
        handle_signals(end_at_once)
    return 0


def flush(exit_code: int) -> int:
    """The exit code after all output is flushed."""
    if sys.stdout.closed:
        return exit_code
    was_terminal = sys.stdout.isatty()
    try:
        sys.stdout.flush()
        return exit_code
    except OSError as error:
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # otherwise Python tries again and prints an error
        if was_terminal:
            return exit_code
        say(f"standard output cannot be written: {error.strerror}")
        return max(exit_code, 1)


def main() -> int:
    handle_signals(end_at_once)
    sys.stdout, sys.stderr = shown(sys.stdout, by_line=sys.stdout.isatty()), shown(sys.stderr, by_line=True)
    if not is_debugged():  # what libraries say to programmers
        warnings.simplefilter("ignore")
        sys.unraisablehook = lambda _: None
    return flush(run(sys.argv[1], sys.argv[2:]))


if __name__ == "__main__":
    sys.exit(main())
