"""Compare andoyer with general algebras for products of polynomials: one table of ratios.

    python benches/rivals/products.py --engine target/release/products [--repeats 5] [--rivals flint symbolica symengine] [--tasks …]
                                      [--output out]

The tasks are the sparse product of M. Monagan and R. Pearce, n = 12 (5,821,335 terms), and the dense product of R. Fateman, n = 20 (135,751 terms). andoyer runs them exactly
and in `f64`, the rivals exactly. The engine is a child process that takes turns with the rivals. Times are processor seconds of one thread, as medians over the repeats; the
ratio is the median of the ratios of the repeats. The factors are made before the measurement. The number of terms and one coefficient of each answer are checked. `reading` is the time of
the first access to a term, which converts the coefficients of andoyer from machine words to reduced fractions. Exit status 1 for a wrong answer.
"""

import argparse
import datetime
import os
import platform
import subprocess
import sys
import time
from collections import namedtuple
from importlib.metadata import version
from pathlib import Path
from statistics import median

from written import write

Task = namedtuple("Task", "variables factors power terms exponents coefficient")
Answer = namedtuple("Answer", "processor clock terms reading coefficient")
Row = namedtuple("Row", "task rival andoyer_s reading_s rival_s ratio lowest highest repeats")

# The numbers of terms that the authors give; the coefficients of x⁶⁰ u⁶⁰, 5¹² · 5¹², and of t⁴⁰, which only one pair of terms makes.
TASKS = {
    "pearce": Task("x y z t u", "sparse", 12, 5_821_335, (60, 0, 0, 0, 60), 5**24),
    "fateman": Task("x y z t", "dense", 20, 135_751, (0, 0, 0, 40), 1),
}
LONG_SECONDS = 5.0  # a rival that takes longer than this runs once


def sparse(variables, power):
    x, y, z, t, u = variables
    return (1 + x + y + 2 * z**2 + 3 * t**3 + 5 * u**5) ** power, (1 + u + t + 2 * z**2 + 3 * y**3 + 5 * x**5) ** power


def dense(variables, power):
    f = 1
    for variable in variables:
        f = f + variable
    f = f**power
    return f, f + 1


class Flint:
    """python-flint's `fmpz_mpoly`, and `fmpq_mpoly` as `flint-rational`."""

    package = "python-flint"

    def __init__(self, rational=False):
        from flint import Ordering, fmpq_mpoly_ctx, fmpz_mpoly_ctx

        self.contexts, self.order = fmpq_mpoly_ctx if rational else fmpz_mpoly_ctx, Ordering.lex

    def factors(self, task):
        context = self.contexts.get(tuple(task.variables.split()), self.order)
        return globals()[task.factors](context.gens(), task.power)

    def product(self, f, g):
        return f * g

    def answer(self, product, task):
        return len(product), int(product[task.exponents])


class Symbolica:
    """Symbolica's polynomials with integer coefficients. Without a licence Symbolica runs on one core."""

    package = "symbolica"

    def __init__(self):
        import symbolica

        self.module = symbolica

    def factors(self, task):
        symbols = [self.module.S(name) for name in task.variables.split()]
        f, g = globals()[task.factors](symbols, task.power)
        f, g = f.to_polynomial(vars=symbols), g.to_polynomial(vars=symbols)
        return f, g

    def product(self, f, g):
        return f * g

    def answer(self, product, task):
        found = None
        for exponents, coefficient in product.coefficient_list():
            if tuple(exponents) == task.exponents:
                found = coefficient
        return product.nterms(), int(str(found.to_expression() if hasattr(found, "to_expression") else found))


class SymEngine:
    """Expanded expressions of SymEngine."""

    package = "symengine"

    def __init__(self):
        import symengine

        self.module = symengine

    def factors(self, task):
        f, g = globals()[task.factors](self.module.symbols(task.variables), task.power)
        return self.module.expand(f), self.module.expand(g)

    def product(self, f, g):
        return self.module.expand(f * g)

    def answer(self, product, task):
        monomial = 1
        for name, exponent in zip(task.variables.split(), task.exponents):
            monomial *= self.module.Symbol(name) ** exponent
        return len(product.args), int(product.as_coefficients_dict()[monomial])


RIVALS = {"flint": Flint, "flint-rational": lambda: Flint(rational=True), "symbolica": Symbolica, "symengine": SymEngine}
PACKAGES = {"flint": "python-flint", "flint-rational": "python-flint", "symbolica": "symbolica", "symengine": "symengine"}


class WrongAnswer(Exception):
    """An answer that differs from the known one."""


class Engine:
    """The child process that multiplies for andoyer."""

    def __init__(self, path, threads):
        environment = os.environ | {"RAYON_NUM_THREADS": str(threads)}
        self.child = subprocess.Popen([path], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment)

    def run(self, name):
        self.child.stdin.write(name + "\n")
        self.child.stdin.flush()
        words = self.child.stdout.readline().split()
        if len(words) != 6:
            raise WrongAnswer(f"{name}: the engine stopped")
        return Answer(float(words[1]), float(words[2]), int(words[3]), float(words[4]), words[5])


def check(name, task, terms, coefficient):
    if (terms, coefficient) != (task.terms, task.coefficient):
        raise WrongAnswer(f"{name}: {terms} terms, coefficient {coefficient} at {task.exponents}")


def compare(engine, name, kind, rival, repeats):
    """One row: `kind` ("exact", "f64") of andoyer against a rival at a task."""
    task, algebra = TASKS[name], RIVALS[rival]()
    f, g = algebra.factors(task)
    ours, reading, theirs = [], [], []
    for repeat in range(repeats + 1):
        answer = engine.run(f"{name}-{kind}")
        # 5²⁴ is no double: the nearest one counts.
        exact = int(answer.coefficient) if kind == "exact" else task.coefficient if float(answer.coefficient) == task.coefficient * 1.0 else None
        check(f"andoyer {kind} {name}", task, answer.terms, exact)
        start = time.process_time()
        product = algebra.product(f, g)
        seconds = time.process_time() - start
        if repeat == 0:  # warms both
            check(f"{rival} {name}", task, *algebra.answer(product, task))
            if seconds < LONG_SECONDS:
                continue
        ours.append(answer.processor)
        reading.append(answer.reading)
        theirs.append(seconds)
        if seconds >= LONG_SECONDS:
            break
    ratios = [b / a for a, b in zip(ours, theirs)]
    medians = median(ours), median(reading), median(theirs), median(ratios)
    return Row(f"{name} {task.power}, {kind}", rival, *medians, min(ratios), max(ratios), len(ratios))


def markdown(rows):
    yield "| product | rival | andoyer [s] | reading [s] | rival [s] | ratio | lowest – highest | repeats |"
    yield "|---|---|---|---|---|---|---|---|"
    for row in rows:
        yield (
            f"| {row.task} | {row.rival} | {row.andoyer_s:.2g} | {row.reading_s:.2g} | {row.rival_s:.2g} | {row.ratio:.3g} "
            f"| {row.lowest:.3g} – {row.highest:.3g} | {row.repeats} |"
        )


def threads_line(path, name, repeats):
    """A line with the ratio of the elapsed times of one thread and of two threads, which take turns."""
    one, two = Engine(path, 1), Engine(path, 2)
    pairs = [(one.run(name).clock, two.run(name).clock) for _ in range(repeats + 1)][1:]
    ratios = [a / b for a, b in pairs]
    return f"{name}, two threads: {median(ratios):.3g} times as fast on the clock ({min(ratios):.3g} – {max(ratios):.3g})."


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--engine", required=True, help="the program target/release/products")
    parser.add_argument("--repeats", type=int, default=5, help="repeats of every row (default: 5)")
    parser.add_argument("--rivals", nargs="+", choices=RIVALS, default=list(RIVALS), metavar="RIVAL", help=", ".join(RIVALS))
    parser.add_argument("--tasks", nargs="+", choices=TASKS, default=list(TASKS), metavar="TASK", help=", ".join(TASKS))
    parser.add_argument("--output", type=Path, default=Path("out"), help="folder of products.md (default: out)")
    parser.add_argument("--data", type=Path, help="file of the rows")
    options = parser.parse_args()
    if options.repeats < 1:
        parser.error(f"--repeats {options.repeats}: at least 1")
    return options


def main():
    options = arguments()
    names = ", ".join(f"{package} {version(package)}" for package in dict.fromkeys(PACKAGES[name] for name in options.rivals))
    lines = [f"{datetime.date.today()}, Python {platform.python_version()}, {platform.machine()}, one thread: {names}.", ""]
    engine, rows = Engine(options.engine, 1), []
    for name in options.tasks:
        for rival in options.rivals:
            for kind in ("exact", "f64"):
                rows.append(compare(engine, name, kind, rival, options.repeats))
                print(f"{rows[-1].task}, {rival}: {rows[-1].ratio:.3g}", file=sys.stderr)
    lines += markdown(rows)
    for name in options.tasks:
        lines += ["", *(threads_line(options.engine, f"{name}-{kind}", options.repeats) for kind in ("exact", "f64"))]
    print("\n".join(lines))
    options.output.mkdir(parents=True, exist_ok=True)
    (options.output / "products.md").write_text("\n".join(lines) + "\n", encoding="utf-8")
    write(options.data, Row._fields, rows)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except WrongAnswer as problem:
        sys.exit(f"{problem}")
