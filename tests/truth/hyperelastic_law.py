"""The contact model hyperelastic_sphere: overlaps from the forces on one sphere, with radius and E equal to 1.

The energy is a function of few invariants of the forces (README.md, "The law"). Its derivative with respect to a force is
the overlap of that contact."""
from typing import NamedTuple

import numpy as np

from elastic_sphere_law import LARGEST_RADIUS

CUBIC = .7  # third coefficient of uniform compression, for p = K (1 - J) and force = area p
LARGEST_COMPRESSION = .3  # P/K up to which the powers of uniform compression are used; linear beyond


class Coefficients(NamedTuple):
    """Couplings c_h, c, c_z, which are the same for all materials; own displacement, q and t of one Poisson ratio."""
    hertz: float
    coupling: float
    size: float
    own: tuple
    volume: float
    shear: float


def invariants(law, normals, forces):
    """P, H, W, Z, D and three powers of the contacts' own displacement, and their derivatives with respect to the
    forces: [8, case] and [8, case, contact], for forces [case, contact]."""
    forces = np.maximum(forces, 1e-9)
    all_forces = forces.sum(1, keepdims=True)
    a2 = (forces / law.modulus)**(2 / 3)
    a = np.clip(np.sqrt(a2), 1e-3, LARGEST_RADIUS)
    pressure = forces.sum(1) / (4 * np.pi)
    points = -forces @ law.point.T - law.uniform * (all_forces - forces)
    sizes = -(2 / 5 * (forces * a2) @ law.size.T + 2 / 3 * a2 * (forces @ law.size.T))
    own, own_work = of_self_term(law, a)
    stress = np.einsum('bc,ci,cj->bij', forces, normals, normals) / (4 * np.pi)
    along = np.einsum('ci,bij,cj->bc', normals, stress, normals) - pressure[:, None] / 3
    values = [pressure, .6 * (forces * a2).sum(1), (forces * points / 2 - forces**2 * own_work).sum(1),
              3 / 8 * (forces * sizes).sum(1), (stress**2).sum((1, 2)) - pressure**2 / 3]
    slopes = [np.full(forces.shape, 1 / (4 * np.pi)), a2, points - forces * own, sizes, along / (2 * np.pi)]
    for n in range(3):
        values.append((forces**2 * a**n).sum(1) / (2 + n / 3))
        slopes.append(forces * a**n)
    return np.array(values), np.array(slopes)


def of_self_term(law, a):
    """Displacement of a contact by its own force beyond Hertz, without uniform compression, per force; its work per
    squared force."""
    powers, slope = law.self_term.powers, law.self_term.slope
    work = np.array([1 / 2, 3 / 7, 3 / 8, 1 / 3]) * powers
    polynomial = np.polynomial.polynomial.polyval
    return (polynomial(a, powers) + slope * np.log(a) + law.uniform,
            polynomial(a, work) + slope * (np.log(a) / 2 - 1 / 12) + law.uniform / 2)


def uniform_work(P, poisson_ratio):
    """Integral of the overlap by uniform compression."""
    compressibility = 3 * (1 - 2 * poisson_ratio)
    u = compressibility / 3, compressibility**2 / 3, CUBIC * compressibility**3
    p = np.where(P.real > LARGEST_COMPRESSION / compressibility, LARGEST_COMPRESSION / compressibility, P)
    more = P - p
    work = p * p * (u[0] / 2 + p * (u[1] / 3 + p * u[2] / 4))
    return work + more * (p * (u[0] + p * (u[1] + p * u[2])) + more / 2 * (u[0] + p * (2 * u[1] + 3 * p * u[2])))


def energy(values, poisson_ratio, c):
    """Energy over E R^3, from the invariants [8, case]."""
    P, hertz, work, size_work, deviator, *own = values
    e, g, z = (1 + c.hertz * P)**(-2 / 3), 1 / (1 + c.coupling * P), 1 / (1 + c.size * P)
    work = work + sum(k * power for k, power in zip(c.own, own))
    cubic = P * (c.volume * P**2 + c.shear * deviator) * z**2
    return e * hertz + g * work + z**(5 / 3) * size_work - 4 * np.pi * (cubic - uniform_work(P, poisson_ratio))


def by_invariants(values, poisson_ratio, c):
    """Derivatives of the energy with respect to the invariants, by complex steps."""
    slopes = []
    for k in range(len(values)):
        moved = values.astype(complex)
        moved[k] += 1e-20j
        slopes.append(energy(moved, poisson_ratio, c).imag / 1e-20)
    return np.array(slopes)


def overlaps(law, normals, forces, c):
    """Overlaps [case, contact] at forces [case, contact]."""
    values, slopes = invariants(law, normals, forces)
    return np.einsum('kb,kbn->bn', by_invariants(values, law.poisson_ratio, c), slopes)


def hessian(law, normals, force, c):
    """Second derivative of the energy with respect to the forces [contact]."""
    step = 1e-6 * np.eye(len(force))
    change = (overlaps(law, normals, force + step, c) - overlaps(law, normals, force - step, c)) / 2e-6
    return (change + change.T) / 2
