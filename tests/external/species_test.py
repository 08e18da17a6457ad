"""A packing of two materials compared with LAMMPS: the force of every contact between grains at the positions of the
last scan, for pairs of the same and of different species: species_test.py MCDEM FOLDER"""
import pathlib
import shutil
import sys

from realities import edges_of, execute, run_scene, write_data

try:
    import h5py
    import numpy
except ImportError as missing:
    print(f"skipped: {missing.name} is not installed")
    sys.exit(77)

SOFT, STIFF = (23.3e3, 0.48), (900e3, 0.3)
SCENE = """[box]
size_x = 0.1
size_y = 0.1
[packing]
count = 150
packing_fraction = 0.6
fractions_by = "volume"
[grains]
friction = 0
restitution = 1
[[species]]
name = "soft"
youngs_modulus = {}
poisson_ratio = {}
[[species]]
name = "stiff"
youngs_modulus = {}
poisson_ratio = {}
density = 30
sizes = "single"
diameter_mean = 0.014
[walls]
friction = 0
restitution = 1
[contact]
model = "independent"
[plate]
start = 0.105
end = 0.085
speed = 0.1
[protocol]
scans_per_stroke = 1
stop_at_scans = true
rate_tolerance = 0
relax_time = 1
settle_time = 0.5
[numerics]
precision = "double"
""".format(*SOFT, *STIFF)


def mcdem_run(mcdem, folder):
    """Positions, diameters, species and contacts between grains of the scan with the lowest plate."""
    with h5py.File(run_scene(mcdem, folder, "species", SCENE)) as run:
        name = next(iter(run["observables"]))
        particles, contacts = run["particles"][name], run["contacts"][name]
        rows = contacts["contact"][contacts["offset"][0]:contacts["offset"][1]]
        return (particles["position/value"][0], particles["diameter"][:], particles["species"][:],
                {(row["grain"], row["partner"]): numpy.linalg.norm(row["force"]) for row in rows if row["partner"] >= 0})


def lammps(folder, positions, diameters, species):
    """The force of each pair of grains."""
    rows = [(d, *position) for d, position in zip(diameters, positions)]
    write_data(folder / "species.data", rows, edges_of("box", (0.1, 0.1)), materials=[s + 1 for s in species], digits=17)
    execute("lmp", "species.in", folder, {
        "pair_e": 2 / sum((1 - nu * nu) / modulus for modulus, nu in (SOFT, STIFF)), "soft_e": SOFT[0], "soft_nu": SOFT[1], "stiff_e": STIFF[0], "stiff_nu": STIFF[1]})
    rows = [line.split() for line in (folder / "species.dump").read_text().splitlines()]
    first = next(n for n, row in enumerate(rows) if row[:2] == ["ITEM:", "ENTRIES"]) + 1
    return {tuple(sorted((int(row[1]) - 1, int(row[2]) - 1))): abs(float(row[3])) for row in rows[first:]}


def main():
    mcdem, folder = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    if not shutil.which("lmp"):
        print("skipped: lmp is not installed")
        return 77
    positions, diameters, species, mine = mcdem_run(mcdem, folder)
    others = {pair: force for pair, force in lammps(folder, positions, diameters, species).items() if force > 0}
    strong = {pair for pair in mine if mine[pair] > 1e-3 * max(mine.values())}
    assert strong <= set(others) and {pair for pair in others if others[pair] > 1e-3 * max(others.values())} <= set(mine)
    for kind, word in enumerate(("soft on soft", "soft on stiff", "stiff on stiff")):
        ratios = numpy.array([mine[pair] / others[pair] for pair in strong if species[list(pair)].sum() == kind])
        print(f"{word}: {len(ratios)} contacts, force of mcdem over LAMMPS {ratios.mean():.6f}, from {ratios.min():.6f} to {ratios.max():.6f}")
        assert len(ratios) > 10 and abs(ratios - 1).max() < 1e-5, "forces differ"
    return 0


if __name__ == "__main__":
    sys.exit(main())
