"""The stress test: compare random scenes of every regime with enclosures of 40 digits, and check their invariants.

    make stress                                     240,000 scenes; writes docs/data/stress.csv and the tables of docs/accuracy.md; takes some minutes
    make stress-short                               takes a minute; part of `make test`
    python tests/stress/run.py --scenes 1600 --seed 1

Exit status 1 if any value is above its budget (`BUDGETS` in accuracy.py and series.py). The seed and the number of a scene determine the scene.
"""

import os

os.environ["RAYON_NUM_THREADS"] = "1"  # the processes already use all cores

import argparse
import csv
import sys
import time
from collections import defaultdict
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

import accuracy
import numpy as np
import references
import series
from regimes import REGIMES

ROOT = Path(__file__).resolve().parents[2]
CSV = ROOT / "docs" / "data" / "stress.csv"
SCENES, SHORT = 240_000, 16_000
BLOCK = 160
QUANTILES = {"median": 0.5, "q99": 0.99, "q99.9": 0.999, "max": 1.0}
BUDGETS = accuracy.BUDGETS | series.BUDGETS
BRACKETS_ORDER = 10
START, END = "<!-- stress: written by make stress -->", "<!-- end -->"
INVARIANTS = ("energy", "|M|", "inertial M", "norm", "time reversal", "group")


def work(task):
    """The values of a block: a list of (regime, {check: value}, number)."""
    kind, seed, numbers = task
    if kind == "scenes":
        return accuracy.of_block(seed, numbers)
    make = series.by_tolerance if kind == "tolerances" else series.by_order
    return [make(seed, number) for number in numbers]


def tasks(seed, scenes, only):
    """Blocks of work for the processes, the longest first; only for some regimes if requested."""
    names = list(REGIMES)
    numbers = [k for k in range(scenes) if not only or any(text in names[k % len(names)] for text in only)]
    lots = {"orders": (range(max(scenes // 600, 8)), 8), "tolerances": (range(scenes // 12), BLOCK), "scenes": (numbers, BLOCK)}
    return [(kind, seed, lot[k : k + size]) for kind, (lot, size) in lots.items() if kind == "scenes" or not only for k in range(0, len(lot), size)]


def collected(seed, scenes, processes, only=()):
    """Values and scene numbers by (check, regime)."""
    values, start = defaultdict(list), time.perf_counter()
    todo = tasks(seed, scenes, only)
    with ProcessPoolExecutor(processes) as pool:
        for done, block in enumerate(pool.map(work, todo), start=1):
            for regime, found, number in block:
                for check, value in found.items():
                    values[check, regime].append((value, number))
            if done % 200 == 0:
                print(f"{done} of {len(todo)} blocks, {time.perf_counter() - start:.0f} s", file=sys.stderr, flush=True)
    return values


def summary(values):
    """Rows of the table: quantiles of each check in each regime, with the number of the worst scene."""
    rows = []
    for (check, regime), pairs in values.items():
        sample = np.array([value for value, _ in pairs])
        quantiles = {name: float(f"{np.quantile(sample, q):.2e}") for name, q in QUANTILES.items()}
        rows.append({"check": check, "regime": regime, "scenes": len(pairs), **quantiles, "budget": BUDGETS[check], "worst": max(pairs)[1]})
    return ordered(rows)


def tables(rows, seed):
    """The tables of the page."""
    cells = {(row["check"], row["regime"]): row for row in rows}
    total = sum(row["scenes"] for row in rows if row["check"] in ("energy", "error / tolerance", "error by order"))
    lines = [
        START,
        "",
        f"{total:,} scenes, seed {seed}. The table has the error of the attitude [rad] and of the rates [M/I], each at the worst of four times:",
        "",
    ]
    lines += ["| regime | scenes | median | q99 | q99.9 | max | rates: q99.9 | max | max of error / bound |", "|---|---|---|---|---|---|---|---|---|"]
    for regime in REGIMES:
        attitude, rates, bound = (cells[check, regime] for check in ("attitude", "rates", "attitude / bound"))
        numbers = [attitude[name] for name in QUANTILES] + [rates["q99.9"], rates["max"]]
        lines.append(f"| {regime} | {attitude['scenes']:,} | " + " | ".join(f"{x:.1e}" for x in numbers) + f" | {bound['max']:.2f} |")
    lines += ["", "These checks need no reference. Each value would be 0 in exact arithmetic; the table has the largest (`group` in units of its budget):", ""]
    lines += ["| regime | " + " | ".join(name.replace("|", r"\|") for name in INVARIANTS) + " |", "|---" * (len(INVARIANTS) + 1) + "|"]
    for regime in REGIMES:
        found = [cells.get((check, regime)) for check in INVARIANTS]
        lines.append(f"| {regime} | " + " | ".join(f"{row['max']:.1e}" if row else "" for row in found) + " |")
    lines += [
        "",
        "The checks of the series, each in units of its budget:",
        "",
        "| check | regime | scenes | median | q99 | q99.9 | max |",
        "|---|---|---|---|---|---|---|",
    ]
    for row in rows:
        if row["check"] in series.BUDGETS and row["check"] != "brackets":
            lines.append(f"| {row['check']} | {row['regime']} | {row['scenes']:,} | " + " | ".join(f"{row[name]:.1e}" for name in QUANTILES) + " |")
    return "\n".join([*lines, "", END])


def kept(regimes):
    """The rows of the existing file for other regimes than these."""
    with open(CSV, encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if row["regime"] not in regimes and (row["regime"] in REGIMES or row["check"] in series.BUDGETS)]
    numbers = dict.fromkeys([*QUANTILES, "budget"], float) | {"scenes": int}
    return [{name: numbers.get(name, str)(value) for name, value in row.items()} for row in rows]


def ordered(rows):
    """Rows by check, then by regime, in the order of their declaration."""
    order = {name: k for k, name in enumerate([*BUDGETS, *REGIMES])}
    return sorted(rows, key=lambda row: (order[row["check"]], order.get(row["regime"], len(order)), row["regime"]))


def write(rows, text):
    """The CSV file, and the tables between the markers of the page."""
    with open(CSV, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    page = ROOT / "docs" / "accuracy.md"
    before, rest = page.read_text(encoding="utf-8").split(START)
    page.write_text(before + text + rest.split(END, 1)[1], encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description="Random scenes of every regime against a reference of 40 digits.")
    parser.add_argument("--scenes", type=int, default=SCENES)
    parser.add_argument("--short", action="store_true", help=f"{SHORT} scenes")
    parser.add_argument("--seed", type=int, default=2017)
    parser.add_argument("--processes", type=int, default=min(os.cpu_count() or 1, 8))
    parser.add_argument("--only", action="append", default=[], metavar="TEXT", help="only regimes whose name contains TEXT; other rows of the file are kept")
    parser.add_argument("--write", action="store_true", help="docs/data/stress.csv and docs/accuracy.md")
    arguments = parser.parse_args()
    scenes, start = SHORT if arguments.short else arguments.scenes, time.perf_counter()

    (mpmath, taylor), count = references.compared(arguments.seed, range(16 if scenes <= SHORT else 64))
    print(f"the reference against mpmath: {mpmath:.1e}, against Taylor's series of the equations of motion: {taylor:.1e} ({count} scenes)")
    left = series.brackets(BRACKETS_ORDER)
    print(f"brackets of the transformation to order {BRACKETS_ORDER}, exactly: {left} left")
    rows = summary(collected(arguments.seed, scenes, arguments.processes, arguments.only))
    seconds = time.perf_counter() - start
    for row in rows:
        numbers = " ".join(f"{row[name]:9.1e}" for name in QUANTILES)
        print(f"{row['check']:<26}{row['regime']:<44}{row['scenes']:>7} {numbers}  of {row['budget']:.0e}")
    bad = [row for row in rows if not row["max"] <= row["budget"]]
    for row in bad:
        print(
            f"ABOVE ITS BUDGET: {row['check']}, {row['regime']}: {row['max']:.2e} in scene {row['worst']} of seed {arguments.seed}, allowed {row['budget']:.0e}"
        )
    if arguments.write:
        if arguments.only:
            rows = ordered(rows + kept({row["regime"] for row in rows}))
        write(rows, tables(rows, arguments.seed))
    wrong = bad or left or max(mpmath, taylor) > references.AGREEMENT
    print(f"{scenes} scenes, {seconds:.0f} s: {'NOT within budget' if wrong else 'all within their budgets'}")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
