#!/usr/bin/env python3
"""figure.png of a run of this example, and the twist of its lines against Eshelby's; exits with status 1 when they differ by more than 1 %.

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

RADIUS, HEIGHT = 200e-9, 800e-9
VIEW = dict(elev=18, azim=-25)                # towards the glide plane, whose normal is x
MAGNIFICATION = 40


def twist_of_lines(path):
    """Twist per length (rad/m) that the lines of a frame make in the unloaded wire: each piece dz at the distance y from the axis
    b (R^2 - y^2)/(pi R^4) dz/H, with b the Burgers vector for the sense of +z (Eshelby, J. Appl. Phys. 24 (1953) 176)."""
    lines, frame = reader.segments(path)
    y, dz = lines[:, :, 1], lines[:, 1, 2] - lines[:, 0, 2]
    mean_square = (y[:, 0] ** 2 + y[:, 0] * y[:, 1] + y[:, 1] ** 2) / 3
    b = frame['Burgers vector [m]'][:, 2]
    return -(b * dz * (RADIUS ** 2 - mean_square)).sum() / (np.pi * RADIUS ** 4 * HEIGHT)


def plastic_twist(history):
    return (history['strain [-]'] - history['elastic strain [-]']) / RADIUS


def outline():
    """Edges of the wire: its two ends, and the trace of the glide plane."""
    angle = np.linspace(0, 2 * np.pi, 61)
    circle = RADIUS * np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    ends = [circle, circle + [0, 0, HEIGHT]]
    return [np.array(pair) for end in ends for pair in zip(end[:-1], end[1:])]


def glide_plane():
    return np.array([[0, s * RADIUS, z] for s, z in ((-1, 0), (1, 0), (1, HEIGHT), (-1, HEIGHT))])


def torque_twist(ax, history):
    degrees = np.degrees(1e-6 / RADIUS)                          # per micrometre, for a nominal strain of 1
    twist, torque = degrees * history['strain [-]'], 1e12 * history['platen moment z [N m]']
    elastic = degrees * history['elastic strain [-]']
    ax.plot(elastic, torque, '--', color=drawing.GREY, lw=1, label='elastic')
    ax.plot(twist, torque, color=drawing.BLUE, lw=1.4, label='torque')
    ax.set(xlabel='twist (degrees/µm)', ylabel='torque (pN m)')
    ax.set_ylim(0, 1.15 * torque.max())
    ax.set_xlim(0, 1.03 * twist.max())
    right = ax.twinx()
    right.plot(twist, plastic_twist(history) * 1e-6 * 180 / np.pi, color=drawing.RED, lw=1.2, label='plastic twist')
    right.set_ylabel('plastic twist (degrees/µm)', color=drawing.RED)
    right.tick_params(axis='y', colors=drawing.RED)
    right.set_ylim(0, 2 * plastic_twist(history).max() * 1e-6 * 180 / np.pi)
    for a in (ax, right):
        a.spines['top'].set_visible(False)
    lines = ax.get_lines() + right.get_lines()
    ax.legend(lines, [x.get_label() for x in lines], frameon=False, loc='upper left', fontsize=8)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    directory = sys.argv[1]
    h, frames = reader.history(directory), reader.frames(directory, 'dislocations')
    row = {int(s): k for k, s in enumerate(h['step'])}
    twist = 1e-6 * np.degrees(h['strain [-]'] / RADIUS)
    largest = int(np.argmax(h['strain [-]']))
    plt.rcParams.update({'font.size': 9})
    fig = plt.figure(figsize=(11.4, 4.6))
    torque_twist(fig.add_axes([0.055, 0.12, 0.275, 0.81]), h)
    loading = [f for f in frames if row[f[1]] <= largest]
    exits = h['surface exits']
    plastic = plastic_twist(h)
    grown = [f for f in loading if exits[row[f[1]]] == 0][-1]
    out = next((f for f in loading if exits[row[f[1]]] > 0), loading[-1])
    half = next((f for f in loading if plastic[row[f[1]]] > 0.5 * plastic[largest]), loading[-1])
    picks = [(frames[0], 'source'), (grown, 'bowed out'), (out, 'first exit'), (half, 'screws at the axis'),
             (loading[-1], 'largest twist'), (frames[-1], 'unloaded')]
    for k, ((_, step, path), name) in enumerate(picks):
        drawing.dislocations(fig.add_axes([0.405 + 0.105 * (k % 3), 0.50 - 0.495 * (k // 3), 0.105, 0.42]),
                             reader.segments(path)[0], outline(), VIEW, f'{name}\n{twist[row[step]]:.2f}°/µm', [glide_plane()])
    grain = reader.grain(reader.frames(directory, 'grain')[-1][2])
    b = reader.log_number(directory, r'b = ([\d.e+-]+) nm') * 1e-9
    drawing.deformed_surface(fig.add_axes([0.735, 0.03, 0.225, 0.9]), grain, np.array([0, 0, b]),
                             MAGNIFICATION, VIEW, 'displacement along the axis / b', [(np.zeros(3), np.array([1.0, 0, 0]))])
    fig.axes[-2].set_title(f'unloaded, displacements x {MAGNIFICATION}', fontsize=8, pad=2)
    for label, x in (('(a)', 0.005), ('(b)', 0.4), ('(c)', 0.735)):
        fig.text(x, 0.96, label, fontsize=10)
    fig.savefig(os.path.join(directory, 'figure.png'), dpi=150)

    print(f'largest torque {1e12 * h["platen moment z [N m]"].max():.4f} pN m, largest energy mismatch '
          f'{100 * abs(h["energy mismatch [-]"][largest:]).max():.2f} %, wall time {h["wall time [s]"][-1]:.0f} s, {h["step"][-1]:.0f} steps')
    bad = False
    for name, frame in (('at the largest twist', loading[-1]), ('unloaded', frames[-1])):
        measured, exact = plastic[row[frame[1]]], twist_of_lines(frame[2])
        print(f'plastic twist {name}: {measured * 1e-6:.5f} rad/um, of the lines (Eshelby) {exact * 1e-6:.5f} rad/um, '
              f'{100 * (measured / exact - 1):+.2f} %')
        bad = bad or not abs(measured / exact - 1) < 0.01
    sys.exit(1 if bad else 0)


if __name__ == '__main__':
    main()
