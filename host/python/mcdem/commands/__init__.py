"""The commands: `python3 -m mcdem WORD ..` runs the module of that name here, `challenge run ..` that of challenge_run.

A module has `add_arguments(parser)` and `run(options) -> exit code`; as EPILOG it may have the end of its help.
"""

# Command -> what it does, as the help lists it.
COMMANDS = {
    "table": "Show the top force of each setting, ratios and the scaling law; programmes scan by scan",
    "compare": "Compare runs with an experiment or another run: the paper's table",
    "figures": "Draw the figures of runs (top force, force distribution, Z, scaling law; others for programmes) or of a diagnosis",
    "report": "Write an HTML page of runs and diagnoses: charts, packings in 3D, tables",
    "diagnose": "Find where a simulation and an experiment differ, and which effect is consistent with the difference",
    "calibrate": "Fit gamma of MC-DEM, or E of another model, to the top force of an experiment",
    "converge": "Measure how plate speed, inertia, time step and settling change a scene's results",
    "experiment check": "Report which data an experiment contains, which are missing and which are suspicious",
    "experiment import": "Make an experiment from the tables of a laboratory or another program",
    "experiment from-run": "Write a simulation as an experiment with measurement errors",
    "challenge make": "Simulate experiments with hidden effects, and write the truth to a separate file",
    "challenge run": "Diagnose every experiment of a challenge",
    "challenge score": "Compare the diagnoses with the truth",
    "export": "Write grains and contacts for ParaView or OVITO",
}
