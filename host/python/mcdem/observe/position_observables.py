"""Observables of contact forces and positions: load through sections, directions, gradients, displacements, friction."""
import numpy as np

from ..experiment.container import apart, lengths
from ..results.names import Wall
from ..results.recording import Bools, Floats
from .observables import observed
from .seen_scans import SeenScans


@observed("positions", ("section_load", 0.002, "", "", "vertical force through horizontal sections, what the side walls carry above them added, "
                        "over the plate's reading"))
def section_load(seen: SeenScans) -> Floats:
    """Mean vertical force over all horizontal sections, over the plate's force: at rest it is 1 (minus the weight above), whatever the
    material. A force f on a grain at z from a neighbour at z' acts in all sections between them and contributes f (z - z') / height. Forces of
    the floor and side walls act below the grain, those of the plate above it."""
    grains = ~seen.is_wall
    source = np.where(seen.at(Wall.plate), seen.plate_z[seen.scan], 0.0)
    source[grains] = seen.position[seen.scan[grains], seen.partner[grains], 2]
    moment = seen.sum(seen.force[:, 2] * (seen.centre[:, 2] - source))
    load: Floats = moment / (seen.plate_z * np.where(seen.top_force > 0, seen.top_force, np.nan))
    return load


@observed("positions",
          ("force_anisotropy", 0.001, "", "", "vertical share of normal forces, minus one third"),
          ("vertical_gradient", 0.01, "", "", "change of the mean contact force with depth, over the height"))
def fabric(seen: SeenScans) -> tuple[Floats, Floats]:
    contacts, grains = seen.residuals, ~seen.is_wall
    vertical = seen.sum(contacts.normal_force * contacts.normal[:, 2] ** 2)
    height = seen.centre[:, 2] + 0.5 * seen.diameter[seen.grain] * contacts.normal[:, 2]
    force = contacts.normal_force
    mean_height, mean_force = seen.mean(height, grains), seen.mean(force, grains)
    off: Floats = height - mean_height[seen.scan]
    spread = seen.sum(off * off, grains)
    slope = seen.sum(off * (force - mean_force[seen.scan]), grains) / np.where(spread > 0, spread, np.nan)
    return vertical / seen.sum(force) - 1 / 3, -slope * seen.plate_z / mean_force


@observed("positions", ("non_affine", 0.001, "", "", "non-affine displacement since the first scan, over the mean diameter"))
def non_affine(seen: SeenScans) -> Floats:
    """Root mean square of the displacements since the first scan minus their best affine map, over the mean diameter."""
    before = seen.recording.scans.position[0]
    if before.shape != seen.position.shape[1:] or not np.isfinite(before).all() or not np.isfinite(seen.position).all():
        return np.full(len(seen), np.nan)
    root: Floats = np.sqrt((affine_map(seen, before)[1]**2).sum(axis=(1, 2)) / len(before))
    return root / float(seen.diameter.mean())


def affine_map(seen: SeenScans, before: Floats) -> tuple[Floats, Floats]:
    """The best affine map of the displacements of all grains since they were at `before` (N, 3): their gradients (S, 3, 3), the last axis that of
    the position; and the displacements minus the map (S, N, 3) [m]."""
    grains, box = len(before), seen.box
    moved = apart(box, np.broadcast_to(before, seen.position.shape).reshape(-1, 3), seen.position.reshape(-1, 3))
    moved = moved.reshape(len(seen), grains, 3).transpose(1, 0, 2).reshape(grains, -1)
    columns = np.column_stack([before, np.ones(grains)])
    found = np.linalg.lstsq(columns, moved, rcond=None)[0]
    left = (moved - columns @ found).reshape(grains, len(seen), 3)
    return found[:3].reshape(3, len(seen), 3).transpose(1, 2, 0), left.transpose(1, 0, 2)


@observed("positions", ("attraction", 0.001, "", "weak", "fraction of the contacts that pull"))
def attraction(seen: SeenScans) -> Floats:
    return seen.mean((seen.residuals.normal_force < 0).astype(float))


def _ratios(seen: SeenScans, where: Bools) -> tuple[Floats, Bools]:
    """Tangential over normal force of contacts, and those of `where` whose normal force is not weak: weak contacts between hardly overlapping
    grains have the least accurate directions."""
    contacts = seen.residuals
    clear = contacts.normal_force > 0.3 * seen.mean(contacts.normal_force)[seen.scan]
    return contacts.tangential / np.where(clear, contacts.normal_force, 1), where & clear


@observed("positions",
          ("friction_ratio", 0.0003, "grains", "", "mean ratio of tangential to normal force between grains"),
          ("friction_high", 0.0003, "grains", "", "80 % quantile of this ratio between grains"),
          ("friction_sliding", 0.01, "grains", "",
           "fraction of the contacts between grains where this ratio is within 20 % of the stated friction"))
def friction(seen: SeenScans) -> tuple[Floats, ...]:
    ratio, where = _ratios(seen, ~seen.is_wall)
    mu = np.full(len(seen), seen.material.friction)
    sliding = seen.fraction(ratio, 0.8 * mu, 1.2 * mu, where) if seen.material.friction > 0 else np.full(len(seen), np.nan)
    return seen.mean(ratio, where), seen.quantile(ratio, 0.8, where), sliding


@observed("positions",
          ("wall_friction_ratio", 0.0003, "walls", "", "mean ratio of tangential to normal force at walls"),
          ("wall_friction_high", 0.0003, "walls", "", "80 % quantile of this ratio at walls"))
def wall_friction(seen: SeenScans) -> tuple[Floats, Floats]:
    ratio, where = _ratios(seen, seen.is_wall)
    return seen.mean(ratio, where), seen.quantile(ratio, 0.8, where)


@observed("positions", ("torque_imbalance", 0.002, "grains", "", "sum over grains of the net torque of the contacts, over the sum of the "
                        "contacts' torques"))
def torque_imbalance(seen: SeenScans) -> Floats:
    """Over the radius of each grain: the torques on a grain at rest cancel. Both grains of a contact have the same one."""
    return net_over_sum(seen, np.cross(seen.residuals.normal, seen.force), 1)


def net_over_sum(seen: SeenScans, vectors: Floats, on_partner: int) -> Floats:
    """(S,) sum over grains of the size of the net vector of their contacts, over the sum of all sizes. `vectors`: (C, 3) on the grain of each
    contact; on its partner it is `on_partner` times that, 1 or -1."""
    grains, shape = ~seen.is_wall, (len(seen), len(seen.diameter))
    owner = np.concatenate([seen.of_grain(seen.grain), seen.of_grain(seen.partner)[grains]])
    both = np.concatenate([vectors, on_partner * vectors[grains]])
    net = np.stack([np.bincount(owner, both[:, axis], shape[0] * shape[1]) for axis in range(3)])
    left = np.sqrt((net**2).sum(axis=0)).reshape(shape).sum(axis=1)
    total = seen.sum(np.where(grains, 2.0, 1.0) * lengths(vectors))
    imbalance: Floats = left / np.where(total > 0, total, np.nan)
    return imbalance
