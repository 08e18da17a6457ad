"""The commands: `python3 -m mcdem WORD ..` runs the module of that name here.

A module has `add_arguments(parser)` and `run(options) -> exit code`; as EPILOG it may have the end of its help.
"""

# Command -> what it does, as the help lists it.
COMMANDS = {
    "table": "Show the top force of each setting, ratios and the scaling law; programmes scan by scan",
    "compare": "Compare runs with an experiment or another run: the paper's table",
    "figures": "Draw the figures of runs (top force, force distribution, Z, scaling law; others for programmes) or of a diagnosis",
    "report": "Write an HTML page of runs and diagnoses: charts, packings in 3D, tables",
    "export": "Write grains and contacts for ParaView or OVITO",
}
