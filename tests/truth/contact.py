"""What both solvers share: hat functions on a cap, and the contact conditions."""
import numpy as np


class Hats:
    """Piecewise linear functions of theta on a cap: `count` nodes from the pole, zero at the rim theta = `rim`.

    Each element has `points` Gauss points; `values` holds the hats there (hat, point) and `integral` the same times
    the area 2 pi sin(theta) dtheta of each point.
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
        self.force = self.integral.sum(1)               # of a hat of unit pressure along the plate normal
        self.gap = self.integral @ (1 - self.cosine)    # the sphere's distance from the plate, weighted by the hat


def solve_contact(stiffness, approach):
    """Pressures p >= 0 with stiffness p >= approach, one of the two an equality everywhere (no tension, no
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
