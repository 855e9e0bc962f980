#!/usr/bin/env python3
"""Measures a run of this example against what it must give; exits with status 1 when a limit is violated.

usage: measure.py DIR
"""
import sys

import numpy as np

from pillar import HEIGHT, NORMAL, SCHMID, SLIP, SOURCE, WIDTH, burgers, modulus, reader, strain_per_slip

# Resolved critical stress of this source (edge, 200 nm) in an infinite body, with this discretisation:
#   examples/frank_read_critical_stress/run.py --case edge 200e-9 5 --minimum-ratio 0.375
INFINITE_CRITICAL_STRESS = 40.2e6  # Pa


def slip_step(grain, b):
    """Mean jump and spread of the displacement along b across the glide plane, from linear fits on its two sides.

    Nodes of the four sides that are farther than 60 nm from the plane; the fits are extrapolated to the trace of the plane.
    """
    x, u = grain['points'].astype(float), grain['displacement_m'].astype(float) @ SLIP
    depth = (x - SOURCE) @ NORMAL
    side = np.maximum(abs(x[:, 0]), abs(x[:, 1])) > 0.499 * WIDTH
    angle = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    trace = np.stack([np.cos(angle), np.sin(angle)], 1)
    trace *= 0.5 * WIDTH / abs(trace).max(axis=1)[:, None]
    z = SOURCE[2] - trace @ NORMAL[:2] / NORMAL[2]
    trace = np.column_stack([trace, z])
    sides = []
    for sign in (1, -1):
        use = side & (sign * depth > 60e-9) & (x[:, 2] > 1e-9) & (x[:, 2] < HEIGHT - 1e-9)
        matrix = np.column_stack([np.ones(use.sum()), (x[use] - SOURCE) / HEIGHT])
        c = np.linalg.lstsq(matrix, u[use], rcond=None)[0]
        sides.append(np.column_stack([np.ones(len(trace)), (trace - SOURCE) / HEIGHT]) @ c)
    jump = sides[0] - sides[1]
    return jump.mean() / b, jump.std() / b


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    directory = sys.argv[1]
    h, b, e = reader.history(directory), burgers(directory), modulus(directory)
    strain, stress, plastic = h['strain [-]'], h['stress [Pa]'], h['axial plastic strain [-]']
    results = []

    early = abs(strain) < 3e-4
    slope = np.polyfit(strain[early], stress[early], 1)[0]
    results.append(('initial slope / modulus', slope / 1e9, e / 1e9, 'GPa', 0.01))

    exits = np.flatnonzero(h['surface exits'] > 0)
    yield_stress = abs(stress[:exits[0] if len(exits) else None]).max()
    results.append(('resolved yield stress / infinite body', yield_stress * SCHMID / 1e6, INFINITE_CRITICAL_STRESS / 1e6,
                    'MPa', 0.15))

    final = len(strain) - 1
    results.append(('plastic strain / (total - elastic)', plastic[final] * 1e6, (strain[final] - stress[final] / e) * 1e6,
                    '1e-6', 0.02))

    slips = abs(plastic[final]) / strain_per_slip(b)
    time, step, path = reader.frames(directory, 'grain')[-1]
    jump, spread = slip_step(reader.grain(path), b)
    results.append(('slip step / slips by plastic strain', abs(jump), slips, 'b', 0.05))

    print(f'{"quantity":40s} {"measured":>11s} {"expected":>11s} {"unit":>5s} {"difference":>11s} {"limit":>7s}')
    bad = 0
    for name, measured, expected, unit, limit in results:
        difference = measured / expected - 1
        ok = abs(difference) <= limit
        bad += not ok
        print(f'{name:40s} {measured:11.4f} {expected:11.4f} {unit:>5s} {100 * difference:+10.2f}% {100 * limit:6.0f}%'
              + ('' if ok else '  VIOLATED'))
    print(f'\nslip step: {abs(jump):.4f} b, varies by {spread:.4f} b along the trace (frame of step {step}, {time * 1e9:.1f} ns)')
    print(f'surface exits {h["surface exits"][-1]:.0f}, steps {h["step"][-1]:.0f}, wall time {h["wall time [s]"][-1]:.0f} s')
    largest = abs(plastic - (strain - stress / e)).max() / abs(plastic).max()
    print(f'largest plastic - (total - elastic) at any time: {100 * largest:.2f} % of the final plastic strain')
    sys.exit(1 if bad else 0)


if __name__ == '__main__':
    main()
