"""Real dumps of LIGGGHTS and LAMMPS are imported by `mcdem experiment import`; the values equal the dumped ones.

dumps_test.py MCDEM FOLDER; exit code 77 if one of the programs is missing.
"""
import csv
import pathlib
import re
import shutil
import subprocess
import sys

import cases
import realities

SETTINGS = ["--set", f"box.size=[{realities.BOX}, {realities.BOX}]", "--set", "grains.youngs_modulus=23300",
            "--set", "grains.poisson_ratio=0.5"]
LAMMPS_WALL = """
[[table]]
role = "contacts"
files = ["{folder}/walls.dump"]
grain = "id"
partner = "{wall}"
where = "f_{wall}[1]"
fx = "f_{wall}[2]"
fy = "f_{wall}[3]"
fz = "f_{wall}[4]"
force_unit = "N"
force_on = "grain"
"""
LIGGGHTS_WALLS = """
[[table]]
role = "contacts"
files = ["{folder}/walls.dump"]
grain = "c_walls[3]"
partner = "c_walls[1]"
fx = "c_walls[4]"
fy = "c_walls[5]"
fz = "c_walls[6]"
force_unit = "N"
force_on = "grain"
[table.walls]
""" + "".join(f'{number} = "{wall}"\n' for number, wall in enumerate(realities.WALLS))


def write_plate(folder, scans):
    """A row for every dumped step; before the stroke the plate is at rest."""
    steps = sorted(realities.read_dump(folder / "grains.dump"))
    with (folder / "plate.txt").open("w") as file:
        file.write("step plate_z top_force\n")
        for step in steps:
            n = max(0, (step - realities.BEGIN) // realities.STEPS)
            file.write(f"{step} {scans[n]['height']!r} {scans[n]['top']!r}\n")
    return steps


def corrected(text, folder, program):
    """Entries that a user adds to the mapping: the walls, which have no names, and both parts of a force."""
    tables = text.split("\n[[table]]\n")
    kept = [table for table in tables if "walls.dump" not in table]
    text = "\n[[table]]\n".join(kept).replace('"?', '"')
    if program == "lmp":
        for axis, number in zip("xyz", "123"):
            text = re.sub(rf"^f{axis} = .*$", f'f{axis} = ["c_normal[{number}]", "c_sliding[{number}]"]', text, flags=re.M)
        return text + "".join(LAMMPS_WALL.format(folder=folder, wall=wall) for wall in realities.WALLS)
    return text + LIGGGHTS_WALLS.format(folder=folder)


def import_dumps(mcdem, folder, program):
    out = folder / "experiment"
    shutil.rmtree(out, ignore_errors=True)
    tables = [str(folder / name) for name in ("plate.txt", "grains.dump", "pairs.dump", "walls.dump")]
    guess = subprocess.run([mcdem, "experiment", "import", *tables, *SETTINGS, "--out", str(out)], capture_output=True, text=True)
    assert guess.returncode == 2, f"walls without names are not safe:\n{guess.stdout}{guess.stderr}"
    assert "walls.dump" in guess.stdout and not (out / "experiment.toml").exists()
    mapping = out / "mapping.toml"
    mapping.write_text(corrected(mapping.read_text(), folder, program))
    subprocess.run([mcdem, "experiment", "import", "--mapping", str(mapping), *SETTINGS, "--out", str(out)], check=True)
    subprocess.run([mcdem, "experiment", "check", str(out)], check=True)
    return out


def rows_of(file):
    with file.open() as text:
        return list(csv.DictReader(text))


def expect_near(read, expected, tolerance, what):
    worst = max(abs(float(a) - b) for a, b in zip(read, expected))
    assert worst <= tolerance, f"{what}: {worst} apart"


def compare(out, scans, before):
    """`before`: number of frames before the stroke."""
    grains, contacts = {}, {}
    for row in rows_of(out / "grains.csv"):
        grains.setdefault(int(row["frame"]) - before, []).append(row)
    for row in rows_of(out / "contacts.csv"):
        contacts.setdefault(int(row["frame"]) - before, {})[(row["grain"], row["partner"])] = row
    for n, scan in enumerate(scans):
        assert len(grains[n]) == len(scan["grains"])
        for row, grain in zip(grains[n], scan["grains"]):
            expect_near([row[key] for key in ("diameter_m", "x_m", "y_m", "z_m")], grain, 1e-10, f"scan {n}")
        touching = [contact for contact in scan["contacts"] if any(contact[3])]  # LAMMPS also lists grains that do not touch
        assert len(contacts[n]) == len(touching), f"scan {n}: {len(contacts[n])} contacts for {len(touching)}"
        for i, partner, point, force in touching:
            negated = not isinstance(partner, str) and partner < i
            row = contacts[n][(str(partner), str(i)) if negated else (str(i), str(partner))]
            expect_near([row[key] for key in ("fx_N", "fy_N", "fz_N")], [-f if negated else f for f in force], 1e-9, f"scan {n}")
            expect_near([row[key] for key in ("x_m", "y_m", "z_m")], point, 1e-9, f"scan {n}")
    print(f"{out}: {len(scans)} scans as they were dumped, {sum(map(len, contacts.values()))} contacts")


def main():
    if realities.missing_programs():
        print("skipped: missing", *realities.missing_programs())
        return 77
    mcdem, folder = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    for name in ("liggghts_plain", "lammps_plain"):
        reality = cases.CASES[name]["reality"]
        place = folder / name
        scans = realities.simulate(place, 1, reality)
        steps = write_plate(place, scans)
        out = import_dumps(mcdem, place, reality["program"])
        compare(out, scans, sum(step < realities.BEGIN for step in steps))
    return 0


if __name__ == "__main__":
    sys.exit(main())
