"""The catalogue against the figures that its sources state: every derived moment is derived again."""

import csv
import math

import numpy as np
import pytest
from conftest import REPOSITORY

from andoyer import Body


def rows(name):
    with (REPOSITORY / "tests/data" / name).open(encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def ratios(name):
    moments = np.sort(Body.named(name).moments)
    return (moments[:2] / moments[2]).tolist()


@pytest.mark.parametrize("row", rows("gravity_degree2.csv"), ids=lambda row: row["body"])
def test_moments_of_a_gravity_field_are_those_of_its_coefficients(row):
    c20, c22, s22, c = (float(row[key]) for key in ("C20", "C22", "S22", "C_over_MR2"))
    if row["body"] == "Ceres":
        c = 0.37 + 2 / 3 * -math.sqrt(5) * c20  # the file has five digits of it
    j2, j22 = -math.sqrt(5) * c20, math.sqrt(5 / 12) * math.hypot(c22, s22)
    # Half of the eighth decimal; of C/(M R²) of the Earth and of Eros the file has eight and five digits.
    rounding = {"Eros": 2e-5}.get(row["body"], 6e-9)
    assert ratios(row["body"]) == pytest.approx([1 - (j2 + 2 * j22) / c, 1 - (j2 - 2 * j22) / c], abs=rounding)


def test_moments_of_eros_go_with_the_polar_moment_of_the_shape_model():
    (c20, c22, s22), polar = (-5.24618393097e-2, 8.23993879858e-2, -2.81095559016e-2), 74.4434 / 16**2
    j2, j22 = -math.sqrt(5) * c20, math.sqrt(5 / 12) * math.hypot(c22, s22)
    assert ratios("eros") == pytest.approx([1 - (j2 + 2 * j22) / polar, 1 - (j2 - 2 * j22) / polar], abs=6e-9)


def test_moments_of_itokawa_are_those_of_its_shape():
    (shape,) = (row for row in rows("inertia_from_shapes.csv") if row["body"] == "Itokawa")
    assert ratios("itokawa") == pytest.approx([float(shape["A_over_C"]), float(shape["B_over_C"])], abs=6e-9)


def test_moments_of_ellipsoids_are_those_of_their_axes():
    axes = {"didymos": (394, 394, 290), "dimorphos": (1, 1 / 1.3, 1 / 1.6)}
    for name, (a, b, c) in axes.items():
        expected = [(b * b + c * c) / (a * a + b * b), (a * a + c * c) / (a * a + b * b)]
        assert ratios(name) == pytest.approx(expected, abs=6e-9)


def test_moments_of_the_moon_are_those_of_its_libration_parameters():
    a, b, c = np.sort(Body.named("moon").moments)
    assert (c - a) / b == pytest.approx(631.0213e-6, abs=1.5e-8)
    assert (b - a) / c == pytest.approx(227.7317e-6, abs=1.5e-8)


def test_moments_of_envisat_are_the_principal_ones_of_its_tensor():
    tensor = np.array([[17023.3, 397.1, -2171.4], [397.1, 124825.7, 344.2], [-2171.4, 344.2, 129112.2]])
    moments = np.linalg.eigvalsh(tensor)
    assert ratios("envisat") == pytest.approx((moments[:2] / moments[2]).tolist(), abs=6e-9)
