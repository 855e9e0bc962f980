#!/usr/bin/python3
"""Draws the cost of finding collisions against the size of the network.

  plot.py RESULTS.json FIGURE.png

RESULTS.json: output of `ddfem_benchmarks --benchmark_filter=detect --benchmark_out=RESULTS.json`, with or without
repetitions (the medians are drawn).
"""
import json
import statistics
import sys
from collections import defaultdict

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

CURVES = [  # benchmark, counter, label, marker
    ("detect_collisions", "build_ns", "building the lists, when it is due", "s"),
    ("detect_collisions", "step_ns", "a step, on average", "o"),
    ("detect_collisions", "keep_ns", "a step without build: keeping the lists", "^"),
    ("detect_collisions", "detect_ns", "exact detection on the pairs", "v"),
]


def read(name):
    """{(benchmark, threads): {segments: {counter: median}}}"""
    with open(name, encoding="utf-8") as file:
        runs = [run for run in json.load(file)["benchmarks"] if run["run_type"] == "iteration"]
    values = defaultdict(lambda: defaultdict(lambda: defaultdict(list)))
    for run in runs:
        parts = run["name"].split("/")
        threads = int(next(p for p in parts if p.startswith("threads:")).split(":")[1])
        for counter, value in run.items():
            if counter.endswith("_ns"):
                values[parts[0], threads][run["segments"]][counter].append(value)
    return {
        key: {n: {c: statistics.median(v) for c, v in counters.items()} for n, counters in sizes.items()}
        for key, sizes in values.items()
    }


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    results = read(sys.argv[1])
    figure, axes = plt.subplots(figsize=(6.4, 4.4), constrained_layout=True)
    for index, (benchmark, counter, label, marker) in enumerate(CURVES):
        for threads, style in ((1, "-"), (2, ":")):
            sizes = results.get((benchmark, threads))
            if sizes:
                n = sorted(sizes)
                axes.loglog(n, [k * sizes[k][counter] * 1e-6 for k in n], style, color=f"C{index}", marker=marker,
                            label=label if threads == 1 else None)
    low, high = axes.get_xlim()
    axes.loglog([low, high], [1e-3 * low, 1e-3 * high], "k--", linewidth=0.8, label="1 µs per segment")
    axes.set_xlim(low, high)
    axes.set_xlabel("segments")
    axes.set_ylabel("time of all cores, ms (dotted: two threads)")
    axes.legend(frameon=False)
    figure.savefig(sys.argv[2], dpi=150)


if __name__ == "__main__":
    main()
