"""Draw the error of each level of the gravity-gradient theory, relative to the effect of the torque on the attitude.

make gravity    writes docs/data/gravity-*.csv from integrations of the full equations, and docs/gravity-gradient.png and docs/gravity-share.png from them
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


ECCENTRICITIES = {"0": ("#0072B2", "o"), "0.3": ("#009E73", "s"), "0.6": ("#E69F00", "^"), "0.9": ("#D55E00", "D")}
ORDERS: dict[str, dict[str, Any]] = {"full": {"linestyle": "-"}, "second-order": {"linestyle": "--", "markerfacecolor": "none"}}


def read(name: str) -> list[dict[str, str]]:
    """The rows of a file of figures."""
    with (DOCS / "data" / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def shares() -> None:
    """Draw what random scenes lose, and of how many the theory holds, by n/spin, eccentricity and level."""
    figure, (error, served) = plt.subplots(1, 2, figsize=(9.0, 4.2), layout="constrained")
    rows = read("gravity-table.csv")
    for eccentricity, (color, marker) in ECCENTRICITIES.items():
        for level, style in ORDERS.items():
            here = [row for row in rows if (row["e"], row["level"]) == (eccentricity, level) and int(row["accepted"])]
            error.plot([float(row["n"]) for row in here], [float(row["median_share"]) for row in here], color=color, marker=marker, markersize=5, **style)
        here = [row for row in rows if (row["e"], row["level"]) == (eccentricity, "full")]
        held = [100 * int(row["accepted"]) / int(row["scenes"]) for row in here]
        served.plot([float(row["n"]) for row in here], held, color=color, marker=marker, markersize=5, label=f"e = {eccentricity}")
    error.plot([], [], color="black", label="full", **ORDERS["full"])
    error.plot([], [], color="black", label="second-order", **ORDERS["second-order"])
    error.set(xscale="log", yscale="log", xlabel="n / spin", ylabel="error / effect of the torque, median")
    served.set(xscale="log", xlabel="n / spin", ylabel="scenes that the theory serves [%]", ylim=(-3, 103))
    for axes in (error, served):
        axes.grid(visible=True, which="major", alpha=0.3)
        axes.legend(frameon=False)
    figure.savefig(DOCS / "gravity-share.png", dpi=150)
    plt.close(figure)


def main() -> None:
    """Draw both pictures."""
    shares()
    series: dict[str, list[dict[str, str]]] = defaultdict(list)
    for row in read("gravity-levels.csv"):
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
