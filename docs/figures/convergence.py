#!/usr/bin/env python3
"""Error of image fields against element size, for each case of the tables.

usage: convergence.py OUT.png TABLE...   tables: output of validation programs called with --study
"""
import re
import sys

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt

# What is drawn: title, abscissa, expected order for degree 1 and 2.
CASES = {
    'screw_under_surface': ('V7: force on a screw under a surface', 'element size / depth', (2, 4)),
    'edge_under_surface': ('V7: force on an edge under a surface', 'element size / depth', (2, 4)),
    'screw_in_plate': ('V8: force on a screw in a plate', 'element size / plate thickness', (2, 4)),
    'edge_in_plate': ('V9: bend of a plate by an edge', 'element size / plate thickness', (2, None)),
    'screw_in_rod': ('V10: force on a screw in a free rod', 'element size / rod radius', (2, 4)),
    'screw_through_surface': ('V11: screw through a free surface, inside', 'element size / distance from the line', (2, 4)),
    'screw_through_surface_at_surface': ('V11: the same, on the surface', 'element size / distance from the line', (1, 2)),
    'loops_under_surface': ('V14: stress of triangular loops', 'element size / smallest depth', (2, 4)),
    'prismatic_loop_under_surface': ('V13: force on a prismatic loop', 'element size / depth', (2, 4)),
}


def read(files):
    errors = {}
    for name in files:
        with open(name) as f:
            for m in re.finditer(r'study (\w+) degree (\d) size +(\S+) error +(\S+)', f.read()):
                errors.setdefault(m[1], {}).setdefault(int(m[2]), []).append((float(m[3]), abs(float(m[4]))))
    return errors


def draw(axes, case, by_degree):
    title, abscissa, orders = CASES[case]
    for degree, colour, order in zip((1, 2), ('C0', 'C3'), orders):
        sizes, values = zip(*sorted(by_degree[degree]))
        axes.loglog(sizes, values, 'o-', color=colour, linewidth=1, markersize=4, label=f'degree {degree}')
        if order:
            # Through the geometric middle of the data.
            middle = len(sizes) // 2
            axes.loglog(sizes, [values[middle] * (h / sizes[middle]) ** order for h in sizes], '--', color=colour, linewidth=0.8,
                        label=f'order {order}')
    axes.axhline(0.02, color='grey', linewidth=0.6, linestyle=':')
    axes.set_title(title, fontsize=9)
    axes.set_xlabel(abscissa, fontsize=8)
    axes.set_ylabel('relative error', fontsize=8)
    every = sorted({h for values in by_degree.values() for h, _ in values})
    ticks = [t for t in (0.02, 0.03, 0.05, 0.1, 0.2, 0.3, 0.5) if every[0] * 0.99 <= t <= every[-1] * 1.01]
    axes.set_xticks(ticks, [f'{t:g}' for t in ticks])
    axes.minorticks_off()
    axes.tick_params(labelsize=7)
    axes.legend(fontsize=7)


errors = read(sys.argv[2:])
cases = [c for c in CASES if c in errors]
figure, grid = plt.subplots(2, (len(cases) + 1) // 2, figsize=(3.5 * ((len(cases) + 1) // 2), 6.2), squeeze=False)
for axes, case in zip(grid.flat, cases):
    draw(axes, case, errors[case])
for axes in list(grid.flat)[len(cases):]:
    axes.axis('off')
figure.tight_layout()
figure.savefig(sys.argv[1], dpi=130)
