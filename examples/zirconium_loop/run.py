#!/usr/bin/env python3
"""Runs the three cases of the example: the kind of the loop and its side of the glide plane.

usage: run.py --program DDFEM -o DIR
"""
import argparse
import os
import subprocess

LOOPS = {'vacancy_above': '1 1 -2 0 / 1 1 -2 0 / 3e-8 2e-8 0 / 8e-9 / 0',
         'interstitial_above': '1 1 -2 0 / -1 -1 2 0 / 3e-8 2e-8 0 / 8e-9 / 0',
         'interstitial_below': '1 1 -2 0 / -1 -1 2 0 / 3e-8 -2e-8 0 / 8e-9 / 0'}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--program', required=True)
    parser.add_argument('-o', '--output', required=True)
    arguments = parser.parse_args()
    folder = os.path.dirname(os.path.abspath(__file__))
    for name, loop in LOOPS.items():
        subprocess.run([arguments.program, 'run', os.path.join(folder, 'input.prm'), '-o', os.path.join(arguments.output, name),
                        '--set', 'Microstructure/Loops=' + loop], check=True)


if __name__ == '__main__':
    main()
