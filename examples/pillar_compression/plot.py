#!/usr/bin/env python3
"""Figures of a run of this example: stress_strain.png, network.png, surface.png and all three in figure.png.

usage: plot.py DIR
"""
import itertools
import os
import sys

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.collections import LineCollection, PolyCollection  # noqa: E402

from pillar import HEIGHT, NORMAL, SLIP, SOURCE, WIDTH, burgers, modulus, reader, strain_per_slip  # noqa: E402

VIEW_PLANE = dict(elev=20, azim=-68)          # towards the glide plane
VIEW_STEP = dict(elev=14, azim=38)            # along the glide plane
MAGNIFICATION = 60
BLUE, RED, GREY = '#1f4e9c', '#b8401f', '#8a8a8a'


def stress_strain(ax, history, e):
    strain, stress = -100 * history['strain [-]'], -history['stress [Pa]'] / 1e6
    plastic = -100 * history['axial plastic strain [-]']
    top = 1.18 * stress.max()
    ax.plot([0, 1e8 * top / e], [0, top], '--', color=GREY, lw=1, label=f'elastic, {e / 1e9:.1f} GPa')
    ax.plot(strain, stress, color=BLUE, lw=1.4, label='stress')
    ax.set(xlabel='compressive strain (%)', ylabel='compressive stress (MPa)', xlim=(0, 1.02 * strain.max()), ylim=(0, top))
    right = ax.twinx()
    right.plot(strain, plastic, color=RED, lw=1.2, label='plastic strain')
    right.set(ylabel='plastic strain (%)', ylim=(0, 1.6 * plastic.max()))
    right.spines['top'].set_visible(False)
    right.yaxis.label.set_color(RED)
    right.tick_params(axis='y', colors=RED)
    ax.spines['top'].set_visible(False)
    lines = ax.get_lines() + right.get_lines()
    ax.legend(lines, [x.get_label() for x in lines], frameon=False, loc='upper left', fontsize=8)


def plane_outline():
    corners = np.array([[1, 1], [-1, 1], [-1, -1], [1, -1]]) * WIDTH / 2
    return np.column_stack([corners, SOURCE[2] - corners @ NORMAL[:2] / NORMAL[2]])


def box_edges():
    corners = np.array(list(itertools.product((-1, 1), (-1, 1), (0, 1)))) * [WIDTH / 2, WIDTH / 2, HEIGHT]
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


def network(ax, path, title):
    lines, _ = reader.segments(path)
    ax.add_collection(LineCollection(project(box_edges(), **VIEW_PLANE)[0], colors=GREY, linewidths=0.6))
    ax.add_collection(PolyCollection([project(plane_outline(), **VIEW_PLANE)[0]], facecolor=(0.35, 0.55, 0.85, 0.16),
                                     edgecolor=(0.35, 0.55, 0.85, 0.6), linewidth=0.5))
    ax.add_collection(LineCollection(project(lines, **VIEW_PLANE)[0], colors=RED, linewidths=1.4, capstyle='round'))
    bare_axes(ax)
    ax.set_title(title, fontsize=8, pad=2)


def chosen_frames(directory, history, b):
    """Frames that tell the story of a source, with their titles."""
    frames = reader.frames(directory, 'dislocations')
    row = {int(s): k for k, s in enumerate(history['step'])}
    slips = abs(history['axial plastic strain [-]']) / strain_per_slip(b)
    exits = history['surface exits']

    def frame(condition):
        return next((f for f in frames if condition(row[f[1]])), frames[-1])

    inside = [f for f in frames if exits[row[f[1]]] == 0]
    bowed = [f for f in inside if slips[row[f[1]]] > 0.1] or inside[-1:]
    speed = history['max speed [m/s]']
    quiet = [f for f in frames if 0.98 < slips[row[f[1]]] < 1.06 and speed[row[f[1]]] < 30] or [frame(lambda k: slips[k] > 1)]
    picks = [(frames[0], 'source'), (bowed[0], 'bowed out'), (frame(lambda k: exits[k] > 0), 'first exit'),
             (frame(lambda k: slips[k] > 0.75), 'arms turn'), (quiet[0], 'one slip done'),
             (frame(lambda k: slips[k] > 1.5), 'second slip')]
    return [(path, f'{name}\n{abs(history["strain [-]"][row[step]]) * 100:.3f} %') for (_, step, path), name in picks]


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


def cut(x, u, value):
    """The parts (points, displacements, values) of a polygon on the two sides of the glide plane; nothing is interpolated across."""
    depth = (x - SOURCE) @ NORMAL
    if (depth >= 0).all() or (depth < 0).all():
        return [(x, u, value)]
    parts = []
    for inside in (depth >= 0, depth < 0):
        points, owners = [], []
        for i in range(len(x)):
            j = (i + 1) % len(x)
            if inside[i]:
                points.append(x[i])
                owners.append(i)
            if inside[i] != inside[j]:
                points.append(x[i] + depth[i] / (depth[i] - depth[j]) * (x[j] - x[i]))
                owners.append(i if inside[i] else j)
        parts.append((np.array(points), u[owners], value[owners]))
    return parts


def surface(ax, path, b):
    """Deformed surface, coloured by the displacement along the Burgers vector in units of b."""
    grain = reader.grain(path)
    x, u = grain['points'].astype(float), grain['displacement_m'].astype(float)
    along = u @ SLIP / b
    along -= np.median(along[(x - SOURCE) @ NORMAL < -60e-9])
    sign = np.sign(along.sum())
    pieces = [piece for c in surface_polygons(grain) for piece in cut(x[c], u[c], sign * along[c])]
    level = matplotlib.colors.Normalize(0, np.ceil((sign * along).max()))
    colours = matplotlib.cm.viridis(level([piece[2].mean() for piece in pieces]))
    middle = np.array([piece[0].mean(axis=0) for piece in pieces])
    outward = np.where(np.abs(middle[:, :2]) > 0.499 * WIDTH, middle[:, :2], 0) / WIDTH
    light = 0.80 + 0.4 * outward[:, 0] + 0.1 * outward[:, 1] + np.where(middle[:, 2] > 0.999 * HEIGHT, 0.2, 0)
    colours[:, :3] *= np.clip(light, 0.55, 1)[:, None]
    deformed = [project(piece[0] + MAGNIFICATION * piece[1], **VIEW_STEP) for piece in pieces]
    order = np.argsort([nearness.mean() for _, nearness in deformed])
    ax.add_collection(PolyCollection([deformed[k][0] for k in order], facecolors=colours[order], edgecolors=colours[order],
                                     linewidths=0.3))
    bare_axes(ax)
    mappable = matplotlib.cm.ScalarMappable(level, 'viridis')
    bar = ax.figure.colorbar(mappable, ax=ax, shrink=0.6, pad=0.02, aspect=22)
    bar.set_label('displacement along the Burgers vector / b')
    ax.set_title(f'displacements x {MAGNIFICATION}', fontsize=8, pad=2)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    directory = sys.argv[1]
    history, b, e = reader.history(directory), burgers(directory), modulus(directory)
    picks, last = chosen_frames(directory, history, b), reader.frames(directory, 'grain')[-1][2]
    plt.rcParams.update({'font.size': 9})

    fig, ax = plt.subplots(figsize=(4.6, 3.4), constrained_layout=True)
    stress_strain(ax, history, e)
    fig.savefig(os.path.join(directory, 'stress_strain.png'), dpi=160)

    fig = plt.figure(figsize=(4.8, 5.6))
    for k, pick in enumerate(picks):
        network(fig.add_axes([0.01 + 0.33 * (k % 3), 0.5 - 0.5 * (k // 3), 0.31, 0.43]), *pick)
    fig.savefig(os.path.join(directory, 'network.png'), dpi=160)

    fig, ax = plt.subplots(figsize=(4.6, 5), constrained_layout=True)
    surface(ax, last, b)
    fig.savefig(os.path.join(directory, 'surface.png'), dpi=160)

    fig = plt.figure(figsize=(11.4, 4.6))
    stress_strain(fig.add_axes([0.048, 0.12, 0.29, 0.81]), history, e)
    for k, pick in enumerate(picks):
        network(fig.add_axes([0.402 + 0.105 * (k % 3), 0.50 - 0.495 * (k // 3), 0.105, 0.42]), *pick)
    surface(fig.add_axes([0.735, 0.03, 0.25, 0.9]), last, b)
    for label, x in (('(a)', 0.005), ('(b)', 0.4), ('(c)', 0.735)):
        fig.text(x, 0.96, label, fontsize=10)
    fig.savefig(os.path.join(directory, 'figure.png'), dpi=150)


if __name__ == '__main__':
    main()
