#!/usr/bin/env python3
"""Critical stress of a Frank-Read source by quasi-static bow-out: no dynamics, none of the code of ddfem.

A planar line between two fixed points, Burgers vector along x in the plane z = 0. For a given swept area the line is in
equilibrium (Newton's method) under the applied resolved stress, which is the unknown multiplier of that constraint, and its
own stress. The critical stress is the largest one on the way. Lengths are in units of the source length L, stresses in
mu b / (2 pi L).

Two models of the core:
  cai     non-singular theory, Cai et al., JMPS 54 (2006) 561, core radius a
  brown   singular theory; the self-stress is the mean of those at the distances +r0 and -r0 in the plane (Brown, Phil. Mag. 10
          (1964) 441; used by Foreman, Phil. Mag. 15 (1967) 1011)
Two surroundings: nothing beyond the pinned ends (as in ddfem), or straight arms that continue the segment to infinity (Foreman).
With arms and L < 500 core radii the line folds back onto its arms before the stress has a maximum; the solver then stops.
"""
import argparse

import numpy as np

ARM = 1e4  # length of an "infinite" arm


def resolved_stress(field, start, end, nu, a):
    """Stress xz (units mu b / 2 pi L) at points field (n,2) of segments start -> end (m,2), all in the plane z = 0, b along x.

    Cai et al. (2006), eq. (13) with b = b x and everything in z = 0:
    s_xz = (mu b / 4 pi) Int [ X dy' / (1-nu) / R_a^3 - Y dx' (1 / R_a^3 + 3 a^2 / (2 R_a^5)) ],  (X, Y) = field - source.
    """
    t = end - start
    length = np.linalg.norm(t, axis=1)
    t = t / length[:, None]
    r = field[:, None, :] - start[None]
    along = np.einsum('nmk,mk->nm', r, t)
    d = r - along[..., None] * t
    rho2 = (d ** 2).sum(-1) + a * a
    v1, v2 = along - length, along               # field minus source along the segment: from v2 (start) to v1 (end)
    r1, r2 = np.sqrt(v1 ** 2 + rho2), np.sqrt(v2 ** 2 + rho2)

    def difference(v, w, x, y):                  # v/x - w/y without cancellation for v, w of equal sign and large
        return np.where(v * w > 0, rho_difference(v, w, x, y), v / x - w / y)

    def rho_difference(v, w, x, y):              # v/x - w/y = sign * rho2 (v^2 - w^2) / (x y (|v| y + |w| x))
        return np.sign(v) * rho2 * (v ** 2 - w ** 2) / (x * y * (np.abs(v) * y + np.abs(w) * x) + 1e-300)

    s = difference(v2, v1, r2, r1)
    i3 = s / rho2                                # Int ds / R_a^3
    j3 = 1 / r1 - 1 / r2                         # Int v ds / R_a^3
    cubes = (v2 / r2) ** 3 - (v1 / r1) ** 3
    i5 = (s - cubes / 3) / rho2 ** 2             # Int ds / R_a^5
    j5 = (1 / r1 ** 3 - 1 / r2 ** 3) / 3         # Int v ds / R_a^5
    x3, y3 = (d[..., k] * i3 + t[:, k] * j3 for k in (0, 1))
    y5 = d[..., 1] * i5 + t[:, 1] * j5
    total = x3 * t[:, 1] / (1 - nu) - y3 * t[:, 0] - (1.5 * a * a * y5 * t[:, 0] if a > 0 else 0.0)
    return 0.5 * total.sum(1)


def graded_quadrature(core, h):
    """Points and weights on [0,1], graded towards both ends down to the core radius (segment length h)."""
    g, w = np.polynomial.legendre.leggauss(4)
    edges = [0.0, min(0.25, core / h)]
    while edges[-1] < 0.5:
        edges.append(min(0.5, 4 * edges[-1]))
    edges = np.array(edges + [1 - e for e in edges[-2::-1]])
    x = np.concatenate([lo + (hi - lo) * (g + 1) / 2 for lo, hi in zip(edges[:-1], edges[1:])])
    return x, np.concatenate([(hi - lo) * w / 2 for lo, hi in zip(edges[:-1], edges[1:])])


class Source:
    """A source of unit length with character 'edge' or 'screw'; sense chosen such that a positive stress bows it to the left."""

    def __init__(self, character, nu, core, model, arms, pieces):
        self.nu, self.core, self.model, self.arms = nu, core, model, arms
        # slip to the right of the line seen along its sense is enclosed counter-clockwise when it bows to the right
        self.t = np.array([0.0, 1.0]) if character == 'edge' else np.array([1.0, 0.0])
        self.n = np.array([self.t[1], -self.t[0]])
        self.x = np.outer(np.linspace(-0.5, 0.5, pieces + 1), self.t)

    def area(self, x):
        u, v = x @ self.t, x @ self.n
        return 0.5 * np.sum((u[1:] - u[:-1]) * (v[1:] + v[:-1]))

    def self_force(self, x):
        """Weak forces per node and unit Burgers vector along the normals of the segments (n+1, 2), and the ones of unit stress."""
        start, end = x[:-1], x[1:]
        h = np.linalg.norm(end - start, axis=1)
        q, w = graded_quadrature(self.core, h.mean())
        t = (end - start) / h[:, None]
        normal = np.stack([t[:, 1], -t[:, 0]], 1)
        points = start[:, None] + q[None, :, None] * (end - start)[:, None]
        lines = (start, end)
        if self.arms:
            lines = (np.vstack([start, x[0] - ARM * self.t, x[-1]]), np.vstack([end, x[0], x[-1] + ARM * self.t]))
        flat = points.reshape(-1, 2)
        if self.model == 'cai':
            stress = resolved_stress(flat, *lines, self.nu, self.core)
        else:
            shift = np.repeat(self.core * normal, len(q), 0)
            stress = 0.5 * (resolved_stress(flat + shift, *lines, self.nu, 0.0)
                            + resolved_stress(flat - shift, *lines, self.nu, 0.0))
        stress = stress.reshape(len(h), len(q))
        force, unit = np.zeros_like(x), np.zeros_like(x)
        for shape, k in ((1 - q, slice(0, -1)), (q, slice(1, None))):
            force[k] += ((stress * w * shape).sum(1) * h)[:, None] * normal
            unit[k] += ((w * shape).sum() * h)[:, None] * normal
        return force, unit

    def jacobian(self, residual, direction, force, unit, tau, eps=1e-6):
        n = len(direction)
        matrix = np.zeros((n + 1, n + 1))
        matrix[:n, n] = unit
        for i in range(n):
            y = self.x.copy()
            y[i + 1] += eps * direction[i]
            g, v = residual(y)
            matrix[:n, i] = (g + tau * v - force) / eps
            matrix[n, i] = (self.area(y) - self.area(self.x)) / eps
        return matrix

    def solve(self, area, tau):
        """Equilibrium with the given swept area: (stress, converged)."""
        inverse, previous = None, np.inf
        for _ in range(40):
            tangent = self.x[2:] - self.x[:-2]
            tangent /= np.linalg.norm(tangent, axis=1)[:, None]
            direction = np.stack([tangent[:, 1], -tangent[:, 0]], 1)

            def residual(x):
                f, u = self.self_force(x)
                return (f[1:-1] * direction).sum(1), (u[1:-1] * direction).sum(1)

            f, u = residual(self.x)
            n = len(direction)
            r = np.append(f + tau * u, self.area(self.x) - area)
            if inverse is None or np.linalg.norm(r) > 0.3 * previous:
                inverse = np.linalg.inv(self.jacobian(residual, direction, f + tau * u, u, tau))
            previous = np.linalg.norm(r)
            step = -inverse @ r
            damping = min(1.0, 0.05 / max(1e-30, np.abs(step[:n]).max()))
            self.x[1:-1] += damping * step[:n, None] * direction
            tau += damping * step[n]
            if damping == 1.0 and np.abs(step[:n]).max() < 1e-6:
                return tau, True
        return tau, False

    def equal_spacing(self):
        s = np.append(0, np.cumsum(np.linalg.norm(np.diff(self.x, axis=0), axis=1)))
        new = np.linspace(0, s[-1], len(s))
        self.x = np.stack([np.interp(new, s, self.x[:, k]) for k in (0, 1)], 1)


def critical_stress(character, nu, core, model='cai', arms=False, pieces=16, step=0.05, history=None):
    """Largest equilibrium stress, in mu b / (2 pi L); @p core in units of L. @p history collects (area, stress)."""
    source, tau, best = Source(character, nu, core, model, arms, pieces), 0.5, []
    area = 0.0
    while area < 3.0:
        source.equal_spacing()
        previous = source.x.copy()
        trial, ok = source.solve(area + step, tau)
        if not ok:
            source.x, step = previous, step / 2
            if step < 2e-3:
                raise RuntimeError(f'no equilibrium found: {character}, core {core}, area {area}')
            continue
        area, tau = area + step, trial
        best.append((area, tau))
        if len(best) > 2 and tau < best[-2][1]:
            break
    if history is not None:
        history.extend(best)
    x, y = np.array(best[-3:]).T                 # vertex of the parabola through the three last points
    c = np.polyfit(x - x[1], y, 2)
    return c[2] - c[1] ** 2 / (4 * c[0])


if __name__ == '__main__':
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--nu', type=float, default=1 / 3, help="Poisson's ratio (default 1/3)")
    parser.add_argument('--pieces', type=int, default=16, help='straight pieces of the line (default 16)')
    arguments = parser.parse_args()
    ratios = np.array([1000., 2000., 5000., 10000.])
    print(f'nu = {arguments.nu:.4g}; tau_c in mu b / (2 pi L), and B of tau_c = A (ln(L / core) + B) with A = 1 (edge), '
          '1/(1-nu) (screw)')
    print('core   arms      character  ' + '  '.join(f'L/core = {r:<6.0f}' for r in ratios) + '   B')
    for model in ('cai', 'brown'):
        for arms in (False, True):
            for character, factor in (('edge', 1.0), ('screw', 1 / (1 - arguments.nu))):
                tau = np.array([critical_stress(character, arguments.nu, 1 / r, model, arms, arguments.pieces)
                                for r in ratios])
                b = tau / factor - np.log(ratios)
                print(f'{model:6s} {"straight" if arms else "none":8s}  {character:9s}  '
                      + '  '.join(f'{x:15.3f}' for x in tau) + f'   {b.mean():+.2f} ({b[0]:+.2f} ... {b[-1]:+.2f})', flush=True)
