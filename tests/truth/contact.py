"""Shared by both solvers: hat functions on a cap, and the contact conditions."""
import numpy as np


class Hats:
    """Piecewise linear functions of theta on a cap: `count` nodes from the pole, zero at the rim theta = `rim`.

    Each element has `points` Gauss points; `values` are the hat functions there (hat, point), and `integral` is
    `values` times the area 2 pi sin(theta) dtheta of each point.
    """

    def __init__(self, rim, count, points):
        self.nodes = np.linspace(0, rim, count + 1)
        step = self.nodes[1]
        g, w = np.polynomial.legendre.leggauss(points)
        self.theta = (self.nodes[:-1, None] + step * (g + 1) / 2).ravel()
        self.cosine = np.cos(self.theta)
        self.area = np.tile(w * step / 2, count) * np.sin(self.theta) * 2 * np.pi
        along = (g + 1) / 2
        self.values = np.zeros((count, self.theta.size))
        for i in range(count):
            self.values[i, i * points:(i + 1) * points] = 1 - along
            if i:
                self.values[i, (i - 1) * points:i * points] = along
        self.integral = self.values * self.area
        self.force = self.integral.sum(1)               # of a hat function of unit pressure along the plate normal
        self.gap = self.integral @ (1 - self.cosine)    # distance of the sphere from the plate, weighted by the hat function


def solve_contact(stiffness, approach):
    """Pressures with p >= 0 and stiffness p >= approach, one of which is an equality everywhere (no tension, no
    penetration): active set iteration."""
    active = np.ones(len(approach), bool)
    for _ in range(200):
        pressure = np.zeros(len(approach))
        pressure[active] = np.linalg.solve(stiffness[np.ix_(active, active)], approach[active])
        residual = stiffness @ pressure - approach
        update = (active & (pressure > 0)) | (~active & (residual < 0))
        if (update == active).all():
            return pressure
        active = update
    raise RuntimeError("the contact areas do not settle")
