#!/usr/bin/python3
"""Figure of what ddfem_far_field_benchmark prints: time per segment by phase, and the direct sum.

usage: plot_far_field.py OUTPUT_OF_THE_BENCHMARK FIGURE.png
"""
import re
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

PHASES = ["tree and rest", "upward", "translations", "downward", "far at points", "near at points", "close pairs"]
COLOURS = ["#7f7f7f", "#aec7e8", "#1f77b4", "#c5d5ea", "#6baed6", "#ff7f0e", "#d62728"]


def read(path):
    """Number of segments, microseconds per segment of every phase, and of the direct sum (by number of segments)."""
    sizes, times, direct = [], [], {}
    with open(path, encoding="utf-8") as file:
        for line in file:
            if match := re.match(r" *(\d+) segments, order", line):
                sizes.append(int(match[1]))
                times.append([1e6 * float(re.search(rf"{p} ([\d.]+)", line)[1]) / sizes[-1] for p in PHASES])
            elif match := re.match(r" *direct sum ([\d.]+) s", line):
                direct[sizes[-1]] = 1e6 * float(match[1]) / sizes[-1]
    return sizes, times, direct


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sizes, times, direct = read(sys.argv[1])
    figure, axes = plt.subplots(figsize=(7.5, 4.2), layout="constrained")
    axes.stackplot(sizes, *zip(*times), labels=PHASES, colors=COLOURS)
    axes.plot(direct.keys(), direct.values(), "k--", label="direct sum, vectorised")
    axes.plot(sizes, [sum(t) for t in times], "k.", markersize=5)
    axes.set_xscale("log")
    axes.set_xlim(sizes[0], sizes[-1])
    axes.set_ylim(0, 1.5 * max(sum(t) for t in times))
    axes.set_xlabel("segments")
    axes.set_ylabel("processor time per segment, µs")
    handles, labels = axes.get_legend_handles_labels()
    axes.legend(handles[::-1], labels[::-1], ncols=2, fontsize=8, loc="upper right")
    figure.savefig(sys.argv[2], dpi=130)


if __name__ == "__main__":
    main()
