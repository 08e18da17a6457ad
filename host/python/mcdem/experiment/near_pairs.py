"""Pairs of neighbouring grains, found with a cell list (host/core/near_pairs.h)."""
import math
from collections.abc import Iterator

import numpy as np

from ..results.recording import Box, Floats, Ints
from .container import into_cell

# Half of the 26 neighbours of a cell after the cell itself, so that each pair of cells is visited once.
STEPS = np.array([(0, 0, 0), (1, 0, 0), (-1, 1, 0), (0, 1, 0), (1, 1, 0), (-1, -1, 1), (0, -1, 1), (1, -1, 1), (-1, 0, 1), (0, 0, 1),
                  (1, 0, 1), (-1, 1, 1), (0, 1, 1), (1, 1, 1)])
PAIRS_AT_ONCE = 1_000_000


def _cells_along(size: Floats, grains: int, edge: float, periodic: bool) -> Ints:
    """(3,) numbers of cells along x, y and z; cells are larger than `edge` if they would far outnumber the grains."""
    enough = 8 * grains + 64
    cells = np.clip(size / max(edge, math.cbrt(size.prod() / enough)), 1, 1e9).astype(np.int64)
    while float(cells[0]) * cells[1] * cells[2] > 16 * enough:  # the box is flatter or thinner than `edge`
        cells[cells.argmax()] //= 2
    if periodic:  # with fewer than three cells along an axis, pairs of cells would be visited twice
        cells[:2][cells[:2] < 3] = 1
    return cells


def _pairs_of_cells(cells: Ints, periodic: bool) -> tuple[Ints, Ints]:
    """Each cell with itself and with the adjacent ones after it."""
    here = np.stack(np.unravel_index(np.arange(cells.prod()), cells[::-1]), axis=1)[:, ::-1]  # x runs fastest
    there = here[:, None] + STEPS
    past = (there < 0) | (there >= cells)
    repeats = np.array([periodic, periodic, False]) & (cells > 1)
    valid = ~(past & ~repeats).any(axis=2)
    there %= cells
    number = (there[..., 2] * cells[1] + there[..., 1]) * cells[0] + there[..., 0]
    return np.repeat(np.arange(len(here)), valid.sum(axis=1)), number[valid]


def near_pairs(position: Floats, box: Box, height: float, edge: float) -> Iterator[tuple[Ints, Ints]]:
    """Blocks of pairs of grains with all those that are closer than `edge` [m]; the cells extend up to `height` [m]."""
    size = np.array([box.size_x, box.size_y, height])
    cells = _cells_along(size, len(position), edge, box.is_periodic)
    of_grain = np.clip(into_cell(box, position) / (size / cells), 0, cells - 1).astype(np.int64)
    number = (of_grain[:, 2] * cells[1] + of_grain[:, 1]) * cells[0] + of_grain[:, 0]
    grain = np.argsort(number, kind="stable")
    count = np.bincount(number, minlength=int(cells.prod()))
    first = count.cumsum() - count
    here, there = _pairs_of_cells(cells, box.is_periodic)
    end = (count[here] * count[there]).cumsum()
    for start in range(0, int(end[-1]), PAIRS_AT_ONCE):
        pair = np.arange(start, min(start + PAIRS_AT_ONCE, int(end[-1])))
        k = np.searchsorted(end, pair, side="right")
        pair -= end[k] - count[here[k]] * count[there[k]]
        a, b = first[here[k]] + pair // count[there[k]], first[there[k]] + pair % count[there[k]]
        new = (here[k] != there[k]) | (a < b)
        yield grain[a[new]], grain[b[new]]
