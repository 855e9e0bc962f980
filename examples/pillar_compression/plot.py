#!/usr/bin/env python3
"""Figures of a run of this example: stress_strain.png, network.png, surface.png and all three in figure.png.

usage: plot.py DIR
"""
import os
import sys

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

from pillar import HEIGHT, NORMAL, SLIP, SOURCE, WIDTH, burgers, drawing, modulus, reader, strain_per_slip  # noqa: E402

BLUE, RED, GREY = drawing.BLUE, drawing.RED, drawing.GREY
VIEW_PLANE = dict(elev=20, azim=-68)          # towards the glide plane
VIEW_STEP = dict(elev=14, azim=38)            # along the glide plane
MAGNIFICATION = 60


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


def network(ax, path, title):
    edges = drawing.box_edges([-WIDTH / 2, -WIDTH / 2, 0], [WIDTH / 2, WIDTH / 2, HEIGHT])
    drawing.dislocations(ax, reader.segments(path)[0], edges, VIEW_PLANE, title, [plane_outline()])


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


def surface(ax, path, b):
    """Deformed surface, coloured by the displacement along the Burgers vector in units of b."""
    grain = reader.grain(path)
    x, u = grain['points'].astype(float), grain['displacement_m'].astype(float)
    along = u @ SLIP / b
    zero = np.median(along[(x - SOURCE) @ NORMAL < -60e-9])
    along -= zero
    sign = np.sign(along.sum())
    drawing.deformed_surface(ax, grain, sign * b * SLIP, MAGNIFICATION, VIEW_STEP, 'displacement along the Burgers vector / b',
                             [(SOURCE, NORMAL)], sign * zero, (0, np.ceil((sign * along).max())))
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
