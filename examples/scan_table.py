#!/usr/bin/python3
"""Puts all scans of a run into one pandas table and prints the means of each replica and phase: scan_table.py RUN"""
import pandas

from run_file import arguments, displacement, label, open_run

path, _ = arguments(__doc__)
tables = []
with open_run(path) as run:
    for replica, rows in run["observables"].items():
        scans = rows[:]
        table = pandas.DataFrame({name: scans[name] for name in scans.dtype.names if scans[name].ndim == 1})
        table = table.assign(replica=label(run, replica), top_force=scans["wall_force"][:, 5, 2],
                             displacement=displacement(run, replica))
        tables.append(table.replace({"phase": {0: "load", 1: "unload"}}))
table = pandas.concat(tables, ignore_index=True)
print(table.groupby(["replica", "phase"], sort=False)[["top_force", "coordination_number", "mean_force"]].mean().to_string())
