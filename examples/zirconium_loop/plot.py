#!/usr/bin/env python3
"""Draws figure.png of a directory written by run.py and prints where the loops end.

usage: plot.py DIR [FIGURE]
"""
import os
import sys

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), '..'))
import output_reader  # noqa: E402

CASES = {'vacancy_above': ('vacancy loop, side of compression', '#1f4e9c', '-'),
         'interstitial_above': ('interstitial loop, side of compression', '#b8401f', '-'),
         'interstitial_below': ('interstitial loop, side of tension', '#d9a441', '--')}


def parts(path):
    """Segments (n, 2, 3) in nm of the line, which stays in y = 0, and of the loop, which does not reach it, all with the sense
    for which b is along +x."""
    segments, frame = output_reader.segments(path)
    backward = frame['Burgers vector [m]'][:, 0] < 0
    segments = 1e9 * np.where(backward[:, None, None], segments[:, ::-1], segments)
    in_plane = np.abs(segments[:, :, 1]).max(axis=1) < 1
    return segments[in_plane], segments[~in_plane]


def area_along_x(segments):
    """Projected area of the loop, nm^2: glide does not change it."""
    return 0.5 * np.sum(segments[:, 0, 1] * segments[:, 1, 2] - segments[:, 0, 2] * segments[:, 1, 1])


def centre(segments):
    lengths = np.linalg.norm(segments[:, 1] - segments[:, 0], axis=1)
    return (lengths * segments[:, :, 0].mean(axis=1)).sum() / lengths.sum()


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    figure = sys.argv[2] if len(sys.argv) == 3 else os.path.join(sys.argv[1], 'figure.png')
    plt.rcParams.update({'font.size': 9, 'axes.spines.top': False, 'axes.spines.right': False})
    fig, (left, right) = plt.subplots(1, 2, figsize=(9.2, 3.9), constrained_layout=True)
    for name, (label, colour, style) in CASES.items():
        frames = output_reader.frames(os.path.join(sys.argv[1], name), 'dislocations')
        time = np.array([t for t, _, _ in frames]) * 1e9
        split = [parts(path) for _, _, path in frames]
        loop = np.array([centre(s) for _, s in split])
        tip = np.array([s[:, :, 0].max() for s, _ in split])
        areas = np.array([area_along_x(s) for _, s in split])
        right.plot(time, loop, style, color=colour, label=label)
        print(f'{label}: from {loop[0]:.1f} to {loop[-1]:.1f} nm; area {areas[0]:.4f} nm^2, changes by at most '
              f'{np.abs(areas / areas[0] - 1).max():.1e}')
        if name == 'vacancy_above':
            right.plot(time, tip, ':', color='0.4', label='tip of the line')
            for k in np.linspace(0, len(frames) - 1, 6).astype(int):
                shade = plt.cm.viridis(0.9 * k / len(frames))
                for group in split[k]:
                    for segment in group:
                        left.plot(segment[:, 0], segment[:, 2], color=shade, lw=1.1)
    left.set(xlabel='x along b (nm)', ylabel='z along c (nm)', aspect='equal', title='line and vacancy loop, seen along y')
    right.set(xlabel='time (ns)', ylabel='x (nm)', ylim=(0, 120))
    right.legend(frameon=False)
    fig.savefig(figure, dpi=150)


if __name__ == '__main__':
    main()
