"""Meaning of column names: a quantity and possibly a unit, in the terms of laboratories and programs."""
import re
from collections.abc import Sequence
from typing import NamedTuple

from scipy import constants

LENGTHS = {"m": 1.0, "cm": 1e-2, "mm": 1e-3, "um": 1e-6}
FORCES: dict[str, float] = {"N": 1.0, "mN": 1e-3, "uN": 1e-6, "kN": 1e3, "cN": 1e-2, "daN": 10.0, "gf": 1e-3 * constants.kgf, "kgf": constants.kgf, "lbf": constants.lbf}
TIMES = {"s": 1.0, "sec": 1.0, "ms": 1e-3, "min": 60.0, "h": 3600.0}
PRESSURES: dict[str, float] = {"Pa": 1.0, "hPa": 1e2, "kPa": 1e3, "MPa": 1e6, "GPa": 1e9, "bar": constants.bar, "mbar": 1e-3 * constants.bar, "psi": constants.psi,
             "ksi": 1e3 * constants.psi, "atm": constants.atm, "torr": constants.torr, "mmHg": constants.mmHg, "N/mm2": 1e6, "N/cm2": 1e4,
             "N/m2": 1.0, "kN/m2": 1e3, "kN/mm2": 1e9, "mN/mm2": 1e3, "kgf/mm2": 1e6 * constants.kgf, "kgf/cm2": 1e4 * constants.kgf, "gf/cm2": 10 * constants.kgf}
VOXEL = "voxel"  # a length unit with its size in the mapping
LENGTH_WORDS = [*LENGTHS, VOXEL]
FORCE_WORDS = [*FORCES, *PRESSURES]  # of a plate: a pressure is multiplied by the area
SYNONYMS = {"µm": "um", "μm": "um", "micron": "um", "µN": "uN", "μN": "uN", "g": "gf", "kg": "kgf", "gram": "gf", "newton": "N",
            "newtons": "N", "meter": "m", "voxels": VOXEL, "vox": VOXEL, "vx": VOXEL, "pix": VOXEL, "px": VOXEL, "pixel": VOXEL, "pixels": VOXEL}
PRESSURE_NAMES = "pressure stress druck spannung pression contrainte axialstress axialpressure verticalstress normalstress pistonpressure " \
    "compressivestress compressionstress engineeringstress nominalstress appliedpressure normalspannung druckspannung pressspannung sigma sigmaz sigmazz"
PERCENT = {"%", "percent", "prozent", "pct"}
FRACTIONS = PERCENT | {"mm/mm", "m/m"}
_RATIOS = [  # of lengths and volumes, which tell a plate's height
    ("strain", "strain axialstrain verticalstrain compressivestrain engineeringstrain ea epsa eps epsilon epsz epszz dehnung stauchung"),
    ("fraction", "fraction relativedensity packingfraction volumefraction volfraction volfrac solidfraction solidvolumefraction estvolumefraction rd "
                 "packungsdichte"),
    ("void_ratio", "voidratio porenzahl e"),
    ("porosity", "porosity porositaet n"),
]
RATIO_KEYS = tuple(key for key, _ in _RATIOS)
_RATIO_NAMES = {word for _, words in _RATIOS for word in words.split() if len(word) > 2}
_LETTERS_OF_SOILS = {"p", "q", "e", "n"}  # mean and deviator stress, void ratio and porosity, where the table has both p and q
DOWNWARDS = "depth tiefe profondeur zdown zdownwards"  # names of a downward z
# Meanings of frame numbers.
COUNTED = {"time": "time t zeit temps testtime testzeit pruefzeit elapsedtime totaltime runningtime", "step": "step timestep schritt iter", "scan": "frame scan image snapshot bild state"}
_FRAME = ("frame", " ".join(COUNTED.values()))



def _of_axes(key: str, names: str, more: Sequence[str]) -> list[tuple[str, str]]:
    """The key and its names for x, y and z, which stand in place of @; `more`: names of each."""
    return [(key.replace("@", axis), f"{names.replace('@', axis)} {others}") for axis, others in zip("xyz", more, strict=True)]


# Keys of the mapping and their names without units and punctuation; the first match is used.
WORDS = {
    "plate": [
        _FRAME,
        ("cycle", "cycle zyklus ncycle cyclenumber"),
        ("phase", "phase direction richtung loading branch ast"),
        ("plate_z", "platez zplate plateheight height z gap plateposition position pos hoehe h platte top ztop topz lid piston bedheight "
                    "pistonposition zpiston platenposition platen toolseparation werkzeugabstand sampleheight specimenheight probenhoehe"),
        ("displacement", "displacement disp stroke travel weg hub verschiebung compression extension crosshead compressiveextension "
                         "compressivedisplacement axialdisplacement standardtravel standardweg traverse traversenweg "
                         "crossheadposition crossheaddisplacement crossheadtravel"),
        *_RATIOS,
        ("mean_stress", "p meanstress meaneffectivestress"),
        ("deviator_stress", "q deviatorstress deviatoricstress"),
        ("set_force", "setforce fset forceset setpoint sollkraft targetforce"),
        ("top_force", "topforce force load f fz kraft last ftop forcez plateforce normalforce loadcell platefz fplate3 compressiveload "
                      "compressiveforce axialforce standardforce standardkraft " + PRESSURE_NAMES),
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
        ("grain", "grain id1 i grain1 grain1id grainid1 particle1id particle1 particlei p1 a graina idi korn1 teilchen1 atom1 patom1 ida part1 g1 i1 label1 lab1 "
                  "labeli"),
        ("partner", "partner id2 j grain2 grain2id grainid2 particle2id particle2 particlej p2 b grainb idj korn2 teilchen2 atom2 patom2 idb part2 g2 i2 "
                    "neighbour neighbor nachbar other contactwith label2 lab2 labelj"),
        *_of_axes("@", "@ @c c@ p@ contact@ @contact cp@ point@ @pos", ("", "", DOWNWARDS)),
        *_of_axes("f@", "f@ force@ @force kraft@ ff@ fc@", ("f1", "f2", "f3")),
        ("force", "force f forcemagnitude fn normalforce kraft fabs fmag forcenorm"),
    ],
}
_LETTERS = str.maketrans({"ä": "ae", "ö": "oe", "ü": "ue", "ß": "ss", "Ä": "ae", "Ö": "oe", "Ü": "ue"})


class ColumnName(NamedTuple):
    base: str = ""  # only lower-case letters and digits, without the unit: "toppressure"
    unit: str = ""  # of length, force, time or pressure; empty if there is none
    unknown: str = ""  # a unit in brackets of another quantity, or of an unknown one; without brackets of a fraction

    @property
    def quantity(self) -> str:
        """What the name says that the column has: a length, a force, a time, a pressure or a fraction; empty if it says nothing."""
        of_units = {"a length": self.unit in LENGTH_WORDS, "a force": self.unit in FORCES, "a time": self.unit in TIMES,
                    "a pressure": self.unit in PRESSURES or not (self.unit or self.unknown) and self.base in PRESSURE_NAMES.split(),
                    "a fraction": self.unknown.lower() in FRACTIONS or not self.unit and self.base in _RATIO_NAMES}
        return next((quantity for quantity, is_so in of_units.items() if is_so), "")


def _known_unit(word: str) -> str:
    """Lengths also cubed, as volumes have them: "mm^3", "mm3"."""
    word = re.sub(r"(\^?3|³)$", "", word)
    word = SYNONYMS.get(word, SYNONYMS.get(word.lower(), word))
    return word if word in LENGTH_WORDS or word in FORCES or word in TIMES else ""


def _pressure_unit(word: str) -> str:
    """"kPa", "PSI", "N/mm2" for "N/mm^2"; empty if it is none."""
    force, slash, area = word.partition("/")
    word = _known_unit(force) + "/" + area.replace("²", "2").replace("^2", "2") if slash else word
    alike = {known.lower(): known for known in PRESSURES if len(known) > 2}
    return word if word in PRESSURES else alike.get(word, alike.get(word.lower(), "") if word.isupper() else "")


def column_name(name: str) -> ColumnName:
    """"Kraft [mN]", "x_mm", "Volume (mm^3)" and "z in mm" name units, "c_force[1]" does not."""
    name, unit, unknown = name.strip(), "", ""
    brackets = re.fullmatch(r"(.+)[\[(]([^\[(]*)[\])]", name, re.DOTALL)
    if brackets and (_known_unit(brackets[2].strip()) or _pressure_unit(brackets[2].strip()) or not re.search(r"\d", brackets[2])):
        name, unknown = brackets[1], brackets[2].strip()
        unit = _known_unit(unknown) or _pressure_unit(unknown)
    elif not brackets:
        ends = [(before, end.strip()) for before, _, end in (name.rpartition(mark) for mark in (" in ", "/", "_", " ", "-", ".")) if before]
        units = ((before, _known_unit(end) or _pressure_unit(end) * (len(before) > 1)) for before, end in ends)
        if known := next(((before, unit) for before, unit in units if unit), None):
            name, unit = known
        else:
            name, unknown = next(((before, end) for before, end in ends if end.lower() in FRACTIONS), (name, ""))
    return ColumnName(re.sub(r"[^a-z0-9]", "", name.translate(_LETTERS).lower()), unit, "" if unit else unknown)


def other_quantity(name: str | ColumnName, wanted: str) -> str:
    """Why a column of this name is none of the `wanted` quantity, "force", "pressure" or "length", and the remedy; empty if the name does not
    say so."""
    name = column_name(name) if isinstance(name, str) else name
    quantity = name.quantity
    if quantity not in ("a pressure", "a fraction") or quantity == f"a {wanted}":
        return ""
    remedy = {("a pressure", "force"): "of a plate, write its unit as force_unit, and it is multiplied by area; of a contact, multiply by its area",
              ("a fraction", "force"): "multiply by the force that is 100 %",
              ("a fraction", "length"): "of a plate, name it for strain, fraction, void_ratio or porosity; otherwise multiply by the length that is 100 %"}
    said = name.unknown or name.unit
    says = f"[{said}], which is {quantity} and no" if said else f"{quantity}, which is no"
    return f"a name says {says} {wanted}: {remedy.get((quantity, wanted), 'change the table')}, and name the column by the unit of the {wanted}"


def columns_by_key(role: str, columns: list[str]) -> dict[str, list[str]]:
    """The columns that names tell for the keys of a table of that role."""
    found = dict[str, list[str]]()
    bases = [column_name(column).base for column in columns]
    for column, base in zip(columns, bases):
        if role == "plate" and base in _LETTERS_OF_SOILS and not {"p", "q"} <= {*bases}:
            continue
        for key in [key for key, words in WORDS[role] if base in words.split()][:1]:
            found.setdefault(key, []).append(column)
    return found
