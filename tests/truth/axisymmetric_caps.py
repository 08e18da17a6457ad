"""Sphere between plates; the pressure of every contact is axisymmetric about the normal of its plate.

Exact for two plates. In other arrangements contact areas are forced to be round, which matters if neighbours are close
(see README.md). Plates in one group have the same load by symmetry; groups may differ.
"""
import numpy as np

from contact import Hats, solve_contact
from sphere_modes import compliance, legendre


def moments(hats, orders):
    """Radial and meridional Legendre moments (order, hat) of hat functions of pressure along the plate normal."""
    n = np.arange(orders + 1.0)[:, None]
    p = legendre(orders, hats.cosine)
    slope = np.zeros_like(p)                            # sin(theta) dP_n/dtheta
    slope[1:] = n[1:] * (hats.cosine * p[1:] - p[:-1])
    radial = -(p * hats.cosine) @ hats.integral.T
    meridional = (slope @ hats.integral.T) / np.where(n > 0, n * (n + 1), 1)
    return radial, meridional


def solve(poisson_ratio, groups, overlaps, count=36, rim=None):
    """Force on one plate of every group, in E R^2; `rim` is the largest allowed contact angle."""
    groups = [np.array(g, float) / np.linalg.norm(g, axis=1)[:, None] for g in groups]
    rims = [rim or min(0.75, 1.45 * np.sqrt(max(overlap, 0.03))) for overlap in overlaps]
    orders = int(min(2500, 10 * count / min(rims)))
    c = compliance(poisson_ratio, orders)
    n = np.arange(orders + 1.0)[:, None]
    caps = [Hats(r, count, points=5) for r in rims]
    load = [moments(cap, orders) for cap in caps]

    stiffness = np.zeros((len(caps) * count,) * 2)
    for a, (radial, meridional) in enumerate(load):
        for b, (source_radial, source_meridional) in enumerate(load):
            cosines = np.clip(groups[b] @ groups[a][0], -1, 1)
            weight = (2 * n + 1) / (4 * np.pi) * legendre(orders, cosines).sum(1)[:, None]
            u = c[:, 0, 0, None] * source_radial + c[:, 0, 1, None] * source_meridional
            v = c[:, 1, 0, None] * source_radial + c[:, 1, 1, None] * source_meridional
            block = radial.T @ (weight * u) + meridional.T @ (weight * n * (n + 1) * v)
            stiffness[a * count:(a + 1) * count, b * count:(b + 1) * count] = block
    approach = np.concatenate([o * cap.force - cap.gap for o, cap in zip(overlaps, caps)])
    pressure = solve_contact(stiffness, approach).reshape(len(caps), count)
    return [p @ cap.force for p, cap in zip(pressure, caps)]
