#!/usr/bin/python3
"""Prints, for every replica and phase of a run, the strongest scan: read_run.py RUN"""
import numpy as np

from run_file import arguments, displacement, label, open_run

path, _ = arguments(__doc__)
with open_run(path) as run:
    print(f"{'replica':34} {'phase':6} {'scans':>5} {'stroke/mm':>9} {'top/N':>9} {'Z':>6} {'<f>/mN':>8}")
    for replica, table in run["observables"].items():
        scans = table[:]  # one row a scan; columns by name, units in table.attrs
        for number, phase in enumerate(("load", "unload")):
            rows = np.flatnonzero(scans["phase"] == number)
            if rows.size == 0:
                continue
            top_force = scans["wall_force"][:, 5, 2]  # walls: x_min x_max y_min y_max floor plate
            best = rows[np.argmax(top_force[rows])]
            print(f"{label(run, replica)[:34]:34} {phase:6} {rows.size:5} {1e3 * displacement(run, replica)[best]:9.3f} "
                  f"{top_force[best]:9.4f} {scans['coordination_number'][best]:6.3f} {1e3 * scans['mean_force'][best]:8.3f}")
        if "failure_cause" in run["particles"][replica].attrs:
            print("  stopped early:", run["particles"][replica].attrs["failure_cause"].decode())
