"""Links the grains of successive frames by their places, where labels count anew in each of them."""
from typing import NamedTuple

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.sparse import coo_matrix
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from .arrays import Floats, Ints

REACH = 0.5  # of the median distance to the nearest neighbour: a grain is not looked for farther from where it is expected
NEIGHBOURS = 8  # whose displacement tells where a grain is expected
LOST = -1


class Links(NamedTuple):
    """Of each grain before: its row now, or LOST; and where it is: if it is lost, where its neighbours' displacement puts it."""

    row: Ints
    position: Floats


def spacing(position: Floats) -> float:
    """Median distance to the nearest neighbour."""
    return float(np.median(cKDTree(position).query(position, 2)[0][:, 1])) if len(position) > 1 else np.inf


def _assigned(expected: Floats, now: Floats, reach: float) -> Ints:
    """The row now of each expected place: the assignment with the least sum of squared distances, within the reach, as many as possible."""
    pairs = cKDTree(expected).sparse_distance_matrix(cKDTree(now), reach, output_type="coo_matrix")
    row, count = np.full(len(expected), LOST), len(expected)
    links = coo_matrix((np.ones(pairs.nnz), (pairs.row, count + pairs.col)), shape=2 * (count + len(now),))
    group = connected_components(links, directed=False)[1][pairs.row]
    order = np.argsort(group, kind="stable")
    for part in np.split(order, np.flatnonzero(np.diff(group[order])) + 1) if len(order) else ():
        left, i = np.unique(pairs.row[part], return_inverse=True)
        right, j = np.unique(pairs.col[part], return_inverse=True)
        cost = np.full((len(left), len(right)), len(part) * 4 * reach**2)
        cost[i, j] = pairs.data[part] ** 2
        chosen = np.column_stack(linear_sum_assignment(cost))
        chosen = chosen[cost[tuple(chosen.T)] <= reach**2]
        row[left[chosen[:, 0]]] = right[chosen[:, 1]]
    return row


def _smoothed(before: Floats, now: Floats, row: Ints) -> Floats:
    """The places where the median displacement of linked neighbours puts the grains."""
    found = np.flatnonzero(row != LOST)
    if not len(found):
        return before
    _, near = cKDTree(before[found]).query(before, min(NEIGHBOURS, len(found)))
    moved = now[row[found]] - before[found]
    return np.asarray(before + np.median(moved[near.reshape(len(before), -1)], axis=1))


def _stretched(before: Floats, now: Floats) -> Floats:
    """The places that the ends of the packing make expect."""
    (low, high), (low_now, high_now) = (np.percentile(at, (2, 98), axis=0) for at in (before, now))
    size = np.where(high > low, high - low, 1)
    return np.where(high > low, low_now + (before - low) * (high_now - low_now) / size, before)


def same_labels(labels: Ints, before: Floats, labels_now: Ints, now: Floats) -> float:
    """The part of the grains that both frames name alike which are near the place where they are expected."""
    _, at, at_now = np.intersect1d(labels, labels_now, return_indices=True)
    if not len(at):
        return 0.0
    off = np.linalg.norm(now[at_now] - _stretched(before, now)[at], axis=1)
    return float(np.mean(off <= 2 * REACH * spacing(before)))


def link(before: Floats, now: Floats) -> Links:
    """Centres [grains][3] and [labels][3] in any unit. The ends of the packing tell first where grains are expected, then their neighbours."""
    reach, expected = REACH * spacing(before), _stretched(before, now)
    for _ in range(2):
        expected = _smoothed(before, now, _assigned(expected, now, reach))
    row = _assigned(expected, now, reach)
    position = expected
    position[row != LOST] = now[row[row != LOST]]
    return Links(row, position)
