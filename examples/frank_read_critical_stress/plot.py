#!/usr/bin/env python3
"""Draws figure.png and prints the table of a directory written by run.py.

usage: plot.py DIR [FIGURE]
"""
import csv
import math
import os
import sys

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

# Foreman, Phil. Mag. 15 (1967) 1011: tau_c = A (mu b / 2 pi L) (ln(L / r0) + B), A = 1 (edge), 1/(1-nu) (screw);
# what is known of the values of B: README.md
FOREMAN_B = {'edge': -0.65, 'screw': -1.06}
# The independent solver quasi_static.py with the core and the isolated source of ddfem, in the same form with r0 = a;
# nu = 0.344754, least squares over L / a = 100 ... 10000: factor and B
QUASI_STATIC = {'edge': (1.008, 0.080), 'screw': (1.488, -0.641)}
# The same solver and core with straight arms (Foreman's geometry), at L / a = 1000, 2000, 5000, 10000
WITH_ARMS = {'edge': [5.396, 6.129, 7.081, 7.795], 'screw': [7.635, 8.710, 10.153, 11.225]}
COLOURS = {'edge': '#1f4e9c', 'screw': '#b8401f'}


def foreman(character, ratio, nu):
    """tau_c in mu b / (2 pi L) as published, with r0 = a exp(1 - 1/(4k)), k = (2-nu)/(2(1-nu)) (see README.md)."""
    k = (2 - nu) / (2 * (1 - nu))
    factor = 1 if character == 'edge' else 1 / (1 - nu)
    return factor * (np.log(ratio) - (1 - 1 / (4 * k)) + FOREMAN_B[character])


def quasi_static(character, ratio):
    factor, b = QUASI_STATIC[character]
    return factor * (np.log(ratio) + b)


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    figure = sys.argv[2] if len(sys.argv) == 3 else os.path.join(sys.argv[1], 'figure.png')
    with open(os.path.join(sys.argv[1], 'critical_stress.csv')) as f:
        rows = list(csv.DictReader(f))
    mu, nu, b = (float(rows[0][k]) for k in ('shear modulus [Pa]', 'poisson ratio [-]', 'burgers vector [m]'))
    data = {'edge': {}, 'screw': {}}
    print('| source | L (nm) | L/L_max | tau_c (MPa) | tau_c 2 pi L / (mu b) | quasi-static | difference |')
    print('|---|---|---|---|---|---|---|')
    for r in rows:
        length, tau = float(r['length [m]']), float(r['critical stress [Pa]'])
        pieces, scaled = length / float(r['maximum segment [m]']), tau * 2 * math.pi * length / (mu * b)
        data[r['character']].setdefault(length, (tau, scaled))
        reference = quasi_static(r['character'], length / b)
        print(f'| {r["character"]} | {length * 1e9:.0f} | {pieces:.0f} | {tau / 1e6:.2f} | {scaled:.3f} | {reference:.3f} | '
              f'{100 * (scaled / reference - 1):+.1f} % |')

    plt.rcParams.update({'font.size': 9, 'axes.spines.top': False, 'axes.spines.right': False})
    fig, (left, right) = plt.subplots(1, 2, figsize=(9.2, 3.9), constrained_layout=True)
    ratio = np.logspace(math.log10(80e-9 / b), math.log10(2000e-9 / b), 60)
    for character, colour in COLOURS.items():
        points = sorted(data[character].items())
        lengths = np.array([p[0] for p in points])
        left.loglog(lengths * 1e9, [p[1][0] / 1e6 for p in points], 'o' if character == 'edge' else 's', color=colour,
                    label=f'{character}, ddfem')
        right.semilogx(lengths / b, [p[1][1] for p in points], 'o' if character == 'edge' else 's', color=colour,
                       label=f'{character}, ddfem (isolated segment)')
        unit = mu * b / (2 * math.pi * ratio * b)
        left.loglog(ratio * b * 1e9, quasi_static(character, ratio) * unit / 1e6, '-', color=colour, lw=1.2,
                    label=f'{character}, quasi-static')
        left.loglog(ratio * b * 1e9, foreman(character, ratio, nu) * unit / 1e6, ':', color=colour, lw=1.2,
                    label=f'{character}, Foreman')
        right.semilogx(ratio, quasi_static(character, ratio), '-', color=colour, lw=1.2,
                       label=f'{character}, quasi-static (isolated segment)')
        right.semilogx(ratio, foreman(character, ratio, nu), ':', color=colour, lw=1.2,
                       label=f'{character}, Foreman (part of a long line)')
        right.semilogx([1000, 2000, 5000, 10000], WITH_ARMS[character], '--', color=colour, lw=1.2,
                       label=f'{character}, quasi-static (part of a long line)')
    left.set(xlabel='length of the source L (nm)', ylabel='critical resolved stress (MPa)')
    left.set_xticks([100, 200, 400, 800, 1600], ['100', '200', '400', '800', '1600'])
    left.set_yticks([5, 10, 20, 50, 100], ['5', '10', '20', '50', '100'])
    left.minorticks_off()
    left.legend(frameon=False, fontsize=8)
    right.set(xlabel='L / b', ylabel=r'$\tau_c\;2\pi L/(\mu b)$', ylim=(2, None))
    top = right.get_ylim()[1]
    right.set_ylim(2, top + 7)
    right.legend(frameon=False, fontsize=8, loc='upper left')
    left.set_title('(a)', loc='left', fontsize=10)
    right.set_title('(b)', loc='left', fontsize=10)
    fig.savefig(figure, dpi=160)
    print(f'wrote {figure}')


if __name__ == '__main__':
    main()
