#!/usr/bin/env python3
"""MCDEM_PROFILE=1 reports the launches and time of every kernel at the end of a run, with the same results.

profile_test.py MCDEM SOURCES
"""
import os
import pathlib
import re
import subprocess
import sys
import tempfile

SCENE = """name = "small"
[box]
size_x = 0.06
size_y = 0.06
[packing]
count = 30
packing_fraction = 0.5
[plate]
start = 0.088
end = 0.086
[protocol]
scans_per_stroke = 1
settle_time = 0.002
relax_time = 0.002
"""


def run(folder, out, **environment):
    (folder / "small.toml").write_text(SCENE)
    return subprocess.run([sys.argv[1], "run", "small.toml", "--out", out, "--no-figures"], cwd=folder, check=True,
                          capture_output=True, text=True, env={**os.environ, **environment}).stderr


def main():
    kernels = set()
    for file in (pathlib.Path(sys.argv[2]) / "kernels").glob("*.cl"):
        kernels |= set(re.findall(r"^(?:WORK_GROUP.* )?kernel void (\w+)\(", file.read_text(), flags=re.M))
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        assert "launches" not in run(folder, "plain", MCDEM_PROFILE="0")
        said = run(folder, "profiled", MCDEM_PROFILE="1")
        assert (folder / "plain/run.h5").read_bytes() == (folder / "profiled/run.h5").read_bytes()
    rows = {row[0]: row[1:] for row in re.findall(r"^(\w+) +(\d+) +([\d.]+) +[\d.]+ +([\d.]+) %$", said, flags=re.M)}
    assert set(rows) == kernels - {"cell_stress"}, said  # only for cells; the scene has none
    launches = {kernel: int(row[0]) for kernel, row in rows.items()}
    assert launches["advance"] > launches["measure"] == launches["reduce"] > 0, said
    assert launches["fill_cells"] == launches["list_neighbours"] == launches["empty_cells"] > 0, said
    waits = float(re.search(r"^device waits +[\d.]+ +([\d.]+) %$", said, flags=re.M)[1])
    assert abs(sum(float(row[2]) for row in rows.values()) + waits - 100) < 1, said


if __name__ == "__main__":
    main()
