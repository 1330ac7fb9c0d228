"""Draw the error of each level of the gravity-gradient theory, relative to the effect of the torque on the attitude.

make gravity    writes docs/data/gravity-*.csv from integrations of the full equations, and docs/gravity-gradient.png from them
"""

import csv
from collections import defaultdict
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt

DOCS = Path(__file__).resolve().parents[1] / "docs"
# Colours of Okabe and Ito, which colour-blind readers can distinguish, and a different marker for each level.
# The level "paper" is drawn last, dashed and with open markers, so that a curve under it is visible.
LEVELS: dict[str, dict[str, Any]] = {
    "full": {"color": "#009E73", "marker": "^"},
    "moving": {"color": "#0072B2", "marker": "s"},
    "paper": {"color": "#D55E00", "marker": "o", "linestyle": "--", "markerfacecolor": "none", "markersize": 7},
}
PANELS = {"J": "J [rad]", "n/spin": "n / spin", "e": "eccentricity e", "(B-A)/C": "(B − A) / C"}


def main() -> None:
    """Draw the four panels."""
    series: dict[str, list[dict[str, str]]] = defaultdict(list)
    with (DOCS / "data" / "gravity-levels.csv").open(encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            series[row["varied"]].append(row)
    figure, grid = plt.subplots(2, 2, figsize=(9.0, 6.6), sharey=True, layout="constrained")
    for axes, (varied, label) in zip(grid.flat, PANELS.items(), strict=True):
        rows = series[varied]
        for level, style in LEVELS.items():
            values = [float(row["value"]) for row in rows]
            axes.plot(values, [float(row[level]) for row in rows], label=level, **{"markersize": 4, **style})
        axes.set_xscale("linear" if varied == "e" else "log")
        axes.set_yscale("log")
        axes.set_xlabel(label)
        axes.grid(visible=True, which="major", alpha=0.3)
    for axes in grid[:, 0]:
        axes.set_ylabel("left of the torque's effect")
    figure.legend(*grid[0, 0].get_legend_handles_labels(), title="level", loc="outside lower center", ncols=len(LEVELS))
    figure.suptitle("Base scene: J = 0.02, n/spin = 2e-3, e = 0.1, (B − A)/C = 0.019, inclination 0.4 rad, 3 orbits")
    figure.savefig(DOCS / "gravity-gradient.png", dpi=150)


if __name__ == "__main__":
    main()
