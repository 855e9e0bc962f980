#!/usr/bin/env python3
"""Equilibrium of the Lomer-Cottrell lock without dynamics and with none of the code of ddfem.

Four arms from the pinned ends to the two triple nodes, which slide on the intersection of the glide planes, and the straight
sessile junction between them. Arms are polygons graded towards the triple nodes. Nodes of an arm move in its glide plane
across the chord of the arm. The weak Peach-Koehler forces of the lines' own non-singular stress (Cai et al., JMPS 54 (2006)
561, core radius a, no core energy besides) and of the applied stress vanish: Newton's method, Jacobian by differences. The
stress is raised in steps, each from the solution before. Units nm, MPa.

Segments at the triple node must not be much shorter than ten core radii: the arms attract each other there, and without a core
energy the line tension of so short a segment does not hold them apart.
"""
import argparse

import numpy as np

N1, N2 = np.array([1, 1, -1]) / 3 ** 0.5, np.array([1, 1, 1]) / 3 ** 0.5
E = np.array([-1, 1, 0]) / 2 ** 0.5                     # intersection of the glide planes
XI1, XI2 = np.array([-1, 2, 1]) / 6 ** 0.5, np.array([-2, 1, 1]) / 6 ** 0.5


def stress(x, start, end, b, mu, nu, a):
    """Stress tensors (n,3,3) at x (n,3), summed over segments start -> end (m,3) with Burgers vectors b (m,3)."""
    t = end - start
    length = np.linalg.norm(t, axis=1)
    t = t / length[:, None]
    r = x[:, None] - start[None]
    v2 = np.einsum('nmk,mk->nm', r, t)
    d = r - v2[..., None] * t
    v1 = v2 - length
    rho2 = (d ** 2).sum(-1) + a * a

    def between(f):                                     # int over the source of the derivative of f(v, R_a)
        return f(v2, np.sqrt(v2 ** 2 + rho2)) - f(v1, np.sqrt(v1 ** 2 + rho2))
    i3 = between(lambda v, s: v / (rho2 * s))
    i3v = between(lambda v, s: -1 / s)
    i5 = between(lambda v, s: v / (3 * rho2 * s ** 3) + 2 * v / (3 * rho2 ** 2 * s))
    i5v = between(lambda v, s: -1 / (3 * s ** 3))
    i5vv = between(lambda v, s: v ** 3 / (3 * rho2 * s ** 3))
    e = np.cross(b, t)
    de = np.einsum('nmk,mk->nm', d, e)
    p, q = i3 + 1.5 * a * a * i5, i3v + 1.5 * a * a * i5v
    screw = -(np.cross(d, b[None]) * p[..., None] + np.cross(t, b)[None] * q[..., None])
    rest = -(d * i3[..., None] + t[None] * i3v[..., None]) / (1 - nu)
    half = np.einsum('nmi,mj->nij', screw, t) + np.einsum('nmi,mj->nij', rest, e)
    c = 3 * de / (1 - nu)
    dd = np.einsum('nm,nmi,nmj->nij', c * i5, d, d)
    dt = np.einsum('nm,nmi,mj->nij', c * i5v, d, t)
    tt = np.einsum('nm,mi,mj->nij', c * i5vv, t, t)
    trace = (de * (i3 + 3 * a * a * i5)).sum(1) / (1 - nu)
    sum_ = half + half.transpose(0, 2, 1) + dd + dt + dt.transpose(0, 2, 1) + tt
    return mu / (4 * np.pi) * (sum_ + trace[:, None, None] * np.eye(3))


def rule(core, h):
    """Points and weights on [0,1], graded towards both ends down to the core radius (segment length h)."""
    g, w = np.polynomial.legendre.leggauss(4)
    edges = [0.0, min(0.5, core / h)]
    while edges[-1] < 0.5:
        edges.append(min(0.5, 3 * edges[-1]))
    edges = np.array(edges + [1 - e for e in edges[-2::-1]])
    x = np.concatenate([p + (q - p) * (g + 1) / 2 for p, q in zip(edges[:-1], edges[1:])])
    return x, np.concatenate([(q - p) * w / 2 for p, q in zip(edges[:-1], edges[1:])])


class Lock:
    """Degrees of freedom: positions of the triple nodes along E, then displacements of the arms' nodes."""

    def __init__(self, mu, nu, b, a, length, pieces, shortest, local):
        self.mu, self.nu, self.a, self.local = mu, nu, a, local
        h = b / 2 ** 0.5
        b1, b2 = h * np.array([0, -1, -1]), h * np.array([-1, 0, 1])
        self.bj = b1 + b2
        # arm: pinned end, triple node it leads to, Burgers vector for the sense from pinned end to triple node, normal
        self.arms = [(-0.5 * length * XI1, 0, b1, N1), (-0.5 * length * XI2, 0, b2, N2),
                     (0.5 * length * XI1, 1, -b1, N1), (0.5 * length * XI2, 1, -b2, N2)]
        # distances from the triple node in parts of the arm: geometric
        low, high = 1.0001, 3.0
        for _ in range(60):
            ratio = 0.5 * (low + high)
            low, high = (ratio, high) if shortest * (ratio ** pieces - 1) / (ratio - 1) < 0.5 * length else (low, ratio)
        s = np.cumsum(np.r_[0.0, shortest * ratio ** np.arange(pieces)])
        self.u = 1 - s / s[-1]                          # 1 at the triple node, 0 at the pinned end
        self.n = len(self.u) - 2
        self.dofs = np.zeros(2 + 4 * self.n)
        self.dofs[:2] = -0.25 * length, 0.25 * length

    def points(self, dofs):
        lines = []
        for k, (pinned, side, _, normal) in enumerate(self.arms):
            triple = dofs[side] * E
            across = np.cross(normal, triple - pinned)
            across /= np.linalg.norm(across)
            x = pinned + self.u[:, None] * (triple - pinned)
            x[1:-1] += dofs[2 + k * self.n:2 + (k + 1) * self.n, None] * across
            lines.append((x[::-1], across))
        return lines

    def residual(self, dofs, applied):
        lines = self.points(dofs)
        start = np.vstack([x[:-1] for x, _ in lines] + [dofs[0] * E[None]])
        end = np.vstack([x[1:] for x, _ in lines] + [dofs[1] * E[None]])
        b = np.vstack([np.tile(arm[2], (len(x) - 1, 1)) for arm, (x, _) in zip(self.arms, lines)] + [self.bj[None]])
        residual = np.zeros_like(dofs)
        for k, (x, across) in enumerate(lines):
            side, bk = self.arms[k][1], self.arms[k][2]
            rules = [rule(self.a, np.linalg.norm(q - p)) for p, q in zip(x[:-1], x[1:])]
            at = np.vstack([p + u[:, None] * (q - p) for p, q, (u, _) in zip(x[:-1], x[1:], rules)])
            sigma = stress(at, start, end, b, self.mu, self.nu, self.a) + applied
            traction = sigma @ bk
            force, first = np.zeros_like(x), 0
            for m, (u, w) in enumerate(rules):
                f = np.cross(traction[first:first + len(u)], x[m + 1] - x[m]) * w[:, None]
                first += len(u)
                force[m] += ((1 - u)[:, None] * f).sum(0)
                force[m + 1] += (u[:, None] * f).sum(0)
            # Virtual motion of a triple node: alone, as in a code that moves nodes, or with the whole arm.
            residual[side] += (force[-1] if self.local else self.u[::-1] @ force) @ E
            residual[2 + k * self.n:2 + (k + 1) * self.n] = (force[1:-1] @ across)[::-1]
        return residual

    def solve(self, tau):
        """Equilibrium under the shear stress tau on (010) along [00-1]; returns whether it exists."""
        applied = np.zeros((3, 3))
        applied[1, 2] = applied[2, 1] = -tau
        inverse, previous = None, np.inf
        for _ in range(60):
            r = self.residual(self.dofs, applied)
            if inverse is None or np.linalg.norm(r) > 0.3 * previous:
                jacobian = np.empty((len(r), len(r)))
                for i in range(len(r)):
                    y = self.dofs.copy()
                    y[i] += 1e-5
                    jacobian[:, i] = (self.residual(y, applied) - r) / 1e-5
                inverse = np.linalg.inv(jacobian)
            previous = np.linalg.norm(r)
            step = -inverse @ r
            damping = min(1.0, 3.0 / np.abs(step).max())
            self.dofs += damping * step
            if self.dofs[1] < self.dofs[0]:
                return False
            if damping == 1.0 and np.abs(step).max() < 1e-5:
                return True
        return False

    def junction(self):
        return self.dofs[1] - self.dofs[0]


def screw_check():
    """Stress of a long screw and edge against the textbook, far outside the core."""
    mu, nu, b, x = 1.0, 0.3, 1.0, np.array([[0.3, 2.0, 0.0]])
    ends = np.array([[0, 0, -1e5]]), np.array([[0, 0, 1e5]])
    r2 = (x ** 2).sum()
    screw = stress(x, *ends, np.array([[0, 0, b]]), mu, nu, 1e-3)[0]
    edge = stress(x, *ends, np.array([[b, 0, 0.0]]), mu, nu, 1e-3)[0]
    assert abs(screw[0, 2] + mu * b * x[0, 1] / (2 * np.pi * r2)) < 1e-6
    expected = -mu * b * x[0, 1] * (3 * x[0, 0] ** 2 + x[0, 1] ** 2) / (2 * np.pi * (1 - nu) * r2 ** 2)
    assert abs(edge[0, 0] - expected) < 1e-6


if __name__ == '__main__':
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--pieces', type=int, default=16)
    parser.add_argument('--shortest', type=float, default=3.0, help='segment at the triple node, nm (default 3)')
    parser.add_argument('--core', type=float, default=0.28635, help='core radius, nm (default b)')
    parser.add_argument('--local', action='store_true', help='balance at the triple node alone, not of whole arms')
    parser.add_argument('--stress', type=float, nargs='*', default=[0, 50, 100, 150, 160, 170])
    arguments = parser.parse_args()
    screw_check()
    lock = Lock(26272.0, 0.344754, 0.28635, arguments.core, 200.0, arguments.pieces, arguments.shortest, arguments.local)
    for tau in arguments.stress:
        ok = lock.solve(tau)
        print(f'tau {tau:6.1f} MPa: ' + (f'junction {lock.junction():.3f} nm' if ok else 'no equilibrium'), flush=True)
        if not ok:
            break
