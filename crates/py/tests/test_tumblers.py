"""Periods and reports of bodies that tumble, against published figures and against a computed light curve."""

import math

import numpy as np
import pytest
from conftest import REPOSITORY

import andoyer
from andoyer.cli import main

HOUR, DAY = 3600.0, 86400.0
APOPHIS = REPOSITORY / "examples/scenes/apophis.toml"


@pytest.fixture(scope="module")
def apophis():
    return andoyer.Scene.from_toml(APOPHIS).solve()


def test_apophis_gives_its_published_periods_back_in_the_convention_of_light_curves(apophis):
    """Pravec et al. 2014: 27.38 h and 263 h, which the state was solved for, are those of the short axis; the long axis precesses in 30.56 h."""
    assert apophis.plan.mode == "short-axis"
    assert apophis.periods["extremal-axis"] == pytest.approx((27.38 * HOUR, 263 * HOUR), rel=1e-12)
    assert apophis.periods["short-axis"] == apophis.periods["extremal-axis"]
    assert apophis.periods["long-axis"] == pytest.approx((30.56 * HOUR, 263 * HOUR), rel=2e-4)


def strongest_period(times, light):
    """Period of the strongest line: the highest bin of the spectrum, then the frequency near it whose sine and cosine leave the least."""
    step = times[1] - times[0]
    taper = np.hanning(len(times))
    light = (light - light.mean()) * taper
    bin_ = int(np.argmax(np.abs(np.fft.rfft(light))))
    frequencies = (bin_ + np.linspace(-1, 1, 401)) / (len(times) * step)
    power = np.abs(np.exp(-2j * np.pi * frequencies[:, None] * times) @ light)
    return 1 / frequencies[int(np.argmax(power))]


@pytest.mark.parametrize("direction", [[1.0, 0.0, 0.0], [0.2, -0.9, 0.4], [0.5, 0.5, 0.7]])
def test_strongest_line_of_the_light_of_apophis_is_twice_the_precession_of_its_long_axis(apophis, direction):
    # Illuminated and seen from one direction, a homogeneous ellipsoid shows the area π |(b c s1, c a s2, a b s3)| of its outline.
    a, b, c = apophis.scene.body.moments
    semi_axes = np.sqrt([b + c - a, a + c - b, a + b - c])
    times = np.arange(2**13) * 1.5 * HOUR  # 512 days, ten samples in a period
    direction = np.array(direction) / np.linalg.norm(direction)
    seen = apophis.rotation(times).apply(direction, inverse=True)
    light = math.pi * np.prod(semi_axes) * np.linalg.norm(seen / semi_axes, axis=1)
    # The grid of frequencies is 1/200 of a bin, that is 15.28 h times 15.28/12288/200 = 1e-4 h.
    assert strongest_period(times, light) == pytest.approx(30.56 / 2 * HOUR, abs=0.004 * HOUR)
    assert strongest_period(times, light) == pytest.approx(apophis.periods["long-axis"].precession / 2, abs=2e-3 * HOUR)


def test_apophis_has_the_published_energy_and_the_parameter_of_its_nutation(apophis):
    assert apophis.energy_ratio == pytest.approx(1.02364, abs=5e-6)
    assert round(apophis.energy_ratio, 3) == 1.024  # Pravec et al. 2014
    # J between 11.09 and 53.83 degrees: Q = cos^2 J, k^2 = 1 - Q1/Q2.
    nutation = np.arccos(np.divide(*apophis.andoyer(np.linspace(0, 263 * HOUR, 20001))[:, [5, 4]].T))
    assert np.degrees([nutation.min(), nutation.max()]) == pytest.approx([11.09, 53.83], abs=0.01)
    expected = 1 - (math.cos(nutation.max()) / math.cos(nutation.min())) ** 2
    assert apophis.elliptic_parameter == pytest.approx(expected, abs=1e-6) == pytest.approx(0.638, abs=5e-4)
    assert apophis.plan.separatrix_ratio == pytest.approx(0.567, abs=5e-4)


def toutatis(rate=1.0):
    """Its long axis 50.005 degrees from the angular momentum where it is nearest (published: 50.0)."""
    body = andoyer.Body.named("toutatis")
    tilt, (a, _, c) = math.radians(50.005), body.moments
    return andoyer.Scene(body, [0, 0, 0, 1], [rate * math.cos(tilt) / a, 0.0, rate * math.sin(tilt) / c]).solve()


def test_toutatis_precesses_in_7_days_40_and_rolls_in_5_days_38():
    """Zhao et al. 2015: 7.40(3) d, 5.38(3) d, both of the long axis."""
    motion = toutatis(toutatis().periods["long-axis"].precession / (7.40 * DAY))
    assert motion.plan.mode == "long-axis" and motion.periods["extremal-axis"] == motion.periods["long-axis"]
    assert [round(period / DAY, 2) for period in motion.periods["long-axis"]] == [7.40, 5.38]
    assert motion.elliptic_parameter == pytest.approx(0.032, abs=5e-4)
    # The long axis stays between 50.0 and 50.8 degrees from the angular momentum.
    times = np.linspace(0, 5.38 * DAY, 2001)
    momentum = motion.angular_velocity(times) * motion.scene.body.moments
    angle = np.degrees(np.arccos(momentum[:, 0] / np.linalg.norm(momentum, axis=1)))
    assert [angle.min(), angle.max()] == pytest.approx([50.0, 50.8], abs=0.05)


def test_reports_of_motions_without_a_polhode_are_their_limits():
    body = andoyer.Body([1.0, 1.5, 2.0])
    for rates, ratio in [([0, 0, 1], 1.0), ([0, 1, 0], 2 / 1.5), ([1, 0, 0], 2.0), ([0, 0, 0], 1.0)]:
        motion = andoyer.Scene(body, [0, 0, 0, 1], rates).solve()
        assert motion.energy_ratio == pytest.approx(ratio, rel=1e-15)
    assert andoyer.Scene(body, [0, 0, 0, 1], [0, 0, 1]).solve().elliptic_parameter == 0.0


def test_plan_of_apophis_is_a_report_that_a_person_reads(capsys):
    assert main(["plan", str(APOPHIS)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0] == "scene         Apophis, tumbling"
    assert "energy        E/E0 1.023637, k^2 0.63833573" in lines
    assert "periods       extremal-axis: P_phi 98568, P_psi 946800" in lines
    assert [line for line in lines if line.startswith("mode ")] == ["mode          short-axis"]
    assert all(len(line.split(maxsplit=1)[0]) < 14 for line in lines)
