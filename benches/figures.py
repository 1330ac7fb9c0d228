"""Measure every file of docs/data in one run, and check that what stands there is one run.

    python benches/figures.py                    `make figures`: each target of TARGETS, then a row for each of its files in docs/data/provenance.csv; needs a clean commit
    python benches/figures.py bench sweep        some of the targets
    python benches/figures.py --check            exit status 1 for an empty cell, a file that is not the measured one, several processors, or a commit that is not clean or not the same (counts and angles have their own)
    python benches/figures.py --check --fresh    and for files that were measured with other sources than those of today

`sources` is a hash of the crates' Rust and Python sources without Rust's comments, `digest` one of the file.
"""

import argparse
import csv
import datetime
import hashlib
import os
import platform
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
DATA = ROOT / "docs" / "data"
PROVENANCE = DATA / "provenance.csv"
# What is timed comes first.
TARGETS = {
    "bench": ["bench.csv", "work-precision.csv"],
    "sweep": ["sweep.csv"],
    "scenes": ["scenes.csv", "ensemble.csv"],
    "libration-cost": ["libration-cost.csv"],
    "rivals-libration": ["libration-rivals.csv"],
    **{f"rivals-{name}": [f"rivals-{name}.csv"] for name in ("propagation", "gradient", "integration", "partials", "normal-form", "products", "ephemeris")},
    "light-curves": ["light-curves.csv"],
    "gravity": [f"gravity-{name}.csv" for name in ("cases", "levels", "bounds", "climb", "table", "spans")] + ["averaged-bodies.csv"],
    "stress": ["stress.csv"],
    "libration-reach": ["libration-reach.csv"],
    "verdicts": ["verdicts.csv"],
    "evolution-times": ["evolution-times.csv"],
    "members": ["members.csv"],
    "rivals-batch": ["rivals-batch.csv"],
    "pulls": ["pulls.csv"],
    "nature": ["nature-earth.csv", "nature-moon.csv", "nature-moon-terms.csv", "nature-moon-rivals.csv"],
}
# Counts of scenes, which the clock changes only where an order takes seconds, counts of verdicts, pulls, angles, ratios to engines that are no engine of the other files, and times that are compared with none of the others: they may be of another commit than the others.
COUNTS = {"evolution-times", "libration-reach", "members", "nature", "pulls", "rivals-batch", "rivals-ephemeris", "verdicts"}
SOURCES = ("crates/*/src/**/*.rs", "crates/py/python/**/*.py")
PAGES = ("README.md", "benches/README.md", "crates/py/README.md", "docs/")
"""What the targets write."""


def digest(file):
    """The first digits of the SHA-256 of a file."""
    return hashlib.sha256(file.read_bytes()).hexdigest()[:16]


def sources(root=ROOT):
    """The hash of the sources that the figures measure, without the comments of Rust."""
    whole = hashlib.sha256()
    for file in sorted(file for pattern in SOURCES for file in root.glob(pattern)):
        whole.update(b"\n".join(line for line in file.read_bytes().splitlines() if not line.lstrip().startswith(b"//")))
    return whole.hexdigest()[:16]


def machine():
    """Processor, cores, compiler and commit. The commit ends in `-dirty` if anything but pages and figures differs from it."""
    changed = [line[3:] for line in _told("git", "status", "--porcelain").splitlines()]
    dirty = any(not path.startswith(PAGES) for path in changed)
    return {
        "processor": _processor(),
        "cores": str(os.cpu_count()),
        "compiler": _told("rustc", "--version"),
        "commit": _told("git", "rev-parse", "--short", "HEAD") + ("-dirty" if dirty else ""),
    }


def _processor():
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    flags = next((line for line in lines if line.startswith("flags")), "")
    wide = "AVX-512" if "avx512f" in flags else "AVX2" if "avx2" in flags else "no AVX2"
    return f"{names[0] if names else platform.machine()} ({wide})"


def _told(*command):
    try:
        return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.rstrip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def provenance(data=DATA):
    """The row of each file."""
    with (data / PROVENANCE.name).open(encoding="utf-8", newline="") as file:
        return {row["file"]: row for row in csv.DictReader(file)}


def faults(data=DATA, today=None):
    """What is wrong with the figures, a sentence each. `today`: the hash of the sources that they have to measure."""
    rows = provenance(data)
    files = {file.name: file for file in data.glob("*.csv") if file.name != PROVENANCE.name}
    found = [f"{name} has no row in {PROVENANCE.name}: run `make figures`" for name in sorted(files.keys() - rows.keys())]
    found += [f"{name} is not there" for name in sorted(rows.keys() - files.keys())]
    for name in sorted(files.keys() & rows.keys()):
        with files[name].open(encoding="utf-8", newline="") as file:
            for number, row in enumerate(csv.DictReader(file), 2):
                found += [f"{name}, line {number}: {column} is empty" for column, cell in row.items() if not (cell or "").strip()]
        if digest(files[name]) != rows[name]["digest"]:
            found.append(f"{name} is not the file that was measured on {rows[name]['date']}")
        if rows[name]["commit"].endswith("-dirty"):
            found.append(f"{name} was measured with changes that are not committed: {rows[name]['commit']}")
        if today and rows[name]["sources"] != today:
            found.append(f"{name} was measured with other sources than those of today: {rows[name]['commit']}")
    for column in ("processor", "cores", "compiler", "commit"):
        values = sorted({row[column] for row in rows.values() if row["target"] not in COUNTS})
        if len(values) > 1:
            found.append(f"the figures have several values of {column}: {', '.join(values)}")
    return found


def measure(targets):
    """Run some targets, and note where their files come from."""
    described = machine()
    if described["commit"].endswith("-dirty"):
        sys.exit("figures: commit the changes outside of docs first")
    described["sources"] = sources()
    rows = provenance() if PROVENANCE.exists() else {}
    known = {name for names in TARGETS.values() for name in names}
    for target in targets:
        subprocess.run(["make", "--no-print-directory", target], cwd=ROOT, check=True)
        today = datetime.datetime.now(datetime.UTC).date().isoformat()
        for name in TARGETS[target]:
            rows[name] = {"file": name, "target": target, **described, "date": today, "digest": digest(DATA / name)}
        kept = [row for name, row in sorted(rows.items()) if name in known]
        with PROVENANCE.open("w", encoding="utf-8", newline="") as file:
            writer = csv.DictWriter(file, kept[0], lineterminator="\n")
            writer.writeheader()
            writer.writerows(kept)


def main():
    """Measure, or check what was measured."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("targets", nargs="*", choices=[[], *TARGETS], help="all by default")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--fresh", action="store_true")
    options = parser.parse_args()
    if not options.check:
        measure(options.targets or TARGETS)
    found = faults(today=sources() if options.fresh else None)
    for fault in found:
        print(f"figures: {fault}")
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
