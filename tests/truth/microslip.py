"""Oblique impact of elastic spheres whose contact slips from its rim inwards: Maw, Barber & Fawcett 1976, Wear 38:101.

The contact is divided into annuli, each of which sticks or slips. Tractions are sums of semi-elliptic ones, sqrt(a_j^2 - r^2), whose
tangential displacement, averaged over the angle, is that of Hertz's pressure with another constant (Johnson 1985, Contact Mechanics,
sections 3.2 and 7.2): on both bodies together (2 a^2 - r^2) pi / (16 G*) within a_j. The normal motion is Hertz's, without damping.
"""
import numpy as np


def displacement(radius, edge):
    """At `radius` by the traction sqrt(edge^2 - r^2), times 8 G*."""
    inside = radius <= edge
    ratio = np.where(inside, 1, edge / radius)
    rim = np.sqrt(np.maximum(radius**2 - edge**2, 0))
    return np.where(inside, np.pi / 2 * (2 * edge**2 - radius**2), (2 * edge**2 - radius**2) * np.arcsin(ratio) + edge * rim)


class Contact:
    """State of the annuli: the elastic displacement less that of the bodies."""

    def __init__(self, shear, friction, largest, annuli):
        self.shear, self.friction = shear, friction
        width = largest / annuli
        self.middle, self.edge = width * (np.arange(annuli) + 0.5), width * (np.arange(annuli) + 1)
        self.influence = displacement(self.middle[:, None], self.edge[None, :]) / (8 * shear)
        self.traction = np.sqrt(np.maximum(self.edge[None, :]**2 - self.middle[:, None]**2, 0))
        self.before = np.zeros(annuli)

    def force(self, moved, pressure):
        """The tangential force after the bodies have moved by `moved` in all, at the pressure of each annulus."""
        count = int(np.count_nonzero(pressure))
        if count == 0:
            self.before = np.full_like(self.before, -moved)
            return 0.0
        limit = self.friction * pressure[:count]
        slips = np.zeros(count)  # direction of slip; 0: sticks
        for _ in range(100):
            stuck = slips == 0
            rows = np.where(stuck[:, None], self.influence[:count, :count] / self.influence[0, 0], self.traction[:count, :count] / self.traction[0, 0])
            right = np.where(stuck, (self.before[:count] + moved) / self.influence[0, 0], slips * limit / self.traction[0, 0])
            parts = np.linalg.solve(rows, right)
            traction, now = self.traction[:count, :count] @ parts, self.influence[:, :count] @ parts - moved
            change = now[:count] - self.before[:count]
            begins = stuck & (np.abs(traction) > limit * (1 + 1e-9))
            ends = ~stuck & (slips * change > 0)  # the surfaces slip against the traction
            if not (begins | ends).any():
                break
            slips = np.where(begins, np.sign(traction), np.where(ends, 0, slips))
        self.before = now
        return float(parts @ (2 * np.pi / 3 * self.edge[:count]**3))


def rebound(pair, speed, slide, index, steps=200, annuli=30):
    """The velocity of the sphere's surface along that of its partner after an impact of impact `index` of `pair`, with the normal speed
    `speed` and the velocity `slide` before it [m/s]."""
    mass, modulus, radius, shear = (float(getattr(pair, name)[index]) for name in ("reduced_mass", "modulus", "reduced_radius", "shear"))
    deepest = float(pair.largest_overlap(speed)[index])
    contact = Contact(shear, float(pair.friction[index]), np.sqrt(radius * deepest), annuli)
    step = float(pair.duration(speed)[index]) / steps
    overlap, closing, moved, sliding = 0.0, float(speed[index]), 0.0, float(slide[index])
    for _ in range(2 * steps):
        overlap, moved = overlap + step * closing, moved + step * sliding
        if overlap <= 0:
            break
        pressure = 2 * modulus / (np.pi * radius) * np.sqrt(np.maximum(radius * overlap - contact.middle**2, 0))
        closing -= step / mass * 4 / 3 * modulus * np.sqrt(radius) * overlap**1.5
        sliding -= step / mass * 3.5 * contact.force(moved, pressure)
    return sliding
