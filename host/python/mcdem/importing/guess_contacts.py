"""Guesses the meaning of a table of contacts: grains and walls, sides of the forces, units."""
import numpy as np

from .contacts import import_contacts
from .guess_lengths import fitting_units, length_factors, state_voxel_size
from .guess_walls import guess_walls, set_walls, unknown_partners
from .mapping import UNCLEAR, guess, negated
from .names import FORCES, VOXEL
from .problems import Problems

MAX_ROWS = 200_000  # maximum number of rows used for a guess
NEAR = 1.2  # of the sum of radii: touching, including measurement errors
LIKE_NEWTONS = ("gf", "kgf")  # with a modulus wrong by a factor of three
FORCE_FACTORS = {unit: FORCES[unit] for unit in "N mN uN kN gf kgf".split()}  # the others are too similar to these


def hertz_force(known, radius, other, overlap):
    """Hertz force between two grains, or a grain and a rigid wall (radius inf) [N]; NaN if E is unknown."""
    modulus = known.youngs_modulus / (1 - known.poisson_ratio**2) / np.where(np.isinf(other), 1, 2)
    return 4 / 3 * modulus * np.sqrt(1 / (1 / radius + 1 / other)) * np.maximum(overlap, 0) ** 1.5


class _Places:
    """The contacts in frames with known positions of the grains."""

    def __init__(self, table, grains):
        frames = import_contacts(table, grains, Problems(), MAX_ROWS)
        self.all = frames
        at = grains.frames_of(table.map.word("frames_by", "plate"), frames.keys)[frames.frame]
        kept = np.flatnonzero(at >= 0)
        position, radius = np.array(grains.position), grains.diameter / 2
        self.force, self.point, self.partner = frames.force[kept], frames.point[kept], frames.partner[kept]
        self.centre, self.radius = position[at[kept], frames.grain[kept]], radius[frames.grain[kept]]
        self.pair = self.partner >= 0
        other = np.maximum(self.partner, 0)
        self.line, self.other_radius = self.centre - position[at[kept], other], radius[other]

    def touching(self):
        """Fraction of touching pairs, 0 without pairs."""
        distance = np.linalg.norm(self.line, axis=1)[self.pair]
        return float(np.mean(distance < NEAR * (self.radius + self.other_radius)[self.pair])) if len(distance) else 0.0

    def outward(self, box):
        """+1 if forces repel grains as given, -1 if they do after reversal: from pairs, otherwise from nearby walls."""
        with np.errstate(invalid="ignore", divide="ignore"):
            cosine = np.sum(self.force * self.line, axis=1) / (np.linalg.norm(self.force, axis=1) * np.linalg.norm(self.line, axis=1))
        cosine = cosine[self.pair & np.isfinite(cosine)]
        if len(cosine) >= 3:
            return float(cosine.mean())
        axis = np.argmax(np.abs(self.force), axis=1)
        sides = np.flatnonzero(~self.pair & (axis < 2))  # the position of the plate is unknown here
        if not len(sides):
            return 0.0
        low = self.centre[sides, axis[sides]] < np.asarray(box)[axis[sides]] / 2
        return float(np.mean(np.where(low == (self.force[sides, axis[sides]] > 0), 1, -1)))


def _guess_offset(table, grains):
    """The offset of the numbers with which nearly all pairs touch."""
    most, best = -1.0, 0
    for offset in (0, 1, -1, -2, -3, -4, -5, -6):  # Yade may number its walls before its grains
        trial = table.changed(id_offset=guess(str(offset), "stated", ""))
        others = unknown_partners(trial, grains, offset, MAX_ROWS)
        if len(others) > 12:  # there are only few walls
            continue
        set_walls(trial.map, others, grains)
        share = _Places(trial, grains).touching()
        if share > most + 0.05:
            most, best = share, offset
    certainty = "sure" if most > 0.9 else UNCLEAR if most > 0 else "likely"
    why = f"{100 * most:.0f} % of the pairs touch then" if most > 0 else "no pairs to tell it by"
    table.map["id_offset"] = guess(str(best), certainty, why + (": numbers of grains, frames or columns may be others" if certainty == UNCLEAR else ""))
    set_walls(table.map, unknown_partners(table, grains, best), grains)
    if len(table.map.walls) > 6:
        table.map["partner"] = guess(table.map.word("partner"), UNCLEAR, "more than six of its numbers are no grains")


def _guess_force_upwards(table, grains, box):
    """Guesses the sign of fz: forces must be along the lines of centres."""
    fz = table.map["fz"]
    as_it_is, other_way = (abs(_Places(trial, grains).outward(box)) for trial in (table, table.changed(fz=negated(fz))))
    if abs(as_it_is - other_way) < 0.2:
        if grains.sign[2] < 0:
            table.map["fz"] = negated(fz)
            table.map["fz"].certainty, table.map["fz"].why = UNCLEAR, "z of the grains is downwards: are the forces too? If not, remove the -"
    elif other_way > as_it_is:
        table.map["fz"] = negated(fz)
        table.map["fz"].certainty = UNCLEAR if fz.certainty == UNCLEAR else "sure"
        table.map["fz"].why += (f"; the other way, for so forces lie along the lines of centres (mean cosine {other_way:.2f}, else "
                                f"{as_it_is:.2f})")


def _guess_force_on(table, grains, box):
    if not all(key in table.map for key in ("fx", "fy", "fz")):
        return
    _guess_force_upwards(table, grains, box)
    sign = _Places(table, grains).outward(box)
    clear = abs(sign) > 0.5
    table.map["force_on"] = guess("partner" if sign < 0 else "grain", "sure" if clear else UNCLEAR,
                                  "so forces push grains apart" if clear else "forces neither push grains apart nor together")


def _guess_sides(table, frames):
    pairs = np.flatnonzero(frames.partner >= 0)
    listed = list(zip(frames.frame[pairs], frames.grain[pairs], frames.partner[pairs]))
    seen, twice = set(), 0
    for frame, grain, partner in listed:
        twice += (frame, partner, grain) in seen
        seen.add((frame, grain, partner))
    table.map["sides"] = guess("both" if 2 * twice > 0.5 * len(listed) else "one", "sure" if twice == 0 or 2 * twice == len(listed) else "likely",
                               f"{2 * twice} of {len(listed)} pairs are there from either side")


def _point_units(table, grains, voxel_size):
    """Units in which contact points are on the surfaces of their grains."""
    fits = []
    for unit in length_factors(voxel_size):
        size = {"voxel_size": guess(repr(float(voxel_size)), "stated", "")} if unit == VOXEL else {}
        places = _Places(table.changed(length_unit=guess(unit, "stated", ""), **size), grains)
        ratio = np.linalg.norm(places.point - places.centre, axis=1) / places.radius
        if len(ratio) and 0.6 < np.median(ratio) < 1.3:
            fits.append(unit)
    return fits


def _guess_point_unit(table, grains, known, voxel_size):
    """Unit and direction of contact points: z may have the opposite sign of the present guess."""
    mapped = table.map
    if "x" not in mapped or "z" not in mapped:
        return
    named, fits = mapped.get("length_unit"), _point_units(table, grains, voxel_size)
    if not fits:
        other = negated(mapped["z"])
        fits = _point_units(table.changed(z=other), grains, voxel_size)
        if fits:
            mapped["z"] = other
            other.why += "; the other way, for so the points lie on the grains' surfaces"
    one = len(fits) == 1
    if named and (not one or fits[0] == named.word):
        named.why += ", and the points lie on the grains' surfaces" if one else ""
    else:
        word = fits[0] if one and not named else named.word if named else "m"
        mapped["length_unit"] = guess(word, "sure" if one and not named else UNCLEAR, f"in {fits[0]} the points lie on the grains' surfaces"
                                      if one else "in no unit, or in several, do the points lie on the grains' surfaces")
    if voxel_size > 0 and mapped.word("length_unit") == VOXEL and not known.voxel_size > 0:
        mapped["voxel_size"] = guess(repr(float(voxel_size)), "sure", "that of the grains")
    else:
        state_voxel_size(mapped, known)


def _guess_force_unit(table, grains, known):
    mapped = table.map
    if "force_unit" in mapped:
        return
    places = _Places(table.changed(force_unit=guess("N", "stated", "")), grains)
    overlap = places.radius + places.other_radius - np.linalg.norm(places.line, axis=1)
    deep = places.pair & (overlap > 0.01 * (places.radius + places.other_radius))
    ratios = np.linalg.norm(places.force, axis=1)[deep] / hertz_force(known, places.radius[deep], places.other_radius[deep], overlap[deep])
    ratio = float(np.median(ratios)) if len(ratios) >= 5 else np.nan
    fits = fitting_units(FORCE_FACTORS, ratio, 1, 1 / 3.1, 3.1)
    if len(fits) == 1:
        mapped["force_unit"] = guess(fits[0], UNCLEAR if fits[0] in LIKE_NEWTONS else "sure",
                                     f"then forces are {ratio * FORCES[fits[0]]:.2g} times Hertz's from the overlaps")
    elif table.parts[0].format != "text" and grains.diameter[0] < 1:
        mapped["force_unit"] = guess("N", "likely", "the grains are in metres, so the program counts in SI")
    else:
        mapped["force_unit"] = guess("N", UNCLEAR, f"as newtons forces would be {ratio:.2g} times Hertz's" if np.isfinite(ratio)
                                     else "no name says it; with --set grains.youngs_modulus=.. the overlaps may")


def guess_contact_meaning(table, grains, known, voxel_size):
    if not grains.keys:
        table.map["id_offset"] = guess("0", UNCLEAR, "the grains' table cannot be read so far")
        return
    _guess_offset(table, grains)
    _guess_force_on(table, grains, known.box)
    frames = _Places(table, grains).all
    guess_walls(table, frames, grains, known)
    _guess_sides(table, frames)
    _guess_point_unit(table, grains, known, voxel_size)
    _guess_force_unit(table, grains, known)
