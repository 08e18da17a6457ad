"""Observables of grains alone, where no contact forces were measured: who touches, overlaps, the forces that Hertz's law gives them, local packing
fractions and motion. The contacts of these scans are those of touching.py."""
import numpy as np

from ..experiment.container import apart, floor_area, lengths
from ..results.names import Wall
from ..results.recording import Bools, Floats
from .force_observables import wall_loads
from .observables import observed
from .position_observables import affine_map, fabric, net_over_sum, section_load
from .seen_scans import SeenScans
from .touching import near_grains

NEIGHBOURS = 1.25  # grains nearer than this, over the sum of their radii, are neighbours: between the first two shells of a dense packing
FEWEST_NEIGHBOURS = 5  # of a grain whose local motion is determined: an affine map has three per direction


@observed("grains",
          ("hertz_floor", 0.005, "floor", "", "Hertz's force of the overlaps at the floor over the force on the plate"),
          ("hertz_sides", 0.005, "sides", "", "a quarter of Hertz's forces of the overlaps at the sides over the force on the plate"),
          ("hertz_plate", 0.005, "plate", "", "Hertz's force of the overlaps at the plate over the plate's reading"),
          ("hertz_couple_x", 0.002, "plate", "", "centre of Hertz's load of the overlaps at the plate along x, over half the box"),
          ("hertz_couple_y", 0.002, "plate", "", "centre of Hertz's load of the overlaps at the plate along y, over half the box"))
def hertz_walls(seen: SeenScans) -> tuple[Floats, ...]:
    return wall_loads(seen)


@observed("grains",
          ("hertz_sections", 0.005, "", "", "vertical Hertz's force of the overlaps through horizontal sections over the plate's reading"),
          ("hertz_anisotropy", 0.002, "", "", "vertical share of Hertz's forces of the overlaps, minus one third"),
          ("hertz_gradient", 0.01, "", "", "change of the mean Hertz's force of the overlaps with depth, over the height"),
          ("hertz_imbalance", 0.005, "", "", "sum over grains of the net Hertz's force of the overlaps, over the sum of these forces"))
def hertz_loads(seen: SeenScans) -> tuple[Floats, ...]:
    # Of the imbalance: tangential forces balance the rest, and errors of the overlaps add to it.
    return section_load(seen), *fabric(seen), net_over_sum(seen, seen.force, -1)


@observed("grains",
          ("touching", 0.01, "grains", "", "touching neighbours per grain, listed ones if the experiment lists them"),
          ("mean_overlap", 0.0002, "grains", "", "mean overlap of touching grains over their mean diameter"),
          ("overlap_spread", 0.005, "grains", "", "standard deviation of the overlaps of touching grains over their mean"),
          ("side_overlap", 0.0002, "sides", "", "mean overlap at the sides over the mean diameter"),
          ("floor_overlap", 0.0002, "floor", "", "mean overlap at the floor over the mean diameter"),
          ("plate_overlap", 0.0002, "plate", "", "mean overlap at the plate over the mean diameter"))
def overlaps(seen: SeenScans) -> tuple[Floats, ...]:
    grains, diameter = ~seen.is_wall, float(seen.diameter.mean())
    overlap = seen.overlap / diameter
    mean = seen.mean(overlap, grains)
    variance = seen.mean(overlap * overlap, grains) - mean * mean

    def at(where: Bools) -> Floats:
        return seen.mean(overlap, where)

    return (2 * seen.count(grains) / len(seen.diameter), mean, np.sqrt(np.maximum(variance, 0)) / mean, at(seen.at_sides),
            at(seen.at(Wall.floor)), at(seen.at(Wall.plate)))


@observed("grains",
          ("fraction_low", 0.0005, "", "", "packing fraction of the lowest third of the height below the plate"),
          ("fraction_middle", 0.0005, "", "", "packing fraction of the middle third"),
          ("fraction_high", 0.0005, "", "", "packing fraction of the highest third"))
def local_fractions(seen: SeenScans) -> tuple[Floats, ...]:
    """Of whole spheres: where they overlap, the volume counts twice."""
    radius, z, height = 0.5 * seen.diameter, seen.position[:, :, 2], seen.plate_z[:, np.newaxis]

    def below(plane: Floats) -> Floats:
        """(S,) volume of the spheres below a plane: that of a spherical cap of each."""
        cap = np.clip(plane - z + radius, 0, 2 * radius)
        volume: Floats = (np.pi * cap**2 * (3 * radius - cap) / 3).sum(axis=1)
        return volume

    levels = [below(np.full_like(height, -np.inf)), below(height / 3), below(2 * height / 3), below(np.full_like(height, np.inf))]
    third = floor_area(seen.box) * seen.plate_z / 3
    low, middle, high = ((above - under) / third for under, above in zip(levels, levels[1:]))
    return low, middle, high


@observed("grains",
          ("affine_compression", 0.002, "", "", "vertical compression of the affine motion of grains since the first scan, over the plate's"),
          ("affine_rest", 0.001, "", "", "motion of grains since the first scan that is not affine, over the mean diameter"),
          ("local_rest", 0.001, "", "", "motion of neighbours since the first scan that no affine map of each grain's surroundings gives, over the "
           "mean diameter"),
          ("lost_neighbours", 0.003, "grains", "", "fraction of the neighbours of the first scan that are none any more"))
def motion(seen: SeenScans) -> tuple[Floats, ...]:
    before = seen.recording.scans.position[0]
    if before.shape != seen.position.shape[1:]:
        return (np.full(len(seen), np.nan),) * 4
    slope, left = affine_map(seen, before)
    plate = 1 - seen.plate_z / seen.recording.plate_start
    diameter = float(seen.diameter.mean())
    local, lost = _of_neighbours(seen, before)
    return (-slope[:, 2, 2] / np.where(plate > 0, plate, np.nan), np.sqrt((left**2).sum(axis=2).mean(axis=1)) / diameter, local / diameter, lost)


def _of_neighbours(seen: SeenScans, before: Floats) -> tuple[Floats, Floats]:
    """(S,) root mean square of the relative positions of neighbours minus the best linear map of those of the first scan, for each grain with
    its own map (D2_min of Falk & Langer 1998) [m]; and the fraction of the neighbours of the first scan that are farther apart now."""
    box, radius, count = seen.box, 0.5 * seen.diameter, len(seen.diameter)
    _, i, j = near_grains(box, before[np.newaxis], NEIGHBOURS * float(seen.diameter.max()))
    first = apart(box, before[i], before[j])
    near = lengths(first) < NEIGHBOURS * (radius[i] + radius[j])
    i, j, first = i[near], j[near], first[near]
    owner, both = np.concatenate([i, j]), np.concatenate([first, -first])  # of each neighbour

    def summed(a: Floats, b: Floats) -> Floats:
        """(N, 3, 3) sums of a b over the neighbours of each grain."""
        products = np.einsum("pa,pb->pab", a, b).reshape(-1, 9)
        sums: Floats = np.array([np.bincount(owner, column, count) for column in products.T]).T.reshape(-1, 3, 3)
        return sums

    number = np.bincount(owner, minlength=count)
    shape = summed(both, both)
    known = (number >= FEWEST_NEIGHBOURS) & (np.linalg.cond(shape) < 1e6)  # neighbours in one plane determine no map
    inverse = np.linalg.inv(shape[known])
    local, lost = np.full(len(seen), np.nan), np.full(len(seen), np.nan)
    for scan, position in enumerate(seen.position):
        way = apart(box, position[i], position[j])
        now = np.concatenate([way, -way])
        cross = summed(now, both)[known]
        rest = np.bincount(owner, (now**2).sum(axis=1), count)[known] - np.einsum("nab,nbc,nac->n", cross, inverse, cross)
        local[scan] = np.sqrt(np.maximum(rest, 0).sum() / number[known].sum())
        lost[scan] = np.mean(lengths(way) >= NEIGHBOURS * (radius[i] + radius[j]))
    return local, lost
