"""Run by Yade (yade -n -x) in an empty folder: compresses soft spheres with a plate and writes the files of Yade's own
exporters, and the same numbers unrounded in printed.json."""
import json
import random

from yade import export
from yade.utils import PWaveTimeStep, sphere, wall

SIZE, HEIGHT, STROKE, SPEED = 0.08, 0.061, 0.006, 0.05  # of the box, of the plate at the start [m]; of the plate [m/s]
FRAMES = 4
RADIUS = 0.0101  # slightly larger than the lattice allows without overlap [m]

random.seed(5)
grain = O.materials.append(FrictMat(young=23300, poisson=0.3, density=200, frictionAngle=0.3))
stiff = O.materials.append(FrictMat(young=5e7, poisson=0.3, density=1000, frictionAngle=0.3))
for axis in range(3):
    for place, sense in ((0, 1), ((SIZE, SIZE, HEIGHT)[axis], -1)):
        O.bodies.append(wall(place, axis, sense, material=stiff))
plate = O.bodies[5]
for n in range(48):
    at = [0.02 * (k + 0.5) + random.uniform(-4e-4, 4e-4) for k in (n % 4, n // 4 % 4, n // 16)]
    O.bodies.append(sphere(at, RADIUS + random.uniform(-2e-4, 2e-4), material=grain))

O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()]),
    InteractionLoop([Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()], [Ip2_FrictMat_FrictMat_MindlinPhys()],
                    [Law2_ScGeom_MindlinPhys_Mindlin()]),
    NewtonIntegrator(damping=0.6, gravity=(0, 0, -9.81)),
]
O.dt = 0.2 * PWaveTimeStep()
O.run(2000, True)

vtk = export.VTKExporter("yade")
frames = []


def note():
    frame = {"plate_z": plate.state.pos[2], "top_force": O.forces.f(5)[2], "grains": [], "contacts": []}
    for body in O.bodies:
        if isinstance(body.shape, Sphere):
            frame["grains"].append([*body.state.pos, 2 * body.shape.radius])
    for i in O.interactions:
        force = i.phys.normalForce + i.phys.shearForce  # on the second body
        frame["contacts"].append([i.id1, i.id2, *force, *i.geom.contactPoint])
    frames.append(frame)
    vtk.exportSpheres()
    export.text(f"spheres-{len(frames) - 1}.txt")
    vtk.exportInteractions(what={"id1": "i.id1", "id2": "i.id2", "force": "i.phys.normalForce+i.phys.shearForce"})


with open("plate.txt", "w") as table:
    table.write("plate_z top_force\n")
    for n in range(FRAMES):
        if n > 0:
            plate.state.vel = (0, 0, -SPEED)
            O.run(int(STROKE / (FRAMES - 1) / SPEED / O.dt), True)
        note()
        table.write(f"{frames[-1]['plate_z']!r} {frames[-1]['top_force']!r}\n")
with open("printed.json", "w") as file:
    json.dump({"size": SIZE, "frames": frames}, file)
