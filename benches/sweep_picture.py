"""The picture and the table of sweep.py: time against error for the series and the closed form.

The colours are those of Okabe and Ito, which colour-blind readers can distinguish. Each σ/σ_sep also has its own marker, and the closed form has dashed lines.
"""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
from matplotlib.lines import Line2D

# σ/σ_sep drawn: its colour and marker.
DRAWN = {0.05: ("#0072B2", "o"), 0.3: ("#009E73", "s"), 0.6: ("#E69F00", "^"), 0.9: ("#CC79A7", "D")}
COSTS = {"sample_ns": "evaluation [ns/sample]", "setup_us": "set-up [μs]"}
STYLE: dict[Any, Any] = {"font.size": 10, "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False}
MARKS = ("<!-- measured -->\n", "<!-- end -->\n")


def select(rows: Sequence[Any], **wanted: object) -> list[Any]:
    """The rows whose fields have these values."""
    return [row for row in rows if all(getattr(row, name) == value for name, value in wanted.items())]


def draw(rows: Sequence[Any], path: Path) -> None:
    """Write the picture: a column for each β, the evaluation above the set-up."""
    betas = sorted({row.beta for row in rows})
    with plt.rc_context(STYLE):
        figure, grid = plt.subplots(len(COSTS), len(betas), figsize=(13, 8), sharex=True, sharey="row", layout="constrained")
        for axes_row, (cost, label) in zip(grid, COSTS.items(), strict=True):
            for axes, beta in zip(axes_row, betas, strict=True):
                _curves(axes, select(rows, beta=beta), cost)
            axes_row[0].set_ylabel(label)
        for axes, beta in zip(grid[0], betas, strict=True):
            axes.set_title(f"β = {beta}")
        for axes in grid[-1]:
            axes.set_xlabel("largest attitude error over 100 rotations [rad]")
        grid[0, 0].set_xlim(10, 3e-17)  # shared: accuracy grows to the right
        for axes in grid[0]:
            axes.set_ylim(bottom=0)
        handles = [Line2D([], [], color=color, marker=marker, label=f"σ/σ_sep = {ratio}") for ratio, (color, marker) in DRAWN.items()]
        handles += [
            Line2D([], [], color="black", label="series, orders 1 to 40"),
            Line2D([], [], color="black", linestyle="--", marker="*", label="closed form, tolerances 1e-3 to 1e-15", markersize=9),
        ]
        figure.legend(handles=handles, loc="outside lower center", ncols=6)
        figure.suptitle("What accuracy costs: series and closed form, one thread", fontweight="bold")
        figure.savefig(path, dpi=110)
        plt.close(figure)


def _curves(axes: Any, rows: Sequence[Any], cost: str) -> None:
    """Draw time against error for the orders of the series and the tolerances of the closed form, at each σ/σ_sep of the picture."""
    for ratio, (color, marker) in DRAWN.items():
        here = select(rows, separatrix_ratio=ratio)
        for chosen, style in ((select(here, fixed="order"), "-"), (select(here, method="closed"), "--")):
            mark = {"marker": marker, "markersize": 3.5} if style == "-" else {"marker": "*", "markersize": 9}
            axes.plot([row.error for row in chosen], [getattr(row, cost) for row in chosen], color=color, linestyle=style, linewidth=1.2, **mark)
    # Set-up spans three decades; the time of a sample hardly moves, and from 0 that is seen.
    axes.set(xscale="log", yscale="log" if cost == "setup_us" else "linear")
    axes.grid(True, which="major", color="#DDDDDD", linewidth=0.6)


def _cell(row: Any) -> str:
    """Order, harmonics, error and times of one row, as cells of the table."""
    order = f"{row.order} / " if row.method == "series" else ""
    return f"{order}{row.harmonics} | {row.error:.1e} | {row.setup_us:.0f} | {row.sample_ns:.1f}"


def table(rows: Sequence[Any]) -> str:
    """The table of both methods at each tolerance and σ/σ_sep, for β = 0.5, as Markdown."""
    lines = [
        "| σ/σ_sep | tolerance | series: order / harmonics | error [rad] | set-up [μs] | ns/sample | closed form: harmonics | error [rad] | set-up [μs] | ns/sample |",
        "|---" * 10 + "|",
    ]
    for closed in select(rows, beta=0.5, method="closed"):
        if closed.separatrix_ratio not in (0.01, 0.1, 0.3, 0.5, 0.7, 0.9) or closed.tolerance not in (1e-3, 1e-6, 1e-12):
            continue
        found = select(rows, beta=0.5, separatrix_ratio=closed.separatrix_ratio, tolerance=closed.tolerance, fixed="tolerance", method="series")
        series = _cell(found[0]) if found else "none up to 60 | | |"
        lines.append(f"| {closed.separatrix_ratio} | {closed.tolerance:.0e} | {series} | {_cell(closed)} |".replace("e-0", "e-"))
    return "\n".join(lines) + "\n"


def write_table(rows: Sequence[Any], path: Path) -> None:
    """Write the table between the marks of the page."""
    page = path.read_text(encoding="utf-8")
    (before, rest), mark, end = page.split(MARKS[0]), *MARKS
    path.write_text(before + mark + "\n" + table(rows) + "\n" + end + rest.split(end)[1], encoding="utf-8")
