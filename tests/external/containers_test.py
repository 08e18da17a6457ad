"""Packings in a cylinder, a periodic container and a cell compared with LAMMPS: forces on the plate and the cylinder's
side, or the stress of the cell. Once at the positions of the last scan, once after LAMMPS's own simulation from the
scan before: containers_test.py MCDEM FOLDER"""
import math
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

SPEED, START, DRAG = 0.05, 0.105, 6e-3  # [m/s], [m], [kg/s]
SCENE = """[container]
{container}
[packing]
count = {count}
packing_fraction = 0.63
[grains]
friction = 0
restitution = 0.5
[walls]
youngs_modulus = 23.3e3
friction = 0
restitution = 0.5
[contact]
model = "independent"
[plate]
start = {start}
end = {end}
speed = {speed}
[protocol]
scans_per_stroke = 5
scan_at_start = true
stop_at_scans = true
rate_tolerance = 0
settle_time = 4
relax_time = 2
settle_unbalanced_force = 5e-4
[numerics]
precision = "double"
"""
CASES = {"cylinder": ("shape = \"cylinder\"\nradius = 0.06", 140), "periodic": ("shape = \"periodic\"\nsize_x = 0.1\nsize_y = 0.11", 140)}
LAW = "hertz/material {:.9g} 0.5 0.5 tangential linear_nohistory 0 0 damping tsuji"
YOUNGS_MODULUS = 23.3e3
# This version of LAMMPS uses E/(2 (1 - nu)) for walls and E/(2 (1 - nu^2)) for two grains of the same material.
WALL_LAW, LAW = LAW.format(YOUNGS_MODULUS / 1.5), LAW.format(YOUNGS_MODULUS)


def mcdem_run(mcdem, folder, shape):
    """Size of the container, diameters, and (positions, plate, force on it, radial force on the side) of the last two
    scans of loading."""
    container, count = CASES[shape]
    scene = SCENE.format(container=container, count=count, start=START, end=START - 0.01, speed=SPEED)
    with h5py.File(run_scene(mcdem, folder, shape, scene)) as run:
        name = next(iter(run["observables"]))
        scans, particles, contacts = run["observables"][name][:], run["particles"][name], run["contacts"][name]
        size = particles["box"].attrs["edges"][:2]
        assert particles["box"].attrs["shape"].decode() == shape and scans["settled"][4:6].all()
        found = []
        for scan in (4, 5):
            rows = contacts["contact"][contacts["offset"][scan]:contacts["offset"][scan + 1]]
            side = numpy.hypot(*rows["force"][rows["partner"] == -1][:, :2].T).sum()
            found.append((particles["position/value"][scan], scans["plate_z"][scan], scans["wall_force"][scan][5, 2], side))
        return size, particles["diameter"][:], found


def numbers_at(output, step, count):
    """The last of LAMMPS's lines with the step and this many numbers."""
    rows = [line.split() for line in output.splitlines()]
    return [float(word) for word in [row for row in rows if len(row) == 1 + count and row[0] == str(step)][-1][1:]]


def lammps(folder, shape, size, diameters, positions, plate, moving, resting, time_step):
    """Forces on the plate and (radial) on the side after these steps."""
    rows = [(d, *position) for d, position in zip(diameters, positions)]
    write_data(folder / f"{shape}.data", rows, edges_of(shape, size), types=1, digits=17)
    output = execute("lmp", "containers.in", folder, {
        "shape": shape, "law": LAW, "wall_law": WALL_LAW, "size_x": size[0], "size_y": size[1], "start": plate, "time_step": time_step, "plate_speed": SPEED,
        "skin": 0.002, "moving": moving, "resting": resting, "drag": DRAG})
    _, plate_force, side_force = numbers_at(output, moving + resting, 3)
    return -plate_force, side_force


FRICTIONLESS = """[container]
shape = "cell"
size_x = 0.1
size_y = 0.11
[packing]
count = 140
packing_fraction = 0.64
[grains]
friction = 0
restitution = 0.5
[contact]
model = "independent"
[protocol]
stop_at_scans = true
settle_time = 4
relax_time = 2
"""
CELL = FRICTIONLESS + """settle_unbalanced_force = 5e-4
rate_tolerance = 0
[[programme]]
strain = 0.06
rate = 0.1
scans = 3
[[programme]]
shear_xz = 0.03
strain_z = 0.08
rate = 0.05
[numerics]
precision = "double"
"""


def cell_run(mcdem, folder):
    """Initial lengths of the cell, diameters, and (positions, strain, stress) of the last three scans."""
    with h5py.File(run_scene(mcdem, folder, "cell", CELL)) as run:
        name = next(iter(run["observables"]))
        scans, particles = run["observables"][name][:], run["particles"][name]
        assert scans["settled"].all(), "not at rest"
        found = [(particles["position/value"][s], scans["strain"][s], scans["stress"][s]) for s in (1, 2, 3)]
        return particles["box"].attrs["edges"][:], particles["diameter"][:], found


def write_cell(path, edges, strain, diameters, positions):
    x, y, z = edges * (1 - strain[:3])
    tilts = f"{strain[3] * edges[1]:.17g} {strain[4] * edges[2]:.17g} {strain[5] * edges[2]:.17g} xy xz yz\n" if strain[3:].any() else ""
    with open(path, "w", encoding="ascii") as out:
        out.write(f"cell\n\n{len(diameters)} atoms\n1 atom types\n\n0 {x:.17g} xlo xhi\n0 {y:.17g} ylo yhi\n0 {z:.17g} zlo zhi\n"
                  f"{tilts}\nAtoms\n\n")
        for n, (at, d) in enumerate(zip(positions, diameters), 1):
            out.write(f"{n} 1 {d:.17g} 11.5 {at[0]:.17g} {at[1]:.17g} {at[2]:.17g}\n")


def lammps_cell(folder, edges, diameters, start, end, moving, resting):
    """Mean and xx, yy, zz, xz of LAMMPS's stress [Pa] after it has deformed the cell from one scan to the strain of
    another."""
    positions, strain, _ = start
    write_cell(folder / "cell.data", edges, strain, diameters, positions)
    last = edges * (1 - end[1][:3])
    output = execute("lmp", "cell.in", folder, {
        "law": LAW, "time_step": 5e-5, "skin": 0.002, "moving": moving, "resting": resting, "drag": DRAG, "end_x": last[0],
        "end_y": last[1], "end_z": last[2], "shear": end[1][4] * edges[2]})
    return numpy.array(numbers_at(output, moving + resting, 6)[1:])


def compare_cell(mcdem, folder):
    edges, diameters, scans = cell_run(mcdem, folder)
    for what, start, end, moving, allowed in (
            ("at the same positions", scans[2], scans[2], 0, 1e-4), ("after its own compression", scans[0], scans[1], 4000, 1e-2),
            ("after its own compression and shear", scans[1], scans[2], 12000, 1e-2)):
        found = lammps_cell(folder, edges, diameters, start, end, moving, 8000 if moving else 0)
        mine = end[2]
        pressure = numpy.trace(mine) / 3
        print(f"cell, LAMMPS {what}: pressure {found[0]:.6g} Pa, mcdem {pressure:.6g} Pa, ratio {pressure / found[0]:.5f}")
        assert math.isclose(pressure, found[0], rel_tol=allowed), "pressures differ"
        for (row, column), other in zip(((0, 0), (1, 1), (2, 2), (0, 2)), found[1:]):
            print(f"    stress {'xyz'[row]}{'xyz'[column]} {other:.6g} Pa, mcdem {mine[row, column]:.6g} Pa")
            assert abs(mine[row, column] - other) < 3 * allowed * pressure, "stresses differ"  # frictionless grains rearrange suddenly


STRESS = FRICTIONLESS + """settle_unbalanced_force = 2e-4
rate_tolerance = 0.02
[[programme]]
pressure = 100
[[programme]]
pressure = 300
[numerics]
precision = "double"
[batch]
replicas = 6
"""


def lammps_lengths(folder, edges, diameters, scan, pressure, modulus):
    """Lengths of the cell [m] at which LAMMPS's barostat reaches the pressure, starting from a scan; its stresses
    there."""
    write_cell(folder / "cell.data", edges, scan[1], diameters, scan[0])
    steps = 200000
    output = execute("lmp", "stress.in", folder, {"law": LAW, "time_step": 5e-5, "skin": 0.002, "pressure": pressure, "modulus": modulus,
                                                  "damping": 0.1, "steps": steps, "drag": DRAG})
    last = numpy.array(numbers_at(output, steps, 6))
    return last[3:], last[:3]


def compare_stress(mcdem, folder):
    """The volume at a pressure, starting from the packing at a lower one."""
    ratios = []
    with h5py.File(run_scene(mcdem, folder, "stress", STRESS)) as run:
        for name in run["observables"]:
            scans, particles = run["observables"][name][:], run["particles"][name]
            edges, diameters = particles["box"].attrs["edges"][:], particles["diameter"][:]
            assert scans["settled"].all(), "not at rest"
            for scan, pressure in zip(scans, (100, 300)):
                assert numpy.allclose(numpy.diag(scan["stress"]), pressure, rtol=1e-3), "not the pressure that was set"
            volumes = [numpy.prod(1 - scan["strain"][:3]) for scan in scans]
            begin = (particles["position/value"][0], scans["strain"][0])
            modulus = 200 / math.log(volumes[0] / volumes[1])
            lengths, stress = lammps_lengths(folder, edges, diameters, begin, 300, modulus)
            assert numpy.allclose(stress, 300, rtol=2e-3), f"LAMMPS has not arrived: {stress}"
            found = numpy.prod(lengths / edges)
            ratios.append((volumes[1] / found, math.log(volumes[0] / volumes[1]) / math.log(volumes[0] / found)))
            print(f"cell at 300 Pa, volume over that at start: LAMMPS {found:.6f}, mcdem {volumes[1]:.6f}; compression over LAMMPS's {ratios[-1][1]:.4f}")
    for of, values, allowed in zip(("volume", "compression from 100 Pa"), numpy.transpose(ratios), (1e-3, 0.03)):
        error = values.std(ddof=1) / math.sqrt(len(values))
        print(f"cell from 100 to 300 Pa, {of}, mcdem over LAMMPS: {values.mean():.5f} +- {error:.5f}")
        assert abs(values.mean() - 1) < allowed + 3 * error and error < allowed, f"{of} differs"


def main():
    mcdem, folder = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    if not shutil.which("lmp"):
        print("skipped: lmp is not installed")
        return 77
    for shape in CASES:
        size, diameters, (first, last) = mcdem_run(mcdem, folder, shape)
        time_step = 5e-5
        there = lammps(folder, shape, size, diameters, last[0], last[1], 0, 0, time_step)
        stroke = lammps(folder, shape, size, diameters, first[0], first[1], round((first[1] - last[1]) / (SPEED * time_step)), 8000, time_step)
        for what, found, allowed in (("at the same positions", there, 1e-4), ("after its own stroke", stroke, 3e-3)):
            for of, mine, other in (("plate", last[2], found[0]), ("side", last[3], found[1]))[:2 if shape == "cylinder" else 1]:
                print(f"{shape}, LAMMPS {what}: force on the {of} {other:.6g} N, mcdem {mine:.6g} N, ratio {mine / other:.5f}")
                # LAMMPS uses the arithmetic mean of the side's curvature radii, mcdem the geometric one: 0.3 % at R =
                # R_c/5.
                assert math.isclose(mine, other, rel_tol=allowed + (0.004 if of == "side" else 0)), "forces differ"
    compare_cell(mcdem, folder)
    compare_stress(mcdem, folder)
    return 0


if __name__ == "__main__":
    sys.exit(main())
