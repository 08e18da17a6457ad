"""Invariants of stress and strain as in soil mechanics: p, q, and their work-conjugate strains.

Arguments may have leading axes: stresses (.., 3, 3), strains (.., 6).
"""
import numpy as np

from ..results.recording import Floats, Recording


def deformation(strain: Floats) -> Floats:
    """(.., 3, 3): deformation gradient of a strain, upper triangular."""
    gradient = np.zeros((*strain.shape[:-1], 3, 3))
    for axis in range(3):
        gradient[..., axis, axis] = 1 - strain[..., axis]
    gradient[..., 0, 1], gradient[..., 0, 2], gradient[..., 1, 2] = strain[..., 3], strain[..., 4], strain[..., 5]
    return gradient


def mean_stress(stress: Floats) -> Floats:
    """p, one third of the trace [Pa]; compression positive."""
    return np.asarray(np.trace(stress, axis1=-2, axis2=-1) / 3)


def deviatoric_stress(stress: Floats) -> Floats:
    """q = sqrt(3/2 s:s) of the symmetric deviator s: |sigma_1 - sigma_3| if two principal stresses are equal [Pa]."""
    symmetric = (stress + np.swapaxes(stress, -1, -2)) / 2
    deviator = symmetric - mean_stress(stress)[..., None, None] * np.eye(3)
    return np.asarray(np.sqrt(1.5 * (deviator**2).sum((-2, -1))))


def volume_strain(strain: Floats) -> Floats:
    """Decrease of a cell's volume over its initial volume."""
    return np.asarray(1 - np.prod(1 - strain[..., :3], axis=-1))


def deviatoric_strain(strain: Floats) -> Floats:
    """eps_q = sqrt(2/3 e:e) of the logarithmic strain's deviator e.

    2/3 |eps_1 - eps_3| if two principal strains are equal; a small shear over sqrt(3).
    """
    gradient = deformation(strain)
    known = np.isfinite(gradient).all((-2, -1), keepdims=True)
    stretches = np.linalg.eigvalsh(np.where(known, gradient @ np.swapaxes(gradient, -1, -2), np.eye(3)))
    with np.errstate(divide="ignore", invalid="ignore"):
        logarithmic = np.where(known[..., 0], np.log(stretches) / 2, np.nan)
        deviator = logarithmic - logarithmic.mean(-1, keepdims=True)
    return np.asarray(np.sqrt(2 / 3 * (deviator**2).sum(-1)))


def load(recording: Recording) -> Floats:
    """(S,) what the scans are loaded by: the force on the plate [N], of a cell its mean stress [Pa]."""
    return mean_stress(recording.scans.stress) if recording.box.is_cell else recording.scans.top_force


def strongest_scan(recording: Recording) -> int | None:
    """Row of the scan of the largest load; None where no scan has one."""
    loads = np.nan_to_num(load(recording), nan=-np.inf)
    return int(np.argmax(loads)) if (loads > 0).any() else None
