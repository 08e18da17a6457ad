"""One stroke of the plate down and up, run by Yade (yade -n -x) in the folder of variables.json (realities.py), recorded in passing in
scans.json: by step, the force on the plate, and what the dumps of liggghts.in have of grains, pairs and walls."""
import json
import math

from yade.utils import facet, sphere, wall

WALLS, PLATE = 6, 5  # bodies 0 to 5, in the order of realities.WALLS

with open("variables.json") as file:
    given = json.load(file)
size, start, steps = given["size"], given["start"], given["steps"]

kinds = [O.materials.append(FrictMat(young=young, poisson=poisson, density=given["density"], frictionAngle=0))
         for young, poisson in given["kinds"]]
angles = [(a, b, math.atan(mu)) for a, row in enumerate(given["frictions"]) for b, mu in enumerate(row)]

for axis in range(3):
    for place, sense in ((0, 1), ((size, size, start)[axis], -1)):
        O.bodies.append(wall(place, axis, sense, material=kinds[-1] if (axis, place) == (2, 0) else kinds[-2]))
if given["slope"]:  # one large facet, so that no grain meets an edge
    O.bodies.erase(PLATE)
    corners = [(size / 2 + 2 * x, size / 2 + 2 * y, start + 2 * given["slope"] * x) for x, y in ((-1, -1), (1, -1), (0, 1))]
    O.bodies.insertAtId(facet(corners, material=kinds[-2]), PLATE)
plate = O.bodies[PLATE]
for material, diameter, *centre in given["grains"]:
    O.bodies.append(sphere(centre, diameter / 2, material=kinds[material]))
grains = [body for body in O.bodies if isinstance(body.shape, Sphere)]

scans = {}


def note():
    atoms, pairs, walls = [], [], []
    for number, body in enumerate(grains, 1):
        weight = body.state.mass * motion.gravity  # not among the forces: the integrator adds it
        atoms.append([number, 2 * body.shape.radius, *body.state.pos, *(O.forces.f(body.id) + weight)])
    for i in O.interactions:
        force = i.phys.normalForce + i.phys.shearForce  # on the second body
        if i.id1 < WALLS:
            walls.append([i.id1, i.id2 - WALLS + 1, *force])
        else:
            pairs.append([i.id2 - WALLS + 1, i.id1 - WALLS + 1, *force])
    scans[O.iter] = [O.forces.f(PLATE)[2], atoms, pairs, walls]


def pass_by():
    """Between the forces and the motion of a step, where both are of the same positions."""
    done, step = divmod(O.iter - given["begin"], steps)
    if done < 0:
        return
    velocity = given["plate_speed"] * (given["moves"][done] if done < len(given["moves"]) else 0)
    if given["smooth"]:
        velocity *= 1 - math.cos(2 * math.pi * (step + 0.5) / steps)
    plate.state.vel = (0, 0, -velocity)
    if step == 0:
        note()


O.dt = given["time_step"]
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb(), Bo1_Facet_Aabb()], verletDist=given["skin"]),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom(avoidGranularRatcheting=False), Ig2_Wall_Sphere_ScGeom(hertzian=True, noRatch=False),
         Ig2_Facet_Sphere_ScGeom(hertzian=True)],
        # Damping of friction would be added without a limit.
        [Ip2_FrictMat_FrictMat_MindlinPhys(betan=given["damping"], betas=0.0, frictAngle=MatchMaker(matches=angles))],
        [Law2_ScGeom_MindlinPhys_Mindlin()]),
    PyRunner(command="pass_by()", iterPeriod=1 if given["smooth"] else steps),
    NewtonIntegrator(damping=0.2, gravity=given["gravity"], label="motion"),
]
O.run(given["relaxed"], True)
motion.damping = 0
O.run(given["end"] + 1 - given["relaxed"], True)
with open("scans.json", "w") as file:
    json.dump(scans, file)
