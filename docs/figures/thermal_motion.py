#!/usr/bin/env python3
"""Thermal motion against what statistical mechanics predicts.

usage: thermal_motion.py WALK DRIFT MODES OUT.png, the first three being the output of `ddfem_thermal_benchmark walk`, `drift`, `modes`
"""
import re
import sys

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt

walk, drift, modes = (open(name).read() for name in sys.argv[1:4])
numbers = re.compile(r'^ *(?:[-\d.]+ +){4,}[-\d.]+ *$', re.M)


def rows(text):
    return [[float(x) for x in m[0].split()] for m in numbers.finditer(text)]


figure, (left, middle, right) = plt.subplots(1, 3, figsize=(11, 3.4))
for part in re.split(r'(?=loop of radius)', walk)[1:]:
    radius = re.match(r'loop of radius ([\d.]+)', part)[1]
    t, square, expected, ratio, error = zip(*rows(part))
    bars = left.errorbar(t, square, [e * x for e, x in zip(error, expected)], fmt='o', markersize=3, label=f'radius {radius} nm')
    left.plot(t, expected, '-', color=bars[0].get_color(), linewidth=1)
left.set_xlabel('time (ns)')
left.set_ylabel('mean square displacement (nm$^2$)')
left.legend(title='200 loops; lines: 2 kT t/(B perimeter)', fontsize=7, title_fontsize=7)

t, mean, predicted, still, error, _ = zip(*rows(drift))
middle.errorbar(t, mean, error, fmt='o', markersize=3, label='200 loops')
middle.plot(t, predicted, '-', linewidth=1, label='random walker in the image force')
middle.plot(t, still, '--', linewidth=1, label='image force without noise')
middle.set_xlabel('time (ns)')
middle.set_ylabel('mean motion from 24 nm depth (nm)')
middle.legend(fontsize=7)

for part in re.split(r'(?=core forces|elastic forces)', modes)[1:]:
    kind, segments = re.match(r'(\w+) forces, (\d+) segments', part).groups()
    values = [(float(v), float(e)) for v, e in re.findall(r'([\d.]+)\(([\d.]+)\)', part)]
    right.errorbar([(k + 1) / int(segments) for k in range(len(values))], [v for v, _ in values], [e for _, e in values],
                   fmt='o' if kind == 'core' else 's', markersize=2.5, linewidth=0.7, label=f'{segments} segments, {kind}')
right.axhspan(0.97, 1.03, color='0.9', zorder=0)
right.set_ylim(0.94, 1.08)
right.set_xlabel('number of the mode / number of segments')
right.set_ylabel('stiffness x mean square amplitude / kT')
right.legend(fontsize=6)
figure.tight_layout()
figure.savefig(sys.argv[4], dpi=150)
