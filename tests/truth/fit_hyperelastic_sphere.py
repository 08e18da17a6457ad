#!/usr/bin/env python3
"""Fits the coefficients of the contact model hyperelastic_sphere to neo_hookean_plates.csv and prints them as C++."""
import argparse
import csv
import pathlib

import numpy as np
from scipy.optimize import least_squares

from elastic_sphere_law import LARGEST_RADIUS, Law, SelfTerm
from neo_hookean_plates import images, mirrors_of

FOLDER = pathlib.Path(__file__).resolve().parent
FITTED = ('two_plates', 'four_square', 'six_plates', 'twelve_icosahedral')  # the others are used to evaluate the fit
LEAST_LOAD = .04  # smaller loads are not resolved by the mesh
CUBIC = .7  # third coefficient of uniform compression, for p = K (1 - J) and force = area p
STEEPEST = 3  # d ln F / d ln overlap above which, close to filled volume, the overlap is fitted instead of the force


class Row:
    """The plates of one load: direction, overlap and force of each, and which of them represent their mirror images."""

    def __init__(self, name, load):
        self.name, self.load = name, load
        self.normals, self.overlap, self.force, self.first = [], [], [], []

    def add(self, row):
        self.first.append(len(self.normals))
        for normal in images(np.array([float(row[axis]) for axis in 'xyz']), mirrors_of(self.name)):
            self.normals.append(normal)
            self.overlap.append(float(row['overlap']))
            self.force.append(float(row['force']))

    def complete(self, self_term, poisson_ratio):
        self.normals, self.overlap, self.force = map(np.array, (self.normals, self.overlap, self.force))
        self.law = Law(poisson_ratio, self.normals, self_term)
        self.pressure = self.force.sum() / (4 * np.pi)
        stress = (self.normals.T * self.force) @ self.normals / (4 * np.pi)
        self.along = np.einsum('ci,ij,cj->c', self.normals, stress, self.normals) - self.pressure / 3
        self.deviator = (stress**2).sum() - self.pressure**2 / 3
        shares = (np.arange(40) + .5) / 40
        self.self_energy = -sum((s * self.force**2 / 40) @ (self.law.self_term(self.law.radius(s * self.force)) + self.law.uniform)
                                for s in shares)
        a = np.minimum(self.law.radius(self.force), LARGEST_RADIUS)
        self.own_powers = [(self.force**2 * a**n).sum() / (2 + n / 3) for n in range(3)]

    def own_energy(self, own):
        return self.self_energy + np.dot(own, self.own_powers)


def read(poisson_ratio):
    rows = {}
    with open(FOLDER / 'neo_hookean_plates.csv', newline='') as table:
        for row in csv.DictReader(table):
            if float(row['poisson_ratio']) == poisson_ratio and row['plate'] != 'equator':
                key = row['case'], float(row['load'])
                rows.setdefault(key, Row(*key)).add(row)
    self_term = SelfTerm(poisson_ratio)
    for row in rows.values():
        row.complete(self_term, poisson_ratio)
    for row in rows.values():  # relative force by overlap, along the loads of the case
        path = sorted((r for r in rows.values() if r.name == row.name), key=lambda r: r.load)
        at = path.index(row)
        low, high = path[max(at - 1, 0)], path[min(at + 1, len(path) - 1)]
        with np.errstate(divide='ignore', invalid='ignore'):
            row.slope = np.log(high.force / low.force) / np.log(high.overlap / low.overlap) / row.overlap
    return [row for row in rows.values() if row.load > LEAST_LOAD]


def powers(P, c):
    """1/(1 + c P), and its derivative."""
    return 1 / (1 + c * P), -c / (1 + c * P)**2


def overlaps(row, p):
    """Overlaps of the model, from the forces of the finite elements: the derivative of its energy by each force."""
    law, force, P = row.law, row.force, row.pressure
    own, (of_hertz, coupling, volume, shear) = p[:3], p[3:]
    squash, squash_slope = powers(P, of_hertz)
    g, g_slope = powers(P, coupling)
    a = law.radius(force)
    inside = np.minimum(a, LARGEST_RADIUS)
    hertz = 3 / 5 * force @ a**2
    moved = -force * (law.self_term(a) + law.uniform) + force * (own[0] + own[1] * inside + own[2] * inside**2)
    pairs, size, pairs_energy, size_energy = law.shear_by_others(force)
    second_energy = pairs_energy + row.own_energy(own)
    by_pressure = 2 / 3 * squash**(-1 / 3) * squash_slope * hertz + g_slope * second_energy
    by_pressure += 5 / 3 * g**(2 / 3) * g_slope * size_energy
    cubic = volume * P**2 + shear * row.deviator
    by_pressure -= 4 * np.pi * g**2 * (2 * volume * P**2 + cubic * (1 - 2 * coupling * P * g))
    x = 3 * (1 - 2 * law.poisson_ratio) * P
    uniform = x / 3 + x**2 / 3 + CUBIC * x**3
    sheared = -2 * shear * P * g**2 * row.along
    return squash**(2 / 3) * a**2 + g * (moved + pairs) + g**(5 / 3) * size + by_pressure / (4 * np.pi) + sheared + uniform


def misses(row, p):
    """Relative error of the model's force at the finite elements' overlap, to first order."""
    return ((row.overlap - overlaps(row, p)) * row.slope)[row.first]


def fit(tables):
    """Couplings of the Hertz part and of the rest; own coefficients, volume and shear term for each Poisson ratio."""
    rows = {nu: [row for row in table if row.name in FITTED] for nu, table in tables.items()}

    def residuals(x):
        return np.concatenate([misses(row, of_poisson_ratio(x, i)) / np.maximum(1, row.slope * row.overlap / STEEPEST)[row.first] /
                               np.sqrt(len(row.first)) for i, nu in enumerate(rows) for row in rows[nu]])

    return least_squares(residuals, [.8, 1.4] + [.03, 0, -.1, .3, 0] * len(rows), loss='soft_l1', f_scale=.02).x


def of_poisson_ratio(x, i):
    own = x[2 + 5 * i:5 + 5 * i]
    return [*own, x[0], x[1], *x[5 + 5 * i:7 + 5 * i]]


def report(poisson_ratio, rows, p):
    """Largest error up to overlap/R 0.10, 0.15 and 0.20, for loads with P below and above 0.12 E."""
    for name in dict.fromkeys(row.name for row in rows):
        worst = np.zeros((2, 3))
        for row in rows:
            for d, miss in zip(row.overlap[row.first], misses(row, p)) if row.name == name else ():
                place = int(np.searchsorted((.1005, .1505, .2005), d))
                if d > .03 and place < 3 and abs(miss) > abs(worst[int(row.pressure > .12), place]):
                    worst[int(row.pressure > .12), place] = miss
        print(f'{poisson_ratio} {name:19}' + ' '.join(f'{100 * miss:6.1f}' for miss in worst.ravel()) + ('  fitted' if name in FITTED else ''))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument('--report', action='store_true', help='worst error of each case instead [%%]: overlap to 0.10, 0.15, 0.20; P to 0.12 E, then above')
    arguments = parser.parse_args()
    tables = {nu: read(nu) for nu in (.3, .4, .49)}
    x = fit(tables)
    for i, (nu, rows) in enumerate(tables.items()):
        p = of_poisson_ratio(x, i)
        if arguments.report:
            report(nu, rows, p)
        else:
            print('    {%.2f, {%.4f, %.4f, %.4f}, %.4f, %.4f},' % (nu, *p[:3], *p[5:]))
    if not arguments.report:
        print('coupling = %.4f, of Hertz = %.4f' % (x[1], x[0]))


if __name__ == '__main__':
    main()
