"""Guesses unit, origin, size and upward direction of the tables of grains."""
import numpy as np

from ..number_text import shortest
from ..problems import Problems
from .arrays import Floats
from .grains import GrainFrames, import_grains
from .guess_names import program_of
from .mapping import SIZE_KEYS, UNCLEAR, Guess, Known, MappedTable, guess
from .names import LENGTHS, DOWNWARDS, VOXEL, column_name
from .rows import ImportTable, of_role


# Distance of nearest neighbours over the sum of their radii, beyond which sizes are doubted: soft grains under load overlap.
SQUEEZED, BIASED = 0.75, 1.08


def plain_grains(table: ImportTable) -> GrainFrames:
    """The grains with their raw numbers taken as metres."""
    return import_grains([table.changed(length_unit=guess("m", "stated", ""))], Problems())


def _reach(grains: GrainFrames) -> Floats:
    """The lowest and the highest coordinates in each complete frame [frames][2][3]."""
    radius = grains.diameter[:, None] / 2
    return np.array([[(at - radius).min(axis=0), (at + radius).max(axis=0)] for at in grains.position if len(at) == len(radius)])


def fitting_units(factors: dict[str, float], value: float, scale: float, low: float, high: float) -> list[str]:
    """Units for which `value` in that unit over `scale` is between `low` and `high`."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return [unit for unit, factor in factors.items() if low < abs(value) * factor / abs(np.float64(scale)) < high]


def length_factors(voxel_size: float) -> dict[str, float]:
    return {**LENGTHS, **({VOXEL: voxel_size} if np.isfinite(voxel_size) and voxel_size > 0 else {})}


def decide_unit(mapped: MappedTable, key: str, fits: list[str], seen: str, otherwise: tuple[str, str], certainty: str = "sure") -> None:
    """States the unit that a name tells, or the only one that `fits` the numbers `seen`; `otherwise` a word and the reason why
    it is unclear."""
    named = mapped.get(key)
    if named and named.certainty == UNCLEAR:
        return
    if named and named.word in fits:
        mapped[key] = guess(named.word, "sure", f"{named.why}, and {seen}")
    elif named:
        mapped[key] = guess(named.word, UNCLEAR, f"{named.why}, but {seen}")
    elif len(fits) == 1:
        mapped[key] = guess(fits[0], certainty, seen)
    else:
        mapped[key] = guess(otherwise[0], UNCLEAR, otherwise[1])


def nearest_over_radii(position: Floats, diameter: Floats) -> float:
    """Median over grains of the smallest ratio of the distance to a neighbour to the sum of the radii: about 1 in a
    dense packing."""
    position, diameter = position[:2000], diameter[:2000]
    if len(position) < 3:
        return np.nan
    few = min(len(position), 200)
    distance = np.linalg.norm(position[:few, None] - position[None], axis=2)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        ratio = 2 * distance / (diameter[:few, None] + diameter[None])
    ratio[np.arange(few), np.arange(few)] = np.inf
    return float(np.median(ratio.min(axis=1)))


def _guess_size(table: ImportTable) -> None:
    """Distinguishes radii and diameters: with the wrong one, distances between neighbours are wrong by a factor of two. Proposes
    a diameter if there is no column for the size."""
    mapped, key = table.map, next((key for key in SIZE_KEYS if key in table.map), "")
    grains = plain_grains(table if key else table.changed(same_diameter=guess("1", "stated", "")))
    ratio = nearest_over_radii(grains.position[0], grains.diameter) if grains.keys else np.nan
    low, high, other = {"radius": (0.35, 0.6, "diameter"), "diameter": (1.65, 2.6, "radius")}.get(key, (0, 0, ""))
    if not key:
        why = "trackpy's size is the radius of gyration of the brightness, not a radius" if program_of(table.parts[0].columns) == "trackpy" \
            else "no column has a size"
        mapped["same_diameter"] = guess(f"{ratio:.4g}" if ratio > 0 else "1", UNCLEAR, why + "; the nearest neighbours are so far apart: are all "
                                        "grains of one size? If not, add a column with diameters or radii to the table")
    elif low < ratio < high:
        mapped[key] = guess(mapped.word(key), UNCLEAR, f"but then the nearest neighbours are {ratio:.2f} times the sum of their radii apart: is it "
                            f"the {other}? Then write {other} in place of {key}")
    elif SQUEEZED < ratio < BIASED:
        mapped[key].why += f"; neighbours touch ({ratio:.2f} of the sum of radii)"
    elif ratio > 0:
        mapped["size_factor"] = guess(f"{ratio:.3g}", UNCLEAR, f"nearest neighbours are {ratio:.3g} times the sum of their radii apart: image "
                                      "analysis puts surfaces too far in or out. With this factor grains touch; 1 if they do not")


def _guess_unit_by_box(mapped: MappedTable, width: float, depth: float, known: Known) -> None:
    (box_x, box_y), factors = known.box, length_factors(known.voxel_size)
    likely = "mm" if width > 0.5 else "m"
    if box_x <= 0:
        unknown = guess(likely, UNCLEAR, "no name says it, and the box is not known: --set box.size=[..] would tell")
        mapped.entries.setdefault("length_unit", unknown)
    elif mapped.word("length_unit", "m") in factors:
        fits = [unit for unit in fitting_units(factors, width, box_x, 0.55, 1.15) if 0.55 < depth * factors[unit] / box_y < 1.15]
        spans = f"the packing is {width:.4g} by {depth:.4g} wide, the box {box_x:g} by {box_y:g} m"
        number = "several units make" if fits else "no unit makes"
        decide_unit(mapped, "length_unit", fits, spans, (likely, f"{number} the packing fit the box: {spans}"))


def state_voxel_size(mapped: MappedTable, known: Known, width: float = 0) -> None:
    """Voxel size of a table in voxels: as stated, otherwise the one with which a packing of this `width` fills the box."""
    if mapped.word("length_unit") != VOXEL:
        return
    if known.voxel_size > 0:
        mapped["voxel_size"] = guess(shortest(known.voxel_size), "sure", "--voxel-size says so")
    else:
        fills = known.box[0] > 0 and width > 0
        mapped["voxel_size"] = guess(f"{known.box[0] / width:.4g}" if fills else "1", UNCLEAR, "--voxel-size would tell"
                                     + (f"; with this one the packing, {width:.4g} voxels wide, fills the box" if fills else ""))


def _guess_origin(mapped: MappedTable, low: Floats, high: Floats, grains: GrainFrames, box: tuple[float, float]) -> None:
    unit, margin = mapped.length_factor(), 0.12 * float(np.median(grains.diameter))  # soft grains overlap walls
    for axis, size in enumerate([*np.divide(box, unit), np.inf] if box[0] > 0 else ()):
        begin, end = low[axis], high[axis]
        word, certainty, why = 0, UNCLEAR, f"grains reach from {begin:.4g} to {end:.4g}"
        if axis == 2 and abs(begin) > margin:
            word = begin
            why += ", and nothing is at 0: do they lie on the floor, as of an image with a margin below it? Then this is right; 0 if they do not"
        elif begin >= -margin and end <= size + margin:
            certainty = "sure"
        else:
            middle = (begin + end) / 2
            word, why = (0 if abs(middle) < margin else middle) - size / 2, f"{why}, the box is {size:.4g} wide"
        mapped["origin_" + "xyz"[axis]] = guess(f"{grains.sign[axis] * word + 0:.6g}", certainty, why)


def guess_grain_lengths(table: ImportTable, known: Known) -> None:
    mapped, grains = table.map, plain_grains(table)
    if not grains.keys:
        return
    low, high = _reach(grains)[0]
    width, depth, _ = high - low
    _guess_unit_by_box(mapped, width, depth, known)
    state_voxel_size(mapped, known, width)
    _guess_origin(mapped, low, high, grains, known.box)


def _end_that_moves(ends: Floats, diameter: float) -> str:
    """The end that moves towards the other one between the highest and the lowest frame; it is the one with the plate."""
    heights = ends[:, 1] - ends[:, 0]
    compression = np.ptp(heights)
    if not compression > 0.1 * diameter:  # smaller changes may be noise
        return "none"
    at_low = (ends[np.argmin(heights), 0] - ends[np.argmax(heights), 0]) / compression
    return "lower" if at_low > 0.8 else "upper" if at_low < 0.2 else "both"


def _upwards(now: Guess, ends: Floats, diameter: float) -> Guess:
    """The entry for z, not reversed so far, with its direction from the ends of the packing and the column's name."""
    end, margin, (low, high) = _end_that_moves(ends, diameter), 0.12 * diameter, ends[0]
    down, reach = "-" + now.word, f"grains reach from {low:.4g} to {high:.4g}"
    named = column_name(now.word).base in DOWNWARDS.split()
    rules = [  # the first one that applies is used
        (named and end in ("upper", "both"), down, UNCLEAR,
         "its name says downwards, but the packing moves at its upper end: remove the - if z is upwards"),
        (named, down, "sure", "its name says downwards"),
        (end == "lower" and abs(high) < margin, down, "sure", f"{reach}, and the packing moves at its lower end: z is downwards"),
        (end == "lower", down, UNCLEAR, f"{reach}, and the packing moves at its lower end: is z downwards? If not, remove the -"),
        (end == "both", now.word, UNCLEAR, "the packing moves at both ends: is z upwards, and does the floor stand still?"),
        (end == "none" and high < margin and low < -margin, down, UNCLEAR, f"{reach}: is z downwards? If not, remove the -"),
        (end == "upper", now.word, now.certainty, f"{now.why}; upwards, because the packing moves at its upper end"),
        (True, now.word, now.certainty, now.why)]
    return next(guess(*rule) for applies, *rule in rules if applies)


def guess_grains_upwards(tables: list[ImportTable]) -> None:
    """Reverses z if that is certain; marks it as unclear if it is possible."""
    single = []  # z of the tables of one frame, which do not tell its direction
    for table in of_role(tables, "grains"):
        _guess_size(table)
        grains = plain_grains(table)
        if grains.keys and len(table.map["z"].words) == 1:
            table.map["z"] = _upwards(table.map["z"], _reach(grains)[:, :, 2], float(np.median(grains.diameter)))
        if len(grains.keys) == 1:
            single.append(table.map["z"])
    if any(table.map.word("z").startswith("-") for table in of_role(tables, "grains")):
        for z in single:
            if not z.word.startswith("-"):
                z.certainty, z.why = UNCLEAR, "it is downwards in another table: write a - before its name if it is here too"
