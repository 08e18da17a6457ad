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
FORCE_SCANS = 10                   # on the way to the highest force, where forces are prescribed
HOLD_SCANS, HOLD_TIME = 3, 0.3     # of the highest force [s]
CONTROL_STIFFNESS = 2e4            # of the plate that keeps a force [N/m]
GRAINS = 216
DENSITY = 11.5                     # [kg/m3]
GRAVITY = 9.81                     # [m/s2]
WIDTHS = {"box": BOX, "cylinder": 0.141, "periodic": 0.118}  # of the container, along x and y [m]
SIDES = {"box": ["x_min", "x_max", "y_min", "y_max"], "cylinder": ["side"], "periodic": []}
WALLS = [*SIDES["box"], "floor", "plate"]
TIME_LIMIT = 1800                  # [s] a run
PROGRAMS = {"liggghts": "liggghts", "lammps": "lmp", "yade": "yade"}


class Failed(Exception):
    pass


def missing_programs(codes=("liggghts", "lammps")):
    """Of these codes, and LAMMPS, which makes the packings."""
    return [PROGRAMS[code] for code in dict.fromkeys([*codes, "lammps"]) if not shutil.which(PROGRAMS[code])]


def run_scene(mcdem, folder, name, text):
    """The result file of a run of this scene by mcdem."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / f"{name}.toml").write_text(text)
    out = folder / f"{name}_run"
    shutil.rmtree(out, ignore_errors=True)
    subprocess.run([mcdem, "run", folder / f"{name}.toml", "--out", out, "--no-figures"], check=True, stdout=subprocess.DEVNULL)
    return out / "run.h5"


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


def edges_of(shape, size):
    """Ends of LAMMPS's box along x and y, for write_data: beyond the walls, or at the period."""
    beyond = 0 if shape == "periodic" else 0.01
    return [(-beyond, length + beyond) for length in size]


def write_data(path, rows, edges, types=2, materials=None, digits=10):
    """A data file for both codes, with diameter and centre of every grain. `materials`: atom types, default 1."""
    lines = ["packing", "", f"{len(rows)} atoms", f"{types} atom types", "",
             *(f"{low:.17g} {high:.17g} {axis}lo {axis}hi" for axis, (low, high) in zip("xy", edges)), "-0.01 0.9 zlo zhi", "", "Atoms", ""]
    lines += [f"{n} {m} {d:.{digits}g} {DENSITY} {x:.{digits}g} {y:.{digits}g} {z:.{digits}g}"
              for n, (m, (d, x, y, z)) in enumerate(zip(materials or [1] * len(rows), rows), 1)]
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


def one_size(chance):
    """Diameters of a truncated normal distribution."""
    sizes = []
    while len(sizes) < GRAINS:
        size = chance.gauss(21.490e-3, 1.199e-3)
        if 18.167e-3 <= size <= 24.561e-3:
            sizes.append(size)
    return sizes


def two_sizes(chance):
    """As many small grains as large ones, with about the volume of those of one size."""
    return chance.sample([24.5e-3, 15e-3] * 118, 236)


def loose_grains(seed, container, draw_sizes):
    """Grains on a wide lattice about the container's axis, with random offsets."""
    chance = random.Random(seed)
    sizes = draw_sizes(chance)
    side, middle = 4, WIDTHS[container] / 2
    step = min(middle * 2, BOX) / side
    shake = (step - 25e-3) / 2
    places = [(x, y) for y in range(side) for x in range(side) if container != "cylinder" or {x, y} & {1, 2}]

    def at(index):
        return middle + step * (index - (side - 1) / 2) + chance.uniform(-shake, shake)

    rows = []
    for n, size in enumerate(sizes):
        x, y = places[n % len(places)]
        rows.append((size, at(x), at(y), step * (n // len(places) + 0.5)))
    return rows


def make_packing(folder, seed, modulus, container, sizes):
    width = WIDTHS[container]
    write_data(folder / "loose.data", loose_grains(seed, container, sizes), edges_of(container, (width, width)))
    execute("lmp", "packing.in", folder, {"container": container, "size_x": width, "size_y": width, "start": START,
                                          "time_step": TIME_STEP, "youngs_modulus": modulus})
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
    """Upward force on the plate at each step: third column of the thermodynamic output, or of the lines "scan ..";
    in LAMMPS the force on the grains."""
    sign = -1 if program == "lmp" else 1
    rows = [line.removeprefix("scan ").split() for line in output.splitlines()]
    return {int(row[0]): sign * float(row[2]) for row in rows if len(row) == 3 and row[0].isdigit()}


def pairs_of(program, rows):
    """(grain, partner, force on grain); grains are numbered from 0."""
    if program == "lmp":
        return [(int(i) - 1, int(j) - 1, [n + t for n, t in zip(f[:3], f[3:])]) for i, j, *f in rows]
    return [(int(i) - 1, int(j) - 1, force) for i, j, *force in rows]


def walls_of(container):
    return [*SIDES[container], "floor", "plate"]


def wall_contacts_of(program, rows, container):
    if program == "lmp":
        return [(int(row[0]) - 1, wall, row[2 + 4 * w:5 + 4 * w]) for row in rows for w, wall in enumerate(walls_of(container))
                if row[1 + 4 * w] != 0]
    return [(int(i) - 1, WALLS[int(mesh)], force) for mesh, i, *force in rows]


def point_of(grains, i, partner, height, tilt, container):
    """Midway between the surfaces of two grains; for a wall, the foot of the perpendicular from the centre."""
    d, *centre = grains[i]
    if partner == "side":
        radius = WIDTHS[container] / 2
        out = [c - radius for c in centre[:2]]
        return [*(radius * (1 + o / math.hypot(*out)) for o in out), centre[2]]
    if isinstance(partner, str):
        axis = "xyz".index(partner[0]) if partner[1] == "_" else 2
        centre[axis] = {"x_min": 0, "y_min": 0, "floor": 0, "plate": plate_height(height, tilt, centre[0])}.get(partner, BOX)
        return centre
    other, *there = grains[partner]
    if container == "periodic":
        there[:2] = (a - WIDTHS[container] * round((a - b) / WIDTHS[container]) for a, b in zip(there, centre[:2]))
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
        raise Failed(f"{scan}: the contacts of a grain miss {worst} N of its force, with {mean} N a contact on average")


def scan_of(reality, scan, top, atoms, pairs, walls):
    """`scan`: height and phase, and what else is known of it."""
    program, tilt, container = reality["program"], reality["tilt"], reality["container"]
    height = scan["height"]
    grains = [tuple(row[1:5]) for row in atoms]
    contacts = pairs_of(program, pairs) + wall_contacts_of(program, walls, container)
    plate = -sum(force[2] for _, partner, force in contacts if partner == "plate")
    if abs(plate - top) > 0.01 * abs(top) + 1e-4:
        raise Failed(f"plate at {height} m: contacts push the plate with {plate} N, its gauge says {top} N")
    expect_all_contacts(f"plate at {height} m", atoms, contacts, gravity_of(reality))
    return {**scan, "top": top, "grains": grains,
            "contacts": [(i, j, point_of(grains, i, j, height, tilt, container), force) for i, j, force in contacts]}


def gravity_of(reality):
    """[m/s2], along x, y and z. `lean`: tangent of the angle by which the box is inclined."""
    down = GRAVITY * reality["weight"] / math.hypot(1, reality["lean"])
    return [down * reality["lean"], 0.0, -down]


def moves(reality):
    """Direction of the plate in each interval: 1 down, 0 at rest, -1 up."""
    down, up = [1] * SCANS, [-1] * SCANS
    return {"stroke": [*down, *up],
            "held": [*down, 0, 0, *up],
            "paused": [move for way in (*down, *up) for move in (way, 0)],  # as for a tomograph, with smooth moves
            "two_cycles": [*down, *up] * 2}[reality["protocol"]]


def schedule(reality):
    """Steps in an interval, and the steps at which the plate starts and stops."""
    steps = round(STEPS * reality["slower"] * reality["finer"])
    begin = steps * math.ceil(BEGIN * reality["finer"] / steps)
    return steps, begin, begin + len(moves(reality)) * steps


def plate_motion(reality):
    """What the experimenter knows of the plate's motion, for experiment.toml: its mean speed, how long it pauses at each scan, and
    how long it is held at the lowest one."""
    steps, _, _ = schedule(reality)
    interval = steps * TIME_STEP / reality["finer"]
    stands = {"paused": f"pause = {interval:.3g}\n", "held": f"hold = {2 * interval:.3g}\n"}.get(reality["protocol"], "")
    return f"speed = {STROKE / SCANS / interval:.3g}\n{stands}"


def stroke_variables(reality):
    """Variables of stroke.in and liggghts.in: downward velocity of the plate over its mean speed, and the steps for which it has
    moved, as formulas of `step`. Abrupt stops shake these light grains at 5 to 20 mm/s, which unloads the walls' friction; in an
    experiment plates are slower. Where the plate pauses, its velocity therefore is 1 - cos over each move."""
    steps, begin, _ = schedule(reality)
    ways = [0, *moves(reality), 0]
    changes = [(begin + n * steps, after - before) for n, (before, after) in enumerate(zip(ways, ways[1:])) if after != before]
    moving = "+".join(f"({change})*(step>{step})" for step, change in changes)
    depth = "+".join(f"({change})*(step-{step})*(step>{step})" for step, change in changes)
    if reality["protocol"] == "paused":
        turn = 2 * math.pi / steps
        depth += f"-({moving})*{1 / turn}*sin({turn}*(step-{begin}))"
        moving = f"({moving})*(1-cos({turn}*(step-{begin})))"
    return {"moving": moving, "depth": depth}


def stroke_scans(reality):
    """By step: height, phase and cycle. The first scan is before the plate moves, the others at the end of a move, or of the
    rest behind it."""
    steps, begin, _ = schedule(reality)
    ways = moves(reality)
    scans, depth, cycle = {begin: {"height": START, "phase": "load", "cycle": 0}}, 0, 0
    for n, way in enumerate(ways, 1):
        depth += way
        cycle += way == 1 and scans[max(scans)]["phase"] == "unload"
        if way:
            phase = "load" if way == 1 else "unload"
        else:
            del scans[max(scans)]
        scans[begin + n * steps] = {"height": START - STROKE / SCANS * depth, "phase": phase, "cycle": cycle}
    return scans


def force_stages(reality):
    """Forces of the scans on the way down and on the way up; the highest is kept between."""
    levels = [reality["highest_force"] * k / FORCE_SCANS for k in range(1, FORCE_SCANS + 1)]
    return levels, levels[-2::-1]


def force_variables(reality):
    """Variables of forces.in; the first scan is the packing at rest."""
    down, up = force_stages(reality)
    forces, ways = [0, *down, *[down[-1]] * HOLD_SCANS, *up], [0, *[1] * len(down), *[0] * HOLD_SCANS, *[-1] * len(up)]
    return {"forces": " ".join(map(str, forces)), "ways": " ".join(map(str, ways)),
            "held": round(HOLD_TIME / HOLD_SCANS / TIME_STEP), "stiffness": CONTROL_STIFFNESS}


def force_scans(reality, output):
    """By step, height, phase, time and prescribed force."""
    lines = [line.split()[1:] for line in output.splitlines() if line.startswith("scan ")]
    settings = force_variables(reality)
    return {int(step): {"height": START + float(moved), "phase": "unload" if way == "-1" else "load", "time": int(step) * TIME_STEP,
                        "set": float(force) or None}
            for (step, moved, _), force, way in zip(lines, settings["forces"].split(), settings["ways"].split())}


def programme_of(reality):
    """The stages of forces, as in a scene."""
    if not reality["highest_force"]:
        return ""
    down, up = force_stages(reality)
    return (f"[[programme]]\nforce = {down[-1]}\nscan_at = {down}\n[[programme]]\nstage = \"hold\"\nkeep = \"force\"\ntime = {HOLD_TIME}\n"
            f"scans = {HOLD_SCANS}\n[[programme]]\nforce = {up[-1]}\nscan_at = {up}\n")


# Further keys of an experiment, in addition to those of its input script.
DEFAULTS = {
    "slower": 1,       # factor by which the plate is slower than SPEED
    "finer": 1,        # factor by which the time step is shorter than TIME_STEP; not where forces are prescribed
    "protocol": "stroke",  # of the plate: one of those of moves()
    "tilt": 0,         # slope of the plate along x
    "weight": 1,       # relative to grains of DENSITY
    "lean": 0,         # inclination of the box along x
    "types": 2,        # number of atom types in the packing's file
    "materials": None,  # number of grain materials, assigned at random; types 1, 2, ..
    "container": "box",  # or cylinder or periodic, by LAMMPS only
    "highest_force": None,  # where forces are prescribed [N], by LAMMPS only
    "sizes": one_size   # function that draws the diameters
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
    container = reality["container"]
    packing = make_packing(folder, seed, 23.3e3, container, reality["sizes"])
    chance = random.Random(seed)
    materials = [chance.randint(1, reality["materials"]) for _ in packing] if reality["materials"] else None
    steps, begin, end = schedule(reality)
    pull = gravity_of(reality)
    time_step = TIME_STEP / reality["finer"]
    variables = {**{key: value for key, value in reality.items() if key not in ("program", "input", *DEFAULTS)},
                 "start": START, "time_step": time_step, "plate_speed": STROKE / (SCANS * steps * time_step), "steps": steps,
                 "relaxed": RELAXED * reality["finer"], "begin": begin, "end": end, "slope": reality["tilt"]}
    if reality["program"] == "yade":
        dumped = by_yade(folder, reality["input"], packing, materials, {**variables, "gravity": pull, "moves": moves(reality), "smooth": reality["protocol"] == "paused"})
    else:
        edges = edges_of(container, [WIDTHS[container]] * 2)
        write_data(folder / "packing.data", packing, edges, reality["types"], materials)
        write_walls(folder, reality["tilt"])
        motion = {"motion": "stroke.in", **stroke_variables(reality)}
        if reality["highest_force"]:
            motion = {"motion": "forces.in", **force_variables(reality)}
            for name in ("grains", "pairs", "walls"):  # they are appended to
                (folder / f"{name}.dump").unlink(missing_ok=True)
        output = execute(reality["program"], reality["input"], folder, {
            **variables, **motion, "scripts": HERE, "container": container,
            "size_x": WIDTHS[container], "size_y": WIDTHS[container], "types": reality["types"],
            "gravity": math.hypot(*pull), "gravity_x": pull[0], "gravity_z": pull[2],
            "wall_columns": " ".join(f"f_{wall}[{k}]" for wall in walls_of(container) for k in (1, 2, 3, 4))})
        dumped = top_forces(reality["program"], output), *(read_dump(folder / f"{name}.dump") for name in ("grains", "pairs", "walls"))
    scans = force_scans(reality, output) if reality["highest_force"] else stroke_scans(reality)
    try:
        return [scan_of(reality, scan, *(table[step] for table in dumped)) for step, scan in scans.items()]
    except KeyError as step:
        raise Failed(f"{folder}: nothing was dumped at step {step}") from step
