"""A packing compressed by Yade is imported by `mcdem experiment import`; the values equal those of Yade.

yade_test.py MCDEM FOLDER; exit code 77 if Yade is missing.
"""
import json
import pathlib
import shutil
import subprocess
import sys

from dumps_test import expect_near, rows_of

SCRIPT = pathlib.Path(__file__).resolve().parent / "yade_packing.py"
WALLS = ["x_min", "x_max", "y_min", "y_max", "floor", "plate"]  # bodies 0 to 5
ROUNDED = 1e-5  # Yade writes six digits


def squeeze(folder):
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    done = subprocess.run(["yade", "-n", "-x", "-j1", str(SCRIPT)], cwd=folder, timeout=600, stdin=subprocess.DEVNULL,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
    assert (folder / "printed.json").exists(), f"Yade failed:\n{done.stdout[-2000:]}"
    return json.loads((folder / "printed.json").read_text())


def import_files(mcdem, folder, files, size, out):
    subprocess.run([mcdem, "experiment", "import", *files, "--set", f"box.size=[{size}, {size}]", "--set",
                    "grains.youngs_modulus=23300", "--set", "grains.poisson_ratio=0.3", "--out", out],
                   cwd=folder, check=True)
    subprocess.run([mcdem, "experiment", "check", out], cwd=folder, check=True)
    return folder / out


def contact_of(first, second, force):
    """Grain, partner and force on the grain, as in an experiment; `force` is that on the second body."""
    if first < len(WALLS):
        return str(second - len(WALLS)), WALLS[first], force
    return str(first - len(WALLS)), str(second - len(WALLS)), [-f for f in force]


def compare_grains(rows, grains, what):
    assert len(rows) == len(grains)
    for row, grain in zip(rows, grains):
        expect_near([row[key] for key in ("x_m", "y_m", "z_m", "diameter_m")], grain, ROUNDED * 0.1, what)


def compare(out, frames):
    plate, grains, contacts = (rows_of(out / f"{name}.csv") for name in ("plate", "grains", "contacts"))
    assert len(plate) == len(frames)
    largest = max(abs(f) for frame in frames for contact in frame["contacts"] for f in contact[2:5])
    for n, frame in enumerate(frames):
        expect_near([plate[n]["plate_z_m"], plate[n]["top_force_N"]], [frame["plate_z"], frame["top_force"]], 1e-12, f"plate {n}")
        compare_grains([row for row in grains if row["frame"] == str(n)], frame["grains"], f"frame {n}")
        listed = {(row["grain"], row["partner"]): row for row in contacts if row["frame"] == str(n)}
        assert len(listed) == len(frame["contacts"]), f"frame {n}: {len(listed)} contacts for {len(frame['contacts'])}"
        for first, second, *rest in frame["contacts"]:
            assert first < second, "Yade lists the smaller number first"
            grain, partner, force = contact_of(first, second, rest[:3])
            row = listed[grain, partner]
            expect_near([row[key] for key in ("fx_N", "fy_N", "fz_N")], force, ROUNDED * largest, f"frame {n}, {grain} {partner}")
    print(f"{out}: {len(frames)} frames as Yade printed them, {len(contacts)} contacts, forces up to {largest:.3g} N")


def main():
    if not shutil.which("yade"):
        print("skipped: missing yade")
        return 77
    mcdem, folder = str(pathlib.Path(sys.argv[1]).resolve()), pathlib.Path(sys.argv[2]).resolve()
    printed = squeeze(folder)
    assert max(frame["top_force"] for frame in printed["frames"]) > 0.01, "the plate must press"
    frames = printed["frames"]

    def files(ending):
        return ["plate.txt", *sorted(file.name for file in folder.glob(ending))]

    compare(import_files(mcdem, folder, files("*.vtk"), printed["size"], "vtk"), frames)
    text = rows_of(import_files(mcdem, folder, files("spheres-*.txt"), printed["size"], "text") / "grains.csv")
    for n, frame in enumerate(frames):
        compare_grains([row for row in text if row["frame"] == str(n)], frame["grains"], f"text, frame {n}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
