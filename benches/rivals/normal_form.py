"""Compare andoyer with general algebras for the normal form of the free rigid body: one table of ratios.

    python benches/rivals/normal_form.py [--orders 10 20] [--repeats 5] [--rivals flint sympy-ring] [--output out]

Every engine computes the normalized Hamiltonian and S, exact and symbolic in β, to the same order (theory §4). The runs are interleaved in one process. Times are CPU seconds
of all threads with RAYON_NUM_THREADS = 1, as medians over the repeats; the ratio is the median of the ratios of the repeats. An answer is checked
before its time counts. Peak memory is that of a child process. The table is printed, and written to the output folder as Markdown and CSV.
Exit status 1 for a wrong answer.
"""

import argparse
import datetime
import gc
import os
import platform
import resource
import subprocess
import sys
import time
from collections import namedtuple
from importlib.metadata import version
from pathlib import Path
from statistics import median

os.environ["RAYON_NUM_THREADS"] = "1"

import algebras
import answers
import energy
import triangle
from written import write

import andoyer

Rival = namedtuple("Rival", "package algorithm algebra orders")
Row = namedtuple("Row", "order rival andoyer_s rival_s ratio lowest highest repeats")

TO_FIFTY = (10, 15, 20, 30, 40, 50)
RIVALS = {
    "flint": Rival("python-flint", triangle, algebras.Flint, TO_FIFTY),
    "flint-energy": Rival("python-flint", energy, algebras.Flint, TO_FIFTY),
    "sympy-ring": Rival("sympy", triangle, algebras.SympyRing, (10, 15)),
    "symengine": Rival("symengine", triangle, algebras.symengine_expressions, (10, 15)),
    "sympy-expressions": Rival("sympy", triangle, algebras.sympy_expressions, (6,)),
}
ALONE = (50, 100)  # orders of ours in a child process
SAMPLE_SECONDS = 0.02  # shorter runs are repeated until a sample has this much
LONG_SECONDS = 1.0  # a rival that takes longer than this is repeated less


def sample(solve, forget=None):
    """Mean CPU seconds of `solve` over a sample, and its last answer."""
    gc.collect()
    total, runs, answer = 0.0, 0, None
    while total < SAMPLE_SECONDS:
        if forget:
            forget()
        start = time.process_time()
        answer = solve()
        total += time.process_time() - start
        runs += 1
    return total / runs, answer


def own_kernel(normal_form):
    return [normal_form.triaxiality_polynomial(n) for n in range(normal_form.order + 1)]


def compare(name, order, repeats):
    """One row of the table: `name` against andoyer at `order`."""
    rival = RIVALS[name]
    algebra = rival.algebra()
    # The first run warms both and is checked whole.
    normal_form = andoyer.NormalForm(order)
    answers.check_kernel("andoyer", own_kernel(normal_form))
    seconds, answer = sample(lambda: rival.algorithm.normalize(algebra, order), algebra.forget)
    answers.check_kernel(name, answers.kernel(algebra, answer[0]))
    answers.check_all(name, algebra, answer, normal_form)
    ours, theirs = [], []
    for _ in range(repeats or (3 if seconds > LONG_SECONDS else 9)):
        seconds, normal_form = sample(lambda: andoyer.NormalForm(order))
        answers.check_kernel("andoyer", own_kernel(normal_form))
        ours.append(seconds)
        seconds, answer = sample(lambda: rival.algorithm.normalize(algebra, order), algebra.forget)
        answers.check_kernel(name, answers.kernel(algebra, answer[0]))
        theirs.append(seconds)
    ratios = [b / a for a, b in zip(ours, theirs)]
    return Row(order, name, median(ours), median(theirs), median(ratios), min(ratios), max(ratios), len(ratios))


def peak_memory():
    """Peak resident memory of this process [MiB]."""
    unit = 1 if platform.system() == "Darwin" else 1024
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * unit / 2**20


def alone(order):
    """The work of a child process: print CPU seconds, memory before the work and peak memory [MiB]."""
    before = peak_memory()
    start = time.process_time()
    normal_form = andoyer.NormalForm(order)
    seconds = time.process_time() - start
    after = peak_memory()
    answers.check_kernel("andoyer", own_kernel(normal_form))
    print(seconds, before, after)


def in_a_child(order):
    """CPU seconds, memory before the work and peak memory [MiB] of `order` in a separate process."""
    command = [sys.executable, __file__, "--alone", str(order)]
    child = subprocess.run(command, capture_output=True, text=True)
    if child.returncode:
        raise answers.WrongAnswer(f"order {order} alone: {child.stderr.strip()}")
    return [float(field) for field in child.stdout.split()]


def markdown(rows):
    yield "| order | rival | andoyer [s] | rival [s] | ratio | lowest – highest | repeats |"
    yield "|---|---|---|---|---|---|---|"
    for row in rows:
        yield (
            f"| {row.order} | {row.rival} | {row.andoyer_s:.2g} | {row.rival_s:.2g} | {row.ratio:.3g} | {row.lowest:.3g} – {row.highest:.3g} | {row.repeats} |"
        )


def preamble(rivals):
    packages = ["andoyer", *dict.fromkeys(RIVALS[name].package for name in rivals)]
    names = ", ".join(f"{package} {version(package)}" for package in packages)
    return f"{datetime.date.today()}, Python {platform.python_version()}, {platform.machine()}, one thread: {names}."


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--orders", type=int, nargs="+", help="orders of every rival (default: each rival's own list)")
    parser.add_argument("--repeats", type=int, help="repeats of every row (default: 9, and 3 where the rival takes over a second)")
    parser.add_argument("--rivals", nargs="+", choices=RIVALS, default=list(RIVALS), metavar="RIVAL", help=", ".join(RIVALS))
    parser.add_argument("--output", type=Path, default=Path("out"), help="folder of rivals.md (default: out)")
    parser.add_argument("--data", type=Path, help="file of the rows")
    parser.add_argument("--alone", type=int, help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.repeats is not None and options.repeats < 1:
        parser.error(f"--repeats {options.repeats}: at least 1")
    if options.orders and min(options.orders) < 1:
        parser.error(f"--orders {min(options.orders)}: at least 1")
    return options


def main():
    options = arguments()
    if options.alone is not None:
        return alone(options.alone)
    lines = [preamble(options.rivals), ""]
    # Before any rival is loaded: a child's peak counts from its parent's size.
    for order in ALONE:
        seconds, before, peak = in_a_child(order)
        memory = f"peak memory {peak:.0f} MiB, {before:.0f} MiB of it before the computation"
        lines += [f"andoyer alone, order {order}: {seconds:.3g} s; {memory}.", ""]
    rows = []
    for name in options.rivals:
        for order in options.orders or RIVALS[name].orders:
            rows.append(compare(name, order, options.repeats))
            print(f"{name}, order {order}: {rows[-1].ratio:.3g}", file=sys.stderr)
    lines += markdown(rows)
    print("\n".join(lines))
    options.output.mkdir(parents=True, exist_ok=True)
    (options.output / "rivals.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    write(options.data, Row._fields, rows)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except answers.WrongAnswer as problem:
        sys.exit(f"{problem}")
