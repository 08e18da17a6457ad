#!/usr/bin/env python3
"""One elastic sphere between rigid frictionless plates, solved numerically. See README.md."""
import argparse
import csv
import itertools
import sys

import numpy as np

import axisymmetric_caps
import full_caps

X, Y, Z = [[1, 0, 0], [-1, 0, 0]], [[0, 1, 0], [0, -1, 0]], [[0, 0, 1], [0, 0, -1]]
SIGNS = (1, -1)
TETRAHEDRON = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
CUBE = list(itertools.product(SIGNS, repeat=3))
FCC = [v for a in SIGNS for b in SIGNS for v in ([a, b, 0], [a, 0, b], [0, a, b])]
TRIANGLE = [[np.cos(t), np.sin(t), 0] for t in (0, 2 * np.pi / 3, 4 * np.pi / 3)]
RECTANGLE = [[np.sin(t), 0, np.cos(t)] for t in np.radians([35, -35, 145, 215])]

# name: groups of equally loaded plates, and the overlaps to solve for (one per group)
ARRANGEMENTS = {
    'two_plates': ([Z], [(.02,), (.05,), (.1,), (.15,)]),
    'three_triangle': ([TRIANGLE], [(.05,), (.1,)]),
    'four_square': ([X + Y], [(.02,), (.05,), (.1,), (.15,)]),
    'tetrahedron': ([TETRAHEDRON], [(.02,), (.05,), (.1,), (.15,)]),
    'two_plus_two': ([Z, X], [(.1, .0), (.1, .03), (.1, .05), (.05, .1), (.15, .05)]),
    'two_plus_four': ([Z, X + Y], [(.1, .05), (.05, .1), (.1, 0.)]),
    'two_plus_triangle': ([Z, TRIANGLE], [(.1, .05), (.05, .05)]),
    'rect_70deg': ([RECTANGLE], [(.02,), (.05,), (.1,)]),
    'six_plates': ([Z + X + Y], [(.02,), (.05,), (.1,), (.15,)]),
    'eight_cube': ([CUBE], [(.02,), (.05,), (.1,)]),
    'twelve_fcc': ([FCC], [(.01,), (.02,), (.04,), (.06,), (.08,)]),
}
POISSON_RATIOS = (0., .2, .3, .45, .49, .5)
IN_FINITE_ELEMENTS = {'two_plates': (.3, .49), 'six_plates': (.3, .49)}  # solved by finite elements, not repeated here


def rotations_of_cube():
    for order in itertools.permutations(range(3)):
        for signs in itertools.product(SIGNS, repeat=3):
            matrix = np.eye(3)[list(order)] * np.array(signs)[:, None]
            if np.linalg.det(matrix) > 0:
                yield matrix


def turn_about_z(angle):
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


OCTAHEDRAL = list(rotations_of_cube())
# Arrangements whose contact areas are not round: their symmetry, and the size of a cap over sqrt(overlap).
FULL = {
    'three_triangle': ([turn_about_z(2 * np.pi * i / 3) for i in range(3)], 1.3),
    'four_square': (OCTAHEDRAL, 1.3),
    'rect_70deg': ([np.diag(d) for d in ([1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1])], 1.3),
    'eight_cube': (OCTAHEDRAL, 1.45),
    'twelve_fcc': (OCTAHEDRAL, 1.5),
}


def solve(name, poisson_ratio, overlaps):
    """Force on a plate of every group of the arrangement, in E R^2."""
    groups, _ = ARRANGEMENTS[name]
    if name in FULL:
        rotations, reach = FULL[name]
        return [full_caps.solve(poisson_ratio, groups[0], overlaps[0], rotations, reach)]
    return axisymmetric_caps.solve(poisson_ratio, groups, overlaps)


def write_table(out, names):
    table = csv.writer(out, lineterminator='\n')
    table.writerow(['case', 'poisson_ratio', 'overlap1', 'overlap2', 'force1', 'force2'])
    for nu in POISSON_RATIOS:
        for name in names:
            if nu in IN_FINITE_ELEMENTS.get(name, ()):
                continue
            for overlaps in ARRANGEMENTS[name][1]:
                second = list(overlaps[1:]) or ['']
                forces = ['%.6g' % f for f in solve(name, nu, overlaps)] + ['']
                table.writerow([name, nu, overlaps[0], second[0], *forces[:2]])
                out.flush()


def compare(file):
    """Prints the force of this solver over that of a table with case, poisson_ratio, overlap_over_R,
    force_over_E_R2."""
    with open(file, newline='') as rows:
        for row in csv.DictReader(rows):
            nu, overlap = float(row['poisson_ratio']), float(row['overlap_over_R'])
            groups = ARRANGEMENTS[row['case']][0]
            reach = 1.2 if row['case'] == 'two_plates' else 1.45
            force = axisymmetric_caps.solve(nu, groups, [overlap], count=48, rim=min(.8, reach * np.sqrt(overlap)))[0]
            print('%-11s nu %.2f overlap %.3f  %.4f' % (row['case'], nu, overlap, force / float(row['force_over_E_R2'])))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    commands = parser.add_subparsers(dest='command', required=True)
    table = commands.add_parser('table', help='write the table of forces to the standard output')
    table.add_argument('case', nargs='*', metavar='CASE', help='of ' + ', '.join(ARRANGEMENTS) + '; all by default')
    check = commands.add_parser('compare', help='compare with a table of finite-element forces')
    check.add_argument('file')
    arguments = parser.parse_args()
    if arguments.command == 'compare':
        return compare(arguments.file)
    unknown = [name for name in arguments.case if name not in ARRANGEMENTS]
    if unknown:
        parser.error('unknown case %s; known: %s' % (', '.join(unknown), ', '.join(ARRANGEMENTS)))
    write_table(sys.stdout, arguments.case or list(ARRANGEMENTS))


if __name__ == '__main__':
    main()
