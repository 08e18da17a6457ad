"""Guesses role and columns of a table from the names of its columns, with their units."""
from .mapping import SIZE_KEYS, UNCLEAR, guess, signed_column
from .names import COUNTED, FORCES, LENGTH_WORDS, VOXEL, column_name, columns_by_key, is_among

LENGTH_KEYS = ("x", "y", "z", *SIZE_KEYS, "plate_z", "displacement")
FORCE_KEYS = ("fx", "fy", "fz", "force", "top_force", "set_force")


def _role_of(columns):
    contacts, grains, plate = (columns_by_key(role, columns).keys() for role in ("contacts", "grains", "plate"))
    if {"grain", "partner"} <= contacts and ({"fx", "fy", "fz"} <= contacts or "force" in contacts):
        return "contacts"
    if {"x", "y", "z"} <= grains and (grains & {*SIZE_KEYS} or _size_is_missing(columns)):
        return "grains"
    if "top_force" in plate and plate & {"plate_z", "displacement"}:
        return "plate"
    return None


def is_trackpy(columns):
    return {"mass", "ecc", "signal"} <= set(columns) or {"raw_mass", "signal"} <= set(columns)


def is_spam(columns):
    return {"Label", "Zpos", "Ypos", "Xpos"} <= set(columns)


def _size_is_missing(columns):
    return is_trackpy(columns) or is_spam(columns) or ("centroid-2" in columns and "label" in columns)


def _note_unit(mapped, key, keys, known):
    """The unit in the names of these columns, if they agree and it is known."""
    units, others = set(), set()
    for entry in keys:
        for word in mapped[entry].words if entry in mapped else ():
            name = column_name(signed_column(word)[1])
            if name.unit in known:
                units.add(name.unit)
            elif name.unit or name.unknown:
                others.add(name.unit + name.unknown)
    first = min(units) if units else known[0]
    if others:
        mapped[key] = guess(first, UNCLEAR, f"a name says [{min(others)}], which is none of {' '.join(known)}: change the table")
    elif len(units) == 1:
        mapped[key] = guess(first, "sure", "the columns' names say so")
    elif units:
        mapped[key] = guess(first, UNCLEAR, "the columns' names say different units, and a table has one: change the table")


def note_units(mapped):
    _note_unit(mapped, "length_unit", LENGTH_KEYS, LENGTH_WORDS)
    _note_unit(mapped, "force_unit", FORCE_KEYS, list(FORCES))


def _note_tangential(mapped, columns):
    """A magnitude of the normal force together with a tangential one without direction."""
    for column in columns:
        base = column_name(column).base
        if base.startswith(("ft", "fs")) or any(word in base for word in ("tang", "shear", "scher")):
            mapped["force"].certainty = UNCLEAR
            mapped["force"].why = f"{column} would not be used: give fx, fy, fz, or confirm that the normal part is enough"


def _note_programs(mapped, columns):
    """Columns of image analysis programs."""
    if is_spam(columns):
        for axis in "xyz" if "Xdisp" in columns else "":
            mapped[axis].words = [f"{axis.upper()}pos", f"{axis.upper()}disp"]
            mapped[axis].why = "SPAM's position and displacement"
        mapped["where"] = guess("Label", "likely", "label 0 is the background")
    program = "SPAM" if is_spam(columns) else "trackpy" if is_trackpy(columns) else "scikit-image" if "centroid-2" in columns else ""
    if program and "length_unit" not in mapped:
        mapped["length_unit"] = guess(VOXEL, "likely", f"{program} counts in voxels")


def guess_by_names(table):
    mapped, columns, repeated = table.map, table.parts[0].columns, table.parts[0].repeated
    mapped.role = role = _role_of(columns) or "unused"
    mapped.role_certainty, mapped.role_why = ("sure", "its columns are named so") if role != "unused" else (
        UNCLEAR, "its columns say nothing that is known")
    found = columns_by_key("contacts", columns)
    if role == "unused" and "grain" in found and "partner" in found and _only_touching(columns):
        mapped.role_certainty, mapped.role_why = "likely", "pairs of grains that touch, without forces: an experiment's contacts have forces"
    if role == "unused":
        return
    found = columns_by_key(role, columns)
    if role == "plate":
        if times := [name for name in found.get("frame", []) if is_among(column_name(name).base, COUNTED["time"])]:
            found["time"] = times
    if "plate_z" in found:
        found.pop("displacement", None)
    for key in [key for key in SIZE_KEYS if key in found][1:]:
        del found[key]
    if all(key in found for key in ("fx", "fy", "fz")):
        found.pop("force", None)
    if role == "contacts" and not all(key in found for key in "xyz"):
        for key in "xyz":
            found.pop(key, None)
    for key, names in found.items():
        one = len(names) == 1 or key == "frame"  # "time" in addition to "frame" has the same meaning
        if names[0] in repeated:
            mapped[key] = guess(names[0], UNCLEAR, "several columns have this very name, and this is the first of them")
        else:
            mapped[key] = guess(names[0], "sure" if one else UNCLEAR, "its name" if one else f"{len(names)} columns have such a name")
    if "force" in mapped:
        _note_tangential(mapped, columns)
    note_units(mapped)
    if role == "grains":
        _note_programs(mapped, columns)


def _only_touching(columns):
    """Contact lists of SPAM: labels of grains, orientations, numbers of voxels."""
    bases = {column_name(column).base for column in columns}
    return bool({"label1", "lab1", "labeli"} & bases) and not any(base.startswith(("f", "kraft")) for base in bases)
