"""The table of the Moon's orientation as code (docs/data/moon_orientation.*): four languages, the table itself, and a month of the kernel of DE421."""

import csv
import os
import shutil
import subprocess

import numpy as np
import pytest
from conftest import REPOSITORY

from andoyer import output

DATA = REPOSITORY / "docs" / "data"
MOON = REPOSITORY / "tests" / "data" / "kernels" / "month.bpc"
YEAR = 365.25 * 86400
TIMES = np.linspace(-50 * YEAR, 49.9 * YEAR, 301)

MAIN = {
    "c": """
#include <stdio.h>
int main(void) {
    double time, angles[3];
    while (scanf("%lf", &time) == 1) {
        moon_orientation(time, angles);
        printf("%.17g %.17g %.17g\\n", angles[0], angles[1], angles[2]);
    }
    return 0;
}
""",
    "rs": """
fn main() {
    for line in std::io::stdin().lines() {
        let [phi, theta, psi] = moon_orientation(line.unwrap().parse().unwrap());
        println!("{phi:?} {theta:?} {psi:?}");
    }
}
""",
    "js": """
for (const line of require("fs").readFileSync(0, "utf8").trim().split("\\n")) console.log(moon_orientation(Number(line)).join(" "));
""",
}
COMPILERS = {
    "c": ["cc", "-std=c99", "-Wall", "-Wextra", "-Werror", "-O2", "-o", "moon", "moon.c", "-lm"],
    "rs": ["rustc", "-D", "warnings", "--edition", "2021", "-O", "-o", "moon", "moon.rs"],
}


@pytest.fixture(scope="module")
def moon():
    """The names of the module in Python."""
    names = {}
    exec((DATA / "moon_orientation.py").read_text(encoding="utf-8"), names)
    return names


def turns_apart(found, expected):
    """Differences of angles, less whole turns."""
    return abs((np.asarray(found) - expected + np.pi) % (2 * np.pi) - np.pi).max()


@pytest.mark.parametrize("language", ["c", "rs", "js"])
def test_every_language_gives_the_angles_of_python(language, moon, tmp_path):
    tool = COMPILERS.get(language, ["node"])[0]
    if shutil.which(tool) is None and not os.environ.get("CI"):
        pytest.skip(f"no {tool} on this machine")
    text = (DATA / f"moon_orientation.{language}").read_text(encoding="utf-8")
    (tmp_path / f"moon.{language}").write_text(text + MAIN[language], encoding="utf-8")
    if language in COMPILERS:
        subprocess.run(COMPILERS[language], cwd=tmp_path, check=True)
    command = ["node", "moon.js"] if language == "js" else [tmp_path / "moon"]
    given = "\n".join(map(repr, TIMES.tolist()))
    done = subprocess.run(command, cwd=tmp_path, input=given, capture_output=True, text=True, check=True)
    found = np.array([line.split() for line in done.stdout.splitlines()], dtype=float)
    assert turns_apart(found, [moon["moon_orientation"](time) for time in TIMES.tolist()]) < 1e-12


def test_the_code_has_the_rows_of_the_table(moon):
    with (DATA / "nature-moon-terms.csv").open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    columns = ("rate", "sine_1", "sine_2", "cosine_1", "cosine_2")
    for angle, terms in (("pole", "POLE"), ("longitude", "LONGITUDE")):
        table = [[float(row[name]) for name in columns if row[name] != "–"] for row in rows if row["angle"] == angle and row["left"] != "–"]
        assert np.array_equal(table, moon[terms])
        table = [[float(row[name]) for name in columns[3:] if row[name] != "–"] for row in rows if row["angle"] == angle and row["left"] == "–"]
        assert np.array_equal(np.ravel(table), np.ravel(moon[f"{terms}_POLYNOMIAL"]))
    assert len(moon["POLE"]) + len(moon["LONGITUDE"]) == 60


@pytest.mark.parametrize("language", ["c", "rs", "py", "js"])
def test_the_code_ends_with_the_kernel_of_its_language(language):
    kernel = (REPOSITORY / f"crates/series/examples/moon_table/kernel.{language}").read_text(encoding="utf-8")
    assert len(kernel) > 1000 and (DATA / f"moon_orientation.{language}").read_text(encoding="utf-8").endswith(kernel)


def test_a_month_of_the_kernel_is_within_an_arcsecond(moon):
    times = np.linspace(0, 31 * 86400, 125)
    expected = output.read_pck(MOON, 31006, times).attitude
    phi, theta, psi = np.array([moon["moon_orientation"](time) for time in times.tolist()]).T
    # The quaternion of turns of the frame about axes 3, 1, 3.
    s, c = np.sin(theta / 2), np.cos(theta / 2)
    found = np.stack([s * np.cos((phi - psi) / 2), s * np.sin((phi - psi) / 2), c * np.sin((phi + psi) / 2), c * np.cos((phi + psi) / 2)], axis=1)
    apart = 2 * np.minimum(*(np.linalg.norm(found - sign * expected, axis=1) for sign in (1, -1)))
    assert np.degrees(apart).max() * 3600 < 0.63
