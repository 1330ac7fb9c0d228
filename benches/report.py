"""Write the measured figures as text and pictures: the beginning of docs/speed.md, docs/performance.png, docs/rivals.png, the table of the README, the end of benches/README.md.

    python benches/report.py          `make report`, from docs/data

This script measures nothing, and refuses figures that are not those of one run (figures.py). The tables show where a rival is faster at the same error.
"""

import csv
import re
import sys
from collections.abc import Sequence
from typing import NamedTuple

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
from figures import DATA, ROOT, faults, provenance

MARKS = ("<!-- report: written by make report -->", "<!-- end -->")
# Colours of Okabe and Ito, with a marker each.
CURVES = {
    "series": ("#0072B2", "o", "series, orders 0 to 60"),
    "closed form": ("#D55E00", "*", "closed form, tolerances 1e-3 to 1e-15"),
    "SciPy closed form": ("#009E73", "s", "SciPy, closed form"),
    "SciPy DOP853": ("#CC79A7", "^", "SciPy, DOP853, tolerances 1e-4 to 1e-13"),
}
# The cases of tests/data/torque_free.json resemble these bodies.
PANELS = {
    "earth": "Earth-like",
    "ceres": "Ceres-like",
    "eros": "Eros-like",
    "triaxial": "triaxial, β = ½",
    "apophis": "Apophis-like",
    "near-separatrix-1e-2": "near the separatrix",
}
STYLE = {"font.size": 10, "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False}
SMALLEST = 1e-17  # where an error of zero is drawn


def read(name):
    """The rows of a file of docs/data."""
    with open(DATA / f"{name}.csv", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def draw(rows, path):
    """Draw the total run time against the error, with a panel for each scene and a curve for each engine."""
    with plt.rc_context(STYLE):
        figure, grid = plt.subplots(2, 3, figsize=(13, 8), sharex=True, sharey=True, layout="constrained")
        for axes, (scene, title) in zip(grid.flat, PANELS.items(), strict=True):
            for engine, (color, marker, label) in CURVES.items():
                here = [row for row in rows if (row["scene"], row["engine"]) == (scene, engine)]
                errors = [max(float(row["error"]), SMALLEST) for row in here]
                axes.plot(errors, [float(row["whole_ms"]) for row in here], color=color, marker=marker, markersize=5, linewidth=1.2, label=label)
            axes.set(title=title, xscale="log", yscale="log")
            axes.grid(True, which="major", color="#DDDDDD", linewidth=0.6)
        grid[0, 0].set_xlim(10, 3e-17)  # accuracy grows to the right
        for axes in grid[-1]:
            axes.set_xlabel("largest attitude error over 100 rotations [rad]")
        for axes in grid[:, 0]:
            axes.set_ylabel("set-up and 20,000 samples [ms]")
        figure.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
        figure.suptitle("What accuracy costs: one thread, uneven times, calls from Python", fontweight="bold")
        figure.savefig(path, dpi=110, metadata={"Software": None})
        plt.close(figure)


def duration(nanoseconds):
    """A time with its unit and three digits."""
    value = float(nanoseconds)
    for unit, size in (("s", 1e9), ("ms", 1e6), ("µs", 1e3)):
        if value >= size:
            return f"{value / size:.3g} {unit}"
    return f"{value:.3g} ns"


def table(heads, rows):
    """A Markdown table."""
    lines = ["| " + " | ".join(heads) + " |", "|---" * len(heads) + "|"]
    return "\n".join([*lines, *("| " + " | ".join(map(str, row)) + " |" for row in rows)])


def run():
    """When and where the figures were measured, in a sentence."""
    first = provenance()["bench.csv"]
    return f"{first['date']}, commit {first['commit']}, {first['processor']}, {first['cores']} cores, {first['compiler']}."


def by_task(rows):
    """A table for each task of the benchmarks, with a row for each size and a column for each engine. Times are for one element if elements are counted."""
    parts = []
    for task in sorted({row["task"] for row in rows}):
        here = [row for row in rows if row["task"] == task]
        engines = sorted({row["engine"] for row in here})
        sizes = list(dict.fromkeys(row["size"] for row in sorted(here, key=_numbers)))
        cells = {(row["size"], row["engine"]): row for row in here}
        lines = []
        for size in sizes:
            found = [cells.get((size, engine)) for engine in engines]
            counted = max(int(row["elements"]) for row in found if row)
            lines.append([size, f"{counted:,}" if counted > 1 else "–", *(duration(row["element_ns"]) if row else "–" for row in found)])
        parts.append(f"### {task}\n\n" + table([task, "elements", *(engine.replace("–", "time") for engine in engines)], lines))
    return "\n\n".join(parts)


def _numbers(row):
    return [(int(part), "") if part.isdigit() else (-1, part) for part in re.split(r"(\d+)", row["size"])]


def at_equal_error(rows):
    """The fastest setting of each engine that reaches this error, and the fastest engine."""
    lines = []
    for scene, title in PANELS.items():
        for error in (1e-6, 1e-12):
            cells, costs = [], {}
            for engine in CURVES:
                fit = [row for row in rows if (row["scene"], row["engine"]) == (scene, engine) and float(row["error"]) <= error]
                best = min(fit, key=lambda row: float(row["whole_ms"]), default=None)
                cells.append(f"{float(best['whole_ms']):.3g}" if best else "not reached")
                if best:
                    costs[engine] = float(best["whole_ms"])
            lines.append([title, f"{error:.0e}".replace("e-0", "e-"), *cells, min(costs, key=costs.get)])
    return table(["scene", "error [rad]", *(f"{engine} [ms]" for engine in CURVES), "fastest"], lines)


def by_work(bench, precision, stress):
    """The time of each kind of work, and the error over all random scenes."""
    ids = {(row["task"], row["size"], row["engine"]): row for row in bench}

    def of(task, size, engine):
        row = ids.get((task, size, engine))
        return duration(row["element_ns"]) if row else "not measured"

    closed = [row for row in precision if row["engine"] == "closed form" and row["setting"] == "1e-15"]
    rival = {row["scene"]: row for row in precision if row["engine"] == "SciPy closed form"}
    ratios = [float(rival[row["scene"]]["whole_ms"]) / float(row["whole_ms"]) for row in closed if row["scene"] in rival]
    attitude = [row for row in stress if row["check"] == "attitude"]
    total = sum(int(row["scenes"]) for row in attitude)
    lines = [
        ["exact normal form, order 10 / 30 / 50", " / ".join(of("normalize", f"order-{n}", "energy") for n in (10, 30, 50))],
        [
            "set-up of a motion, closed form / series of order 20",
            f"{of('set-up', 'body-new-tolerance-1e-12', 'closed')} / {of('set-up', 'body-new-order-20', 'series')}",
        ],
        [
            "a sample of attitude and rates, 100,000 even times",
            of("skip", "times-uniform", "closed"),
        ],
        [
            "the same in calls with 1 / 100 / 10,000 / 1,000,000 uneven times",
            " / ".join(of("evaluate", f"times-{count}", "closed") for count in (1, 100, 10_000, 1_000_000)),
        ],
        [
            "gravity gradient, 1,000 rotations: set-up / a sample",
            f"{of('gradient-solve', 'ellipse-full', 'spin')} / {of('gradient-evaluate', 'ellipse-full', 'spin')}",
        ],
        ["against SciPy's closed form, calls from Python", f"{min(ratios):.3g} to {max(ratios):.3g} times as fast"],
        [
            f"attitude error, {total:,} random scenes: 99.9th percentile in the worst regime / maximum",
            f"{max(float(r['q99.9']) for r in attitude):.1e} / {max(float(r['max']) for r in attitude):.1e} rad",
        ],
    ]
    return table(["what", "measured"], lines)


def summary(bench, precision, stress):
    """The table of the README: the time of each kind of work, and the error over all random scenes."""
    first = provenance()["bench.csv"]
    said = f"One core of a shared machine with AVX-512, {first['date']}, commit {first['commit']} (`make figures`). More: [accuracy](docs/accuracy.md), [speed](docs/speed.md)."
    return f"{by_work(bench, precision, stress)}\n\n{said}"


def between(path, text):
    """Replace the text between the marks of a page."""
    page = path.read_text(encoding="utf-8")
    before, rest = page.split(MARKS[0], 1)
    path.write_text(f"{before}{MARKS[0]}\n\n{text}\n\n{MARKS[1]}{rest.split(MARKS[1], 1)[1]}", encoding="utf-8")


def spread(values, digits=2):
    """The lowest and the highest number."""
    low, high = (
        f"{value:.{digits}g}".replace("e-0", "e-") if value < 10**digits else f"{float(f'{value:.{digits}g}'):,.0f}" for value in (min(values), max(values))
    )
    return low if low == high else f"{low} to {high}"


class Against(NamedTuple):
    """One rival at one kind of work: the ratios of its time to ours, our errors and its errors [rad], none where both are exact or the rival is set to our error."""

    work: str
    rival: str
    ratios: Sequence[float]
    ours: Sequence[float] = ()
    its: Sequence[float] = ()


def numbers(rows, column):
    """A column as numbers."""
    return [float(row[column]) for row in rows]


def against_rivals():
    """Every rival at every kind of work."""
    propagation, gradient, partials, products = read("rivals-propagation"), read("rivals-gradient"), read("rivals-partials"), read("rivals-products")
    own = {(row["scene"], row["times"]): row for row in propagation if row["engine"] == "andoyer closed"}
    engines = {
        "heyoka, tolerances 1e-12 and 1e-15": ("heyoka 1e-12", "heyoka 1e-15"),
        "SciPy, closed form": ("SciPy closed form",),
        "SciPy, DOP853": ("SciPy DOP853",),
        "ode_solvers, DOP853": ("ode_solvers DOP853",),
        "Orekit, TorqueFree": ("Orekit TorqueFree",),
    }
    found = []
    for name, settings in engines.items():
        here = [row for row in propagation if row["engine"] in settings]
        ours = numbers([own[row["scene"], row["times"]] for row in here], "attitude_error")
        found.append(Against("free motion, 100,000 times", name, numbers(here, "whole_ratio"), ours, numbers(here, "attitude_error")))
    free, forced = ([row for row in partials if (row["scene"] == "under a torque") is under] for under in (False, True))
    exact = [row for row in read("rivals-normal-form") if row["rival"] == "flint" and row["order"] in ("10", "30", "50")]
    whole = {rival: [row for row in products if row["rival"] == rival and row["task"].endswith("exact")] for rival in ("flint", "symbolica")}
    return [
        *found,
        Against("averaged gravity gradient", "heyoka, tolerance 1e-12", *(numbers(gradient, name) for name in ("ratio", "error", "heyoka_error"))),
        Against("integrated gravity gradient, with our bound", "heyoka at our error", numbers(read("rivals-integration"), "ratio_at_error")),
        Against("derivatives of a free motion", "heyoka, variational equations", numbers(free, "ratio")),
        Against("derivatives under a torque", "heyoka, variational equations", numbers(forced, "ratio")),
        Against("exact normal form, orders 10 to 50", "python-flint, Deprit's triangle", numbers(exact, "ratio")),
        Against("exact products of polynomials", "python-flint", numbers(whole["flint"], "ratio")),
        Against("exact products of polynomials", "Symbolica", numbers(whole["symbolica"], "ratio")),
    ]


def rivals_table(found):
    """Ratios and errors, a row for a rival at a kind of work."""
    rows = [[of.work, of.rival, spread(of.ratios), *(spread(errors, 1) if errors else "–" for errors in (of.ours, of.its))] for of in found]
    return table(["work", "rival", "rival's time / ours", "our error [rad]", "its error [rad]"], rows)


def draw_rivals(found, path):
    """Draw the range of each ratio as a bar beside its numbers."""
    with plt.rc_context(STYLE):
        figure, axes = plt.subplots(figsize=(10, 5), layout="constrained")
        for place, of in enumerate(reversed(found)):
            low, high = min(of.ratios), max(of.ratios)
            axes.barh(place, high - low if high > low else 0.04 * low, left=low, height=0.6, color="#0072B2" if low >= 1 else "#D55E00")
            axes.annotate(spread(of.ratios), (high, place), (6, 0), textcoords="offset points", va="center")
        axes.axvline(1, color="#444444", linewidth=0.8)
        axes.set(
            xscale="log",
            xlim=(0.5, 5000),
            xlabel="rival's time / ours",
            yticks=range(len(found)),
            yticklabels=[f"{of.work}: {of.rival}" for of in reversed(found)],
        )
        axes.tick_params(axis="y", length=0)
        axes.spines["left"].set_visible(False)
        axes.grid(True, axis="x", which="major", color="#DDDDDD", linewidth=0.6)
        axes.set_axisbelow(True)
        figure.savefig(path, dpi=110, metadata={"Software": None})
        plt.close(figure)


def main():
    wrong = faults()
    if wrong:
        sys.exit("\n".join(f"report: {fault}" for fault in wrong))
    bench, precision, stress = read("bench"), read("work-precision"), read("stress")
    draw(precision, ROOT / "docs" / "performance.png")
    found = against_rivals()
    draw_rivals(found, ROOT / "docs" / "rivals.png")
    compiled = [float(row["compilation_s"]) for row in read("rivals-integration")] + [float(row["compilation_ms"]) / 1e3 for row in read("rivals-gradient")]
    said = "A ratio above 1 means that we are faster; a range goes over the scenes, the one next to the separatrix included, uneven and uniform times, set-up included. "
    said += f"Compilation is not counted: under a torque heyoka's takes {spread(compiled)} s a scene."
    page = "\n\n".join(
        [
            f"Measured in one run, one thread unless it says otherwise: {run()}",
            "![Rival's time over ours, a bar a rival](rivals.png)",
            rivals_table(found),
            said,
            "![Run time against error, a panel a scene, a curve an engine](performance.png)",
            "For each engine the table gives the time of its cheapest setting that reaches the error. The time includes set-up and 20,000 samples:",
            at_equal_error(precision),
        ]
    )
    between(ROOT / "docs" / "speed.md", page)
    between(
        ROOT / "benches" / "README.md",
        f"Medians, for one element if the table has a number of elements, otherwise for the whole task. {run()}\n\n{by_task(bench)}",
    )
    between(ROOT / "README.md", summary(bench, precision, stress))
    print("docs/speed.md, docs/performance.png, docs/rivals.png, benches/README.md, README.md")


if __name__ == "__main__":
    main()
