#!/usr/bin/env python3
"""Error of the correction under a free surface against element size.

usage: loops_under_surface.py TABLE OUT.png, TABLE being the output of `validation_loops_under_surface SIZE ...`
"""
import re
import sys

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt

errors = {}
with open(sys.argv[1]) as f:
    for m in re.finditer(r'element size ([\d.]+), points deeper than [\d.]+, loop (\d+): largest error +([\d.]+)', f.read()):
        errors.setdefault(int(m[2]), []).append((float(m[1]), float(m[3])))

figure, axes = plt.subplots(figsize=(5.2, 4))
for loop, values in sorted(errors.items()):
    sizes, percent = zip(*sorted(values))
    axes.loglog(sizes, percent, 'o-', label=f'loop {loop}', linewidth=1, markersize=4)
sizes = sorted({h for values in errors.values() for h, _ in values})
worst = max(e for values in errors.values() for h, e in values if h == sizes[-1])
for order, style in ((2, ':'), (3, '--')):
    axes.loglog(sizes, [worst * (h / sizes[-1]) ** order for h in sizes], 'k' + style, linewidth=1, label=f'order {order}')
axes.set_xlabel('element size near the loop (loops 2 to 3.5 deep)')
axes.set_ylabel('largest error of the correction stress (%)')
axes.set_xticks(sizes, [f'{h:g}' for h in sizes])
axes.minorticks_off()
axes.legend(fontsize=7, ncol=2)
figure.tight_layout()
figure.savefig(sys.argv[2], dpi=150)
