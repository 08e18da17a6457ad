"""Observables of contact forces without positions: forces on walls, and their distribution."""
import numpy as np

from ..experiment.container import towards_wall
from ..results.names import Wall
from ..results.recording import Floats
from .observables import observed
from .seen_scans import SeenScans


@observed("contacts",
          ("floor_force", 0.003, "floor", "", "force on the floor over that on the plate"),
          ("side_force", 0.003, "sides", "", "a quarter of the normal forces on the sides over the force on the plate"),
          ("plate_contacts", 0.003, "plate", "", "sum of the contact forces at the plate over the plate's own reading"),
          ("plate_couple_x", 0.002, "plate", "", "centre of the plate's load along x, over half the box"),
          ("plate_couple_y", 0.002, "plate", "", "centre of the plate's load along y, over half the box"))
def wall_loads(seen: SeenScans) -> tuple[Floats, ...]:
    sides, at_plate = seen.at_sides, seen.at(Wall.plate)
    floor = seen.sum(seen.force[:, 2], seen.at(Wall.floor))
    outward = np.zeros(seen.force.shape)
    outward[sides] = towards_wall(seen.box, -1 - seen.partner[sides], seen.point[sides])
    on_sides = seen.sum(np.abs(np.einsum("ij,ij->i", seen.force, outward)), sides) / 4
    load = -seen.force[:, 2]
    plate = seen.sum(load, at_plate)
    couples = [seen.sum(load * (seen.point[:, axis] / (0.5 * size) - 1), at_plate) for axis, size in enumerate((seen.box.size_x, seen.box.size_y))]
    top = np.where((seen.top_force > 0) & (plate > 0), seen.top_force, np.nan)
    return floor / top, on_sides / top, plate / top, *(couple / np.where(np.isnan(top), np.nan, plate) for couple in couples)


@observed("contacts",
          ("coordination_number", 0.01, "", "", "contacts per grain"),
          ("weak_contacts", 0.005, "", "weak", "contacts per grain with one to two times the force threshold"),
          ("mean_force", 0.003, "", "", "log of the mean contact force"),
          ("force_spread", 0.005, "", "", "standard deviation of contact forces over their mean"),
          ("weak_forces", 0.003, "", "weak", "fraction of the contacts below 0.3 mean forces"),
          ("strong_forces", 0.003, "", "strong", "fraction of the contacts above 2 mean forces"),
          ("strongest_forces", 0.01, "", "strong", "95 % quantile of contact forces over their mean"))
def force_distribution(seen: SeenScans) -> tuple[Floats, ...]:
    grains, force = len(seen.diameter), seen.magnitude
    mean = seen.mean(force)
    variance = seen.mean(force * force) - mean * mean
    nothing, all_of_them = np.zeros(len(seen)), np.full(len(seen), np.inf)
    return (seen.sum(np.where(seen.is_wall, 1.0, 2.0)) / grains, seen.count(force < 2 * seen.material.force_threshold) / grains, np.log(mean),
            np.sqrt(np.maximum(variance, 0)) / mean, seen.fraction(force, nothing, 0.3 * mean), seen.fraction(force, 2 * mean, all_of_them),
            seen.quantile(force, 0.95) / mean)
