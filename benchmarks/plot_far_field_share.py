#!/usr/bin/python3
"""Draws the shares of near and far field against the depth of the tree, as figures IV.28 to IV.30 of Durocher's thesis.

  plot_far_field_share.py RESULTS.csv FIGURES

RESULTS.csv: written by `ddfem_far_field_share_benchmark` (the medians over the steps are drawn). FIGURES: beginning of the
names of the three pictures.
"""
import csv
import statistics
import sys
from collections import defaultdict

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

FAR = [("upward", "upward"), ("translations", "translations"), ("downward", "downward"), ("points", "at points"),
       ("images", "distant images")]
NEAR = [("near", "near field at points"), ("close", "close pairs in closed form")]
PHASES = [("tree", "tree")] + NEAR + FAR
TITLES = {"Frank-Read": "case 1, Frank-Read sources", "loops": "case 2, loops"}


def read(name):
    """{case: {(depth, mode): {phase: median, ms}}}; depth 0 is that by cost."""
    values = defaultdict(lambda: defaultdict(lambda: defaultdict(list)))
    with open(name, encoding="utf-8") as file:
        for row in csv.DictReader(file):
            for phase, _ in PHASES:
                values[row["case"]][int(row["depth"]), row["mode"]][phase].append(1e3 * float(row[phase]))
    return {case: {key: {phase: statistics.median(v) for phase, v in phases.items()} for key, phases in runs.items()}
            for case, runs in values.items()}


def total(phases, names=PHASES):
    return sum(phases[name] for name, _ in names)


def depths(runs):
    return sorted({depth for depth, _ in runs if depth > 0})


def best(runs, mode):
    return min(depths(runs), key=lambda depth: total(runs[depth, mode]))


def figure_modes(results):
    """IV.28: what cut-off and full cost, each at its best depth and at that by cost."""
    figure, all_axes = plt.subplots(1, len(results), figsize=(9.6, 4.2), constrained_layout=True, squeeze=False)
    for axes, (case, runs) in zip(all_axes[0], results.items()):
        bars = [(depth, mode) for mode in ("cut-off", "full") for depth in (best(runs, mode), 0)]
        bottom = [0.0] * len(bars)
        for index, (phase, label) in enumerate(PHASES):
            heights = [runs[bar][phase] for bar in bars]
            if max(heights) > 0:
                axes.bar(range(len(bars)), heights, 0.65, bottom, color=f"C{index}", label=label)
            bottom = [b + h for b, h in zip(bottom, heights)]
        axes.set_xticks(range(len(bars)), [f"{mode}\n{f'depth {depth}' if depth else 'by cost'}" for depth, mode in bars])
        axes.set_title(TITLES[case])
        axes.set_ylabel("time of the forces of a step, ms")
        handles, labels = axes.get_legend_handles_labels()
        axes.legend(handles[::-1], labels[::-1], frameon=False, fontsize=8, loc="upper left")
    return figure


def figure_shares(results):
    """IV.29: near and far field by depth."""
    figure, all_axes = plt.subplots(1, len(results), figsize=(9.6, 4.2), constrained_layout=True, squeeze=False)
    for axes, (case, runs) in zip(all_axes[0], results.items()):
        x = depths(runs)
        labels = [str(depth) for depth in x] + ["by cost"]
        keys = [(depth, "full") for depth in x + [0]]
        near, far = ([total(runs[key], names) / total(runs[key]) for key in keys] for names in (NEAR, FAR))
        axes.bar(labels, near, 0.65, color="C0", label="near field, close pairs")
        axes.bar(labels, far, 0.65, near, color="C1", label="far field")
        axes.bar(labels, [1 - n - f for n, f in zip(near, far)], 0.65, [n + f for n, f in zip(near, far)], color="C7",
                 label="tree")
        for k, f in enumerate(far):
            axes.text(k, near[k] + f / 2, f"{100 * f:.0f} %", ha="center", va="center", fontsize=8)
        axes.set_title(TITLES[case])
        axes.set_xlabel("depth of the tree")
        axes.set_ylabel("share of the time of the forces")
        axes.set_ylim(0, 1.18)
        axes.set_yticks([0, 0.25, 0.5, 0.75, 1])
        axes.legend(frameon=False, fontsize=8, ncols=3, loc="upper center")
    return figure


def figure_depths(results):
    """IV.30: time by depth."""
    figure, all_axes = plt.subplots(1, len(results), figsize=(9.6, 4.2), constrained_layout=True, squeeze=False)
    for axes, (case, runs) in zip(all_axes[0], results.items()):
        x = depths(runs)
        curves = [("full", total, "full", "C3", "o"), ("full", lambda p: total(p, FAR), "far field", "C1", "^"),
                  ("full", lambda p: total(p, NEAR), "near field, close pairs", "C0", "v"),
                  ("cut-off", total, "cut-off", "C7", "s")]
        for mode, quantity, label, colour, marker in curves:
            axes.semilogy(x, [quantity(runs[depth, mode]) for depth in x], color=colour, marker=marker, label=label)
        axes.axhline(total(runs[0, "full"]), color="k", linestyle="--", linewidth=0.8, label="full, by cost")
        axes.set_xticks(x)
        low, high = axes.get_ylim()
        ticks = [t for t in (100, 200, 500, 1000, 2000, 5000, 10000) if low < t < high]
        axes.set_yticks(ticks, [str(t) for t in ticks])
        axes.minorticks_off()
        axes.set_title(TITLES[case])
        axes.set_xlabel("depth of the tree")
        axes.set_ylabel("time of a step, ms")
        axes.legend(frameon=False, fontsize=8)
    return figure


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    results = read(sys.argv[1])
    for name, draw in (("modes", figure_modes), ("shares", figure_shares), ("depths", figure_depths)):
        draw(results).savefig(f"{sys.argv[2]}_{name}.png", dpi=130)


if __name__ == "__main__":
    main()
