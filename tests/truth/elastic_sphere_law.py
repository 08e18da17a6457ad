"""The contact model elastic_sphere: overlaps from the forces on one sphere, with radius and E equal to 1.

Sums are explained in host/elasticity/elastic_sphere_series.h."""
import numpy as np

from sphere_modes import compliance, legendre

TERMS = 1200
SMALLEST_SINE, LARGEST_RADIUS = .15, .64


def pair_displacements(poisson_ratio, sines):
    """Outward displacement at s = sin(theta/2) by a unit point force, and the factor of the spread of finite
    contacts."""
    modes = compliance(poisson_ratio, TERMS)
    n = np.arange(TERMS + 1.)
    factor = (-(2 * n + 1) / (4 * np.pi) * np.exp(-36 * (n / TERMS)**8))[:, None] * legendre(TERMS, 1 - 2 * sines**2)
    radial, coupling = modes[:, 0, 0], modes[:, 0, 1]
    return radial @ factor, (coupling / 2 - (.5 + n * (n + 1) / 4) * radial) @ factor


def self_displacement(poisson_ratio, a):
    """Outward displacement beyond Hertz of a contact of radius a by its own unit force."""
    x, weight = np.polynomial.legendre.leggauss(300)
    y, punch = x[x > 0], weight[x > 0]
    r2 = a * a * (1 - y**2)
    cosine = np.sqrt(1 - r2)
    orders = max(400, int(120 / a))
    modes, n = compliance(poisson_ratio, orders), np.arange(orders + 1.)
    count = n * (n + 1)
    P = legendre(orders, cosine)
    slope = np.vstack([np.zeros_like(cosine), n[1:, None] * (cosine * P[1:] - P[:-1])])
    moments = [(-(P * cosine) @ w, slope @ w / np.maximum(count, 1)) for w in (3 * y**2 * punch, punch)]
    (source_r, source_m), (receiver_r, receiver_m) = moments
    terms = receiver_r * (modes[:, 0, 0] * source_r + modes[:, 0, 1] * source_m)
    terms += receiver_m * (modes[:, 0, 1] * source_r + count * modes[:, 1, 1] * source_m)
    gap = -((r2**2 / 2 / (1 + np.sqrt(1 - r2))**2) @ punch) / (4 / 3 * a**3 / (1 - poisson_ratio**2))
    return -((2 * n + 1) / (4 * np.pi) * terms).sum() + (1 - poisson_ratio**2) / (2 * a) + gap


class SelfTerm:
    """S0 + S1 ln a + S2 a + S3 a^2 + S4 a^3, as in the model."""

    def __init__(self, poisson_ratio):
        a = np.array([.05, .08, .12, .17, .22, .28, .34, .40, .46, .52, .58, .64])
        self.slope = (1 + poisson_ratio) * (1 - 2 * poisson_ratio)**2 / (2 * np.pi)
        value = [self_displacement(poisson_ratio, x) - self.slope * np.log(x) for x in a]
        self.powers = np.polynomial.polynomial.polyfit(a, value, 3)

    def __call__(self, a):
        a = np.clip(a, 1e-3, LARGEST_RADIUS)
        return np.polynomial.polynomial.polyval(a, self.powers) + self.slope * np.log(a)


class Law:
    """Overlaps of contacts in the directions `normals`."""

    def __init__(self, poisson_ratio, normals, self_term):
        self.poisson_ratio = poisson_ratio
        self.uniform = (1 - 2 * poisson_ratio) / (4 * np.pi)  # inward displacement of all points by a unit force, besides shear
        self.modulus = 4 / 3 / (1 - poisson_ratio**2)
        self.self_term = self_term
        others = ~np.eye(len(normals), dtype=bool)
        sines = np.maximum(np.sqrt(np.maximum(.5 - .5 * normals @ normals.T, 0)), SMALLEST_SINE)
        known, place = np.unique(np.round(sines[others], 9), return_inverse=True)
        self.point, self.size = np.zeros(sines.shape), np.zeros(sines.shape)
        for matrix, value in zip((self.point, self.size), pair_displacements(poisson_ratio, known)):
            matrix[others] = value[place]

    def radius(self, force):
        return (force / self.modulus)**(1 / 3)

    def own(self, force):
        """Displacement by each contact's own force."""
        a = self.radius(force)
        return a**2 - force * self.self_term(a)

    def by_others(self, force):
        """Displacement by the other forces, and the energy of which it is the derivative."""
        a2 = self.radius(force)**2
        points = -self.point @ force
        sizes = -(2 / 5 * self.size @ (force * a2) + 2 / 3 * a2 * (self.size @ force))
        return points + sizes, force @ points / 2 + 3 / 8 * force @ sizes
