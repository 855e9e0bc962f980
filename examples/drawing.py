"""Drawings in orthographic projection that the plot scripts share: edges, lines of dislocations, deformed surfaces."""
import itertools

import matplotlib.cm
import matplotlib.colors
import numpy as np
from matplotlib.collections import LineCollection, PolyCollection

BLUE, RED, GREY = '#1f4e9c', '#b8401f', '#8a8a8a'


def box_edges(low, high):
    """The twelve edges of a box as pairs of points."""
    corners = [np.array(c) for c in itertools.product(*zip(low, high))]
    return [(p, q) for p, q in itertools.combinations(corners, 2) if (p != q).sum() == 1]


def project(points, elev, azim):
    """Orthographic projection of points (..., 3) in m: (..., 2) in nm, and the nearness to the eye."""
    e, a = np.radians([elev, azim])
    towards = np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])
    right = np.array([-np.sin(a), np.cos(a), 0])
    points = 1e9 * np.asarray(points)
    return np.stack([points @ right, points @ np.cross(towards, right)], -1), points @ towards


def bare_axes(ax):
    ax.set_aspect('equal')
    ax.autoscale_view()
    ax.set_axis_off()


def dislocations(ax, lines, edges, view, title, planes=()):
    """Lines (n, 2, 3) in m, the edges of the body, and outlines of glide planes."""
    ax.add_collection(LineCollection([project(e, **view)[0] for e in edges], colors=GREY, linewidths=0.6))
    ax.add_collection(PolyCollection([project(p, **view)[0] for p in planes], facecolor=(0.35, 0.55, 0.85, 0.16),
                                     edgecolor=(0.35, 0.55, 0.85, 0.6), linewidth=0.5))
    ax.add_collection(LineCollection(project(lines, **view)[0], colors=RED, linewidths=1.4, capstyle='round'))
    bare_axes(ax)
    ax.set_title(title, fontsize=8, pad=2)


def surface_polygons(grain):
    """Plane quadrilaterals (index arrays) of the surface cells."""
    polygons = []
    x = grain['points']
    for c in grain['cells']:
        if len(c) != 9:
            polygons.append(c)
        elif np.linalg.norm(x[c[4]] - x[c].mean(axis=0)) < 1e-3 * np.ptp(x[c], axis=0).max():      # lexicographic
            polygons += [c[[i, i + 1, i + 4, i + 3]] for i in (0, 1, 3, 4)]
        else:                                                        # corners, sides, centre
            polygons += [c[list(i)] for i in ((0, 4, 8, 7), (4, 1, 5, 8), (8, 5, 2, 6), (7, 8, 6, 3))]
    return np.array(polygons)


def sides(x, u, point, normal, slip):
    """Depths of the vertices of a polygon behind a plane, and their displacements on its back and front. In the plane itself, where
    the displacement jumps by multiples of @slip, the written one is that of one side: it is shifted to that of the next vertex."""
    depth = (x - point) @ normal
    on = np.abs(depth) < 1e-12
    if on.any() and not on.all():
        u = u.copy()
        for i in np.flatnonzero(on):
            j = next(j % len(x) for step in range(1, len(x)) for j in (i + step, i - step) if not on[j % len(x)])
            u[i] += 0.5 * round(2 * (u[j] - u[i]) @ slip / (slip @ slip)) * slip
            depth[i] = np.copysign(1e-12, depth[j])
    return depth, u


def cut(x, u, point, normal, slip):
    """The parts (points, displacements) of a polygon on the two sides of a plane; nothing is interpolated across where the
    displacement jumps by @slip (a vector) or more."""
    depth, u = sides(x, u, point, normal, slip)
    if (depth >= 0).all() or (depth < 0).all():
        return [(x, u)]
    parts = []
    for inside in (depth >= 0, depth < 0):
        points, displacements = [], []
        for i in range(len(x)):
            j = (i + 1) % len(x)
            if inside[i]:
                points.append(x[i])
                displacements.append(u[i])
            if inside[i] != inside[j]:
                fraction = depth[i] / (depth[i] - depth[j])
                points.append(x[i] + fraction * (x[j] - x[i]))
                jumps = abs((u[j] - u[i]) @ slip) > 0.5 * slip @ slip
                displacements.append(u[i if inside[i] else j] if jumps else u[i] + fraction * (u[j] - u[i]))
        parts.append((np.array(points), np.array(displacements)))
    return parts


def deformed_surface(ax, grain, slip, magnification, view, label, planes=(), zero=0.0, levels=None):
    """Surface displaced by @magnification times the displacement, coloured by the component along the Burgers vector @slip (m) less
    @zero, in units of it, and cut along planes (point, normal)."""
    x, u = grain['points'].astype(float), grain['displacement_m'].astype(float)
    pieces = [(x[c], u[c]) for c in surface_polygons(grain)]
    for point, normal in planes:
        pieces = [part for piece in pieces for part in cut(*piece, point, normal, slip)]
    values = [(piece[1].mean(axis=0) @ slip) / (slip @ slip) - zero for piece in pieces]
    level = matplotlib.colors.Normalize(*(levels or (min(values), max(values))))
    colours = matplotlib.cm.viridis(level(values))
    light = np.array([0.7 + 0.3 * abs(unit_normal(piece[0]) @ [0.9, 0.25, 0.6]) for piece in pieces])
    colours[:, :3] *= np.clip(light, 0.5, 1)[:, None]
    deformed = [project(piece[0] + magnification * piece[1], **view) for piece in pieces]
    order = np.argsort([nearness.mean() for _, nearness in deformed])
    ax.add_collection(PolyCollection([deformed[k][0] for k in order], facecolors=colours[order], edgecolors=colours[order],
                                     linewidths=0.3))
    bare_axes(ax)
    bar = ax.figure.colorbar(matplotlib.cm.ScalarMappable(level, 'viridis'), ax=ax, shrink=0.6, pad=0.02, aspect=22)
    bar.set_label(label)


def unit_normal(polygon):
    n = np.cross(polygon, np.roll(polygon, -1, axis=0)).sum(axis=0)
    return n / max(np.linalg.norm(n), 1e-300)
