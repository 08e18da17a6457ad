"""The command `mcdem` that pip installs: starts the program in this package, which starts this interpreter for commands written in Python."""
import os
import sys
from typing import NoReturn


def main() -> NoReturn:
    program = os.path.join(os.path.dirname(os.path.abspath(__file__)), "bin", "mcdem")
    os.environ.setdefault("MCDEM_PYTHON", sys.executable)
    try:
        os.execv(program, [program, *sys.argv[1:]])
    except OSError as error:
        sys.exit(f"mcdem: {program}: {error.strerror}: install mcdem again")
