"""OVITO loads grains and contacts of an export, following the OVITO.txt of the export.

ovito_test.py PROGRAM SOURCE OVITO_PYTHON; exit code 77: OVITO_PYTHON, or the present python3, has no module ovito.
"""
import json
import pathlib
import subprocess
import sys
import textwrap

import numpy as np

from exported import Exported, arguments, missing, scan_of, skip

program, source, more = arguments()
pythons = [python for python in (*more, sys.executable) if pathlib.Path(python).exists() and not missing(python, "ovito")]
if not pythons:
    skip(f"no module ovito in {' or '.join((*more, sys.executable))} (pip install ovito)")

exported = Exported(program, source, "xyz")
guide = (exported.view / "OVITO.txt").read_text()
code = textwrap.dedent(guide.split("In Python:")[1].split("\n\nOf a")[0])
with exported.open() as file:
    for replica in file["observables"]:
        name, = (found.stem for found in exported.view.glob(f"{replica}*.xyz"))
        done = subprocess.run([pythons[0], str(pathlib.Path(__file__).parent / "read_ovito.py")],
                              input=code.replace("NAME", name), capture_output=True, text=True,
                              cwd=exported.view, timeout=300)
        assert done.returncode == 0, done.stdout + done.stderr
        frames = json.loads(done.stdout.splitlines()[-1])
        assert len(frames) == len(file[f"observables/{replica}"]), len(frames)
        for scan, frame in enumerate(frames):
            position, contacts, row = scan_of(file, replica, scan)
            between = contacts[contacts["partner"] >= 0]
            assert np.allclose(frame["position"], position, rtol=1e-6, atol=1e-9)
            assert np.allclose(frame["radius"], file[f"particles/{replica}/diameter"][:] / 2, rtol=1e-6)
            assert frame["identifier"] == list(range(len(position)))
            assert frame["topology"] == [[int(c["grain"]), int(c["partner"])] for c in between]
            assert np.allclose(np.transpose(frame["force"]), between["force"], rtol=1e-6, atol=1e-12)
            assert np.allclose(frame["overlap"], between["overlap"], rtol=1e-6, atol=1e-12)
            assert abs(frame["top_force"] - row["wall_force"][5, 2]) < 1e-6
