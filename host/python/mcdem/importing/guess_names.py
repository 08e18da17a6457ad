"""Guesses role and columns of a table from the names of its columns, with their units."""
import re
from collections.abc import Sequence
from collections.abc import Set as AbstractSet

from .mapping import PLACE_KEYS, SIZE_KEYS, UNCLEAR, Guess, MappedTable, guess, signed_column
from .names import COUNTED, FORCE_WORDS, FORCES, LENGTH_WORDS, VOXEL, column_name, columns_by_key, other_quantity
from .rows import ImportTable

WITHOUT_FORCES = "pairs of grains that touch, without forces"
LENGTH_KEYS = ("x", "y", "z", *SIZE_KEYS, "plate_z", "displacement")
FORCE_KEYS = ("fx", "fy", "fz", "force", "top_force", "set_force", "mean_stress", "deviator_stress")
PROGRAMS = {"SPAM": {"Label", "Zpos", "Ypos", "Xpos"}, "trackpy": {"mass", "signal"}, "scikit-image": {"centroid-2"}}


def _may_be_force(column: str) -> bool:
    name = column_name(column)
    known = columns_by_key("contacts", [column]) or name.quantity in ("a length", "a time", "a fraction")
    return not known and re.search("id$|^no$|label|number|distance|branch|normal|angle|area|radius", name.base) is None


def has_force(keys: AbstractSet[str]) -> bool:
    """Whether these keys tell the force on a plate."""
    return "top_force" in keys or {"mean_stress", "deviator_stress"} <= keys


def _role_of(columns: list[str]) -> tuple[str, str, str]:
    """Role, certainty and reason."""
    contacts, grains, plate = (columns_by_key(role, columns).keys() for role in ("contacts", "grains", "plate"))
    bases, pairs = [column_name(column).base for column in columns], {"grain", "partner"} <= contacts
    roles = {"contacts": pairs and ({"fx", "fy", "fz"} <= contacts or "force" in contacts),
             "grains": {"x", "y", "z"} <= grains and (grains & {*SIZE_KEYS} or program_of(columns)),
             "plate": has_force(plate) and plate & {*PLACE_KEYS}}
    if role := next((role for role, is_so in roles.items() if is_so), None):
        return role, "sure", "its columns are named so"
    # Contact lists of SPAM: labels of grains, orientations, numbers of voxels.
    if pairs and {"label1", "lab1", "labeli"} & {*bases} and not any(base.startswith(("f", "kraft")) for base in bases):
        return "contacts", "likely", WITHOUT_FORCES
    named = all(len(column_name(names[0]).base) > 2 for key, names in columns_by_key("contacts", columns).items() if key in ("grain", "partner"))
    if pairs and named and not contacts & {"fx", "fy", "fz", "force"} and not any(map(_may_be_force, columns)):
        return "contacts", "likely", WITHOUT_FORCES
    return "unused", UNCLEAR, "its columns say nothing that is known"


def program_of(columns: list[str]) -> str:
    """The image analysis program that names columns so, empty if there is none."""
    return next((program for program, names in PROGRAMS.items() if names <= set(columns)), "")


def _note_unit(mapped: MappedTable, key: str, keys: Sequence[str], known: Sequence[str]) -> None:
    """The unit in the names of these columns, if they agree and it is known."""
    names = [column_name(signed_column(word)[1]) for entry in keys if entry in mapped for word in mapped[entry].words]
    units = sorted({name.unit + name.unknown for name in names} - {""}, key=lambda unit: (unit in known, unit))
    pressures = mapped.role == "plate" and key == "force_unit" and ("mean_stress" in mapped or any(name.quantity == "a pressure" for name in names))
    others = [what for name in names if (what := other_quantity(name, "pressure" if pressures else key.removesuffix("_unit")))]
    if others:
        mapped[key] = guess(units[-1] if units[-1] in known else known[0], UNCLEAR, others[0])
    elif units and units[0] not in known:
        mapped[key] = guess(units[-1] if units[-1] in known else known[0], UNCLEAR,
                            f"a name says [{units[0]}], which is none of {' '.join(known)}: change the table")
    elif len(units) == 1:
        mapped[key] = guess(units[0], "sure", "the columns' names say so")
    elif units:
        mapped[key] = guess(units[0], UNCLEAR, "the columns' names say different units, and a table has one: change the table")
    elif pressures:
        mapped[key] = guess("kPa", UNCLEAR, "the name says a pressure, and no unit")


def note_units(mapped: MappedTable) -> None:
    _note_unit(mapped, "length_unit", LENGTH_KEYS, LENGTH_WORDS)
    _note_unit(mapped, "force_unit", FORCE_KEYS, FORCE_WORDS if mapped.role == "plate" else list(FORCES))


def _note_programs(mapped: MappedTable, columns: list[str]) -> None:
    """Columns of image analysis programs."""
    program = program_of(columns)
    if program == "SPAM":
        for axis in "xyz" if "Xdisp" in columns else "":
            mapped[axis] = Guess([f"{axis.upper()}pos", f"{axis.upper()}disp"], "sure", "SPAM's position and displacement")
        mapped["where"] = guess("Label", "likely", "label 0 is the background")
    if program:
        mapped.entries.setdefault("length_unit", guess(VOXEL, "likely", f"{program} counts in voxels"))


def guess_by_names(table: ImportTable) -> None:
    mapped, columns, repeated = table.map, table.parts[0].columns, table.parts[0].repeated
    mapped.role, mapped.role_certainty, mapped.role_why = _role_of(columns)
    if (role := mapped.role) == "unused":
        return
    found = columns_by_key(role, columns)
    times = [name for name in found.get("frame", []) if column_name(name).base in COUNTED["time"].split()]
    if role == "plate" and times:
        found["time"] = times
    sizes = [key for key in SIZE_KEYS if key in found]
    without = {  # keys that are not needed, or not complete
        **dict.fromkeys([key for key in PLACE_KEYS if key in found][1:], True), 
        **dict.fromkeys(("mean_stress", "deviator_stress"), "top_force" in found or not has_force(found.keys())),
        "force": all(key in found for key in ("fx", "fy", "fz")),
        **{key: role == "contacts" and not all(key in found for key in "xyz") for key in "xyz"}, **dict.fromkeys(sizes[1:], True)}
    for key, names in found.items():
        if without.get(key):
            continue
        one = len(names) == 1 or key == "frame"  # "time" in addition to "frame" has the same meaning
        why = "its name" if one else f"{len(names)} columns have such a name"
        if names[0] in repeated:
            one, why = False, "several columns have this very name, and this is the first of them"
        mapped[key] = guess(names[0], "sure" if one else UNCLEAR, why)
    for column in columns if "force" in mapped else ():  # besides the magnitude of a normal force
        if re.match("f[ts]|.*(tang|shear|scher)", column_name(column).base):
            mapped["force"] = guess(mapped.word("force"), UNCLEAR,
                                    f"{column} would not be used: give fx, fy, fz, or confirm that the normal part is enough")
    if mapped.role_why == WITHOUT_FORCES:
        mapped.entries = {key: of for key, of in mapped.entries.items() if key not in "xyz"}
    note_units(mapped)
    if role == "grains":
        _note_programs(mapped, columns)
