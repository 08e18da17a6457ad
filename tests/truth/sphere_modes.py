"""Surface modes of a free elastic sphere: surface displacements by tractions of each Legendre order.

Units: radius 1, Young's modulus 1. Tractions t_r P_n (radial) and t_t dP_n/dtheta (meridional) give displacements
U P_n and V dP_n/dtheta, (U, V) = C_n (t_r, t_t). A resultant force (n = 1) is balanced by a uniform body force.
"""
import numpy as np


def compliance(poisson_ratio, orders):
    """C_n for n = 0 .. orders, shape (orders + 1, 2, 2).

    The modes are u = grad(phi) and u = r^2 grad(phi) + alpha x phi with phi = r^n P_n. Tractions are in units of the
    shear modulus; lambda/mu = 2 nu / k with k = 1 - 2 nu is multiplied by k, so that nothing is singular at nu = 1/2.
    """
    nu, k = poisson_ratio, 1 - 2 * poisson_ratio
    n = np.arange(2.0, orders + 1)
    one = np.ones_like(n)
    denominator = (n + 3) * 2 * nu + (n + 5) * k
    alpha = -2 * (n * 2 * nu + (3 * n + 1) * k) / denominator
    lambda_divergence = 2 * nu * (2 * n * (n + 5) - 2 * (n + 3) * (3 * n + 1)) / denominator
    displacement = np.array([[n, n + alpha], [one, one]])
    traction = np.array([[2 * n * (n - 1), lambda_divergence + 2 * (n + 1) * (n + alpha)],
                         [2 * (n - 1), 2 * n + alpha]])
    traction /= 2 * (1 + nu)
    result = np.zeros((orders + 1, 2, 2))
    result[0, 0, 0] = k
    # Fields r^2 grad(z) and x z, minus the rigid translation that would violate reciprocity.
    result[1] = [[k / 2, 2 * nu - 0.5], [nu - 0.25, 2]]
    result[2:] = displacement.transpose(2, 0, 1) @ np.linalg.inv(traction.transpose(2, 0, 1))
    return result


def toroidal_compliance(poisson_ratio, orders):
    """Displacement over traction of the twisting modes r x grad(Y_n); rigid rotations (n = 1) are excluded."""
    n = np.arange(orders + 1.0)
    result = np.zeros(orders + 1)
    result[2:] = 2 * (1 + poisson_ratio) / (n[2:] - 1)
    return result


def legendre(orders, x):
    """P_n(x), n = 0 .. orders along the first axis."""
    x = np.asarray(x, float)
    result = np.empty((orders + 1,) + x.shape)
    result[0], result[1] = 1, x
    for n in range(1, orders):
        result[n + 1] = ((2 * n + 1) * x * result[n] - n * result[n - 1]) / (n + 1)
    return result


def associated_legendre(orders, m, x):
    """P_n^m, with e^(i m phi) orthonormal over the sphere, and sin(theta) dP_n^m/dtheta."""
    value = np.zeros((orders + 1, x.size))
    sine = np.sqrt(1 - x * x)
    first = np.full(x.size, np.sqrt(1 / (4 * np.pi)))
    for k in range(1, m + 1):
        first = -np.sqrt((2 * k + 1) / (2 * k)) * sine * first
    value[m] = first
    if m < orders:
        value[m + 1] = np.sqrt(2 * m + 3) * x * first
    for n in range(m + 2, orders + 1):
        a = np.sqrt((4 * n * n - 1) / (n * n - m * m))
        b = np.sqrt(((n - 1) ** 2 - m * m) / (4 * (n - 1) ** 2 - 1))
        value[n] = a * (x * value[n - 1] - b * value[n - 2])
    slope = np.zeros_like(value)
    for n in range(max(m, 1), orders + 1):
        slope[n] = n * x * value[n] - np.sqrt((n * n - m * m) * (2 * n + 1) / (2 * n - 1)) * value[n - 1]
    return value, slope
