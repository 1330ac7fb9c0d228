"""Sphinx extension: tables from the committed figures in docs/data, so that a page always agrees with its file.

A block marked `measured` contains the name of one of the tables below. Date, commit and files of the figures stand under the table.
"""

import csv
import itertools
import re
import statistics
import subprocess
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import figures
from docutils import nodes
from docutils.statemachine import StringList
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

DATA = Path(__file__).resolve().parents[1] / "data"
BODY_EPOCHS = 1e9

Row = dict[str, str]
# The files of the table that is being written.
FILES: list[str] = []


def read(name: str) -> list[Row]:
    """The lines of a file of figures."""
    if name not in FILES:
        FILES.append(name)
    with (DATA / name).open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def since(commit: str) -> str:
    """How many commits ago that was; nothing where Git does not know the commit."""
    try:
        counted = subprocess.run(["git", "rev-list", "--count", f"{commit}..HEAD"], cwd=DATA, capture_output=True, text=True, check=True)
    except (OSError, subprocess.CalledProcessError):
        return ""
    count = int(counted.stdout)
    return f", {count} commit{'s' * (count != 1)} ago"


def origins(files: Iterable[str]) -> list[str]:
    """Date and commit of files of figures: a paragraph in Markdown."""
    rows = figures.provenance(DATA)
    runs: dict[tuple[str, ...], list[str]] = {}
    for name in files:
        if name not in rows:
            raise LookupError(f"measured: {name} has no row in provenance.csv: run `make figures`")
        if rows[name]["digest"] != figures.digest(DATA / name):
            raise LookupError(f"measured: {name} is not the file that was measured on {rows[name]['date']}")
        runs.setdefault(tuple(rows[name][column] for column in ("date", "commit", "processor", "cores")), []).append(f"[{name}](/data/{name})")
    return [
        f"Measured on {date} at commit {commit}{since(commit)}, {processor}, {cores} cores: {', '.join(names)}."
        for (date, commit, processor, cores), names in runs.items()
    ]


def plain(cell: str) -> str:
    """A number without an exponent where it needs none: 10 for 1.0e1, 0.03 for 3.0e-2."""
    if not re.fullmatch(r"-?\d+(\.\d+)?e[+-]?\d+", cell):
        return cell
    digits, exponent = cell.split("e")
    if not -3 < int(exponent) < 5:
        return f"{digits}e{int(exponent)}"
    places = max(len(digits.partition(".")[2]) - int(exponent), 0)
    return f"{float(cell):,.{places}f}"


def markdown(header: Iterable[str], rows: Iterable[Iterable[str]]) -> list[str]:
    """A table in Markdown."""
    head = list(header)
    return [f"| {' | '.join(line)} |" for line in [head, ["---"] * len(head), *([plain(cell) for cell in row] for row in rows)]]


def scenes_accuracy() -> list[str]:
    """Errors and bounds of the example scenes."""
    rows = ([r["scene"], r["method"], r["separatrix_ratio"], r["order"], r["harmonics"], r["error"], r["bound"]] for r in read("scenes.csv"))
    return markdown(["scene", "method", "σ/σ_sep", "order", "harmonics", "error [rad]", "bound [rad]"], rows)


def scenes_speed() -> list[str]:
    """Time of a sample of the example scenes."""
    return markdown(["scene", "method", "harmonics", "ns/sample"], ([r["scene"], r["method"], r["harmonics"], r["sample_ns"]] for r in read("scenes.csv")))


def chosen(method: str) -> dict[float, list[Row]]:
    """The motions of the sweep with a fixed tolerance, by tolerance."""
    groups: dict[float, list[Row]] = {}
    for row in read("sweep.csv"):
        if (row["method"], row["fixed"]) == (method, "tolerance"):
            groups.setdefault(float(row["tolerance"]), []).append(row)
    return dict(sorted(groups.items(), reverse=True))


def sweep_accuracy() -> list[str]:
    """Errors by tolerance: median, largest, and largest ratio to the bound."""
    rows = []
    for method in ("series", "closed"):
        for tolerance, motions in chosen(method).items():
            errors = [float(row["error"]) for row in motions]
            shares = [float(row["error"]) / float(row["bound"]) for row in motions]
            figures = [f"{statistics.median(errors):.1e}", f"{max(errors):.1e}", f"{max(shares):.2f}"]
            rows.append([method, f"{tolerance:.0e}", str(len(motions)), *figures])
    return markdown(["method", "tolerance [rad]", "motions served", "median error [rad]", "largest error [rad]", "largest error / bound"], rows)


def sweep_speed() -> list[str]:
    """Set-up and evaluation by tolerance."""
    rows = []
    for method in ("series", "closed"):
        for tolerance, motions in chosen(method).items():
            figures = []
            for column in ("setup_us", "sample_ns"):
                values = [float(row[column]) for row in motions]
                figures += [f"{statistics.median(values):.1f}", f"{max(values):.1f}"]
            rows.append([method, f"{tolerance:.0e}", *figures])
    return markdown(["method", "tolerance [rad]", "set-up [μs], median", "highest", "ns/sample, median", "highest"], rows)


def ensemble() -> list[str]:
    """Measured ensembles, and the time of 1e9 body-epochs at their rate."""
    rows = []
    for row in read("ensemble.csv"):
        body_epochs = int(row["bodies"]) * int(row["epochs"])
        each = float(row["seconds"]) / body_epochs
        rows.append([row["bodies"], row["epochs"], row["threads"], row["seconds"], f"{1e9 * each:.0f}", f"{BODY_EPOCHS * each:,.0f}"])
    return markdown(["bodies", "epochs each", "threads", "seconds", "ns a body-epoch", "seconds for 1e9 body-epochs"], rows)


def gravity_cases() -> list[str]:
    """The relative error of each level in the reference cases."""
    header = [
        "case",
        "n/spin",
        "e",
        "effect of the torque [rad]",
        "paper",
        "moving",
        "full",
        "second-order",
        "error of full [rad]",
        "bound [rad]",
        "error of second-order [rad]",
        "its bound [rad]",
    ]
    names = [
        "case",
        "n_over_spin",
        "e",
        "effect_rad",
        "paper",
        "moving",
        "full",
        "second_order",
        "full_error_rad",
        "bound_rad",
        "second_error_rad",
        "second_bound_rad",
    ]
    return markdown(header, ([row[name] for name in names] for row in read("gravity-cases.csv")))


def gravity_bounds() -> list[str]:
    """Error over bound in random scenes, by averaging."""
    rows = []
    for averaging, level in (("spin", "full"), ("orbit", "full"), ("spin", "second-order")):
        motions = [row for row in read("gravity-bounds.csv") if (row["averaging"], row["level"]) == (averaging, level)]
        # What the integration loses is no error of the motion, and an error below it is unknown.
        motions = [row for row in motions if float(row.get("lost", 0)) <= float(row["bound"]) / 3]
        shares = sorted(max(float(row["error"]) - float(row.get("lost", 0)), 0) / float(row["bound"]) for row in motions)
        errors = [float(row["error"]) / float(row["torque"]) for row in motions]
        figures = [f"{statistics.median(shares):.4f}", f"{shares[-1]:.2f}", f"{statistics.median(errors):.1e}"]
        rows.append([averaging, level, str(len(motions)), *figures])
    return markdown(["averaged over", "level", "motions", "error / bound, median", "largest", "error / torque, median"], rows)


def averaged_bodies() -> list[str]:
    """Precessing orbits and several bodies by theory, against the integration, by regime."""
    groups: dict[str, list[Row]] = {}
    for row in read("averaged-bodies.csv"):
        groups.setdefault(row["regime"], []).append(row)
    rows = []
    for regime, motions in groups.items():
        shares = [float(row["error"]) / (float(row["bound"]) + float(row["integration_bound"])) for row in motions]
        gains = [float(row["error"]) / float(row["effect"]) for row in motions]
        largest = max(float(row["error"]) for row in motions)
        rows.append([regime, str(len(motions)), f"{statistics.median(shares):.4f}", f"{max(shares):.2f}", f"{statistics.median(gains):.1e}", f"{largest:.1e}"])
    return markdown(["orbits", "motions", "error / bound, median", "largest", "error / effect of the torque, median", "largest error [rad]"], rows)


def gravity_climb() -> list[str]:
    """The largest error over bound that hill climbing finds, by family of scenes and theory: of the two modes the worse."""
    header = ["scenes", "mode", "averaged over", "level", "climbs", "scenes solved", "error [rad]", "bound [rad]", "largest error / bound"]
    names = ["family", "mode", "averaging", "level", "starts", "solved", "error", "bound", "ratio"]
    worst: dict[tuple[str, ...], Row] = {}
    for row in read("gravity-climb.csv"):
        theory = (row["family"], row["averaging"], row["level"])
        if theory not in worst or float(row["ratio"]) > float(worst[theory]["ratio"]):
            worst[theory] = row
    return markdown(header, ([row[name] for name in names] for row in worst.values()))


def gravity_table() -> list[str]:
    """Accepted scenes, error over the effect of the torque, and bound over error, by n/spin and e, in first and second order."""
    groups: dict[tuple[str, str], dict[str, Row]] = {}
    for row in read("gravity-table.csv"):
        groups.setdefault((row["n"], row["e"]), {})[row["level"]] = row
    rows = []
    for (motion, eccentricity), levels in groups.items():
        first, second = levels["full"], levels["second-order"]
        figures = [level[name] for name in ("median_share", "median_bound_over_error") for level in (first, second)]
        rows.append([motion, eccentricity, f"{first['accepted']} of {first['scenes']}", *(figure.replace("NaN", "–") for figure in figures)])
    return markdown(["n/spin", "e", "scenes", "error / effect, full", "second-order", "bound / error, full", "second-order"], rows)


def gravity_spans() -> list[str]:
    """Error and bound of both orders over long spans."""
    groups: dict[tuple[str, str], dict[str, Row]] = {}
    for row in read("gravity-spans.csv"):
        groups.setdefault((row["scene"], row["rotations"]), {})[row["level"]] = row
    rows = []
    for (scene, rotations), levels in groups.items():
        pair = (levels["full"], levels["second-order"])
        shares = [f"{float(row['error']) / float(row['effect']):.1e}" for row in pair]
        errors = [f"{float(row['error']):.1e}" for row in pair]
        # The integration knows no error below its own bound.
        known = [max(float(row["error"]), float(row["reference"])) for row in pair]
        ratios = [f"{float(row['bound']) / error:.2g}" for row, error in zip(pair, known, strict=True)]
        figures = [figure for order in zip(shares, errors, ratios, strict=True) for figure in order]
        rows.append([scene, rotations, pair[0]["orbits"], f"{float(pair[0]['effect']):.1e}", *figures, f"{float(pair[0]['reference']):.1e}"])
    header = ["scene", "rotations", "orbits", "effect of the torque [rad]", "error / effect, full", "error [rad]", "bound / error"]
    header += ["error / effect, second-order", "error [rad]", "bound / error", "bound of the integration [rad]"]
    return markdown(header, rows)


def front() -> list[str]:
    """Time, error and span in three lines."""
    times = {
        row["engine"]: float(row["whole_ns"])
        for row in read("rivals-propagation.csv")
        if (row["scene"], row["times"]) == ("apophis", "uneven") and row["whole_ns"] != "–"
    }
    beside = ", ".join(
        f"{name} {times[engine]:,.0f} ns" for name, engine in (("heyoka at 1e-12", "heyoka 1e-12"), ("SciPy's closed form", "SciPy closed form"))
    )
    stress = [row for row in read("stress.csv") if row["check"] == "attitude"]
    long = next(float(row["max"]) for row in stress if "1e9 rotations" in row["regime"])
    scenes = sum(int(row["scenes"]) for row in stress)
    rows = [
        ["a sample of Apophis, set-up included, 100,000 uneven times", f"**{times['andoyer closed']:.1f} ns** ({beside})"],
        [f"largest error of {scenes:,} random scenes", f"**{max(float(row['max']) for row in stress):.1e} rad**"],
        ["largest error after up to 1e9 rotations", f"**{long:.1e} rad**"],
    ]
    return markdown(["what", "measured"], rows)


def libration_rivals() -> list[str]:
    """Librations beside the integration and heyoka at 1e-12, by scene and span."""
    settings = {"next": "1e-09", "integrated": "1e-09", "heyoka": "1e-12"}
    cases: dict[tuple[str, str], dict[str, Row]] = {}
    for row in read("libration-rivals.csv"):
        if row["setting"] == settings.get(row["engine"]):
            cases.setdefault((row["case"], row["orbits"]), {})[row["engine"]] = row
    rows = []
    for (case, orbits), engines in cases.items():
        cells = [case, f"{int(orbits):,}"]
        for name, columns in (("next", ("error", "seconds")), ("integrated", ("error", "seconds")), ("heyoka", ("error", "seconds"))):
            cells += [engines[name][column] if engines[name][column] == "–" else f"{float(engines[name][column]):.2g}" for column in columns]
        rows.append(cells)
    header = ["scene", "orbits", *(f"{engine}: {column}" for engine in ("libration", "integration", "heyoka") for column in ("error [rad]", "time [s]"))]
    return markdown(header, rows)


def libration_cost() -> list[str]:
    """Cost and error of librations by eccentricity and order."""
    header = ["e", "order", "first [s]", "next [s]", "harmonics", "a sample [ns]", "kept [MiB]", "error over 1,000 orbits [rad]"]
    names = ("eccentricity", "order", "first_s", "next_s", "harmonics", "sample_ns", "kept_mib", "error")
    return markdown(header, ([row[name] for name in names] for row in read("libration-cost.csv")))


def rivals_partials() -> list[str]:
    """Derivatives beside heyoka's variational equations."""
    header = ["scene", "times", "`Motion.partials` [ns a time]", "heyoka [ns a time]", "ratio", "largest difference"]
    return markdown(
        header, ([row[name] for name in ("scene", "samples", "ours_ns", "heyoka_ns", "ratio", "difference")] for row in read("rivals-partials.csv"))
    )


def rivals_gradient() -> list[str]:
    """The averaged theory beside heyoka's integration."""
    header = [
        "scene",
        "times",
        "set-up and first evaluation [µs]",
        "a sample [ns]",
        "heyoka: integration [µs]",
        "a sample [ns]",
        "ratio of the whole",
        "error [rad]",
        "heyoka",
    ]
    names = ("scene", "times", "first_us", "sample_ns", "heyoka_us", "heyoka_sample_ns", "ratio", "error", "heyoka_error")
    return markdown(header, ([row[name] for name in names] for row in read("rivals-gradient.csv")))


def rivals_integration() -> list[str]:
    """The integration beside heyoka's."""
    header = ["scenes", "ratio at our error", "ratio at the tolerance, 1e-10", "ours [ms]"]
    return markdown(
        header, ([row[name] for name in ("regime", "ratio_at_error", "ratio_at_tolerance", "milliseconds")] for row in read("rivals-integration.csv"))
    )


def light_curves() -> list[str]:
    """Light curves with known answers, found from random starts."""
    rows = read("light-curves.csv")
    return markdown(rows[0], (row.values() for row in rows))


def members() -> list[str]:
    """Seconds and memory of large ensembles, by kind."""
    columns = ["kind", "members", "epochs", "threads", "seconds", "ms_a_member", "memory_mb"]
    head = ["kind", "members", "epochs", "threads or workers", "s", "ms a member", "largest memory of a process [MB]"]
    return markdown(head, ([row[column] for column in columns] for row in read("members.csv")))


def rivals_batch() -> list[str]:
    """Ensembles of integrated members beside heyoka's batch mode, by regime."""
    columns = ["regime", "ratio", "alone", "error", "heyoka_tolerance", "us_a_member"]
    head = ["regime", "heyoka's batch mode / ensemble", "scenes one by one / ensemble", "largest error [rad]", "heyoka's tolerance", "µs a member"]
    return markdown(head, ([row[column] for column in columns] for row in read("rivals-batch.csv")))


def evolution_times() -> list[str]:
    """Averages over years, and integrations of a shorter span."""
    columns = ("scene", "years", "all_rotations", "averages_ms", "evaluation_us", "plan_ms", "rotations", "integration_ms", "ratio")
    head = [
        "scene",
        "years",
        "rotations",
        "`evolve` [ms]",
        "an evaluation [µs]",
        "`plan` [ms]",
        "rotations that are integrated",
        "[ms]",
        "time by rotation over that of averages",
    ]
    return markdown(head, ([row[column] for column in columns] for row in read("evolution-times.csv")))


def pulls() -> list[str]:
    """Pulls of fits to magnitudes, a row a parameter."""
    rows = read("pulls.csv")
    head = ["parameter", "mean", "width", "within 1 σ", "within 2 σ", "fits", "of sets"]
    return markdown(head, ([row[column] for column in ("parameter", "mean", "width", "within 1", "within 2", "fits", "sets")] for row in rows))


def verdicts() -> list[str]:
    """How often the verdicts on simulated light curves are right, by quantity, class of motion and model of the body."""
    rows = [row for row in read("verdicts.csv") if row["error"] == "–"]
    lines = []
    for part in ("periods", "pole", "mode"):
        for name, model in itertools.product(("short-axis", "long-axis", "principal-axis", "underdetermined"), ("ellipsoid", "facets")):
            of_class = [row for row in rows if (row["class"], row["model"]) == (name, model)]
            if not of_class:
                continue
            said = [(row[f"verdict {part}"], row[f"right {part}"] == "1") for row in of_class]
            counts = [
                said.count(("secure", True)),
                said.count(("secure", False)),
                *(sum(word == other for word, _ in said) for other in ("ambiguous", "not determined")),
            ]
            lines.append([part, name, model, str(len(of_class)), *map(str, counts), str(sum(right for _, right in said))])
    return markdown(["quantity", "class", "model", "sets", "secure, right", "secure, wrong", "ambiguous", "not determined", "best state right"], lines)


def nature_moon() -> list[str]:
    """Largest differences of a rigid Moon from the orientation of DE421, by model and span."""
    header = ["model", "years", 'about axis 1 ["]', 'axis 2 ["]', 'axis 3 ["]', 'whole angle ["]']
    return markdown(header, ([row[name] for name in ("model", "years", "axis_1", "axis_2", "axis_3", "angle")] for row in read("nature-moon.csv")))


def nature_moon_terms() -> list[str]:
    """The largest angle that a table of the Moon's orientation leaves, by its number of terms."""
    terms = [row for row in read("nature-moon-terms.csv") if row["left"] != "–"]
    return markdown(["terms", 'largest angle left, 1950 to 2050 ["]'], ([str(count), terms[count - 1]["left"]] for count in range(10, len(terms) + 1, 10)))


def nature_moon_table() -> list[str]:
    """The table of the Moon's orientation, largest terms first in each part."""
    header = ["angle", "period [d]", "rate [rad/s], or power", 'sine, x or longitude ["]', 'sine, y ["]', 'cosine, x or longitude ["]', 'cosine, y ["]']
    return markdown(
        header, ([row[name] for name in ("angle", "period_days", "rate", "sine_1", "sine_2", "cosine_1", "cosine_2")] for row in read("nature-moon-terms.csv"))
    )


def nature_moon_rivals() -> list[str]:
    """Differences of three series from the orientation of DE421 on the same days."""
    header = [
        "series",
        "size",
        "axes",
        'largest ["]',
        'root mean square ["]',
        'without the mean rotation: largest ["]',
        'root mean square ["]',
        'mean rotation about axes 1, 2, 3 ["]',
    ]
    return markdown(header, ([value for name, value in row.items() if name != "days"] for row in read("nature-moon-rivals.csv")))


def rivals_ephemeris() -> list[str]:
    """Times of states from DE440 by three readers, and how far the positions are from those of SpiceyPy."""
    header = ["bodies", "times", "reader", "100,000 states [ms]", "ratio to ours", "largest difference of a position from SpiceyPy's, over the distance"]
    return markdown(header, (list(row.values()) for row in read("rivals-ephemeris.csv")))


def nature_earth() -> list[str]:
    """Terms of the nutation of a rigid Earth, published and found: the main ones over the longest span."""
    rows = read("nature-earth.csv")
    longest = max((row["years"] for row in rows), key=float)
    header = ["argument", "period [d]", "in the sum with", "Δψ sine, REN-2000 [µas]", "found", "difference", "Δε cosine, REN-2000 [µas]", "found", "difference"]
    names = ["argument", "period_days", "with", *(f"{angle}{what}_uas" for angle in ("dpsi_sin", "deps_cos") for what in ("", "_found", "_difference"))]
    return markdown(header, ([row[name] for name in names] for row in rows if row["years"] == longest and row["main"] == "yes"))


def nature_nutation() -> list[str]:
    """Differences from REN-2000 by span and angle, of all terms of 100 µas that the span separates."""
    groups: dict[str, list[Row]] = {}
    for row in read("nature-earth.csv"):
        groups.setdefault(row["years"], []).append(row)
    lines = []
    for years, rows in groups.items():
        for name, title in (("dpsi_sin", "Δψ, sine"), ("dpsi_cos", "Δψ, cosine"), ("deps_cos", "Δε, cosine"), ("deps_sin", "Δε, sine")):
            apart = [abs(float(row[f"{name}_difference_uas"])) for row in rows]
            lines.append([years, title, str(len(rows)), f"{statistics.median(apart):.2f}", str(sum(value <= 100 for value in apart)), f"{max(apart):.1f}"])
    return markdown(["years", "amplitude", "terms", "median difference [µas]", "terms within 100 µas", "largest [µas]"], lines)


TESTED = {
    "andoyer-double": ("crates/double/tests", "*.rs"),
    "andoyer-kernels": ("crates/kernels/tests", "*.rs"),
    "andoyer-series": ("crates/series/tests/algebra", "*.rs"),
    "andoyer-propagate": ("tests/tests", "*.rs"),
    "Python": ("crates/py/tests", "test_*.py"),
}


def claim(text: str) -> str:
    """The first paragraph of the header of a test file: what it verifies, and against what."""
    header = re.match(r'(?:(?://! ?.*)\n)+|"""(?:.|\n)*?"""', text)
    lines = [line.removeprefix("//!").strip() for line in header[0].strip('"').splitlines()] if header else []
    return " ".join("\n".join(lines).partition("\n\n")[0].split())


def verified() -> list[str]:
    """What the tests verify and against what, by the header of each file, with the number of its test functions."""
    rows = []
    for module, (folder, pattern) in TESTED.items():
        for path in sorted((DATA.parents[1] / folder).glob(pattern)):
            text = path.read_text(encoding="utf-8")
            tests = len(re.findall(r"(?m)^ *#\[test\]|^def test_", text))
            if tests:
                rows.append([module, claim(text).replace("|", "\\|"), f"`{path.name}`", str(tests)])
    return markdown(["module", "what is verified, and against what", "file", "tests"], rows)


TABLES: dict[str, Callable[[], list[str]]] = {
    "averaged-bodies": averaged_bodies,
    "ensemble": ensemble,
    "evolution-times": evolution_times,
    "members": members,
    "rivals-batch": rivals_batch,
    "front": front,
    "gravity-bounds": gravity_bounds,
    "gravity-cases": gravity_cases,
    "gravity-climb": gravity_climb,
    "gravity-spans": gravity_spans,
    "gravity-table": gravity_table,
    "libration-cost": libration_cost,
    "libration-rivals": libration_rivals,
    "light-curves": light_curves,
    "nature-earth": nature_earth,
    "nature-moon": nature_moon,
    "nature-moon-rivals": nature_moon_rivals,
    "nature-moon-table": nature_moon_table,
    "nature-moon-terms": nature_moon_terms,
    "nature-nutation": nature_nutation,
    "rivals-ephemeris": rivals_ephemeris,
    "rivals-gradient": rivals_gradient,
    "rivals-integration": rivals_integration,
    "rivals-partials": rivals_partials,
    "scenes-accuracy": scenes_accuracy,
    "scenes-speed": scenes_speed,
    "sweep-accuracy": sweep_accuracy,
    "sweep-speed": sweep_speed,
    "verified": verified,
    "pulls": pulls,
    "verdicts": verdicts,
}


class Measured(SphinxDirective):
    """One of the tables, by name."""

    has_content = True

    def run(self) -> list[nodes.Node]:
        name = " ".join(self.content).strip()
        if name not in TABLES:
            raise self.error(f"measured: there is no table {name!r}, only {', '.join(TABLES)}")
        # The tests, and the number of commits since, are no file that the page depends on.
        self.env.note_reread()
        for file in DATA.glob("*.csv"):
            self.env.note_dependency(str(file))
        FILES.clear()
        lines = TABLES[name]()
        container = nodes.container()
        self.state.nested_parse(StringList([*lines, "", *origins(FILES)], source=name), 0, container)
        return container.children


def setup(app: Sphinx) -> dict[str, Any]:
    app.add_directive("measured", Measured)
    return {"version": "1", "parallel_read_safe": True, "parallel_write_safe": True}
