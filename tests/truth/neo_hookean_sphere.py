"""One neo-Hookean sphere between rigid frictionless plates by finite elements: total Lagrangian, radius and E are 1.

Energy per undeformed volume mu/2 (J^-2/3 I1 - 3) + K/2 (J - 1)^2. Quadratic bricks with 20 nodes and 2x2x2 integration
points, which do not lock at nu = 0.49. Penalty contact: a stiff spring per undeformed area at the integration points of
the surface."""
import itertools

import cvxopt
import cvxopt.cholmod
import numpy as np
import scipy.sparse as sp

CORNERS = np.array([[i, j, k] for k in (-1, 1) for j in (-1, 1) for i in (-1, 1)], float)
EDGES = np.array([p for p in itertools.product((-1, 0, 1), repeat=3) if sum(x == 0 for x in p) == 1], float)
NODES = np.vstack([CORNERS, EDGES])
STIFFNESS_OF_PLATE = 10000.0  # of the springs, over the shear modulus and R


def brick_shapes(points):
    """Shape functions and their gradients, [point, node] and [point, node, 3]."""
    value, slope = np.empty((len(points), 20)), np.empty((len(points), 20, 3))
    for n, node in enumerate(NODES):
        f = np.where(node == 0, 1 - points**2, 1 + points * node)
        df = np.where(node == 0, -2 * points, node)
        if n < 8:
            g, dg = points @ node - 2, node
            value[:, n] = f.prod(1) * g / 8
        else:
            value[:, n] = f.prod(1) / 4
        for a in range(3):
            rest = np.delete(f, a, 1).prod(1)
            slope[:, n, a] = (rest * df[:, a] * g + f.prod(1) * dg[a]) / 8 if n < 8 else rest * df[:, a] / 4
    return value, slope


def face_shapes(points):
    """Shape functions on the brick's face zeta = 1, for its eight nodes: [point, node] and [point, node, 2]."""
    on_face = [n for n, node in enumerate(NODES) if node[2] == 1]
    value, slope = brick_shapes(np.column_stack([points, np.ones(len(points))]))
    return value[:, on_face], slope[:, on_face, :2]


def gauss(count, dimensions):
    x, w = np.polynomial.legendre.leggauss(count)
    points = np.array(list(itertools.product(x, repeat=dimensions)))
    return points, np.array([np.prod(c) for c in itertools.product(w, repeat=dimensions)])


def block(size, place):
    """Nodes of size[0] x size[1] x size[2] bricks, positioned by place(u) with u in [0, 1]^3: [brick, 20, 3]."""
    origins = np.array(list(itertools.product(*map(range, size))), float)
    u = (origins[:, None] + (NODES[None] + 1) / 2) / np.array(size)
    return place(u.reshape(-1, 3)).reshape(-1, 20, 3)


def octant(n, layers):
    """Bricks of the octant x, y, z > 0 of the sphere, a core cube and three shells; those at the surface last."""
    def core(u):
        largest = u.max(1, keepdims=True)
        length = np.linalg.norm(u, axis=1, keepdims=True)
        return .5 * u * (.65 + .35 * largest / np.where(length > 0, length, 1))

    def shell(axis):
        def place(u):
            face = np.insert(u[:, :2], axis, 1, axis=1)
            ray = np.insert(np.tan(np.pi / 4 * u[:, :2]), axis, 1, axis=1)
            outer = ray / np.linalg.norm(ray, axis=1, keepdims=True)
            t = 1 - (1 - u[:, 2:])**1.3  # thinner towards the surface
            return (1 - t) * core(face) + t * outer
        return place

    bricks = [block((n, n, n), core)]
    for axis in range(3):
        made = block((n, n, layers), shell(axis))
        if axis == 1:  # right-handed
            made = flipped(made)
        bricks.append(made)
    return np.vstack(bricks)


def flipped(bricks):
    """The same bricks with the first two local axes exchanged."""
    order = [int(np.flatnonzero((NODES == node[[1, 0, 2]]).all(1))[0]) for node in NODES]
    return bricks[:, order]


class Mesh:
    """The sphere, or its part on the positive side of the mirror planes in `mirrors`."""

    def __init__(self, n, layers, mirrors=(0, 1, 2)):
        self.mirrors = mirrors
        first = octant(n, layers)
        parts = []
        for signs in itertools.product((1, -1), repeat=3):
            if any(signs[a] < 0 for a in mirrors):
                continue
            part = first * np.array(signs)
            parts.append(flipped(part) if np.prod(signs) < 0 else part)
        bricks = np.vstack(parts)
        flat = bricks.reshape(-1, 3)
        _, index, inverse = np.unique(np.round(flat, 7) + 0., axis=0, return_index=True, return_inverse=True)
        self.position = flat[index]
        self.bricks = inverse.reshape(-1, 20)
        self._volume_points()
        self._surface_points()

    def _volume_points(self):
        points, weight = gauss(2, 3)
        _, slope = brick_shapes(points)
        jacobian = np.einsum('qna,enb->eqba', slope, self.position[self.bricks])
        self.weight = np.linalg.det(jacobian) * weight
        assert (self.weight > 0).all()
        self.gradient = np.einsum('qna,eqab->eqnb', slope, np.linalg.inv(jacobian))

    def _surface_points(self):
        on_face = [n for n, node in enumerate(NODES) if node[2] == 1]
        faces = self.bricks[:, on_face]
        faces = faces[(np.abs(np.linalg.norm(self.position[faces], axis=2) - 1) < 1e-9).all(1)]
        points, weight = gauss(4, 2)
        self.face_value, slope = face_shapes(points)
        tangent = np.einsum('qna,fnb->fqab', slope, self.position[faces])
        normal = np.cross(tangent[:, :, 0], tangent[:, :, 1])
        self.faces, self.face_weight = faces, np.linalg.norm(normal, axis=2) * weight
        self.face_point = np.einsum('qn,fnb->fqb', self.face_value, self.position[faces])


class Sphere:
    """Static displacements between plates; `linear`: Hooke's law for small strain."""

    def __init__(self, mesh, poisson_ratio, linear=False):
        self.mesh, self.linear = mesh, linear
        self.mu = 1 / (2 * (1 + poisson_ratio))
        self.bulk = 1 / (3 * (1 - 2 * poisson_ratio))
        self.spring = STIFFNESS_OF_PLATE * self.mu
        self.u = np.zeros_like(mesh.position)
        self.dof = (3 * mesh.bricks[:, :, None] + np.arange(3)).reshape(-1, 60)
        free = np.ones_like(mesh.position, bool)
        for axis in mesh.mirrors:
            free[np.abs(mesh.position[:, axis]) < 1e-9, axis] = False
        self.free = free.ravel()
        self._plan()

    def _plan(self):
        """Indices of the bricks' matrix entries in the lower triangle of the sparse matrix."""
        number = np.full(self.free.size, -1)
        number[self.free] = np.arange(self.free.sum())
        local = number[self.dof]
        rows, columns = np.repeat(local, 60, 1).ravel(), np.tile(local, (1, 60)).ravel()
        self.keep = (rows >= columns) & (columns >= 0)
        self.rows, self.columns, self.number = rows[self.keep], columns[self.keep], number
        self.size = int(self.free.sum())

    def _bulk_terms(self, u, tangent):
        m = self.mesh
        H = np.einsum('eni,eqnj->eqij', u[m.bricks], m.gradient)
        if self.linear:
            strain = (H + H.swapaxes(2, 3)) / 2
            trace = np.trace(strain, axis1=2, axis2=3)
            lame = self.bulk - 2 * self.mu / 3
            density = self.mu * (strain**2).sum((2, 3)) + lame / 2 * trace**2
            P = 2 * self.mu * strain + lame * trace[..., None, None] * np.eye(3)
            A = None
            if tangent:
                d = np.eye(3)
                A = (self.mu * (np.einsum('ik,jl->ijkl', d, d) + np.einsum('il,jk->ijkl', d, d)) +
                     lame * np.einsum('ij,kl->ijkl', d, d)).reshape(9, 9)[None, None]
                A = np.broadcast_to(A, H.shape[:2] + (9, 9))
            return density, P, A
        F = H + np.eye(3)
        J = np.linalg.det(F)
        if (J <= 0).any():
            return None
        G = np.linalg.inv(F).swapaxes(2, 3)  # F^-T
        I1, p = (F**2).sum((2, 3)), self.mu * J**(-2 / 3)
        density = (p * I1 - 3 * self.mu) / 2 + self.bulk / 2 * (J - 1)**2
        s = -p * I1 / 3 + self.bulk * (J - 1) * J
        P = p[..., None, None] * F + s[..., None, None] * G
        if not tangent:
            return density, P, None
        f, g = F.reshape(F.shape[:2] + (9,)), G.reshape(G.shape[:2] + (9,))
        gt = np.einsum('eqil,eqkj->eqijkl', G, G).reshape(F.shape[:2] + (9, 9))  # -d(F^-T)/dF
        A = p[..., None, None] * np.eye(9) - (2 / 3 * p)[..., None, None] * (
            f[..., :, None] * g[..., None, :] + g[..., :, None] * f[..., None, :])
        A += (2 / 9 * p * I1 + self.bulk * (2 * J - 1) * J)[..., None, None] * g[..., :, None] * g[..., None, :]
        A -= s[..., None, None] * gt
        return density, P, A

    def _gaps(self, u, normal, distance):
        m = self.mesh
        x = (m.position + u)[m.faces]
        return np.einsum('fni,i,qn->fq', x, normal, m.face_value) - distance

    def energy(self, plates, u):
        terms = self._bulk_terms(u, False)
        if terms is None:
            return np.inf
        total = (terms[0] * self.mesh.weight).sum()
        for normal, distance in plates:
            g = np.maximum(self._gaps(u, normal, distance), 0)
            total += self.spring / 2 * (g**2 * self.mesh.face_weight).sum()
        return total + self.hold * (u**2).sum() / 2

    def system(self, plates, u):
        """Gradient of the energy and its sparse second derivative."""
        m = self.mesh
        _, P, A = self._bulk_terms(u, True)
        force = np.zeros_like(u)
        np.add.at(force, m.bricks, np.einsum('eqij,eqnj,eq->eni', P, m.gradient, m.weight))
        matrix = np.zeros((len(m.bricks), 60, 60))
        for q in range(8):  # one point at a time, to save memory
            B = np.zeros((len(m.bricks), 9, 60))
            for i in range(3):
                B[:, 3 * i:3 * i + 3, i::3] = m.gradient[:, q].swapaxes(1, 2)
            AB = np.matmul(A[:, q] * m.weight[:, q, None, None], B)
            matrix += np.matmul(B.swapaxes(1, 2), AB)
        value = [matrix.ravel()[self.keep]]
        rows, columns = [self.rows], [self.columns]
        for normal, distance in plates:
            g = self._gaps(u, normal, distance)
            w = np.where(g > 0, self.spring * m.face_weight, 0)
            touched = np.flatnonzero(w.any(1))
            if not len(touched):
                continue
            pressed = np.einsum('fq,qn->fn', (w * np.maximum(g, 0))[touched], m.face_value)
            np.add.at(force, m.faces[touched], pressed[..., None] * normal)
            k = np.einsum('fq,qn,qm->fnm', w[touched], m.face_value, m.face_value)
            k = np.einsum('fnm,i,j->fnimj', k, normal, normal).reshape(len(touched), -1)
            local = self.number[(3 * m.faces[touched][:, :, None] + np.arange(3)).reshape(len(touched), 24)]
            r, c = np.repeat(local, 24, 1), np.tile(local, (1, 24))
            keep = (r >= c) & (c >= 0)
            value.append(k[keep])
            rows.append(r[keep])
            columns.append(c[keep])
        matrix = sp.csc_matrix((np.concatenate(value), (np.concatenate(rows), np.concatenate(columns))),
                               shape=(self.size, self.size))
        matrix += self.hold * sp.identity(self.size, format='csc')
        return force.ravel()[self.free] + self.hold * u.ravel()[self.free], sp.tril(matrix, format='coo')

    hold = 1e-7  # spring from every node to its original position: fixes free rotations

    def _newton_step(self, gradient, matrix):
        """A descent direction; if the second derivative is not positive definite, a multiple of the unit matrix is
        added."""
        for more in (0, 1e-5, 1e-4, 1e-3, 1e-2):
            data = matrix.data + more * (matrix.row == matrix.col)
            lower = cvxopt.spmatrix(cvxopt.matrix(data), matrix.row.tolist(), matrix.col.tolist(), (self.size, self.size))
            step = cvxopt.matrix(-gradient)
            try:
                cvxopt.cholmod.linsolve(lower, step)
                return np.array(step).ravel()
            except ArithmeticError:
                continue
        return None

    def press(self, plates):
        """Like `solve`; a sphere without a mirror first moves to its equilibrium between softer plates."""
        if len(self.mesh.mirrors) < 2:
            stiff, self.spring = self.spring, .03 * self.spring
            found = self.solve(plates, 60)
            self.spring = stiff
            if not found:
                return False
        return self.solve(plates)

    def solve(self, plates, most=40, tolerance=1e-7):
        """Newton's method from the present displacements; True if it converged."""
        value = self.energy(plates, self.u)
        for _ in range(most):
            gradient, matrix = self.system(plates, self.u)
            step = self._newton_step(gradient, matrix)
            if step is None:
                return False
            slope = gradient @ step
            full = np.zeros(self.u.size)
            full[self.free] = step
            full = full.reshape(self.u.shape)
            length = 1.0
            while length > 1e-4:
                after = self.energy(plates, self.u + length * full)
                if after <= value + 1e-4 * length * slope + 1e-15:
                    break
                length /= 2
            else:
                return False
            self.u, value = self.u + length * full, after
            if -slope < tolerance**2 * max(value, 1e-8) * 1e4:
                return True
        return False

    def contacts(self, plates):
        """Force of every plate on the whole sphere and its force-weighted mean penetration, at the present
        displacements."""
        copies = 2**len(self.mesh.mirrors)
        forces, yields = [], []
        for normal, distance in plates:
            g = np.maximum(self._gaps(self.u, normal, distance), 0)
            pressed = self.spring * g * self.mesh.face_weight
            image = copies / 2**sum(abs(normal[a]) < 1e-9 for a in self.mesh.mirrors)
            forces.append(pressed.sum() * copies / image)
            yields.append((pressed * g).sum() / pressed.sum() if pressed.sum() else 0.)
        return np.array(forces), np.array(yields)

    def centre(self):
        """Displacement of the centre of mass; zero by symmetry along an axis with a mirror plane."""
        m = self.mesh
        at_points = np.einsum('qn,enb->eqb', brick_shapes(gauss(2, 3)[0])[0], self.u[m.bricks])
        mean = np.einsum('eqb,eq->b', at_points, m.weight) / m.weight.sum()
        return np.where([a in m.mirrors for a in range(3)], 0, mean)

    def reach(self, normal):
        """Distance of the surface beyond R along a normal."""
        m = self.mesh
        return ((m.position + self.u)[m.faces] @ normal).max() - 1
