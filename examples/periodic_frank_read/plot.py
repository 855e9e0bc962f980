#!/usr/bin/env python3
"""figure.png of a run of this example: stress and density against strain, and the network in the cell.

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

SIZE = np.array([1.0e-6, 1.1e-6, 1.2e-6])
VIEW = dict(elev=20, azim=-68)
BLUE, RED, GREY = drawing.BLUE, drawing.RED, drawing.GREY


def folded(lines):
    """Segments (n, 2, 3) cut at the faces of the cell and moved into it (the cell is centred at the origin)."""
    parts = []
    for a, b in lines:
        cuts = [0.0, 1.0]
        for k in range(3):
            lo, hi = sorted((a[k] / SIZE[k] + 0.5, b[k] / SIZE[k] + 0.5))
            cuts += [((m - 0.5) * SIZE[k] - a[k]) / (b[k] - a[k]) for m in range(int(np.ceil(lo)), int(np.floor(hi)) + 1)
                     if b[k] != a[k]]
        cuts = sorted(c for c in cuts if 0 <= c <= 1)
        for s, t in zip(cuts[:-1], cuts[1:]):
            if t - s < 1e-9:
                continue
            shift = -np.floor((a + 0.5 * (s + t) * (b - a)) / SIZE + 0.5) * SIZE
            parts.append((a + s * (b - a) + shift, a + t * (b - a) + shift))
    return np.array(parts)


def network(ax, path, title):
    drawing.dislocations(ax, folded(reader.segments(path)[0]), drawing.box_edges(-SIZE / 2, SIZE / 2), VIEW, title)


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    directory = sys.argv[1]
    h, frames = reader.history(directory), reader.frames(directory, 'dislocations')
    strain, stress, density = 100 * abs(h['strain [-]']), -h['stress [Pa]'] / 1e6, h['dislocation density [1/m^2]']
    row = {int(s): k for k, s in enumerate(h['step'])}
    young = 2e9 * (reader.log_number(directory, r'mu = ([\d.e+-]+) GPa')
                   * (1 + reader.log_number(directory, r'nu = ([\d.e+-]+)')))
    plt.rcParams.update({'font.size': 9})
    fig = plt.figure(figsize=(11.4, 4.4))
    left = fig.add_axes([0.048, 0.12, 0.32, 0.81])
    left.plot([0, 1.1e8 * stress.max() / young], [0, 1.1 * stress.max()], '--', color=GREY, lw=1,
              label=f'elastic, {young / 1e9:.1f} GPa')
    left.plot(strain, stress, color=BLUE, lw=1.4, label='stress')
    left.set(xlabel='compressive strain (%)', ylabel='compressive stress (MPa)', xlim=(0, 1.02 * strain.max()),
             ylim=(0, 1.2 * stress.max()))
    right = left.twinx()
    right.semilogy(strain, density, color=RED, lw=1.2, label='density')
    right.set_ylabel('dislocation density (1/m²)', color=RED)
    right.set_ylim(1e11, 2 * density.max())
    right.tick_params(axis='y', colors=RED)
    for ax in (left, right):
        ax.spines['top'].set_visible(False)
    lines = left.get_lines() + right.get_lines()
    left.legend(lines, [x.get_label() for x in lines], frameon=False, loc='upper left', fontsize=8)

    targets = [density[0], 3 * density[0], 8 * density[0], density[-1]]
    for k, target in enumerate(targets):
        _, step, path = next((f for f in frames if density[row[f[1]]] >= target), frames[-1])
        network(fig.add_axes([0.455 + 0.27 * (k % 2), 0.50 - 0.495 * (k // 2), 0.26, 0.43]), path,
                f'strain {strain[row[step]]:.3f} %, density {density[row[step]] / 1e12:.1f} × 10$^{{12}}$ /m²')
    fig.text(0.005, 0.955, '(a)', fontsize=10)
    fig.text(0.455, 0.955, '(b)', fontsize=10)
    fig.savefig(os.path.join(directory, 'figure.png'), dpi=150)


if __name__ == '__main__':
    main()
