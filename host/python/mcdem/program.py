"""Runs a module as a command of the program: python3 -m mcdem.program MODULE ARGUMENT... (host/cli/shell/python_program.h).

Messages begin with `mcdem: `. Exit codes: 0 done, 1 failed, 2 bad input, 130 interrupted.
"""
import os
import runpy
import signal
import sys

from .errors import INTERRUPTED, InputError, RunError

# Module -> Debian package, if its name is not python3-MODULE.
PACKAGES = {"PIL": "python3-pil"}


def say(text):
    for line in str(text).splitlines():
        print(f"mcdem: {line}", file=sys.stderr)


def interrupt(number, frame):
    """The first signal ends the command cleanly. Ctrl-C arrives twice, from the terminal and from the program."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.signal(signal.SIGTERM, signal.SIG_DFL)
    raise KeyboardInterrupt


def exit_code_of(error):
    """Prints the error and returns its exit code."""
    if isinstance(error, InputError):
        for problem in error.problems:
            say(problem)
        return 2
    if isinstance(error, KeyboardInterrupt):
        return INTERRUPTED
    if isinstance(error, ModuleNotFoundError) and error.name and not error.name.startswith("mcdem"):
        name = error.name.split(".")[0]
        say(f"the Python package {name} is not there for {sys.executable}: install {PACKAGES.get(name, f'python3-{name}')}, "
            "or name a Python 3 that has it by MCDEM_PYTHON")
    elif isinstance(error, RunError):
        say(error)
    elif isinstance(error, MemoryError):
        say("not enough memory")
    elif isinstance(error, OSError):
        say(f"{error.filename}: {error.strerror}" if error.filename else error.strerror or error)
    else:
        raise error
    return 1


def run(module, arguments):
    sys.argv = [module, *arguments]
    try:
        runpy.run_module(module, run_name="__main__")
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else 0 if end.code is None else 1
    except BaseException as error:
        return exit_code_of(error)
    return 0


def flush(exit_code):
    """The exit code after all output is flushed."""
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


def main():
    signal.signal(signal.SIGINT, interrupt)
    signal.signal(signal.SIGTERM, interrupt)
    sys.stdout.reconfigure(encoding="utf-8", errors="surrogateescape")
    sys.stderr.reconfigure(encoding="utf-8", errors="surrogateescape")
    return flush(run(sys.argv[1], sys.argv[2:]))


if __name__ == "__main__":
    sys.exit(main())
