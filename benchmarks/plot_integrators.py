#!/usr/bin/python3
"""Figure of what `ddfem_integrators_benchmark orders` prints: error of a bowing source against the step, with the order of each integrator.

usage: plot_integrators.py OUTPUT_OF_THE_BENCHMARK FIGURE.png
"""
import math
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt


def read(path):
    """Names of the integrators, and rows of step and errors."""
    with open(path, encoding="utf-8") as file:
        names = file.readline().split(":")[1].strip().strip(";").split(";")
        return names, [[float(x) for x in line.split(";")] for line in file]


def slope(steps, errors):
    """Between the two smallest errors that rounding and the reference do not spoil."""
    good = [(h, e) for h, e in zip(steps, errors) if e > 1e-10][-2:]
    return math.log(good[0][1] / good[1][1]) / math.log(good[0][0] / good[1][0])


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    names, rows = read(sys.argv[1])
    figure, axes = plt.subplots(figsize=(6.5, 4.6), layout="constrained")
    for k, name in enumerate(names):
        steps, errors = zip(*[(r[0], r[k + 1]) for r in rows if not math.isnan(r[k + 1])])
        axes.loglog(steps, errors, "o-", markersize=4, label=f"{name}: order {slope(steps, errors):.2f}")
        print(f"{name}: order {slope(steps, errors):.3f}, largest stable step of the table {max(steps):g} ns")
    axes.set_xlabel("step [ns]")
    axes.set_ylabel("largest error of a node after 2 ns [nm]")
    axes.set_ylim(1e-9, 1e2)
    axes.grid(True, which="major", linewidth=0.3)
    axes.legend(fontsize=8)
    figure.savefig(sys.argv[2], dpi=150)


if __name__ == "__main__":
    main()
