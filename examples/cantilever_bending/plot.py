#!/usr/bin/env python3
"""figure.png of a run of this example, and the numbers of its README.

usage: plot.py DIR
"""
import os
import sys

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..'))
import drawing  # noqa: E402
import output_reader as reader  # noqa: E402

LENGTH, WIDTH, DEPTH, BLOCK, ROOT_WIDTH = 900e-9, 300e-9, 360e-9, 300e-9, 600e-9
SOURCES = np.array([[180e-9, 0, 100e-9], [220e-9, 0, -100e-9]])
AXES = np.array([[-1, 3, 5], [0, 0, 0], [1, 2, -1]], float)      # crystal directions of x, y, z
AXES /= np.maximum(np.linalg.norm(AXES, axis=1), 1e-30)[:, None]
AXES[1] = np.cross(AXES[2], AXES[0])
NORMAL = AXES @ np.array([1, 1, 1]) / np.sqrt(3)                 # of the glide planes
SLIP = AXES @ np.array([-1, 0, 1]) / np.sqrt(2)                  # direction of the Burgers vector
VIEW_LINES = dict(elev=20, azim=62)           # towards the glide planes
VIEW_SURFACE = dict(elev=16, azim=-62)        # along them
MAGNIFICATION = 60
STAGES = ('load', 'hold', 'unload', 'reload')
COLOURS = (drawing.BLUE, '#2f8f6b', '#d08a1d', drawing.RED)


def body_edges():
    """Edges of the block and of the beam."""
    half, beam = ROOT_WIDTH / 2, np.array([WIDTH, DEPTH]) / 2
    return (drawing.box_edges([-BLOCK, -half, -half], [0, half, half])
            + drawing.box_edges([0, -beam[0], -beam[1]], [LENGTH, beam[0], beam[1]]))


def stage_rows(history, stage):
    """Rows from the beginning of a stage to its end, which is the first row of the next one."""
    rows = np.flatnonzero(history['stage'] == stage)
    return np.arange(rows[0], min(rows[-1] + 2, len(history['stage']))) if len(rows) else rows


def curves(ax, history, height):
    deflection, force = -1e9 * history['strain [-]'] * height, -1e6 * history['platen force z [N]']
    for stage, (name, colour) in enumerate(zip(STAGES, COLOURS), 1):
        rows = stage_rows(history, stage)
        ax.plot(deflection[rows], force[rows], color=colour, lw=1.4, label=name)
    elastic = -1e9 * history['elastic strain [-]'] * height
    k = int(np.argmax(force))
    ax.plot([0, elastic[k]], [0, force[k]], '--', color=drawing.GREY, lw=1, label='elastic')
    ax.set(xlabel='deflection of the end (nm)', ylabel='force at the end (µN)', xlim=(0, 1.03 * deflection.max()),
           ylim=(min(0, 1.1 * force.min()), 1.12 * force.max()))
    for side in ('top', 'right'):
        ax.spines[side].set_visible(False)
    ax.legend(frameon=False, loc='upper left', fontsize=8)


def report(history, height):
    force, deflection = -history['platen force z [N]'], -history['strain [-]'] * height
    moment = -history['fixed face moment y [N m]']
    print(f'{history["step"][-1]:.0f} steps, wall time {history["wall time [s]"][-1]:.0f} s, '
          f'surface exits {history["surface exits"][-1]:.0f}')
    stiffness = force / np.where(history['elastic strain [-]'] == 0, 1, -history['elastic strain [-]'] * height)
    print(f'elastic stiffness {stiffness[len(force) // 2]:.3f} N/m')
    for stage, name in enumerate(STAGES, 1):
        rows = stage_rows(history, stage)
        print(f'{name:8s} force {1e6 * force[rows[0]]:8.4f} -> {1e6 * force[rows[-1]]:8.4f} uN, deflection '
              f'{1e9 * deflection[rows[0]]:7.3f} -> {1e9 * deflection[rows[-1]]:7.3f} nm, moment at the root '
              f'{1e15 * moment[rows[-1]]:8.4f} fN m')
    imbalance = abs(history['platen force z [N]'] + history['fixed face force z [N]']).max() / force.max()
    lever = (abs(moment) / np.maximum(abs(force), 1e-3 * force.max()))[abs(force) > 0.1 * force.max()]
    print(f'forces of the two faces differ by {imbalance:.1e} of the largest; moment at the root / force: '
          f'{1e9 * lever.min():.3f} to {1e9 * lever.max():.3f} nm (length {1e9 * height:.0f} nm)')
    late = abs(history['work [J]']) > 0.1 * abs(history['work [J]']).max()
    print(f'largest energy mismatch {100 * abs(history["energy mismatch [-]"][late]).max():.2f} %')


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    directory = sys.argv[1]
    history, frames = reader.history(directory), reader.frames(directory, 'dislocations')
    height = BLOCK + LENGTH
    stage = dict(zip(history['step'].astype(int), history['stage']))
    exits = dict(zip(history['step'].astype(int), history['surface exits']))
    plt.rcParams.update({'font.size': 9})
    fig = plt.figure(figsize=(11.4, 5))
    curves(fig.add_axes([0.062, 0.11, 0.25, 0.82]), history, height)
    end = {s: int(history['step'][stage_rows(history, s)[-1]]) for s in (1, 2, 3, 4)}

    def at_end(collection, s):
        return min(collection, key=lambda f: abs(f[1] - end[s]))
    picks = [(frames[0], 'sources'), (next((f for f in frames if exits[f[1]] > 0), frames[-1]), 'first exit')]
    most = history['surface exits'].max()
    picks += [(next((f for f in frames if exits[f[1]] > 0.9 * most), frames[-1]), 'last exits')]
    picks += [(at_end(frames, s), f'end of {name}') for s, name in enumerate(STAGES, 1) if name != 'hold']
    for k, ((_, _, path), name) in enumerate(picks):
        drawing.dislocations(fig.add_axes([0.335 + 0.16 * (k % 2), 0.67 - 0.325 * (k // 2), 0.155, 0.275]),
                             reader.segments(path)[0], body_edges(), VIEW_LINES, name)
    _, unloaded, path = at_end(reader.frames(directory, 'grain'), 3)
    grain, row = reader.grain(path), int(np.flatnonzero(history['step'] == unloaded)[0])
    b = reader.log_number(directory, r'b = ([\d.e+-]+) nm') * 1e-9
    drawing.deformed_surface(fig.add_axes([0.665, 0.08, 0.32, 0.85]), grain, b * SLIP,
                             MAGNIFICATION, VIEW_SURFACE, 'displacement along the Burgers vector / b', [(s, NORMAL) for s in SOURCES])
    force = abs(1e6 * history['platen force z [N]'][row])
    fig.axes[-2].set_title(f'unloaded ({force:.2f} µN), displacements x {MAGNIFICATION}', fontsize=8, pad=2)
    for label, x in (('(a)', 0.005), ('(b)', 0.33), ('(c)', 0.665)):
        fig.text(x, 0.96, label, fontsize=10)
    fig.savefig(os.path.join(directory, 'figure.png'), dpi=150)
    report(history, height)


if __name__ == '__main__':
    main()
