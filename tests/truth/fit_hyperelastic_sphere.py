#!/usr/bin/env python3
"""Fits the coefficients of the contact model hyperelastic_sphere to neo_hookean_plates.csv and to filled cells, and prints
them as C++."""
import argparse
import csv
import pathlib

import numpy as np
from scipy.optimize import least_squares

from elastic_sphere_law import Law, SelfTerm
from filled_cells import filled_cells
from hyperelastic_law import Coefficients, by_invariants, hessian, invariants, uniform_work
from neo_hookean_plates import images, mirrors_of

FOLDER = pathlib.Path(__file__).resolve().parent
POISSON_RATIOS = .3, .4, .49
FITTED = {'two_plates', 'four_square', 'six_plates', 'twelve_icosahedral',
          'eight_plus_two', 'unequal_fours', 'eight_plus_pairs', 'two_fours',
          'random_seven_b', 'random_eight_b', 'random_eight_c', 'random_nine_b', 'random_nine_c', 'random_nine_d',
          'random_ten', 'random_ten_b', 'asymmetric_eight_b'}  # the others are used to evaluate the fit
LEAST_LOAD, LEAST_OVERLAP = .04, .029  # smaller ones are not resolved by the mesh
LARGEST_PRESSURE, HIGH_PRESSURE = 1.05, .3
HIGH_WEIGHT = .3  # of loads above HIGH_PRESSURE at nu 0.49, and of filled cells
STEEPEST = 3  # d ln F / d ln overlap above which, close to filled volume, the overlap is fitted instead of the force
FILLED_PRESSURE, FILLED_POISSON_RATIO = 20, .49  # of the filled cells; uniform compression is subtracted
SHAPE_WEIGHT = .3  # of the differences between the overlaps of a filled cell, relative to their mean
START = Coefficients(1, 1.2, 1.8, (0, .3, -.5), .1, .5)


class Row:
    """The plates of one load: direction, overlap and force of each, and which of them represent their mirror images."""

    def __init__(self, name, poisson_ratio, load):
        self.name, self.poisson_ratio, self.load = name, poisson_ratio, load
        self.normals, self.overlap, self.force, self.first = [], [], [], []

    def add(self, row):
        self.first.append(len(self.normals))
        for normal in images(np.array([float(row[axis]) for axis in 'xyz']), mirrors_of(self.name)):
            self.normals.append(normal)
            self.overlap.append(float(row['overlap']))
            self.force.append(float(row['force']))

    def complete(self, self_term):
        self.normals, self.overlap, self.force = map(np.array, (self.normals, self.overlap, self.force))
        self.law = Law(self.poisson_ratio, self.normals, self_term)
        self.pressure = self.force.sum() / (4 * np.pi)
        values, slopes = invariants(self.law, self.normals, self.force[None])
        self.values, self.slopes = values[:, 0], slopes[:, 0]
        self.judged = [c for c in self.first if self.overlap[c] > LEAST_OVERLAP]

    def linearise(self, c):
        """Relative change of the forces by that of the overlaps; a sphere without mirrors moves to equilibrium."""
        mirrors, count = len(mirrors_of(self.name)), len(self.force)
        ways = self.normals if mirrors < 3 else np.zeros((count, 0))
        system = np.block([[hessian(self.law, self.normals, self.force, c), ways],
                           [ways.T, np.zeros((ways.shape[1], ways.shape[1]))]])
        self.by_overlap = np.linalg.pinv(system, rcond=1e-12)[:count, :count] / self.force[:, None]
        self.steepness = np.abs(self.by_overlap @ self.overlap).mean()

    def misses(self, by_invariant):
        """Relative error of the model's force at the finite elements' overlap, to first order."""
        return (self.by_overlap @ (self.overlap - by_invariant @ self.slopes))[self.judged]

    def weight(self):
        high = self.pressure > HIGH_PRESSURE and self.poisson_ratio == .49
        return (HIGH_WEIGHT if high else 1) / max(1, self.steepness / STEEPEST) / np.sqrt(len(self.judged))


def read():
    rows = {}
    with open(FOLDER / 'neo_hookean_plates.csv', newline='') as table:
        for row in csv.DictReader(table):
            if row['plate'] != 'equator' and float(row['load']) > LEAST_LOAD:
                key = row['case'], float(row['poisson_ratio']), float(row['load'])
                rows.setdefault(key, Row(*key)).add(row)
    self_terms = {nu: SelfTerm(nu) for nu in POISSON_RATIOS}
    for row in rows.values():
        row.complete(self_terms[row.poisson_ratio])
    return list(rows.values())


class Cell:
    """A polyhedron whose forces are proportional to the areas of its facets, with the mean pressure FILLED_PRESSURE."""

    def __init__(self, normals, shares, overlap, self_term):
        self.normals, self.shares, self.overlap = normals, shares, overlap
        self.law = Law(FILLED_POISSON_RATIO, normals, self_term)
        self.values, self.slopes = (x[:, 0] for x in invariants(self.law, normals, self.force(FILLED_PRESSURE)[None]))
        root = np.sqrt(shares)[:, None]
        self.moves = normals @ np.linalg.pinv(root * normals) * root.T  # part of overlaps that moves the polyhedron

    def force(self, pressure):
        return 4 * np.pi * pressure * self.shares

    def misses(self, by_invariant):
        """Relative error of the mean overlap, and of each overlap less the mean, for the best position."""
        mean, found = self.shares @ self.overlap, by_invariant @ self.slopes
        of_each = found - self.overlap - self.moves @ (found - self.overlap)
        return np.append(self.shares @ found / mean - 1, SHAPE_WEIGHT * np.sqrt(self.shares) * of_each / mean)


def cells_of():
    self_term = SelfTerm(FILLED_POISSON_RATIO)
    return [Cell(*made, self_term) for made in filled_cells()]


def of_poisson_ratio(x, nu):
    i = 3 + 5 * POISSON_RATIOS.index(nu)
    return Coefficients(*x[:3], tuple(x[i:i + 3]), *x[i + 3:i + 5])


def by_invariants_of(samples, nu, c):
    """Derivatives of the energy for many loads or cells: [sample, invariant]."""
    return by_invariants(np.array([s.values for s in samples]).T, nu, c).T


def residuals(x, rows, cells):
    parts = []
    for nu in POISSON_RATIOS:
        of_nu = [row for row in rows if row.poisson_ratio == nu]
        for row, slopes in zip(of_nu, by_invariants_of(of_nu, nu, of_poisson_ratio(x, nu))):
            parts.append(row.weight() * row.misses(slopes))
    slopes = by_invariants_of(cells, FILLED_POISSON_RATIO, of_poisson_ratio(x, FILLED_POISSON_RATIO))
    slopes[:, 0] -= 4 * np.pi * uniform_overlap(FILLED_PRESSURE)
    weight = HIGH_WEIGHT / np.sqrt(len(cells) / 20)
    return np.concatenate(parts + [weight * cell.misses(s) for cell, s in zip(cells, slopes)])


def uniform_overlap(P):
    """Of the filled cells."""
    return uniform_work(np.array(P + 1e-20j), FILLED_POISSON_RATIO).imag / 1e-20


def fit(rows, cells):
    """Three couplings; own coefficients, volume and shear term for each Poisson ratio. The errors are linearised with the
    coefficients of the previous fit."""
    rows = [row for row in rows if row.name in FITTED and row.pressure < LARGEST_PRESSURE]
    x = np.array([*START[:3]] + [*START.own, START.volume, START.shear] * 3)
    for _ in range(3):
        for row in rows:
            row.linearise(of_poisson_ratio(x, row.poisson_ratio))
        x = least_squares(residuals, x, loss='soft_l1', f_scale=.02, x_scale='jac', args=(rows, cells), max_nfev=30).x
    return x


def report(rows, x):
    """Largest error up to overlap/R 0.10, 0.15 and 0.20, for loads with P up to 0.12 E, up to 0.3 E and above."""
    for row in rows:
        row.linearise(of_poisson_ratio(x, row.poisson_ratio))
    for name in dict.fromkeys(row.name for row in rows):
        worst = np.zeros((3, 3))
        for row in (row for row in rows if row.name == name and row.pressure < 1):
            slopes = by_invariants_of([row], row.poisson_ratio, of_poisson_ratio(x, row.poisson_ratio))[0]
            band = np.searchsorted((.12, .3), row.pressure)
            for d, miss in zip(row.overlap[row.judged], row.misses(slopes)):
                place = np.searchsorted((.1005, .1505, .2005), d)
                if place < 3 and abs(miss) > abs(worst[band, place]):
                    worst[band, place] = miss
        print(f'{name:19}' + ' '.join(f'{100 * miss:6.1f}' for miss in worst.ravel()) + ('  fitted' if name in FITTED else ''))


def report_convexity(rows, cells, x):
    """Smallest over largest eigenvalue of the energy's second derivative: positive if forces have one solution."""
    def smallest(samples, force_of, nu_of):
        ratios = []
        for s in samples:
            values = np.linalg.eigvalsh(hessian(s.law, s.normals, force_of(s), of_poisson_ratio(x, nu_of(s))))
            ratios.append(values[0] / values[-1])
        return min(ratios)

    print('convexity: finite elements %.4f' % smallest(rows, lambda s: s.force, lambda s: s.poisson_ratio), end='')
    for P in (.5, 1, 3):
        print(', filled cells at P = %g: %.4f' % (P, smallest(cells, lambda s: s.force(P), lambda s: FILLED_POISSON_RATIO)), end='')
    print()


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--report', action='store_true', help='worst error of each case instead, to first order [%%]: overlap to 0.10, 0.15, 0.20; P to 0.12 E, to 0.3 E, to E')
    arguments = parser.parse_args()
    rows, cells = read(), cells_of()
    x = fit(rows, cells)
    if arguments.report:
        report(rows, x)
        report_convexity(rows, cells, x)
        return
    for nu in POISSON_RATIOS:
        c = of_poisson_ratio(x, nu)
        print('    {%.2f, {%.4f, %.4f, %.4f}, %.4f, %.4f},' % (nu, *c.own, c.volume, c.shear))
    print('coupling = %.4f, hertz = %.4f, size = %.4f' % (x[1], x[0], x[2]))


if __name__ == '__main__':
    main()
