"""Runs the given lines from standard input, which create a `pipeline` in OVITO, and prints its contents as JSON."""
import json
import sys

code = sys.stdin.read()
names = {}
exec(compile(code, "OVITO.txt", "exec"), names)  # lines of the project's own OVITO.txt
frames = []
for number in range(names["pipeline"].num_frames):
    data = names["pipeline"].compute(number)
    particles, bonds = data.particles, data.particles.bonds
    frames.append({"position": particles.positions[...].tolist(), "radius": particles["Radius"][...].tolist(),
                   "identifier": particles.identifiers[...].tolist(), "topology": bonds.topology[...].tolist(),
                   "force": [bonds[f"force_{axis}"][...].tolist() for axis in "xyz"],
                   "overlap": bonds["overlap"][...].tolist(),
                   "top_force": float(data.attributes["top_force"])})
print(json.dumps(frames))
