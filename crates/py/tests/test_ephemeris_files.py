"""Orbits and attitudes from SPICE's files: excerpts with the values of CSPICE (tests/data/kernels), and a month of the Moon from them."""

import csv
from pathlib import Path

import numpy as np
import pytest

import andoyer
from andoyer import output

DATA = Path(__file__).resolve().parents[3] / "tests" / "data" / "kernels"
MONTH, MOON = DATA / "month.bsp", DATA / "month.bpc"
GM = {"SUN": 132712440041.93938, "EARTH": 398600.435436}  # DE440, km³/s²
END = 31 * 86400.0


def lines(name, *bodies):
    with (DATA / "values.csv").open() as file:
        rows = [row for row in csv.DictReader(file) if row["file"] == name and (not bodies or (row["target"], row["observer"]) == bodies)]
    return np.array([[float(row["et"]), *(float(row[f"value{k}"]) for k in range(1, 7))] for row in rows])


@pytest.mark.parametrize(("target", "observer"), [(10, 301), ("EARTH", "moon"), ("399", 301)])
def test_a_table_of_an_ephemeris_has_its_positions(target, observer):
    codes = ("10" if target == 10 else "399", "301")
    table = andoyer.TabulatedOrbit.from_spk(MONTH, target, observer, (0.0, END), gm=1.0, error=1e-12)
    for et, *state in lines("month.bsp", *codes):
        assert np.linalg.norm(table.position(et) - state[:3]) < 2e-12 * np.linalg.norm(state[:3])
    assert table.times[0] == 0 and table.times[-1] == END and len(table.times) < 400


def test_the_error_decides_the_rows_and_the_epoch_is_time_zero():
    fine, coarse = (andoyer.TabulatedOrbit.from_spk([MONTH], 10, 301, (1e5, 2e6), gm=1.0, error=error, epoch=1e5) for error in (1e-12, 1e-6))
    assert len(coarse.times) < len(fine.times) and fine.times[0] == 0 and fine.times[-1] == 1.9e6
    ecliptic = andoyer.TabulatedOrbit.from_spk(MONTH, 10, 3, (0, END), gm=1.0, frame="ECLIPJ2000")
    assert abs(ecliptic.position(1e6)[2]) < 1e-4 * np.linalg.norm(ecliptic.position(1e6))


@pytest.mark.parametrize(
    ("arguments", "error", "said"),
    [
        ({"target": 4}, andoyer.InputError, "4"),
        ({"span": (0, 1e9)}, andoyer.InputError, "2678400"),
        ({"span": (10, 0)}, andoyer.InputError, "span"),
        ({"span": (0, np.nan)}, andoyer.InputError, "span"),
        ({"target": "VULCAN"}, andoyer.InputError, "VULCAN"),
        ({"frame": "IAU_MOON"}, andoyer.InputError, "IAU_MOON"),
        ({"error": 0.0}, andoyer.InputError, "error"),
        ({"error": 1e-19}, andoyer.InputError, "shorter span"),
        ({"files": DATA / "none.bsp"}, andoyer.FileError, "none.bsp"),
        ({"files": MOON}, andoyer.FileError, "month.bpc"),
        ({"gm": -1.0}, andoyer.InputError, "gm"),
    ],
)
def test_what_no_ephemeris_has_is_refused(arguments, error, said):
    given = {"files": MONTH, "target": 10, "observer": 301, "span": (0, 1e6), "gm": 1.0} | arguments
    with pytest.raises(error, match=said):
        andoyer.TabulatedOrbit.from_spk(given.pop("files"), given.pop("target"), given.pop("observer"), given.pop("span"), **given)


def test_the_attitude_of_a_pck_is_that_of_cspice():
    rows = lines("month.bpc")
    rows = rows[np.argsort(rows[:, 0])]
    samples = output.read_pck(MOON, "moon_pa_de421", rows[:, 0])
    for (_, phi, delta, turn, *rates), attitude, found in zip(rows, samples.attitude, samples.angular_velocity, strict=True):
        # The angles are those of [W]3 [δ]1 [φ]3 from inertial to body components.
        matrix = frame_turn(turn, 2) @ frame_turn(delta, 0) @ frame_turn(phi, 2)
        assert np.allclose(rotation(attitude).T, matrix, rtol=0, atol=5e-15)
        s, c = np.sin, np.cos
        expected = [rates[0] * s(delta) * s(turn) + rates[1] * c(turn), rates[0] * s(delta) * c(turn) - rates[1] * s(turn), rates[0] * c(delta) + rates[2]]
        assert np.allclose(found, expected, rtol=0, atol=1e-20)
    with pytest.raises(andoyer.InputError, match="IAU_MARS"):
        output.read_pck(MOON, "IAU_MARS", [0.0])
    with pytest.raises(andoyer.InputError, match="31008"):
        output.read_pck(MOON, "MOON_PA_DE440", [0.0])


def frame_turn(angle, axis):
    c, s = np.cos(angle), np.sin(angle)
    i, j = (axis + 1) % 3, (axis + 2) % 3
    matrix = np.eye(3)
    matrix[i, i] = matrix[j, j] = c
    matrix[i, j], matrix[j, i] = s, -s
    return matrix


def rotation(q):
    x, y, z, w = q
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def arcseconds(motion, times):
    found, exact = motion.attitude(times), output.read_pck(MOON, 31006, times).attitude
    return np.degrees(2 * np.minimum(*(np.linalg.norm(found - sign * exact, axis=1) for sign in (1, -1)))) * 3600


def test_a_month_of_the_moon():
    """A rigid Moon from the state of the kernel: degree 4 keeps to it, degree 2 alone does not."""
    # (C − A)/B and (B − A)/C of DE421.
    beta, gamma = 0.0006310022025364629, 0.0002277305314199142
    largest = (1 + beta) / (1 + gamma)
    moments = [largest - beta, 1.0, largest]
    start = output.read_pck(MOON, 31006, [0.0])
    bodies = [andoyer.TabulatedOrbit.from_spk(MONTH, name, "MOON", (0, END), gm=GM[name], error=1e-11) for name in ("EARTH", "SUN")]
    worst = {}
    for name, body in {"degree 2": andoyer.Body(moments), "degree 4": andoyer.Body(moments, gravity=andoyer.Gravity.named("moon"))}.items():
        scene = andoyer.Scene(body, start.attitude[0], start.angular_velocity[0], orbit=bodies, span=(0, END), tolerance=1e-10)
        worst[name] = arcseconds(scene.solve(), np.linspace(0, END, 200)).max()
    # What is left is the elasticity and the core of the Moon.
    assert worst["degree 4"] < 0.2
    assert worst["degree 2"] > 10 * worst["degree 4"]
