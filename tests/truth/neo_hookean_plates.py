#!/usr/bin/env python3
"""Writes neo_hookean_plates.csv for one neo-Hookean sphere between plates: neo_hookean_plates.py >
neo_hookean_plates.csv."""
import argparse
import csv
import itertools
import sys

import numpy as np
from scipy.optimize import minimize

from neo_hookean_sphere import Mesh, Sphere

Z, X, Y = [0, 0, 1], [1, 0, 0], [0, 1, 0]
FCC = [[1, 1, 0], [1, 0, 1], [0, 1, 1]]
GOLDEN = (1 + 5**.5) / 2
# One of each plate's mirror images about the coordinate planes, and its overlap over that of the first plate.
SYMMETRIC = {
    'two_plates': ([Z], [1]),
    'four_square': ([X, Y], [1, 1]),
    'six_plates': ([X, Y, Z], [1, 1, 1]),
    'eight_cube': ([[1, 1, 1]], [1]),
    'twelve_fcc': (FCC, [1, 1, 1]),
    'twelve_icosahedral': ([[0, 1, GOLDEN], [1, GOLDEN, 0], [GOLDEN, 0, 1]], [1, 1, 1]),
    'fourteen': ([[1, 1, 1], X, Y, Z], [1, 1, 1, 1]),
    'two_plus_four': ([Z, X, Y], [1, .5, .5]),
    'unequal_pairs': ([Z, X, Y], [1, .75, .4]),
    'eight_plus_two': ([[1, 1, 1], Z], [1, .6]),
    'unequal_fours': (FCC, [1, .85, .7]),
    'eight_plus_pairs': ([[1, 1, 1.3], X, Y], [1, .8, .7]),
    'two_fours': ([[1.6, 0, 1], [0, 1, .8]], [1, .8]),
    'four_plus_pairs': ([[1, 0, .8], Y, Z], [1, .7, .55]),
}
# Random arrangements, symmetric about x = 0 and y = 0 only: numbers of plates on the z axis, in either plane,
# elsewhere.
RANDOM = {
    'random_five': ((1, 2, 0), 1),
    'random_six': ((0, 3, 0), 2),
    'random_seven': ((1, 1, 1), 3),
    'random_eight': ((0, 2, 1), 4),
    'random_nine': ((1, 0, 2), 5),
    'random_nine_b': ((1, 2, 1), 31),
    'random_ten': ((0, 1, 2), 32),
    'random_eight_b': ((0, 0, 2), 33),
    'random_seven_b': ((1, 1, 1), 34),
    'random_nine_c': ((1, 0, 2), 35),
    'random_ten_b': ((0, 1, 2), 36),
    'random_nine_d': ((1, 2, 1), 37),
    'random_eight_c': ((0, 2, 1), 38),
    'random_seven_c': ((1, 1, 1), 51),
    'random_nine_e': ((1, 0, 2), 52),
}
# Random arrangements without symmetry: number of plates, and seed.
ASYMMETRIC = {f'asymmetric_{name}': (count, seed) for seed, (name, count) in
              enumerate((('five', 5), ('six', 6), ('seven', 7), ('eight', 8), ('nine', 9)), 11)}
ASYMMETRIC |= {'asymmetric_five_b': (5, 21), 'asymmetric_seven_b': (7, 23),
               'asymmetric_eight_b': (8, 41), 'asymmetric_six_b': (6, 53)}
OVERLAPS = (.025, .05, .075, .1, .125, .15, .175, .2)
POISSON_RATIOS = (.3, .4, .49)


def random_plates(kinds, seed):
    """Plates more than 45 degrees apart that enclose the sphere, and their overlaps over the largest one."""
    random = np.random.default_rng(seed)
    on_axis, in_planes, elsewhere = kinds
    masks = [[0, 0, 1]] * on_axis + [[1, 0, 1], [0, 1, 1]] * in_planes + [[1, 1, 1]] * elsewhere
    masks = masks[:on_axis + in_planes] + [[1, 1, 1]] * elsewhere
    while True:
        normals = random.normal(size=(len(masks), 3)) * masks
        normals[:, :2] = np.abs(normals[:, :2])  # in the modelled quarter of the sphere
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        every = np.array([image for n in normals for image in images(n, (0, 1))])
        ways = random.normal(size=(400, 3))
        ways /= np.linalg.norm(ways, axis=1, keepdims=True)
        if (every @ every.T - 2 * np.eye(len(every))).max() < np.cos(np.pi / 4) and (ways @ every.T).max(1).min() > .35:
            overlaps = random.uniform(.5, 1, len(masks))
            return normals, overlaps / overlaps.max()


def asymmetric_plates(count, seed):
    """Plates more than 45 degrees apart, none of them a mirror image of another, and their overlaps over the largest
    one."""
    random = np.random.default_rng(seed)
    while True:
        normals = random.normal(size=(count, 3))
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        ways = random.normal(size=(400, 3))
        ways /= np.linalg.norm(ways, axis=1, keepdims=True)
        if (normals @ normals.T - 2 * np.eye(count)).max() < np.cos(np.pi / 4) and (ways @ normals.T).max(1).min() > .2:
            overlaps = balanced(normals, random.uniform(.5, 1, count))
            if overlaps.min() > .25 * overlaps.max():
                return normals, overlaps / overlaps.max()


def balanced(normals, overlaps):
    """Relative to the origin at which the Hertz forces cancel, so that the sphere hardly moves between its plates."""
    def energy(move):
        return (np.maximum(overlaps - normals @ move, 0)**2.5).sum()

    return overlaps - normals @ minimize(energy, np.zeros(3)).x


def mirrors_of(name):
    """Axes about which the arrangement is symmetric."""
    return () if name.startswith('asymmetric') else (0, 1) if name.startswith('random') else (0, 1, 2)


def images(normal, mirrors):
    """All mirror images of a plate."""
    signs = itertools.product(*((1, -1) if axis in mirrors else (1,) for axis in range(3)))
    return sorted({tuple(np.array(s) * normal + 0.) for s in signs})


def cases():
    for name, (normals, shares) in SYMMETRIC.items():
        yield name, np.array(normals, float) / np.linalg.norm(normals, axis=1, keepdims=True), np.array(shares)
    for name, of in RANDOM.items():
        yield name, *random_plates(*of)
    for name, of in ASYMMETRIC.items():
        yield name, *asymmetric_plates(*of)


def load(sphere, normals, shares, start, overlap):
    """Loads from one overlap to the next, in smaller steps if Newton's method requires them."""
    step = overlap - start
    while start < overlap - 1e-9:
        before = sphere.u
        to = min(start + step, overlap)
        if sphere.press([(n, 1 - to * s) for n, s in zip(normals, shares)]):
            start = to
            continue
        sphere.u = before
        step /= 2
        if step < 1e-3:
            return False
    return True


def rows_of(mesh, name, normals, shares, nu, linear, overlaps):
    sphere, start = Sphere(mesh, nu, linear), 0
    for overlap in overlaps:
        if not load(sphere, normals, shares, start, overlap):
            print(f'{name} nu {nu}: no solution found at {overlap}', file=sys.stderr)
            return
        start = overlap
        plates = [(n, 1 - overlap * s) for n, s in zip(normals, shares)]
        forces, yields = sphere.contacts(plates)
        centre = sphere.centre()
        for number, (normal, force, give) in enumerate(zip(normals, forces, yields)):
            own = 1 - plates[number][1] + centre @ normal - give
            count = len(images(normal, mesh.mirrors))
            yield [name, nu, overlap, number, count, *np.round(normal, 7), f'{own:.6g}', f'{force:.6g}']
        if name == 'two_plates':  # a plate that just touches the displaced equator
            yield [name, nu, overlap, 'equator', 2, 1, 0, 0, f'{-sphere.reach(np.array(X)):.6g}', 0]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('case', nargs='*', help='all by default')
    parser.add_argument('--bricks', type=int, default=4, help='along the edge of an octant; with 6 the forces change by less than 1 %%')
    parser.add_argument('--linear', action='store_true', help="small strain, Hooke's law, instead")
    parser.add_argument('--nu', type=float, nargs='*', default=POISSON_RATIOS)
    parser.add_argument('--overlaps', type=float, nargs='*', default=OVERLAPS)
    arguments = parser.parse_args()
    table = csv.writer(sys.stdout, lineterminator='\n')
    table.writerow(['case', 'poisson_ratio', 'load', 'plate', 'count', 'x', 'y', 'z', 'overlap', 'force'])
    for name, normals, shares in cases():
        if arguments.case and name not in arguments.case:
            continue
        mesh = Mesh(arguments.bricks, arguments.bricks, mirrors_of(name))
        for nu in arguments.nu:
            table.writerows(rows_of(mesh, name, normals, shares, nu, arguments.linear, arguments.overlaps))
            sys.stdout.flush()


if __name__ == '__main__':
    main()
