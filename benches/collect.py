"""Collect the measurements of criterion in one table, docs/data/bench.csv.

    python benches/collect.py          after `cargo bench`; `make bench` runs both

A row is a benchmark id `task/size/engine` with the median and its 95 % interval in ns per iteration, and the elements per iteration if the benchmark counts them. Only ids that were
measured since the start of the run are used (`--since`, seconds since 1970).
"""

import argparse
import csv
import json
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
OUTPUT = ROOT / "docs" / "data" / "bench.csv"


def rows(folder, since):
    """The newest measurement of each id, in the order of tasks, sizes as numbers, and engines."""
    for path in folder.glob("**/new/benchmark.json"):
        estimates = path.with_name("estimates.json")
        if estimates.stat().st_mtime < since:
            continue
        known = json.loads(path.read_text(encoding="utf-8"))
        median = json.loads(estimates.read_text(encoding="utf-8"))["median"]
        task, *rest = known["full_id"].split("/")
        interval = median["confidence_interval"]
        elements = (known.get("throughput") or {}).get("Elements", 1)
        yield {
            "task": task,
            "size": "/".join(rest[:-1]) or rest[-1],
            "engine": rest[-1] if len(rest) > 1 else "–",
            "median_ns": f"{median['point_estimate']:.6g}",
            "low_ns": f"{interval['lower_bound']:.6g}",
            "high_ns": f"{interval['upper_bound']:.6g}",
            "elements": elements,
            "element_ns": f"{median['point_estimate'] / elements:.6g}",
        }


def by_number(row):
    """Sorts order-2 before order-10."""
    size = [(int(part), "") if part.isdigit() else (-1, part) for part in re.split(r"(\d+)", row["size"])]
    return row["task"], row["engine"], size


def main():
    parser = argparse.ArgumentParser(description="Criterion's estimates as one table.")
    parser.add_argument("--criterion", type=Path, default=ROOT / "target" / "criterion")
    parser.add_argument("--since", type=float, default=0.0)
    parser.add_argument("--output", type=Path, default=OUTPUT)
    arguments = parser.parse_args()
    found = sorted(rows(arguments.criterion, arguments.since), key=by_number)
    if not found:
        parser.exit(1, f"no measurement in {arguments.criterion}: run `cargo bench` first\n")
    with open(arguments.output, "w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, found[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(found)
    print(f"{len(found)} benchmarks: {arguments.output.relative_to(ROOT) if arguments.output.is_relative_to(ROOT) else arguments.output}")


if __name__ == "__main__":
    main()
