#!/usr/bin/env python3
"""Stress-strain curves of the same pillar on several meshes, and their differences from the finest one.

usage: pillar_meshes.py TABLE OUT.png, TABLE being the output of `validation_heavy_pillar_meshes`
"""
import re
import sys

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt
import numpy as np

curves = {}
with open(sys.argv[1]) as f:
    for m in re.finditer(r'curve (.+?) \| (\S+) (\S+) (\S+)', f.read()):
        curves.setdefault(m[1], []).append([float(m[k]) for k in (2, 3, 4)])
curves = {name: np.array(rows) for name, rows in curves.items()}
kinds = list(dict.fromkeys(name.split(',')[0] for name in curves))
figure, grid = plt.subplots(2, len(kinds), figsize=(4.6 * len(kinds), 6), squeeze=False, sharex='col',
                            gridspec_kw={'height_ratios': (2, 1)})
for (above, below), kind in zip(grid.T, kinds):
    names = [name for name in curves if name.split(',')[0] == kind]
    finest = curves[names[-1]]
    scale = np.abs(finest[:, 1]).max()
    for name in names:
        strain, stress = -curves[name][:, 0], -curves[name][:, 1]
        style = {'linewidth': 1, 'linestyle': '--' if 'distorted' in name else '-'}
        above.plot(100 * strain, 1e-6 * stress, label=name.split(', ', 1)[1], **style)
        common = strain <= -finest[-1, 0]
        difference = stress - np.interp(strain, -finest[:, 0], -finest[:, 1])
        below.plot(100 * strain[common], 100 * difference[common] / scale, **style)
    above.set_title(f'{kind} pillar', fontsize=9)
    above.set_ylabel('compressive stress (MPa)', fontsize=8)
    above.legend(fontsize=7)
    below.set_xlabel('compressive strain (%)', fontsize=8)
    below.set_ylabel('less finest (% of largest)', fontsize=8)
    for axes in (above, below):
        axes.tick_params(labelsize=7)
figure.tight_layout()
figure.savefig(sys.argv[2], dpi=130)
