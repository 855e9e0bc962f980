#!/usr/bin/env python3
"""Draws figure.png from the output of validation_heavy_lomer.

usage: plot.py TABLE [FIGURE]
"""
import sys

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

# quasi_static.py --local --shortest 3 --pieces 16: tau (MPa) and junction (nm)
QUASI_STATIC = {0: 96.868, 150: 79.069}


def read(path):
    lock, lattice = {}, []
    for line in open(path):
        fields = line.split()
        try:
            if len(fields) == 6 and fields[0] == 'lock':
                low, high, tolerance, time, length = map(float, fields[1:])
                lock.setdefault((low, high, tolerance), []).append((time, length))
            elif len(fields) == 6 and fields[0] == 'map':
                lattice.append(tuple(map(float, fields[1:])))
        except ValueError:
            continue                                     # a statement, not a row
    return lock, lattice


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    lock, lattice = read(sys.argv[1])
    figure, axes = plt.subplots(1, 3, figsize=(14, 4.2))
    for (low, high, tolerance), rows in sorted(lock.items()):
        time, length = np.array(rows).T
        axes[0].plot(time, length, label=f'{low:g} to {high:g} nm' + ('' if tolerance > 0.01 else ', small steps'),
                     ls='-' if tolerance > 0.01 else '--', lw=1)
    for tau, length in QUASI_STATIC.items():
        axes[0].axhline(length, color='0.6', lw=0.8, ls=':')
        axes[0].text(2.5, length + 0.5, f'quasi-static, {tau} MPa', ha='right', fontsize=8)
    axes[0].set(xlabel='time (ns)', ylabel='length of the junction (nm)', xlim=(0, 2.5), ylim=(60, 105),
                title='Lock at 0 and, from 0.5 ns, 150 MPa')
    axes[0].legend(fontsize=8, loc='lower left')
    rows = np.array(lattice)
    angles = np.unique(rows[:, 0])
    for axis, column, title in ((axes[1], 2, 'dislocation dynamics'), (axes[2], 3, 'line tension')):
        values = np.full((len(angles), len(angles)), np.nan)
        for row in rows:
            values[np.searchsorted(angles, row[1]), np.searchsorted(angles, row[0])] = row[column]
        edges = np.append(angles, 2 * angles[-1] - angles[-2]) - 0.5 * (angles[1] - angles[0])
        image = axis.pcolormesh(edges, edges, np.where(values > 1, values, np.nan), vmin=0, vmax=200, cmap='viridis')
        axis.set_facecolor('0.9')
        axis.set(xlabel='phi_1 (degrees)', ylabel='phi_2 (degrees)', title='Lomer junction (nm), ' + title)
        figure.colorbar(image, ax=axis)
    figure.tight_layout()
    figure.savefig(sys.argv[2] if len(sys.argv) == 3 else 'figure.png', dpi=110)


if __name__ == '__main__':
    main()
