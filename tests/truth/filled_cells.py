"""Polyhedra with the volume of the undeformed sphere: what a grain with P much larger than E becomes. By Minkowski's
theorem the areas of the facets, proportional to the forces, determine their distances from the centre."""
import numpy as np
from scipy.optimize import brentq
from scipy.spatial import ConvexHull, HalfspaceIntersection, QhullError

from neo_hookean_plates import SYMMETRIC, balanced, images

VOLUME = 4 * np.pi / 3  # of the sphere with radius 1
FACETS, EACH = range(5, 15), 30  # numbers of facets, and polyhedra for each of them
SQUARE_OVERLAPS = .5, .7, .85, 1.15, 1.3  # of the square facets of fourteen plates, over that of the others


def cell(normals, distances):
    """Facet areas and volume of the polyhedron between these planes."""
    corners = HalfspaceIntersection(np.column_stack([normals, -distances]), np.zeros(3)).intersections
    areas = np.zeros(len(normals))
    for i, (normal, distance) in enumerate(zip(normals, distances)):
        facet = corners[np.abs(corners @ normal - distance) < 1e-9]
        first = np.cross(normal, [1, 0, 0] if abs(normal[0]) < .8 else [0, 1, 0])
        first /= np.linalg.norm(first)
        flat = np.unique(np.round(facet @ np.column_stack([first, np.cross(normal, first)]), 10), axis=0)
        if len(flat) > 2:
            areas[i] = ConvexHull(flat).volume
    return areas, areas @ distances / 3


def apart(random, count):
    """Directions with a least angle between any two, then pushed apart by a random amount."""
    least = np.cos(np.radians(45 if count <= 9 else 42 if count <= 11 else 38))
    normals = []
    while len(normals) < count:
        normals = []
        for _ in range(400):
            normal = random.normal(size=3)
            normal /= np.linalg.norm(normal)
            if all(normal @ other < least for other in normals):
                normals.append(normal)
            if len(normals) == count:
                break
    normals = np.array(normals)
    for _ in range(random.integers(0, 25)):
        between = normals[:, None] - normals
        squared = (between**2).sum(-1) + np.eye(count)
        normals = normals + .02 * (between / squared[..., None]**2).sum(1)
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    return normals


def filled(random, normals, shares):
    """Shares of the facets in the surface and their overlaps, if these plates enclose a compact polyhedron."""
    ways = random.normal(size=(500, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    if (ways @ normals.T).max(1).min() < .25:
        return None
    try:
        load = brentq(lambda t: cell(normals, 1 - t * shares)[1] - VOLUME, 0, .75 / shares.max(), xtol=1e-8)
    except (QhullError, ValueError):  # open, or too small
        return None
    areas, _ = cell(normals, 1 - load * shares)
    if areas.min() < .004 * areas.sum() or load * shares.max() > .5:
        return None
    return normals, areas / areas.sum(), load * shares


def symmetric():
    """Plates and relative overlaps of the symmetric arrangements that can fill a cell."""
    for name in ('six_plates', 'eight_cube', 'twelve_fcc', 'twelve_icosahedral', 'fourteen', 'two_plus_four', 'unequal_pairs'):
        planes, shares = SYMMETRIC[name]
        planes = np.array(planes, float) / np.linalg.norm(planes, axis=1, keepdims=True)
        normals = [(image, share) for plane, share in zip(planes, shares) for image in images(plane, (0, 1, 2))]
        yield name, np.array([n for n, _ in normals]), np.array([s for _, s in normals], float)


def filled_cells():
    """Normals, shares of the facets in the surface, and overlaps of each polyhedron."""
    random, cells = np.random.default_rng(5), []
    for count in FACETS:
        found, tries = 0, 0
        while found < EACH and tries < 400:
            tries += 1
            normals = apart(random, count)
            shares = random.uniform(random.uniform(.35, .95), 1, count)
            made = filled(random, normals, balanced(normals, shares))
            if made:
                cells.append(made)
                found += 1
    for name, normals, shares in symmetric():
        cells.append(filled(random, normals, shares))
        for square in SQUARE_OVERLAPS if name == 'fourteen' else ():
            cells.append(filled(random, normals, np.where(np.abs(normals).max(1) > .99, square, shares)))
    return [made for made in cells if made]
