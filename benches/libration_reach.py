"""Draw the share of random locked scenes that a libration serves, by amplitude and shape.

make libration-reach    writes docs/data/libration-reach.csv (`libration reach 300 1`) and docs/libration-reach.png from it

Each row of the file is a scene of 1,000 orbits with a tolerance of 1e-8: `difference` is (B - A)/C, `amplitude` is in degrees, `served` is 1 if the plan meets the tolerance, `reached` is 1 if some order from 4 to 12 comes to 1e-8. A cell
of the picture has the number of scenes that are served, of those that an order reaches, and of all.
"""

import argparse
import csv
import sys
from pathlib import Path

from figures import ROOT

DATA = ROOT / "docs" / "data" / "libration-reach.csv"
PICTURE = ROOT / "docs" / "libration-reach.png"
NEEDED = ["difference", "eccentricity", "amplitude", "served", "reached"]
SHAPES = [1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 0.3]
AMPLITUDES = [0.0, 0.3, 1.0, 3.0, 10.0]
PANELS = {"circle": lambda row: row["eccentricity"] == 0, "ellipse, e up to 0.3": lambda row: row["eccentricity"] > 0}


def read(path):
    """The rows as numbers."""
    with path.open(encoding="utf-8", newline="") as file:
        reader = csv.DictReader(file)
        missing = [name for name in NEEDED if name not in (reader.fieldnames or [])]
        if missing:
            raise SystemExit(f"{path}: no column {', '.join(missing)}; it has {', '.join(reader.fieldnames or [])}")
        return [{name: float(row[name] or "nan") for name in NEEDED} for row in reader]


def shares(rows):
    """Served, reached and all scenes of each cell, amplitudes by shapes."""
    cells = [[[0, 0, 0] for _ in SHAPES[1:]] for _ in AMPLITUDES[1:]]
    for row in rows:
        i = next((k for k, top in enumerate(AMPLITUDES[1:]) if row["amplitude"] <= top), len(AMPLITUDES) - 2)
        j = next((k for k, top in enumerate(SHAPES[1:]) if row["difference"] <= top), len(SHAPES) - 2)
        cells[i][j][0] += int(row["served"] == 1)
        cells[i][j][1] += int(row["reached"] == 1)
        cells[i][j][2] += 1
    return cells


def draw(rows, path):
    """Write the picture: a panel for circles and one for ellipses, a cell with its share and its number of scenes."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    with plt.rc_context({"font.size": 10}):
        figure, grid = plt.subplots(1, len(PANELS), figsize=(10.5, 4.2), sharey=True, layout="constrained")
        for axes, (title, belongs) in zip(grid, PANELS.items(), strict=True):
            cells = shares([row for row in rows if belongs(row)])
            values = [[served / count if count else float("nan") for served, _, count in line] for line in cells]
            image = axes.imshow(values, origin="lower", aspect="auto", vmin=0, vmax=1, cmap="cividis")
            for i, line in enumerate(cells):
                for j, (served, reached, count) in enumerate(line):
                    if count:
                        color = "white" if served / count < 0.6 else "black"
                        axes.text(j, i, f"{served} / {reached} / {count}", ha="center", va="center", color=color, fontsize=9)
            axes.set_xticks([k - 0.5 for k in range(len(SHAPES))], [f"{shape:g}" for shape in SHAPES])
            axes.set_yticks([k - 0.5 for k in range(len(AMPLITUDES))], [f"{amplitude:g}" for amplitude in AMPLITUDES])
            axes.set(xlabel="(B − A)/C", title=title)
        grid[0].set_ylabel("amplitude [deg]")
        figure.colorbar(image, ax=grid, label="share of all that is served")
        figure.savefig(path, dpi=130)
        plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--data", type=Path, default=DATA)
    parser.add_argument("--output", type=Path, default=PICTURE)
    options = parser.parse_args()
    rows = read(options.data)
    draw(rows, options.output)
    served = sum(row["served"] == 1 for row in rows)
    print(f"{served} of {len(rows)} served: {options.output.name}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
