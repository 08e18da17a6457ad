"""Who touches in scans without measured contact forces: by the overlap of grains, or as the experiment lists it (topology.csv)."""
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..experiment.container import apart, into_cell, lengths, towards_wall, wall_distance, walls_of
from ..results.recording import NO_CONTACTS, Box, Contacts, Floats, Ints, Recording
from .contact_residuals import GrainsAlone, Material, reduced_modulus, reduced_radius_at


def near_grains(box: Box, position: Floats, reach: float) -> tuple[Ints, Ints, Ints]:
    """Scan and grains of all pairs whose centres, `position` (S, N, 3), are less than `reach` apart [m]. One tree has the grains of all scans, far
    apart from one another along z."""
    from scipy.spatial import cKDTree  # pages, which list the observables, do without it
    scans, count = position.shape[:2]
    inside = into_cell(box, position.reshape(-1, 3))
    inside[:, 2] += (np.ptp(inside[:, 2]) + 2 * reach) * np.repeat(np.arange(scans), count)
    size = [box.size_x, box.size_y, 0] if box.is_periodic else None
    pairs = cKDTree(inside, boxsize=size).query_pairs(reach, output_type="ndarray")
    i, j = np.sort(pairs % count, axis=1).T
    return pairs[:, 0] // count, i, j


def with_hertz_contacts(recording: Recording, numbers: Sequence[int], material: Material) -> Recording:
    """The recording, whose scans with these numbers have the contacts of their grains: with the normal forces that Hertz's law gives the measured
    overlaps, and with these overlaps, which are negative for a listed contact of grains that do not overlap."""
    scans, contacts, how = recording.scans, [NO_CONTACTS] * len(recording.scans), material.grains_alone
    if how and len(numbers):
        between = _between_grains(recording, numbers, material, how)
        walls = _at_walls(recording, numbers, material, how)
        scan, grain, partner, point, force, overlap = (np.concatenate(both) for both in zip(between, walls, strict=True))
        order = np.argsort(scan, kind="stable")
        every = Contacts(grain[order], partner[order], point[order], force[order], overlap[order])
        ends = np.cumsum(np.bincount(scan, minlength=len(numbers)))
        for number, begin, end in zip(numbers, [0, *ends[:-1]], ends):
            contacts[number] = every.rows(slice(begin, end))
    return replace(recording, scans=replace(scans, contacts=tuple(contacts)))


Touching = tuple[Ints, Ints, Ints, Floats, Floats, Floats]  # scan, grain, partner, point, force, overlap


def _between_grains(recording: Recording, numbers: Sequence[int], material: Material, how: GrainsAlone) -> Touching:
    scans, radius, box = recording.scans, 0.5 * recording.diameter, recording.box
    position = np.stack([scans.position[number] for number in numbers])
    if how.listed:
        lists = [scans.contacts[number] for number in numbers]
        scan = np.repeat(np.arange(len(numbers)), [len(one) for one in lists])
        i, j = (np.concatenate([getattr(one, name) for one in lists]) for name in ("grain", "partner"))
        scan, i, j = scan[j >= 0], i[j >= 0], j[j >= 0]
    else:
        scan, i, j = near_grains(box, position, float(recording.diameter.max()))
    way = apart(box, position[scan, i], position[scan, j])
    distance = lengths(way)
    overlap = radius[i] + radius[j] - distance
    touches = (distance > 0) & (how.listed | (overlap > how.touching))
    scan, i, j, way, distance, overlap = (of[touches] for of in (scan, i, j, way, distance, overlap))
    normal = way / distance[:, np.newaxis]
    force = _hertz(reduced_modulus(material, False), radius[i] * radius[j] / (radius[i] + radius[j]), overlap)
    return scan, i, j, position[scan, i] + 0.5 * way, -force[:, np.newaxis] * normal, overlap


def _at_walls(recording: Recording, numbers: Sequence[int], material: Material, how: GrainsAlone) -> Touching:
    """By overlap, also where contacts are listed: images show walls less well than grains."""
    box, count = recording.box, len(recording.diameter)
    position = np.concatenate([recording.scans.position[number] for number in numbers])
    scan, grain = np.repeat(np.arange(len(numbers)), count), np.tile(np.arange(count), len(numbers))
    plate_z = recording.scans.plate_z[list(numbers)]
    found = []
    for wall in walls_of(box):
        overlap = 0.5 * recording.diameter[grain] - wall_distance(box, wall, plate_z[scan], position)
        touches = overlap > how.touching
        at, radius, overlap = position[touches], 0.5 * recording.diameter[grain[touches]], overlap[touches]
        normal = towards_wall(box, wall, at)
        force = _hertz(reduced_modulus(material, True), reduced_radius_at(box, np.full(len(at), int(wall)), radius), overlap)
        found.append((scan[touches], grain[touches], np.full(len(at), -1 - int(wall)), at + (radius - overlap)[:, np.newaxis] * normal,
                      -force[:, np.newaxis] * normal, overlap))
    scan, grain, partner, point, force, overlap = (np.concatenate(of) for of in zip(*found, strict=True))
    return scan, grain, partner, point, force, overlap


def _hertz(modulus: float, radius: Floats, overlap: Floats) -> Floats:
    """(C,) forces [N]."""
    force: Floats = 4 / 3 * modulus * np.sqrt(radius) * np.maximum(overlap, 0) ** 1.5
    return force
