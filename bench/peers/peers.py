"""LIGGGHTS and LAMMPS with the packing of the step benchmarks: grain-steps per second of each."""
import json
import math
import os
import pathlib
import re
import shutil
import subprocess

from programs import Failed, environment

HERE = pathlib.Path(__file__).resolve().parent
GAMMA = 1.125
TIME_LIMIT = 300  # [s] per run
OVERLAP = 0.05  # over the radius; the dampings of both LAMMPS styles agree at this overlap

# skin [m]: the fastest of 1, 2.7 and 4 mm for each; LIGGGHTS's example of its multi-contact model uses 4 mm.
CODES = [
    {"code": "LAMMPS, granular", "contacts": "independent", "program": "lmp", "input": "lammps.in", "law": "granular",
     "variables": {"skin": 0.001, "warm_up": 100, "steps": 400}},
    {"code": "LAMMPS, gran/hertz/history", "contacts": "independent", "program": "lmp", "input": "lammps.in", "law": "history",
     "variables": {"skin": 0.001, "warm_up": 100, "steps": 400}},
    {"code": "LIGGGHTS", "contacts": "independent", "program": "liggghts", "input": "liggghts.in",
     "variables": {"skin": 0.001, "warm_up": 100, "steps": 400, "surface": "default", "multicontact": 0}},
    {"code": "LIGGGHTS", "contacts": "multi-contact", "program": "liggghts", "input": "liggghts.in",
     "variables": {"skin": 0.004, "warm_up": 20, "steps": 60, "surface": "multicontact", "multicontact": 1}},
]
LEAST_CONTACTS, MOST_CONTACTS = 4, 8  # per grain, without walls


def write_plate(folder, parameters):
    """The plate as two triangles at height 0, slightly larger than the box."""
    low = -0.005
    high_x, high_y = parameters["size_x"] + 0.005, parameters["size_y"] + 0.005
    corners = [(low, low), (high_x, low), (high_x, high_y), (low, high_y)]
    text = "solid plate\n"
    for triangle in ((0, 1, 2), (0, 2, 3)):
        vertices = "".join(f"  vertex {corners[n][0]} {corners[n][1]} 0\n" for n in triangle)
        text += f"facet normal 0 0 1\n outer loop\n{vertices} endloop\nendfacet\n"
    (folder / "plate.stl").write_text(text + "endsolid plate\n")


def export(build, folder, grains):
    """Writes the packing into `folder`; returns its parameters."""
    subprocess.run([build / "bench" / "export_packing", str(grains), folder], check=True)
    parameters = json.loads((folder / "parameters.json").read_text())
    write_plate(folder, parameters)
    return parameters


def lammps_law(style, parameters):
    """Arguments of a contact law for grains and walls: `granular` from E, nu and e, `gran/hertz/history` from
    stiffnesses."""
    modulus, poisson, restitution, friction, diameter, density = (parameters[key] for key in (
        "youngs_modulus", "poisson_ratio", "restitution", "friction", "diameter", "density"))
    if style == "granular":
        law = (f"hertz/material {modulus} {restitution} {poisson} tangential mindlin NULL 1.0 {friction} damping tsuji")
        return {"pair": "granular", "coefficients": f"* * {law}", "wall": f"granular {law}"}
    reduced_modulus = modulus / (2 * (1 - poisson**2))
    normal = 4 / 3 * reduced_modulus
    shear = 2 * modulus / ((1 + poisson) * (2 - poisson))
    # Both dampings are linear in the velocity; this one increases with another power of the overlap.
    reduced_radius, reduced_mass = diameter / 4, density * math.pi * diameter**3 / 12
    contact_radius = math.sqrt(reduced_radius * OVERLAP * diameter / 2)
    loss = -math.log(restitution) / math.hypot(math.pi, math.log(restitution))
    damping = 2 * math.sqrt(5 / 6) * loss * math.sqrt(2 * reduced_modulus * contact_radius * reduced_mass)
    law = f"{normal} {shear} {damping / (reduced_mass * contact_radius)} NULL {friction} 1"
    return {"pair": f"gran/hertz/history {law}", "coefficients": "* *", "wall": f"hertz/history {law}"}


def command_of(code, folder, parameters, processes):
    variables = {**parameters, **code["variables"], "folder": folder, "gamma": GAMMA}
    if "law" in code:
        variables.update(lammps_law(code["law"], parameters))
    command = ["mpirun", "--oversubscribe", "-n", str(processes)] if processes > 1 else []
    command += [code["program"], "-log", "none", "-in", HERE / code["input"]]
    for name, value in variables.items():
        command += ["-var", name, str(value)]
    return command


def parse(output, returncode, grains):
    """Grain-steps per second of the last run in `output`, and Z at its end; raises Failed if there is none."""
    if returncode != 0:
        raise Failed("crashed: " + (re.findall(r"MPI_ERR_\w+|^ERROR: .*", output, re.MULTILINE) or [f"exit code {returncode}"])[0])
    loops = re.findall(r"Loop time of (\S+) on \d+ procs for (\d+) steps", output)
    thermo = re.findall(r"^ *\d+ +\d+ +(\S+) +\S+ *$", output, re.MULTILINE)
    if len(loops) < 2 or not thermo:
        raise Failed("no result")
    contacts = float(thermo[-1])
    if not LEAST_CONTACTS < contacts < MOST_CONTACTS:
        raise Failed(f"Z = {contacts}: not the packing it should be")
    seconds, steps = float(loops[-1][0]), int(loops[-1][1])
    return grains * steps / seconds, contacts


def log_name(code):
    return re.sub(r"\W+", "_", f"{code['code']} {code['contacts']}")


def run_code(code, folder, parameters, processes):
    result = {"code": code["code"], "contacts": code["contacts"], "processes": processes}
    missing = [p for p in [code["program"]] + ["mpirun"] * (processes > 1) if not shutil.which(p)]
    if missing:
        return {**result, "note": f"{missing[0]} is not installed"}
    env = environment(OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")
    try:
        done = subprocess.run(command_of(code, folder, parameters, processes), env=env, cwd=folder, timeout=TIME_LIMIT,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace")
        (folder / f"{log_name(code)}_{processes}.log").write_text(done.stdout)
        rate, contacts = parse(done.stdout, done.returncode, parameters["grains"])
    except subprocess.TimeoutExpired:
        return {**result, "note": f"not done after {TIME_LIMIT} s"}
    except Failed as problem:
        return {**result, "note": str(problem)}
    return {**result, "grain_steps_per_s": rate, "contacts_per_grain": contacts}


def measure(build, grains=50_000):
    """Every code on one process, and on as many as there are cores."""
    folder = build / f"bench_peers_{grains}"
    parameters = export(build, folder, grains)
    counts = sorted({1, os.cpu_count() or 1})
    return [run_code(code, folder, parameters, processes) for code in CODES for processes in counts]
