"""Runs one of the commands, as a module that program.py starts."""
import sys

from mcdem.commands.command_line import run_command

if __name__ == "__main__":
    sys.exit(run_command(sys.argv[1:]))
