"""Each measured contact: the overlap implied by its force, the overlap of the measured positions, and the surface displacement by the other
contacts of its two grains."""
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ..experiment.container import apart, lengths, towards_wall, wall_distance
from ..results.names import Wall
from ..results.recording import Box, Floats, Ints

if TYPE_CHECKING:
    from .seen_scans import SeenScans

MOST_PAIRS = 1_000_000  # of contacts of one grain, whose displacements are computed at once
CLOSEST = 0.0225  # of sin^2(theta / 2): contacts closer than 17 degrees are measurement errors


@dataclass(frozen=True)
class GrainsAlone:
    """Without measured contact forces, grains are compared by themselves."""

    touching: float  # overlap from which they touch [m]
    listed: bool = False  # whether the experiment lists which grains touch (topology.csv)


@dataclass(frozen=True)
class Material:
    """What the residuals assume; the same for all recordings that are compared."""

    youngs_modulus: float = 0.0  # grains [Pa]
    poisson_ratio: float = 0.5
    wall_youngs_modulus: float = 0.0  # [Pa]
    wall_poisson_ratio: float = 0.5
    friction: float = 0.0  # between grains
    force_threshold: float = 0.0  # as stated by the instrument [N]
    grains_alone: GrainsAlone | None = None


@dataclass(frozen=True, eq=False)
class ContactResiduals:
    """Of C contacts. Lengths are over R* = R_i R_j / (R_i + R_j), or over R at a wall."""

    normal: Floats  # (C, 3) from grain to partner
    normal_force: Floats  # (C,) positive for repulsion [N]
    tangential: Floats  # (C,) magnitude of the tangential force [N]
    reduced_radius: Floats  # (C,) R* [m]
    implied: Floats  # (C,) overlap at which Hertz's law gives the force; negative for attraction
    measured: Floats  # (C,) overlap of the measured spheres; negative for a gap
    cross_contact: Floats  # (C,) sum of delta_kc of both grains [paper, Eq. 1 with gamma = 1]

    @property
    def residual(self) -> Floats:
        """(C,)"""
        return self.implied - self.measured


def contact_residuals(seen: "SeenScans") -> ContactResiduals:
    """Of all contacts of scans with positions."""
    box, radius = seen.box, 0.5 * seen.diameter
    grains, walls = ~seen.is_wall, seen.is_wall
    here = radius[seen.grain]
    normal, gap, reduced_radius = np.empty(seen.force.shape), np.empty(len(here)), np.empty(len(here))

    between = apart(box, seen.centre[grains], seen.position[seen.scan[grains], seen.partner[grains]])
    distance = lengths(between)
    there = radius[seen.partner[grains]]
    is_apart = distance > 0
    normal[grains] = np.where(is_apart[:, np.newaxis], between / np.where(is_apart, distance, 1)[:, np.newaxis], (0.0, 0.0, 1.0))
    gap[grains] = distance - here[grains] - there
    reduced_radius[grains] = here[grains] * there / (here[grains] + there)

    wall, at_wall = -1 - seen.partner[walls], here[walls]
    normal[walls] = towards_wall(box, wall, seen.centre[walls])
    gap[walls] = wall_distance(box, wall, seen.plate_z[seen.scan[walls]], seen.centre[walls]) - at_wall
    reduced_radius[walls] = reduced_radius_at(box, wall, at_wall)

    normal_force = -np.einsum("ij,ij->i", seen.force, normal)
    tangential = seen.force + normal_force[:, np.newaxis] * normal
    modulus = np.where(walls, reduced_modulus(seen.material, True), reduced_modulus(seen.material, False))
    return ContactResiduals(normal, normal_force, lengths(tangential), reduced_radius, implied_overlap(normal_force, modulus, reduced_radius),
                            -gap / reduced_radius, _cross_contact(seen, normal, normal_force) / reduced_radius)


def implied_overlap(force: Floats, modulus: Floats | float, reduced_radius: Floats | float) -> Floats:
    """Overlap over R* at which Hertz's law gives a force [N], with E* [Pa] and R* [m]; negative for attraction."""
    size = 3 * np.abs(force) / (4 * modulus * reduced_radius**2)
    implied: Floats = np.copysign(np.cbrt(size * size), force)
    return implied


def reduced_radius_at(box: Box, wall: Ints, radius: Floats) -> Floats:
    """(C,) R* of grains of these radii at these walls [m]. Inside a cylinder 1/R* is the geometric mean of both directions (Johnson 1985,
    section 4.2)."""
    curved = (wall == Wall.x_min) & box.is_cylinder
    reduced: Floats = radius / np.sqrt(1 - np.where(curved, radius / (box.size_x / 2), 0))
    return reduced


def reduced_modulus(material: Material, wall: bool) -> float:
    """E* of two grains, or of a grain and a wall [Pa]."""
    grain = (1 - material.poisson_ratio**2) / material.youngs_modulus
    return 1 / (grain + ((1 - material.wall_poisson_ratio**2) / material.wall_youngs_modulus if wall else grain))


def _cross_contact(seen: "SeenScans", normal: Floats, normal_force: Floats) -> Floats:
    """(C,) displacement of both grains' surfaces at each contact by their other contacts that push [m].

    The paper's Eq. 1 with both points on the undeformed sphere (Gonzalez & Cuitino 2012), s = sin(theta / 2), in units of
    (1 + nu) F/(4 pi E R).
    """
    grains = ~seen.is_wall
    contact = np.concatenate([np.arange(len(normal)), np.flatnonzero(grains)])  # each from the side of its grain, then of its partner
    owner = np.concatenate([seen.of_grain(seen.grain), seen.of_grain(seen.partner)[grains]])
    outward = np.concatenate([normal, -normal[grains]])
    order = np.argsort(owner, kind="stable")  # by grain
    contact, owner, outward = contact[order], owner[order], outward[order]
    force = np.maximum(normal_force[contact], 0)
    count = np.bincount(owner)[owner]  # contacts of the grain of each side
    nu, moved = seen.material.poisson_ratio, np.zeros(len(owner))
    for size in np.unique(count):
        sides = np.flatnonzero(count == size).reshape(-1, size)  # (grains, contacts of a grain)
        for some in np.array_split(sides, -(-sides.size * size // MOST_PAIRS)):
            moved[some] = np.einsum("gab,gb->ga", _displacement_on_sphere(outward[some], nu), force[some])
    moved *= (1 + nu) / (4 * np.pi * seen.material.youngs_modulus * 0.5 * seen.diameter[owner % len(seen.diameter)])
    return np.bincount(contact, moved, len(normal)).astype(float)


def _displacement_on_sphere(direction: Floats, nu: float) -> Floats:
    """(grains, contacts, contacts) at each contact by each other one of the same grain; `direction` (grains, contacts, 3)."""
    s = direction @ direction.transpose(0, 2, 1)  # the largest arrays: cosines, then s, without copies
    s *= -0.5
    s += 0.5
    np.sqrt(np.maximum(s, CLOSEST, out=s), out=s)
    displacement: Floats = (7 - 8 * nu) * s
    displacement += np.divide(-2 * (1 - nu), s, out=s)
    displacement -= 2 * (1 - 2 * nu)
    own = np.arange(direction.shape[1])
    displacement[:, own, own] = 0
    return displacement
