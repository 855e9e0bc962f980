#!/usr/bin/env python3
"""Finds the critical stress of Frank-Read sources by bisection and writes DIR/critical_stress.csv.

Every trial is a run of ddfem at constant resolved shear stress. The source has operated when it has swept 1.5 L^2 (the
unstable shape has swept less than L^2), and has not when all nodes are slower than 5e-4 tau b / B. The stresses of the
last two trials that differ in outcome enclose the critical stress.
"""
import argparse
import csv
import math
import os
import re
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor

HERE = os.path.dirname(os.path.abspath(__file__))
LENGTHS = [100e-9, 200e-9, 400e-9, 800e-9, 1600e-9]
DRAG = 2e-5                                      # Pa s, aluminium
COLUMNS = ['character', 'length [m]', 'maximum segment [m]', 'lower stress [Pa]', 'upper stress [Pa]',
           'critical stress [Pa]', 'shear modulus [Pa]', 'poisson ratio [-]', 'burgers vector [m]', 'trials', 'wall time [s]']


def medium(program):
    """Shear modulus, Poisson's ratio and Burgers vector (SI) as the program reports them."""
    text = subprocess.run([program, 'check', f'{HERE}/input.prm'], capture_output=True, text=True, check=True).stdout
    m = re.search(r'mu = ([\d.e+-]+) GPa, nu = ([\d.e+-]+), b = ([\d.e+-]+) nm', text)
    if not m:
        sys.exit(f'cannot read the material from: {text}')
    return float(m[1]) * 1e9, float(m[2]), float(m[3]) * 1e-9


def estimate(character, length, mu, nu, b):
    """First guess: A (mu b / 2 pi L) (ln(L/b) + B) with A of the line-tension model and a rough B."""
    factor, offset = (1, 0.0) if character == 'edge' else (1 / (1 - nu), -0.7)
    return factor * mu * b / (2 * math.pi * length) * (math.log(length / b) + offset)


def operates(options, character, length, max_segment, stress, constants):
    mu, nu, b = constants
    side = 10 * length
    strain = b * 1.5 * length ** 2 / (math.sqrt(2) * side ** 3)
    settings = {
        'Microstructure/Frank-Read sources':
            f'1 1 1 / -1 0 1 / 0 0 0 / {length:.8g} / {90 if character == "edge" else 0}',
        'Domain/Size': f'{side:.6g} {side:.6g} {side:.6g}',
        'Loading/Stress': f'0 0 0 0 {stress:.8g} 0',
        'Discretisation/Minimum segment': f'{options.minimum_ratio * max_segment:.8g}',
        'Discretisation/Maximum segment': f'{max_segment:.8g}',
        'Time stepping/Final plastic strain': f'{strain:.8g}',
        'Time stepping/Equilibrium speed': f'{5e-4 * stress * b / DRAG:.6g}',
    }
    directory = f'{options.output}/{character}_{length * 1e9:.0f}nm_{length / max_segment:.0f}_{stress / 1e6:.4f}MPa'
    command = [options.program, 'run', f'{HERE}/input.prm', '-o', directory, '--threads', '1']
    for key, value in settings.items():
        command += ['--set', f'{key}={value}']
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        raise RuntimeError(f'{" ".join(command)}\n{result.stdout}{result.stderr}')
    with open(f'{directory}/history.csv') as f:
        last = list(csv.DictReader(f))[-1]
    swept = float(last['plastic strain xz [-]'])
    if math.sqrt(2) * abs(swept) >= strain * 0.999:
        if swept < 0:
            raise RuntimeError(f'{directory}: the source moved against the applied stress')
        return True
    if float(last['max speed [m/s]']) <= 5.001e-4 * stress * b / DRAG:
        return False
    raise RuntimeError(f'{directory}: neither operated nor at rest after {last["step"]} steps')


def critical_stress(options, character, length, pieces, constants, log=print):
    """Row of the table; @p pieces: length of the source over the maximum segment."""
    begin, trials = time.time(), 0
    guess = estimate(character, length, *constants)
    low, high, factor = 0.0, math.inf, 1.02
    stress = guess
    while high / max(low, 1e-30) > 1 + options.tolerance:
        trials += 1
        if operates(options, character, length, length / pieces, stress, constants):
            high = stress
        else:
            low = stress
        if low == 0.0:
            stress = high / factor
        elif math.isinf(high):
            stress = low * factor
        else:
            stress = math.sqrt(low * high)
        if trials > 30:
            raise RuntimeError(f'{character} {length}: no bracket')
    row = [character, length, length / pieces, low, high, math.sqrt(low * high), *constants, trials,
           round(time.time() - begin, 1)]
    log(f'{character:5s}  L = {length * 1e9:6.0f} nm  L / L_max = {pieces:2d}  tau_c = {row[5] / 1e6:8.3f} MPa'
        f'  ({trials} trials, {row[-1]:.0f} s)', flush=True)
    return row


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('-o', '--output', default='results/frank_read_critical_stress', help='directory for everything')
    parser.add_argument('--program', default='build/release/ddfem', help='the program (default build/release/ddfem)')
    parser.add_argument('--quick', action='store_true', help='two lengths, coarse lines, 2 %%')
    parser.add_argument('--jobs', type=int, default=2, help='sources at a time (default 2)')
    parser.add_argument('--tolerance', type=float, default=0.01, help='width of the final bracket (default 0.01)')
    parser.add_argument('--case', nargs=3, metavar=('CHARACTER', 'LENGTH', 'PIECES'),
                        help='one source only, for example: edge 200e-9 12 (L / maximum segment)')
    parser.add_argument('--minimum-ratio', type=float, default=0.3, help='minimum over maximum segment (default 0.3)')
    options = parser.parse_args()
    os.makedirs(options.output, exist_ok=True)
    os.environ['OMP_NUM_THREADS'] = '1'
    constants = medium(options.program)
    if options.case:
        cases = [(options.case[0], float(options.case[1]), int(options.case[2]))]
    elif options.quick:
        options.tolerance = max(options.tolerance, 0.02)
        cases = [(c, length, 8) for c in ('edge', 'screw') for length in (200e-9, 800e-9)]
    else:
        cases = [(c, length, 12) for c in ('edge', 'screw') for length in LENGTHS]
        cases += [(c, 200e-9, pieces) for c in ('edge', 'screw') for pieces in (6, 18)]  # convergence
    with ThreadPoolExecutor(options.jobs) as pool:
        rows = list(pool.map(lambda case: critical_stress(options, *case, constants), cases))
    path = f'{options.output}/critical_stress.csv'
    with open(path, 'w', newline='') as f:
        writer = csv.writer(f)
        writer.writerow(COLUMNS)
        writer.writerows(rows)
    print(f'wrote {path}')


if __name__ == '__main__':
    main()
