#!/usr/bin/env python3
"""Neo-Hookean spheres in contact: writes neo_hookean_chain.csv. Finite elements as in neo_hookean_sphere.py.

A stiff spring keeps surface points of the first sphere out of the second sphere above it. Spheres are in a row along
z."""
import csv
import sys

import numpy as np
import scipy.sparse as sp

from neo_hookean_sphere import Mesh, Sphere, face_shapes

X, Y, Z = np.eye(3)
POISSON_RATIOS = (.3, .49)
BRICKS = 4


class Spheres(Mesh):
    """Two meshed spheres; the second one has another radius and is above the first. Symmetric about x = 0 and y = 0."""

    def __init__(self, first, second, radius, height):
        self.mirrors = (0, 1)
        self.first_nodes, self.first_faces = len(first.position), len(first.faces)
        self.position = np.vstack([first.position, radius * second.position + height * Z])
        self.bricks = np.vstack([first.bricks, second.bricks + self.first_nodes])
        self.faces = np.vstack([first.faces, second.faces + self.first_nodes])
        self.face_value = first.face_value
        self.face_weight = np.vstack([first.face_weight, radius**2 * second.face_weight])
        self.weight = np.vstack([first.weight, radius**3 * second.weight])
        self.gradient = np.vstack([first.gradient, second.gradient / radius])


class Chain(Sphere):
    """Two spheres between plates. `held`: the equator of the first sphere is a mirror plane, and only its upper half is
    meshed."""

    def __init__(self, mesh, poisson_ratio, height, held):
        super().__init__(mesh, poisson_ratio)
        if held:
            free = self.free.reshape(-1, 3)
            on_mirror = (np.arange(len(free)) < mesh.first_nodes) & (np.abs(mesh.position[:, 2]) < 1e-9)
            free[on_mirror, 2] = False
            self._plan()
        near = np.linalg.norm(mesh.position[mesh.faces].mean(1)[:, :2], axis=1) < .85
        middle = mesh.position[mesh.faces].mean(1)[:, 2]
        owner = np.arange(len(mesh.faces)) < mesh.first_faces
        self.below = np.flatnonzero(owner & near & (middle > .3))
        self.above = np.flatnonzero(~owner & near & (middle < height))

    def _gaps(self, u, normal, distance):
        gaps = super()._gaps(u, normal, distance)
        if abs(normal[2]) < .5:  # at the side: touches only the first sphere
            gaps[self.mesh.first_faces:] = -1
        return gaps

    def _meet(self, u):
        """For every point of the first sphere inside the second: its face and index there, the other face, depth, slope
        vector, and the shape functions of the other face."""
        m = self.mesh
        x = m.position + u
        corners = x[m.faces[self.above]]
        low, high = corners[..., :2].min(1), corners[..., :2].max(1)
        points = np.einsum('qn,fnb->fqb', m.face_value, x[m.faces[self.below]])
        at = points[..., None, :2]
        row, q, column = np.nonzero(((low - .02 < at) & (at < high + .02)).all(-1) & (points[..., None, 2] > corners[..., 2].min(1) - .05))
        local, nodes, target = np.zeros((len(row), 2)), corners[column], points[row, q]
        for _ in range(10):
            value, slope = face_shapes(local)
            tangent = np.einsum('pna,pnb->pab', slope, nodes)
            miss = np.einsum('pn,pnb->pb', value, nodes) - target
            local = np.clip(local - np.linalg.solve(tangent[:, :, :2].swapaxes(1, 2), miss[:, :2, None])[..., 0], -1.3, 1.3)
        inside = (np.abs(local).max(1) < 1 + 1e-9) & (np.abs(miss[:, :2]).max(1) < 1e-9) & (miss[:, 2] < 0)
        rise = np.linalg.solve(tangent[:, :, :2], tangent[:, :, 2:])[..., 0]
        slope = np.column_stack([-rise, np.ones(len(rise))])
        return [a[inside] for a in (self.below[row], q, self.above[column], -miss[:, 2], slope, value)]

    def energy(self, plates, u):
        total = super().energy(plates, u)
        if not np.isfinite(total):
            return total
        face, q, _, depth, _, _ = self._meet(u)
        return total + self.spring / 2 * (depth**2 * self.mesh.face_weight[face, q]).sum()

    def system(self, plates, u):
        gradient, matrix = super().system(plates, u)
        force = np.zeros_like(u)
        value, rows, columns = [], [], []
        for face, q, other, depth, slope, shape in zip(*self._meet(u)):
            w = self.spring * self.mesh.face_weight[face, q]
            nodes = np.concatenate([self.mesh.faces[face], self.mesh.faces[other]])
            moves = np.concatenate([self.mesh.face_value[q], -shape])[:, None] * slope
            np.add.at(force, nodes, w * depth * moves)
            local = self.number[(3 * nodes[:, None] + np.arange(3)).ravel()]
            r, c = np.repeat(local, len(local)), np.tile(local, len(local))
            keep = (r >= c) & (c >= 0)
            value.append(w * np.outer(moves.ravel(), moves.ravel()).ravel()[keep])
            rows.append(r[keep])
            columns.append(c[keep])
        if value:
            matrix = matrix + sp.coo_matrix((np.concatenate(value), (np.concatenate(rows), np.concatenate(columns))), matrix.shape)
        return gradient + force.ravel()[self.free], sp.coo_matrix(sp.csc_matrix(matrix))


def loads(chain, plates_at, overlaps):
    """Solves the loads one after the other; returns the plates' forces on whole spheres, in units of E and the first
    radius."""
    start = 0.
    for overlap in overlaps:
        step = overlap - start
        while start < overlap - 1e-9:
            before, to = chain.u, min(start + step, overlap)
            if chain.solve(plates_at(to)):
                start = to
                continue
            chain.u, step = before, step / 2
            if step < 1e-3:
                return
        yield overlap, chain.contacts(plates_at(overlap))


def unequal(poisson_ratio, radius):
    """Two spheres of unequal radii between two plates; `overlap` is the approach of the plates."""
    half = Mesh(BRICKS, BRICKS, (0, 1))
    height = 1 + radius
    chain = Chain(Spheres(half, half, radius, height), poisson_ratio, height, False)
    for overlap, (forces, gives) in loads(chain, lambda d: [(-Z, 1 - d / 2), (Z, height + radius - d / 2)], (.05, .1, .15, .2, .3)):
        yield ['unequal', poisson_ratio, radius, f'{overlap - gives.sum():.6g}', f'{forces[0]:.6g}', 0, 0]


def three(poisson_ratio, side):
    """Three equal spheres between two plates; the middle one is between four more plates, whose approach is `side`
    times as large."""
    chain = Chain(Spheres(Mesh(BRICKS, BRICKS), Mesh(BRICKS, BRICKS, (0, 1)), 1, 2), poisson_ratio, 2, True)
    for overlap, (forces, gives) in loads(chain, lambda d: [(Z, 3 - d), (X, 1 - side * d), (Y, 1 - side * d)], (.05, .1, .15, .2, .3)):
        apart = overlap - gives[0], side * overlap - gives[1]
        force = forces[0], 2 * forces[1]  # the mesh of the middle sphere is half of a quarter
        yield ['three', poisson_ratio, side, *(f'{x:.6g}' for pair in zip(apart, force) for x in pair)]


def main():
    wanted = sys.argv[1:] or ('unequal', 'three')
    table = csv.writer(sys.stdout, lineterminator='\n')
    table.writerow(['case', 'poisson_ratio', 'parameter', 'overlap', 'force', 'side_overlap', 'side_force'])
    for nu in POISSON_RATIOS:
        for rows in [{'unequal': lambda: unequal(nu, .6), 'three': lambda: three(nu, .5)}[name]() for name in wanted]:
            for row in rows:
                table.writerow(row)
                sys.stdout.flush()


if __name__ == '__main__':
    main()
