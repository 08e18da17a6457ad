"""Meaning of column names: a quantity and possibly a unit, in the terms of laboratories and programs."""
import re
from collections.abc import Sequence
from typing import NamedTuple

import pint

_units = pint.UnitRegistry()


def _factors(words: str, base: str) -> dict[str, float]:
    return {word: _units.Quantity(1, word).to(base).magnitude for word in words.split()}


LENGTHS = _factors("m cm mm um", "m")
FORCES = _factors("N mN uN kN cN daN gf kgf lbf", "N")
TIMES = _factors("s sec ms min h", "s")
VOXEL = "voxel"  # a length unit with its size in the mapping
LENGTH_WORDS = [*LENGTHS, VOXEL]
SYNONYMS = {"µm": "um", "μm": "um", "micron": "um", "µN": "uN", "μN": "uN", "g": "gf", "kg": "kgf", "gram": "gf", "newton": "N",
            "newtons": "N", "meter": "m", "voxels": VOXEL, "vox": VOXEL, "vx": VOXEL, "pix": VOXEL, "px": VOXEL, "pixel": VOXEL, "pixels": VOXEL}
PRESSURES = {*"Pa hPa kPa MPa GPa mbar psi ksi atm torr mmHg bar".split()}
PRESSURE_NAMES = "pressure stress druck spannung pression contrainte axialstress axialpressure verticalstress normalstress pistonpressure " \
    "compressivestress compressionstress engineeringstress nominalstress normalspannung druckspannung pressspannung sigma sigmaz sigmazz"
FRACTIONS = {"%", "percent", "prozent", "pct", "mm/mm", "m/m"}
DOWNWARDS = "depth tiefe profondeur zdown zdownwards"  # names of a downward z
# Meanings of frame numbers.
COUNTED = {"time": "time t zeit temps", "step": "step timestep schritt iter", "scan": "frame scan image snapshot bild state"}
_FRAME = ("frame", " ".join(COUNTED.values()))



def _of_axes(key: str, names: str, more: Sequence[str]) -> list[tuple[str, str]]:
    """The key and its names for x, y and z, which stand in place of @; `more`: names of each."""
    return [(key.replace("@", axis), f"{names.replace('@', axis)} {others}") for axis, others in zip("xyz", more, strict=True)]


# Keys of the mapping and their names without units and punctuation; the first match is used.
WORDS = {
    "plate": [
        _FRAME,
        ("cycle", "cycle zyklus ncycle cyclenumber"),
        ("phase", "phase direction richtung loading"),
        ("plate_z", "platez zplate plateheight height z gap plateposition position pos hoehe h platte top ztop topz lid piston bedheight "
                    "pistonposition zpiston platenposition platen"),
        ("displacement", "displacement disp stroke travel weg hub verschiebung compression extension crosshead compressiveextension "
                         "compressivedisplacement axialdisplacement standardtravel standardweg traverse traversenweg "
                         "crossheadposition crossheaddisplacement crossheadtravel"),
        ("set_force", "setforce fset forceset setpoint sollkraft targetforce"),
        ("top_force", "topforce force load f fz kraft last ftop forcez plateforce normalforce loadcell platefz fplate3 compressiveload "
                      "compressiveforce axialforce standardforce standardkraft"),
    ],
    "grains": [
        _FRAME,
        ("grain", "grain id particle label index korn teilchen nr no number atom particleid grainid bead beadid"),
        *_of_axes("@", "@ @c c@ pos@ @pos centroid@ @centroid center@ @center centre@ @centre coord@ @coord com@ @com @u p@ position@ "
                       "barycenter@ centerofmass@", ("centroid2", "centroid1", f"centroid0 {DOWNWARDS}")),  # axes of an image: z, y, x
        ("diameter", "diameter d dia diam durchmesser diametre equivalentdiameterarea equivalentdiameter eqdiameter equivdiam "
                     "equivalentsphericaldiameter"),
        ("radius", "radius r rad radii halbmesser rayon equivalentradius equivalentradii equivradius equivradii eqradius"),
        ("volume", "volume volume3d volumen vol"),
    ],
    "contacts": [
        _FRAME,
        ("grain", "grain id1 i grain1 particle1 particlei p1 a graina idi korn1 teilchen1 atom1 patom1 ida part1 g1 i1 label1 lab1 "
                  "labeli"),
        ("partner", "partner id2 j grain2 particle2 particlej p2 b grainb idj korn2 teilchen2 atom2 patom2 idb part2 g2 i2 "
                    "neighbour neighbor nachbar other contactwith label2 lab2 labelj"),
        *_of_axes("@", "@ @c c@ p@ contact@ @contact cp@ point@ @pos", ("", "", DOWNWARDS)),
        *_of_axes("f@", "f@ force@ @force kraft@ ff@ fc@", ("f1", "f2", "f3")),
        ("force", "force f forcemagnitude fn normalforce kraft fabs fmag forcenorm"),
    ],
}
_LETTERS = str.maketrans({"ä": "ae", "ö": "oe", "ü": "ue", "ß": "ss", "Ä": "ae", "Ö": "oe", "Ü": "ue"})


class ColumnName(NamedTuple):
    base: str = ""  # only lower-case letters and digits, without the unit: "toppressure"
    unit: str = ""  # of length, force or time; empty if there is none
    unknown: str = ""  # a unit in brackets of another quantity, or of an unknown one; without brackets of a pressure or a fraction

    @property
    def quantity(self) -> str:
        """What the name says that the column has: a length, a force, a time, a pressure or a fraction; empty if it says nothing."""
        of_units = {"a length": self.unit in LENGTH_WORDS, "a force": self.unit in FORCES, "a time": self.unit in TIMES,
                    "a pressure": _is_pressure(self.unknown) or not (self.unit or self.unknown) and self.base in PRESSURE_NAMES.split(),
                    "a fraction": self.unknown.lower() in FRACTIONS}
        return next((quantity for quantity, is_so in of_units.items() if is_so), "")


def _known_unit(word: str) -> str:
    """Lengths also cubed, as volumes have them: "mm^3", "mm3"."""
    word = re.sub(r"(\^?3|³)$", "", word)
    word = SYNONYMS.get(word, SYNONYMS.get(word.lower(), word))
    return word if word in LENGTH_WORDS or word in FORCES or word in TIMES else ""


def _is_pressure(word: str) -> bool:
    """"kPa", "N/mm2", "kgf/cm^2"."""
    force, _, area = word.partition("/")
    if word in PRESSURES or len(word) > 2 and word in {known.lower() for known in PRESSURES}:
        return True
    return _known_unit(force) in FORCES and re.fullmatch(r"[mcd]?m(\^?2|²)", area) is not None


def column_name(name: str) -> ColumnName:
    """"Kraft [mN]", "x_mm", "Volume (mm^3)" and "z in mm" name units, "c_force[1]" does not."""
    name, unit, unknown = name.strip(), "", ""
    brackets = re.fullmatch(r"(.+)[\[(]([^\[(]*)[\])]", name, re.DOTALL)
    if brackets and (_known_unit(brackets[2].strip()) or _is_pressure(brackets[2].strip()) or not re.search(r"\d", brackets[2])):
        name, unknown = brackets[1], brackets[2].strip()
        unit = _known_unit(unknown)
    elif not brackets:
        ends = [(before, end.strip()) for before, _, end in (name.rpartition(mark) for mark in (" in ", "/", "_", " ", "-", ".")) if before]
        others = ((before, end) for before, end in ends if _is_pressure(end) and len(before) > 1 or end.lower() in FRACTIONS)
        if known := next(((before, unit) for before, end in ends if (unit := _known_unit(end))), None):
            name, unit = known
        else:
            name, unknown = next(others, (name, ""))
    return ColumnName(re.sub(r"[^a-z0-9]", "", name.translate(_LETTERS).lower()), unit, "" if unit else unknown)


def other_quantity(name: str | ColumnName, wanted: str) -> str:
    """Why a column of this name is none of the `wanted` quantity, "force" or "length", and the remedy; empty if the name does not say so."""
    name = column_name(name) if isinstance(name, str) else name
    quantity = name.quantity
    if quantity not in ("a pressure", "a fraction"):
        return ""
    remedy = {("a pressure", "force"): "multiply by the area that it acts on, such as that of the plate",
              ("a fraction", "force"): "multiply by the force that is 100 %", ("a fraction", "length"): "multiply by the length that is 100 %"}
    says = f"[{name.unknown}], which is {quantity} and no" if name.unknown else f"{quantity}, which is no"
    return f"a name says {says} {wanted}: {remedy.get((quantity, wanted), 'change the table')}, and name the column by the unit of the {wanted}"


def columns_by_key(role: str, columns: list[str]) -> dict[str, list[str]]:
    """The columns that names tell for the keys of a table of that role."""
    found = dict[str, list[str]]()
    for column in columns:
        base = column_name(column).base
        for key in [key for key, words in WORDS[role] if base in words.split()][:1]:
            found.setdefault(key, []).append(column)
    return found
