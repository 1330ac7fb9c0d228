"""Measure the cost of librations by order and eccentricity, and draw it.

    python benches/libration_cost.py             docs/data/libration-cost.csv, then the picture docs/libration-cost.png; some minutes
    python benches/libration_cost.py --picture   the picture alone

Each row is a process of its own (`librations`, built by cargo): a body with amplitudes of 1 degree over 1,000 orbits, at a fixed order. A circle has the moments 0.55, 0.8, 1, an ellipse those of
the Moon (0.99948, 0.999772, 1). Times are those of the processor. `kept_mib` is the memory of the normal forms that serve the next state, of all orders up to this one; `peak_mib` is that of the process.
"""

import argparse
import csv
import subprocess
import sys
from pathlib import Path

from figures import ROOT

DATA = ROOT / "docs" / "data" / "libration-cost.csv"
PICTURE = ROOT / "docs" / "libration-cost.png"
PROGRAM = ROOT / "target" / "release" / "librations"
COLUMNS = ["eccentricity", "order", "degrees", "first_s", "next_s", "harmonics", "sample_ns", "kept_mib", "peak_mib", "error", "estimate"]
DEGREES = 1.0
ORDERS = {0.0: range(2, 13, 2), 0.01: range(2, 7, 2), 0.0549: range(2, 7, 2), 0.1: range(2, 5, 2)}
LONGEST = 60.0
"""No higher order is tried after one that takes so many seconds."""
STYLES = ["o-", "s--", "^-.", "D:"]
COLORS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7"]


def measured():
    """The rows, each from a process of its own."""
    for eccentricity, orders in ORDERS.items():
        for order in orders:
            arguments = [str(PROGRAM), str(eccentricity), str(order), str(DEGREES)]
            line = subprocess.run(arguments, capture_output=True, text=True, check=True).stdout.strip()
            print(line, flush=True)
            row = dict(zip(COLUMNS, line.split(","), strict=False))
            if not row["harmonics"]:
                break
            yield row
            if float(row["first_s"]) > LONGEST:
                break


def draw(rows, path):
    """Write the picture: first solution, next state, memory and error by order."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    panels = {"first_s": "first solution [s]", "next_s": "next state [s]", "kept_mib": "memory of the forms [MiB]", "error": "error over 1,000 orbits [rad]"}
    with plt.rc_context({"font.size": 10, "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False}):
        figure, grid = plt.subplots(2, 2, figsize=(9.0, 6.6), sharex=True, layout="constrained")
        for axes, (column, label) in zip(grid.flat, panels.items(), strict=True):
            for eccentricity, style, color in zip(ORDERS, STYLES, COLORS, strict=True):
                here = [row for row in rows if float(row["eccentricity"]) == eccentricity]
                axes.semilogy(
                    [int(row["order"]) for row in here], [max(float(row[column]), 1e-13) for row in here], style, color=color, label=f"e = {eccentricity:g}"
                )
            axes.set_ylabel(label)
            axes.grid(visible=True, which="major", alpha=0.3)
        for axes in grid[1]:
            axes.set_xlabel("order")
        figure.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=len(ORDERS))
        figure.suptitle("Librations of 1° over 1,000 orbits, by order and eccentricity")
        figure.savefig(path, dpi=130)
        plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--picture", action="store_true", help="draw from the file that is there")
    parser.add_argument("--data", type=Path, default=DATA)
    parser.add_argument("--output", type=Path, default=PICTURE)
    options = parser.parse_args()
    if not options.picture:
        subprocess.run(
            ["cargo", "build", "--release", "--locked", "--quiet", "-p", "andoyer-benches", "--features", "programs", "--bin", "librations"],
            cwd=ROOT,
            check=True,
        )
        rows = list(measured())
        with options.data.open("w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
            writer.writeheader()
            writer.writerows(rows)
    with options.data.open(encoding="utf-8", newline="") as file:
        draw(list(csv.DictReader(file)), options.output)
    return 0


if __name__ == "__main__":
    sys.exit(main())
