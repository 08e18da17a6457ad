"""Data of the 3D view of a packing on a page, which page_packing.js draws with plotly.js: grains would be 40 times as many numbers as
triangles of spheres. Lengths are in mm, forces in mN, with five digits."""
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..observe.stress_strain import deviatoric_strain, mean_stress, strongest_scan, volume_strain
from ..results import Box, Phase, Recording
from ..results.recording import Floats, Ints
from .labels import one_line, stress_unit
from .packing_parts import MM, layout_of, sphere_number, static_parts, walls_of

MN = 1e-3


@dataclass(frozen=True, eq=False)
class ShownPacking:
    """A recording with positions and contacts, and the rows of the scans that are shown."""
    label: str
    recording: Recording
    rows: Sequence[int]


@dataclass(frozen=True)
class PackingLimits:
    """`scans`: of each packing, by default as many as fit; `max_numbers` of all packings together, about 3 MB; `max_grains` of a
    packing: those nearest to its middle plane."""
    scans: int | None = None
    max_numbers: int = 600_000
    max_grains: int = 20_000


def numbers_of_scan(grains: int, contacts: int) -> int:
    return 3 * (grains + contacts)


def scans_shown(recording: Recording, numbers: int, limits: PackingLimits = PackingLimits()) -> list[int]:
    """Rows of scans, evenly spaced, with the first, the last and that of the largest load if possible.

    `numbers`: numbers per scan of all packings together.
    """
    count = len(recording.scans)
    room = max(3, limits.max_numbers // max(1, numbers)) if limits.scans is None else limits.scans
    most, found = min(count, room), strongest_scan(recording)
    strongest = count - 1 if found is None else found
    if most == 1:
        return [strongest]
    shown = [(s * (count - 1) + (most - 1) // 2) // (most - 1) for s in range(most)]
    if most >= 3 and 0 < strongest < count - 1:
        shown[min(range(1, most - 1), key=lambda s: abs(shown[s] - strongest))] = strongest
    return shown


def packing_view(packings: Sequence[ShownPacking], limits: PackingLimits = PackingLimits()) -> dict[str, Any] | None:
    """None if no scan has positions. Colours end at the quantile 0.995 of the forces; `strongest` is the scan at which a page opens."""
    shown = [(one, [row for row in one.rows if len(one.recording.scans.position[row])]) for one in packings]
    shown = [(one, rows) for one, rows in shown if rows]
    if not shown:
        return None
    forces = [_forces(one.recording, row) for one, rows in shown for row in rows]
    return {"settings": [_setting(one, rows, limits) for one, rows in shown],
            "force_mN": _colour_end(np.concatenate([contact for contact, _ in forces])),
            "load_mN": (end := _colour_end(np.concatenate([load for _, load in forces]))), **static_parts(end)}


def _rounded(values: Floats) -> Floats:
    """To five digits: less than a pixel, and half the size of the page."""
    values = np.asarray(values, float)
    with np.errstate(divide="ignore", invalid="ignore"):
        unit = 10.0 ** (np.floor(np.log10(np.abs(values))) - 4)
        scaled = np.copysign(np.floor(np.abs(values / unit) + 0.5), values)
        found = np.where(unit < 1, scaled / np.round(1 / unit), scaled * unit)
    return np.where((values == 0) | ~np.isfinite(values), values, found)


def _numbers(values: Floats) -> list[float]:
    return list(_rounded(values).tolist())


def _forces(recording: Recording, row: int) -> tuple[Floats, Floats]:
    """Of the contacts and on the grains [mN]."""
    contacts = recording.scans.contacts[row]
    force = np.linalg.norm(contacts.force, axis=1) / MN
    load = np.zeros(len(recording.diameter))
    np.add.at(load, contacts.grain, force)
    np.add.at(load, contacts.partner[~contacts.is_wall], force[~contacts.is_wall])
    return force, load


def _colour_end(values: Floats) -> float:
    """1 if there are no values."""
    end = np.sort(values)[len(values) - 1 - len(values) // 200] if len(values) else 0
    return float(_rounded(end)) if end > 0 else 1.0


def _shown_grains(recording: Recording, row: int, most: int) -> Ints:
    away = np.abs(recording.scans.position[row][:, 1] - recording.box.size_y / 2)
    return np.sort(np.argsort(away, kind="stable")[:most])


def _setting(packing: ShownPacking, rows: Sequence[int], limits: PackingLimits) -> dict[str, Any]:
    recording = packing.recording
    grains = _shown_grains(recording, rows[0], limits.max_grains)
    top = float(np.fmax.reduce(recording.scans.plate_z[list(rows)], initial=0))
    sizes = np.array([recording.box.size_x, recording.box.size_y, top]) / MM
    strongest = strongest_scan(recording)
    loads = mean_stress(recording.scans.stress) if recording.box.is_cell else recording.scans.top_force
    loads = np.nan_to_num(loads[list(rows)], nan=-np.inf)
    return {"label": one_line(packing.label), "container": recording.box.shape.name, "box_mm": _numbers(sizes[:2]),
            "top_mm": float(_rounded(sizes[2])), "number": grains.tolist(), "diameter_mm": _numbers(recording.diameter[grains] / MM),
            "strongest": int(np.argmax(loads)) if strongest is not None and (loads > 0).any() else 0,
            "sphere": sphere_number(len(grains)), "walls": walls_of(recording.box),
            "layout": layout_of(sizes, float(recording.diameter[grains].max(initial=0)) / MM),
            "scans": [_scan(recording, row, grains) for row in rows]}


def _words(recording: Recording, row: int) -> str:
    scans = recording.scans
    if not recording.box.is_cell:
        return (f"{recording.displacement[row] / MM:.2f} mm, {Phase(int(scans.phase[row])).name}ing, cycle {scans.cycle[row] + 1}, "
                f"top force {scans.top_force[row]:.4g} N")
    p = float(mean_stress(scans.stress[row]))
    unit = stress_unit(p)
    return (f"volume strain {100 * volume_strain(scans.strain[row]):.2f} %, deviatoric strain "
            f"{100 * deviatoric_strain(scans.strain[row]):.2f} %, φ {scans.packing_fraction[row]:.3f}, p {p / unit.size:.4g} {unit.name}")


def _scan(recording: Recording, row: int, grains: Ints) -> dict[str, Any]:
    scans, contacts, box = recording.scans, recording.scans.contacts[row], recording.box
    cell = _edges(box, scans.strain[row])
    position = _into_cell(box, cell, scans.position[row][grains])
    place = np.full(len(recording.diameter), -1)
    place[grains] = np.arange(len(grains))
    start, end = place[contacts.grain], np.where(contacts.is_wall, contacts.partner, place[np.maximum(contacts.partner, 0)])
    both = (start >= 0) & (contacts.is_wall | (end >= 0))
    moved, plate, force = (_rounded(value) for value in (recording.displacement[row] / MM, scans.plate_z[row] / MM,
                                                         np.linalg.norm(contacts.force[both], axis=1) / MN))
    return {"frame": int(scans.frame[row]), "title": f"scan {scans.frame[row]}: {_words(recording, row)}", "displacement_mm": float(moved),
            "plate_mm": float(plate), **({"cell_mm": _numbers(cell / MM)} if box.is_cell else {}),
            **{f"{axis}_mm": _numbers(position[:, a] / MM) for a, axis in enumerate("xyz")},
            "grain": start[both].tolist(), "partner": end[both].tolist(), "force_mN": force.tolist()}


def _edges(box: Box, strain: Floats) -> Floats:
    """Lengths along x, y and z and tilts xy, xz and yz of the container at this strain [m]."""
    lengths = np.array([box.size_x, box.size_y, box.height])
    return np.concatenate([lengths * (1 - strain[:3]), strain[3:] * lengths[[1, 2, 2]]]) if box.is_cell else np.append(lengths, np.zeros(3))


def _into_cell(box: Box, edges: Floats, points: Floats) -> Floats:
    """The images of the points inside the periodic cell; in other containers the points themselves. For a tilted cell the equivalent
    upright cell is used."""
    if not box.is_periodic:
        return points
    x, y, z, xy, xz, yz = edges
    points = np.array(points, float)
    if box.is_cell:
        points -= np.floor(points[:, 2:] / z) * np.array([xz, yz, z])
    points -= np.floor(points[:, 1:2] / y) * np.array([xy, y, 0])
    points -= np.floor(points[:, :1] / x) * np.array([x, 0, 0])
    return np.where(points < np.array([x, y, z if box.is_cell else np.inf]), points, 0)
