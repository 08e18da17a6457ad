"""The commands: `python3 -m mcdem WORD ..` runs the module of that name here, `challenge run ..` that of challenge_run.

A module has `add_arguments(parser)` and `run(options) -> exit code`; as EPILOG it may have the end of its help, and as
`parse(parser, words) -> options` a way of its own to read its words.
"""
import pathlib

# Command -> what it does, in the order of the help. The compiled program contains the same list (host/cli/shell/command_list.h).
COMMANDS = dict(line.split("\t") for line in pathlib.Path(__file__).with_name("commands.txt").read_text().splitlines())

PROGRAM_COMMANDS = ("devices", "validate", "run")  # of the compiled program
