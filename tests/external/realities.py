"""Simulates one stroke with LIGGGHTS, LAMMPS or Yade on a packing made by LAMMPS, and reads the dumped scans."""
import json
import math
import pathlib
import random
import shutil
import subprocess

HERE = pathlib.Path(__file__).resolve().parent
BOX = 0.125                        # [m]
START, STROKE = 0.1240, 0.0223     # of the plate, as in challenge.toml [m]
SPEED = 0.1                        # of the plate [m/s]
SCANS = 12                         # per stroke
STEPS = 170                        # between scans at that speed: a time step of 0.08 Rayleigh times
TIME_STEP = STROKE / (SCANS * STEPS * SPEED)
RELAXED = 12 * STEPS               # steps with a drag,
BEGIN = 15 * STEPS                 # and without, at least, before the plate moves
GRAINS = 216
DENSITY = 11.5                     # [kg/m3]
GRAVITY = 9.81                     # [m/s2]
WALLS = ["x_min", "x_max", "y_min", "y_max", "floor", "plate"]
TIME_LIMIT = 1800                  # [s] a run
PROGRAMS = {"liggghts": "liggghts", "lammps": "lmp", "yade": "yade"}


class Failed(Exception):
    pass


def missing_programs(codes=("liggghts", "lammps")):
    """Of these codes, and LAMMPS, which makes the packings."""
    return [PROGRAMS[code] for code in dict.fromkeys([*codes, "lammps"]) if not shutil.which(PROGRAMS[code])]


def execute(program, script, folder, variables):
    command = [program, "-log", "none", "-in", HERE / script, "-var", "folder", "."]
    for name, value in variables.items():
        command += ["-var", name, str(value)]
    return run_command(command, folder, script)


def run_command(command, folder, script):
    done = subprocess.run(command, cwd=folder, timeout=TIME_LIMIT, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, text=True, errors="replace")
    (folder / f"{script}.log").write_text(done.stdout)
    if done.returncode != 0 or "ERROR" in done.stdout:
        raise Failed(f"{command[0]} failed: see {folder / (script + '.log')}\n{done.stdout[-600:]}")
    return done.stdout


def write_data(path, rows, types=2, materials=None):
    """A data file for both codes, with diameter and centre of every grain. `materials`: atom types, default 1."""
    lines = ["packing", "", f"{len(rows)} atoms", f"{types} atom types", "", f"-0.01 {BOX + 0.01} xlo xhi", f"-0.01 {BOX + 0.01} ylo yhi",
             "-0.01 0.9 zlo zhi", "", "Atoms", ""]
    materials = materials or [1] * len(rows)
    lines += [f"{n} {m} {d:.10g} {DENSITY} {x:.10g} {y:.10g} {z:.10g}"
              for n, (m, (d, x, y, z)) in enumerate(zip(materials, rows), 1)]
    path.write_text("\n".join(lines) + "\n")


def read_dump(path):
    """Rows of numbers for each step."""
    frames, title, step = {}, "", None
    for line in path.read_text().splitlines():
        if line.startswith("ITEM:"):
            title = line
        elif title == "ITEM: TIMESTEP":
            step = int(line)
            frames[step] = []
        elif title.startswith(("ITEM: ATOMS", "ITEM: ENTRIES")):
            frames[step].append([float(word) for word in line.split()])
    return frames


def loose_grains(seed):
    """Grains with truncated normal diameters on a wide lattice with random offsets."""
    chance = random.Random(seed)
    sizes = []
    while len(sizes) < GRAINS:
        size = chance.gauss(21.490e-3, 1.199e-3)
        if 18.167e-3 <= size <= 24.561e-3:
            sizes.append(size)
    side = 4
    step = BOX / side
    shake = (step - 25e-3) / 2
    return [(size, *((step * (index + 0.5) + chance.uniform(-shake, shake)) for index in (n % side, n // side % side)),
             step * (n // side**2 + 0.5)) for n, size in enumerate(sizes)]


def make_packing(folder, seed, modulus):
    write_data(folder / "loose.data", loose_grains(seed))
    execute("lmp", "packing.in", folder, {"size_x": BOX, "size_y": BOX, "start": START, "time_step": TIME_STEP,
                                          "youngs_modulus": modulus})
    return [tuple(row[1:]) for row in max(read_dump(folder / "packing.dump").items())[1]]


def plate_height(height, tilt, x):
    """Height of the plate's face at x; it is tilted about the middle of the box."""
    return height + tilt * (x - BOX / 2)


def write_walls(folder, tilt):
    """Every wall as two triangles, slightly larger than the box."""
    low, high, top = -0.005, BOX + 0.005, 0.16
    left, right = plate_height(START, tilt, low), plate_height(START, tilt, high)
    planes = {"x_min": [(0, low, low), (0, high, low), (0, high, top), (0, low, top)],
              "x_max": [(BOX, low, low), (BOX, high, low), (BOX, high, top), (BOX, low, top)],
              "y_min": [(low, 0, low), (high, 0, low), (high, 0, top), (low, 0, top)],
              "y_max": [(low, BOX, low), (high, BOX, low), (high, BOX, top), (low, BOX, top)],
              "floor": [(low, low, 0), (high, low, 0), (high, high, 0), (low, high, 0)],
              "plate": [(low, low, left), (high, low, right), (high, high, right), (low, high, left)]}
    for name, corners in planes.items():
        text = f"solid {name}\n"
        for triangle in ((0, 1, 2), (0, 2, 3)):
            vertices = "".join("  vertex {} {} {}\n".format(*corners[n]) for n in triangle)
            text += f"facet normal 0 0 1\n outer loop\n{vertices} endloop\nendfacet\n"
        (folder / f"{name}.stl").write_text(text + f"endsolid {name}\n")


def top_forces(program, output):
    """Upward force on the plate at each step: third column of the thermodynamic output; in LAMMPS the force on the
    grains."""
    sign = -1 if program == "lmp" else 1
    rows = [line.split() for line in output.splitlines()]
    return {int(row[0]): sign * float(row[2]) for row in rows if len(row) == 3 and row[0].isdigit()}


def pairs_of(program, rows):
    """(grain, partner, force on grain); grains are numbered from 0."""
    if program == "lmp":
        return [(int(i) - 1, int(j) - 1, [n + t for n, t in zip(f[:3], f[3:])]) for i, j, *f in rows]
    return [(int(i) - 1, int(j) - 1, force) for i, j, *force in rows]


def wall_contacts_of(program, rows):
    if program == "lmp":
        return [(int(row[0]) - 1, wall, row[2 + 4 * w:5 + 4 * w]) for row in rows for w, wall in enumerate(WALLS)
                if row[1 + 4 * w] != 0]
    return [(int(i) - 1, WALLS[int(mesh)], force) for mesh, i, *force in rows]


def point_of(grains, i, partner, height, tilt):
    """Midway between the surfaces of two grains; for a wall, the foot of the perpendicular from the centre."""
    d, *centre = grains[i]
    if isinstance(partner, str):
        axis = "xyz".index(partner[0]) if partner[1] == "_" else 2
        centre[axis] = {"x_min": 0, "y_min": 0, "floor": 0, "plate": plate_height(height, tilt, centre[0])}.get(partner, BOX)
        return centre
    other, *there = grains[partner]
    distance = math.dist(centre, there)
    part = (d / 2 + distance - other / 2) / (2 * distance)
    return [a + part * (b - a) for a, b in zip(centre, there)]


def expect_all_contacts(scan, atoms, contacts, gravity):
    """Checks that the force on every grain is that of its contacts and its weight. LIGGGHTS recomputes contacts for its
    list with the displacements of the previous step, so forces differ by up to 8 % of the mean contact force if grains
    rearrange. A missing contact would cause a difference of its whole force."""
    missing = [[f - math.pi / 6 * row[1]**3 * DENSITY * g for f, g in zip(row[5:8], gravity)] for row in atoms]
    for i, partner, force in contacts:
        for axis in range(3):
            missing[i][axis] -= force[axis]
            if not isinstance(partner, str):
                missing[partner][axis] += force[axis]
    mean = sum(math.hypot(*force) for _, _, force in contacts) / len(contacts)
    worst = max(math.hypot(*force) for force in missing)
    if worst > 0.2 * mean:
        raise Failed(f"scan {scan}: the contacts of a grain miss {worst} N of its force, with {mean} N a contact on average")


def scan_of(reality, n, top, atoms, pairs, walls):
    program, tilt = reality["program"], reality["tilt"]
    height = START - STROKE / SCANS * min(n, 2 * SCANS - n)
    grains = [tuple(row[1:5]) for row in atoms]
    contacts = pairs_of(program, pairs) + wall_contacts_of(program, walls)
    plate = -sum(force[2] for _, partner, force in contacts if partner == "plate")
    if abs(plate - top) > 0.01 * abs(top) + 1e-4:
        raise Failed(f"scan {n}: contacts push the plate with {plate} N, its gauge says {top} N")
    expect_all_contacts(n, atoms, contacts, gravity_of(reality))
    return {"height": height, "phase": "load" if n <= SCANS else "unload", "top": top, "grains": grains,
            "contacts": [(i, j, point_of(grains, i, j, height, tilt), force) for i, j, force in contacts]}


def gravity_of(reality):
    """[m/s2], along x, y and z. `lean`: tangent of the angle by which the box is inclined."""
    down = GRAVITY * reality["weight"] / math.hypot(1, reality["lean"])
    return [down * reality["lean"], 0.0, -down]


def schedule(reality):
    """Steps between scans, and the steps at which the plate starts, reaches the lowest position, leaves it, and is
    back."""
    steps = round(STEPS * reality["slower"])
    begin = steps * math.ceil(BEGIN / steps)
    turn = begin + SCANS * steps
    back = turn + reality["held"] * steps
    return steps, begin, turn, back, back + SCANS * steps


# Further keys of an experiment, in addition to those of its input script.
DEFAULTS = {
    "slower": 1,       # factor by which the plate is slower than SPEED
    "held": 0,         # number of intervals for which the plate rests at its lowest position
    "tilt": 0,         # slope of the plate along x
    "weight": 1,       # relative to grains of DENSITY
    "lean": 0,         # inclination of the box along x
    "types": 2,        # number of atom types in the packing's file
    "materials": None  # number of grain materials, assigned at random; types 1, 2, ..
}


def by_yade(folder, script, packing, materials, variables):
    """What is dumped elsewhere: by step, the force on the plate, and rows of grains, pairs and walls."""
    grains = [(material - 1, *row) for material, row in zip(materials, packing)]
    (folder / "variables.json").write_text(json.dumps({**variables, "size": BOX, "density": DENSITY, "grains": grains}))
    run_command(["yade", "-n", "-x", "-j1", HERE / script], folder, script)
    scans = json.loads((folder / "scans.json").read_text())
    return [{int(step): scan[k] for step, scan in scans.items()} for k in range(4)]


def simulate(folder, seed, reality):
    """Scans of the case: plate position, phase and force; grains as (diameter, x, y, z); contacts as (grain, partner,
    point, force on grain)."""
    folder.mkdir(parents=True, exist_ok=True)
    reality = {**DEFAULTS, **reality}
    packing = make_packing(folder, seed, 23.3e3)
    chance = random.Random(seed)
    materials = [chance.randint(1, reality["materials"]) for _ in packing] if reality["materials"] else None
    steps, begin, turn, back, end = schedule(reality)
    pull = gravity_of(reality)
    variables = {**{key: value for key, value in reality.items() if key not in ("program", "input", *DEFAULTS)},
                 "start": START, "time_step": TIME_STEP, "plate_speed": STROKE / (SCANS * steps * TIME_STEP), "steps": steps,
                 "relaxed": RELAXED, "begin": begin, "turn": turn, "back": back, "end": end, "slope": reality["tilt"]}
    if reality["program"] == "yade":
        dumped = by_yade(folder, reality["input"], packing, materials, {**variables, "gravity": pull})
    else:
        write_data(folder / "packing.data", packing, reality["types"], materials)
        write_walls(folder, reality["tilt"])
        output = execute(reality["program"], reality["input"], folder, {
            **variables, "size_x": BOX, "size_y": BOX, "types": reality["types"], "gravity": math.hypot(*pull), "gravity_x": pull[0],
            "gravity_z": pull[2]})
        dumped = top_forces(reality["program"], output), *(read_dump(folder / f"{name}.dump") for name in ("grains", "pairs", "walls"))
    try:
        return [scan_of(reality, n, *(table[(begin if n <= SCANS else back - SCANS * steps) + n * steps]
                                      for table in dumped)) for n in range(2 * SCANS + 1)]
    except KeyError as step:
        raise Failed(f"{folder}: nothing was dumped at step {step}") from step
