"""Sphere between equal plates; the pressure of every contact may vary around its centre.

The plates are related by the rotations of a group, so the pressure of one cap is the unknown: hat functions in theta
times trigonometric nodes in phi. Within the cap vector harmonics (spheroidal and toroidal) of order |m| <= (nodes -
1)/2 are used, between caps the Green's tensor of the sphere in real space.
"""
import numpy as np
from scipy.interpolate import CubicSpline

from contact import Hats, solve_contact
from sphere_modes import associated_legendre, compliance, legendre, toroidal_compliance


def own_cap(poisson_ratio, hats, nodes, orders):
    """Stiffness (hat, node, hat, node) of a cap with itself."""
    c, toroidal = compliance(poisson_ratio, orders), toroidal_compliance(poisson_ratio, orders)
    n = np.arange(orders + 1.0)[:, None]
    count = np.where(n > 0, n * (n + 1), 1)
    phi = 2 * np.pi * np.arange(nodes) / nodes
    total = 0
    for m in range((nodes - 1) // 2 + 1):
        value, slope = associated_legendre(orders, m, hats.cosine)
        radial = -(value * hats.cosine) @ hats.integral.T
        meridional = (slope @ hats.integral.T) / count
        twist = m * (value @ hats.integral.T) / count
        u = c[:, 0, 0, None] * radial + c[:, 0, 1, None] * meridional
        v = c[:, 1, 0, None] * radial + c[:, 1, 1, None] * meridional
        block = radial.T @ u + meridional.T @ (count * v) + twist.T @ (count * toroidal[:, None] * twist)
        harmonic = np.cos(m * (phi[:, None] - phi)) * (1 if m == 0 else 2) / nodes ** 2
        total = total + np.einsum('ab,ij->aibj', block, harmonic)
    return total


class GreensTensor:
    """Displacement of one surface point by a force at another: scalar functions of the angle between them.

    With the points x and y, the tensor acts on radial and tangential parts f_r x + f_t. Normal terms follow from P_n(x
    . y) by the surface gradient on either side."""
    smallest = np.radians(7)

    def __init__(self, poisson_ratio, orders=600):
        n = np.arange(orders + 1.0)
        count = np.where(n > 0, n * (n + 1), 1)
        c, toroidal = compliance(poisson_ratio, orders), toroidal_compliance(poisson_ratio, orders)
        angle = np.radians(np.linspace(7, 179.7, 1200))
        x = np.cos(angle)
        p = legendre(orders, x)
        first, second = np.zeros_like(p), np.zeros_like(p)      # derivatives by x
        first[1:] = n[1:, None] * (p[:-1] - x * p[1:]) / (1 - x * x)
        second[1:] = ((2 * x * first - count[:, None] * p) / (1 - x * x))[1:]
        factor = (2 * n + 1) / (4 * np.pi) * np.exp(-36 * (n / orders) ** 8)  # filter: the series diverges

        def tabulate(coefficient, function):
            return CubicSpline(angle, (factor * coefficient) @ function)

        self.radial = tabulate(c[:, 0, 0], p)
        self.mixed = tabulate(c[:, 0, 1] / count, first)
        self.tangential = tabulate(c[:, 1, 1] / count, first), tabulate(c[:, 1, 1] / count, second)
        self.twist = tabulate(toroidal / count, first), tabulate(toroidal / count, second)
        self.range = angle[0], angle[-1]

    def between(self, x, e_x, y, e_y):
        """Displacement along -e_x at the points x by unit forces along -e_y at the points y."""
        cosine = np.clip(x @ y.T, -1, 1)
        angle = np.arccos(cosine)
        if angle.min() < self.smallest:
            raise ValueError("caps nearer than 7 degrees")
        angle = np.clip(angle, *self.range)
        x_r, y_r = -(x @ e_x), -(y @ e_y)
        x_t, y_t = -e_x - x_r[:, None] * x, -e_y - y_r[:, None] * y
        x_turned, y_turned = np.cross(x_t, x), np.cross(y_t, y)
        x_yt, xt_y = x @ y_t.T, x_t @ y.T
        return (self.radial(angle) * np.outer(x_r, y_r)
                + self.mixed(angle) * (x_r[:, None] * x_yt + y_r[None, :] * xt_y)
                + self.tangential[1](angle) * xt_y * x_yt + self.tangential[0](angle) * (x_t @ y_t.T)
                + self.twist[1](angle) * (x_turned @ y.T) * (x @ y_turned.T)
                + self.twist[0](angle) * (x_turned @ y_turned.T))


def frame(directions):
    """The first direction and two perpendicular vectors, the first of them towards a near plate, so that phi = 0 has
    the symmetry."""
    e = directions[0]
    towards = directions[np.argsort(-(directions @ e))[1]]
    if abs(towards @ e) > 0.99:
        towards = np.cross(e, [0.3, 0.5, 0.8])
    across = towards - (towards @ e) * e
    across /= np.linalg.norm(across)
    return e, across, np.cross(e, across)


def solve(poisson_ratio, directions, overlap, rotations, reach, count=22, nodes=13):
    """Force on each plate in E R^2. `rotations`: 3 x 3 matrices that leave the arrangement unchanged; for each plate
    one of them maps the first plate to it. The cap extends to theta = reach sqrt(overlap)."""
    directions = np.array(directions, float) / np.linalg.norm(directions, axis=1)[:, None]
    rim = reach * np.sqrt(overlap)
    hats = Hats(rim, count, points=4)
    own = own_cap(poisson_ratio, hats, nodes, int(min(2000, 8 * count / rim)))

    e, a, b = frame(directions)
    phi = 2 * np.pi * np.arange(nodes) / nodes
    around = np.cos(phi)[:, None] * a + np.sin(phi)[:, None] * b
    sine, cosine = np.sin(hats.theta)[:, None, None], hats.cosine[:, None, None]
    points = (cosine * e + sine * around).reshape(-1, 3)
    area = np.repeat(hats.area / nodes, nodes)
    tensor = GreensTensor(poisson_ratio)
    others = 0
    for direction in directions[1:]:
        rotation = next(r for r in rotations if np.allclose(r @ e, direction))
        others = others + tensor.between(points, e, points @ rotation.T, direction)
    others = others * np.outer(area, area)
    to_points = np.einsum('iq,jk->ijqk', hats.values, np.eye(nodes)).reshape(count * nodes, -1)

    # The pole is a single point, so its nodes in phi share one unknown.
    share = np.zeros((count * nodes, count * nodes - nodes + 1))
    share[:nodes, 0] = 1
    share[nodes:, 1:] = np.eye(count * nodes - nodes)
    stiffness = share.T @ (own.reshape(count * nodes, -1) + to_points @ others @ to_points.T) @ share
    force = share.T @ np.repeat(hats.force / nodes, nodes)
    gap = share.T @ np.repeat(hats.gap / nodes, nodes)
    return solve_contact((stiffness + stiffness.T) / 2, overlap * force - gap) @ force
