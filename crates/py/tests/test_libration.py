"""Bodies locked to an orbit: against integrations, against nature, and where the series ends."""

import math
from fractions import Fraction

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation

import andoyer
from andoyer.cli import main

TURN = 2 * math.pi
MOON = andoyer.Body([0.99948, 0.999772, 1.0])


def angles(psi, theta, phi):
    """The attitude Rz(psi) Ry(theta) Rx(phi)."""
    half = [(math.sin(x / 2), math.cos(x / 2)) for x in (psi, theta, phi)]
    (a, b), (c, d), (e, f) = half
    return [b * d * e - a * c * f, b * c * f + a * d * e, a * d * f - b * c * e, b * d * f + a * c * e]


def scene(body=MOON, attitude=(0, 0, 0, 1), resonance=1.0, eccentricity=0.0549, orbits=1000, **options):
    options = {"orbit": andoyer.Orbit(1.0, eccentricity), "tolerance": 1e-9, "method": "libration"} | options
    return andoyer.Scene(body, attitude, [0, 0, resonance], span=(0, orbits * TURN), **options)


CASES = [
    ("pendulum", [0.85, 0.95, 1.0], 1.0, 0.0, 5.0, 8, 9.6e-11),
    ("Moon", [0.99948, 0.999772, 1.0], 1.0, 0.0549, 1.0, 4, 2e-11),
    ("Mercury", [0.9998, 0.9999, 1.0], 1.5, 0.2056, 1.0, 4, 2e-7),
]


@pytest.mark.parametrize(("moments", "resonance", "e", "degrees", "order", "error"), [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_planar_libration_is_that_of_an_integration(moments, resonance, e, degrees, order, error):
    motion = scene(andoyer.Body(moments), angles(math.radians(degrees), 0, 0), resonance, e, tolerance=1e-9 if e < 0.1 else 1e-7).solve()
    assert (motion.plan.method, motion.plan.order, motion.plan.resonance) == ("libration", order, Fraction(resonance))
    verification = motion.verify()
    assert verification.holds
    assert verification.error < error


def test_three_angles_meet_the_tolerance():
    body, attitude = andoyer.Body([0.55, 0.8, 1.0]), angles(*np.radians([2.0, 1.2, 1.0]))
    motion = andoyer.Scene(
        body, attitude, [-math.sin(math.radians(1.2)), 0.0174, 0.9997], orbit=andoyer.Orbit(1.0), span=(0, 1000 * TURN), tolerance=1e-9, method="libration"
    ).solve()
    verification = motion.verify()
    assert motion.plan.meets_tolerance
    assert verification.holds


def test_terms_of_the_longitude_add_up_to_the_attitude():
    motion = scene(attitude=angles(0.01, 0, 0), orbits=100).solve()
    times = np.linspace(0, 600, 50)
    sums = sum(
        term.amplitude * np.sin(term.phase + (TURN * times / term.period if math.isfinite(term.period) else 0))
        for term in motion.libration.terms()
        if term.angle == "longitude"
    )
    x, _, z, w = np.moveaxis(motion.attitude(times), -1, 0)
    seen = 2 * np.arctan2(z, w) - times
    assert np.allclose(x, 0, atol=1e-12)
    assert np.abs(np.angle(np.exp(1j * (seen - sums)))).max() < 1e-10


@pytest.mark.filterwarnings("ignore::andoyer.ToleranceWarning")
def test_a_missed_estimate_over_a_span_that_was_compared_is_twice_the_difference():
    given = {"orbit": andoyer.Orbit(1.0, 0.1), "order": 4, "tolerance": 1e-10, "method": "libration"}
    start = andoyer.Body([0.9996, 0.9997, 1.0]), angles(0.02, 0.012, 0.01), [0, 0, 1.0]
    compared = andoyer.Scene(*start, span=(0, 100 * TURN), **given).solve()
    verification = compared.verify()
    assert verification.holds
    assert not compared.plan.meets_tolerance
    assert compared.plan.error_bound < 3 * verification.error
    # Nothing was compared before the epoch: the estimate stays.
    assert andoyer.Scene(*start, span=(-TURN, 100 * TURN), **given).solve().plan.error_bound > 3 * compared.plan.error_bound


def test_the_rate_of_a_term_is_that_of_its_multiples():
    libration = scene(attitude=angles(0.01, 0.006, 0.005), tolerance=1e-7).solve().libration
    rates = np.array([*libration.frequencies, 1.0])
    terms = libration.terms()
    assert len(terms) > 30
    for term in terms:
        assert np.dot(term.multiples, rates) == pytest.approx(TURN / term.period, rel=1e-9, abs=1e-12), term


def test_rates_are_derivatives_of_the_attitude():
    motion = scene(andoyer.Body([0.55, 0.8, 1.0]), angles(0.03, 0.02, -0.02), eccentricity=0.0, orbits=50, tolerance=1e-7).solve()
    verification = motion.verify()
    step = 1e-4
    for time in (1.0, 100.0, 300.0):
        before, after = motion.attitude([time - step, time + step])
        a, b = before * [-1, -1, -1, 1], after
        vector = a[3] * b[:3] + b[3] * a[:3] + np.cross(a[:3], b[:3])
        assert np.allclose(vector * 2 / (2 * step), motion.angular_velocity([time])[0], atol=1e-7)
    assert verification.holds


MONTH = 27.321661
# Period of the Moon's node on the ecliptic [d].
NODE = 6798.38


def moon(scale, spin=1 - 7.84e-5, **options):
    """The rigid Moon of degree 2 on a fixed ellipse, in days: (C − A)/B and (B − A)/C of DE421, and the Earth's share of the mass."""
    beta, gamma = 6.3100220e-4, 2.2773053e-4
    middle, n = (1 + gamma) / (1 + beta), TURN / MONTH
    orbit = andoyer.Orbit(n, 0.0549, mass_fraction=1 - 0.0121506)
    body = andoyer.Body([middle - gamma, middle, 1.0])
    return andoyer.Scene(body, angles(scale, scale, 4 * scale), [0, 0, n * spin], orbit=orbit, **options).solve()


def fitted_rates(times, signals, multiples, guess):
    """Rates of modes [rad/time] of which `signals` are sums of lines at the given multiples of them and of n, by least squares."""
    guess = np.array(guess)

    def residuals(change):
        lines = multiples @ np.append(guess * (1 + 1e-6 * change), TURN / MONTH)
        columns = np.stack([wave(rate * times) for rate in lines for wave in (np.cos, np.sin)] + [np.ones_like(times)], axis=1)
        return np.concatenate([signal - columns @ np.linalg.lstsq(columns, signal, rcond=None)[0] for signal in signals]) / np.std(signals)

    found = least_squares(residuals, np.zeros(len(guess)), diff_step=1e-3)
    assert np.sqrt(np.mean(found.fun**2)) < 1e-3, "the lines are those of the signal"
    return guess * (1 + 1e-6 * found.x)


@pytest.fixture(scope="module")
def lunar_spectrum():
    """Proper periods [d] in the frame that turns with the Moon, from the attitude of an integration over 220 years."""
    motion = moon(1e-5, span=(0, 3000 * MONTH), tolerance=1e-9, method="integrated")
    times = np.sort(np.random.default_rng(1).uniform(0, 3000 * MONTH, 1200))
    seen = Rotation.from_rotvec(np.outer(TURN / MONTH * times, [0, 0, 1])).inv() * motion.rotation(times)
    psi, theta, phi = seen.as_euler("ZYX").T
    longitude = fitted_rates(times, [psi], np.array([[1, j] for j in (-1, 0, 1)] + [[0, j] for j in (1, 2, 3)]), [TURN / 1056])
    lines = [[1, 0, j] for j in range(-3, 3)] + [[0, 1, j] for j in range(-2, 3)]
    pole = fitted_rates(times, [theta, phi], np.array(lines), [TURN / 27.2965, TURN / 26700])
    return TURN / np.concatenate([longitude, pole])


def test_moon_of_degree_two_has_the_proper_periods_of_an_integration(lunar_spectrum):
    found = moon(1e-5, span=(0, 1000 * MONTH), tolerance=1e-4, method="libration").libration.periods
    # The fit of the wobble, whose rate is a thousandth of n, is the least accurate.
    assert (np.abs(found / lunar_spectrum - 1) < [2e-5, 3e-6, 1.5e-3]).all(), found / lunar_spectrum - 1


def test_moon_of_degree_two_is_within_three_per_cent_of_laser_ranging(lunar_spectrum):
    # Yang et al. (2017) from DE430: 1056.16 d, 8806.9 d from the node, 27,262.99 d. Degree 3, tides, the core and the moving orbit are absent here.
    longitude, pole, wobble = lunar_spectrum
    assert (longitude, wobble) == (pytest.approx(1056.16, rel=1e-3), pytest.approx(27262.99, rel=0.025))
    # In the frame of the orbit the mode has 27.3 d, in one that does not turn 81 years, and from the node, which regresses as the pole does, 24.1 years.
    fixed = 1 / (1 / pole - 1 / MONTH)
    assert pole == pytest.approx(27.2965, abs=1e-3) and fixed / 365.25 == pytest.approx(81.1, abs=0.3)
    assert 1 / (1 / NODE - 1 / fixed) == pytest.approx(8806.9, rel=3e-3)


@pytest.mark.parametrize(
    ("ratio", "seconds", "error", "years"),
    [(2.18e-4, 38.5, 1.6, 11.6), (1.175e-4, 21.0, 1.0, 15.85)],
    ids=["mantle, Margot et al. 2012", "whole, Rambaux and Bois 2004"],
)
def test_mercury_librates_in_88_days_and_in_its_proper_period(ratio, seconds, error, years):
    n = TURN / 87.9691
    motion = andoyer.Scene(
        andoyer.Body([0.9997, 0.9997 + ratio, 1.0]), [0, 0, 0, 1], [0, 0, 1.5 * n], orbit=andoyer.Orbit(n, 0.20563), span=(0, 36525), tolerance=1e-7,
        method="libration",
    ).solve()  # fmt: skip
    largest = motion.libration.forced()[0]
    assert (largest.angle, largest.multiples, largest.period) == ("longitude", (0, 0, 0, 1), pytest.approx(87.9691))
    assert math.degrees(largest.amplitude) * 3600 == pytest.approx(seconds, abs=error)
    assert motion.libration.periods[0] / 365.25 == pytest.approx(years, abs=0.1)


def test_phobos_librates_by_a_degree():
    # Willner et al. (2014): 1.14 degrees; the moments are those of Willner et al. (2010), and degree 3 is absent.
    motion = scene(andoyer.Body([0.3615, 0.4265, 0.5024]), eccentricity=0.01511, orbits=50, tolerance=1e-3).solve()
    assert math.degrees(motion.libration.forced()[0].amplitude) == pytest.approx(1.1, abs=0.05)
    # In first order 2e w²/(1 − w²), w² = 3 (B − A)/C.
    square = 3 * (0.4265 - 0.3615) / 0.5024
    assert motion.libration.forced()[0].amplitude == pytest.approx(2 * 0.01511 * square / (1 - square), rel=0.01)


@pytest.mark.parametrize("thin", [1e-2, 1e-3, 1e-4])
def test_boom_satellite_swings_with_root_three_and_two(thin):
    # A rod swings with √3 n in the plane of its orbit and with 2 n across it (Beletsky); its own thickness counts by (B − A)/C and (C − A)/B.
    motion = scene(andoyer.Body([thin, 1 - thin / 2, 1.0]), angles(1e-3, 1e-3, 0), eccentricity=0.0, orbits=100).solve()
    frequencies = motion.libration.frequencies
    assert frequencies[0] == pytest.approx(math.sqrt(3), rel=2 * thin)
    assert min(abs(frequencies[1:] - 2)) < 2 * thin


def test_half_rotation_an_orbit_is_stable_across():
    turned = angles(math.pi / 2, 0, 0)
    motion = scene(andoyer.Body([0.97, 0.9705, 1.0]), turned, 0.5, 0.1, orbits=100, tolerance=1e-6).solve()
    assert motion.plan.resonance == Fraction(1, 2)
    assert motion.verify().holds


REFUSED = [
    ("free", {"orbit": None}, "no orbit"),
    ("circle", {"orbit": andoyer.Orbit(1.0), "resonance": 1.5}, "no torque"),
    ("fast", {"resonance": 40.0}, "no resonance"),
    ("flyby", {"orbit": andoyer.Orbit(1.0, 1.5)}, "hyperbola"),
    ("two bodies", {"orbit": [andoyer.Orbit(1.0, 0.1), andoyer.Orbit(2.0, 0.1)]}, "2 bodies"),
    ("revolution", {"body": andoyer.Body([0.9, 0.9, 1.0])}, "A = B"),
    ("sphere", {"body": andoyer.Body([1.0, 1.0, 1.0])}, "A = B"),
    ("far", {"attitude": angles(0.8, 0, 0)}, "46 degrees"),
    # A rotation at the rate of the resonance is no swing of a neighbouring one.
    ("farther", {"body": andoyer.Body([0.3615, 0.4265, 0.5024]), "attitude": angles(1.0, 0, 0), "eccentricity": 0.0151}, "57 degrees from the resonance 1"),
    (
        "elongated",
        {"body": andoyer.Body([0.5, 0.75, 1.0]), "orbit": andoyer.Orbit(1.0, 0.3)},
        "the resonance 1 is unstable in the orbit's plane and out of it: a small angle grows by a factor e in 5.61",
    ),
]


@pytest.mark.parametrize(("options", "words"), [case[1:] for case in REFUSED], ids=[case[0] for case in REFUSED])
def test_scene_without_a_libration_says_why(options, words):
    with pytest.raises(andoyer.TheoryError, match=words) as caught:
        scene(**options).solve()
    assert caught.value.argument == "method"


def test_terms_of_a_precessing_orbit_have_a_fifth_multiple():
    orbit = andoyer.Orbit(1.0, 0.0549, inclination=0.0898, node_rate=-4e-3, pericentre_rate=1.2e-2)
    motion = scene(attitude=angles(0.001, 0, 0), orbit=orbit, orbits=100, tolerance=1e-3).solve()
    assert motion.verify().holds
    assert {len(term.multiples) for term in motion.libration.terms()} == {5}


@pytest.mark.parametrize(("resonance", "e", "rates"), [(1.0, 0.05, (-2e-4, 1e-4)), (1.5, 0.1, (-2e-4, 0.0)), (1.0, 0.0, (-2e-4, 1e-4))])
def test_terms_of_all_three_angles_add_up_to_the_attitude_on_a_precessing_orbit(resonance, e, rates):
    node_rate, pericentre_rate = rates
    inclination, node, argument = 0.1, 0.3, 0.8
    orbit = andoyer.Orbit(1.0, e, inclination=inclination, node=node, argument_of_pericentre=argument, node_rate=node_rate, pericentre_rate=pericentre_rate)

    def frame(times, obliquity):
        turn = resonance * times + argument + pericentre_rate * times
        zeros = np.zeros_like(times)
        return Rotation.from_euler("ZXZ", np.transpose([node + node_rate * times, zeros + inclination + obliquity, turn]))

    attitude = frame(np.zeros(1), 0.0)[0] * Rotation.from_euler("ZYX", [0.01, 0.004, 0.003])
    spin = attitude.inv().apply((frame(np.zeros(1), 0.0)[0]).apply([0, 0, resonance + pericentre_rate + node_rate * math.cos(inclination)]))
    body = andoyer.Body([0.9985, 0.9995, 1.0])
    motion = andoyer.Scene(body, attitude.as_quat(), spin, orbit=orbit, span=(0, 600), tolerance=1e-5, method="libration").solve()
    libration, times = motion.libration, np.linspace(0, 600, 40)
    seen = (frame(times, libration.obliquity).inv() * motion.rotation(times)).as_euler("ZYX").T
    for name, angle in zip(("longitude", "pole-1", "pole-2"), seen, strict=True):
        terms = [term for term in libration.terms() if term.angle == name]
        sums = sum(term.amplitude * np.sin(term.phase + (TURN * times / term.period if math.isfinite(term.period) else 0)) for term in terms)
        assert np.abs(angle - sums).max() < 1e-9, name
    assert libration.mean_motion == 1.0
    assert 0 < libration.residual < motion.plan.error_bound


def test_auto_takes_the_libration_over_many_orbits_only():
    attitude = angles(math.radians(1.0), 0, 0)
    short, long = (scene(attitude=attitude, orbits=orbits, method="auto", tolerance=1e-7).solve().plan.method for orbits in (100, 100_000))
    assert (short, long) == ("integrated", "libration")


@pytest.fixture
def moon_file(tmp_path):
    """A moon with 3, 2 and 1 mrad in its angles; the file asks for no method."""
    path = tmp_path / "moon.toml"
    path.write_text(scene(attitude=angles(3e-3, 2e-3, 1e-3), orbits=50, tolerance=1e-4, method="auto").to_toml(), encoding="utf-8")
    return path


def printed(capsys, *arguments):
    status = main(["librations", *map(str, arguments)])
    streams = capsys.readouterr()
    return status, streams.out.splitlines(), streams.err


def test_command_prints_modes_and_terms(moon_file, capsys):
    status, lines, errors = printed(capsys, moon_file)
    motion = scene(attitude=angles(3e-3, 2e-3, 1e-3), orbits=50, tolerance=1e-4).solve()
    terms = motion.libration.terms()
    assert (status, errors) == (0, "") and lines[0].split() == [
        "resonance",
        "1",
        "rotations",
        "an",
        "orbit,",
        "order",
        str(motion.plan.order) + ",",
        *lines[0].split()[-4:],
    ]
    assert f"period {motion.libration.periods[0]:.10g}, amplitude {motion.libration.amplitudes[0]:.6e} rad" in lines[2]
    table = lines[6:]
    assert len(table) == min(len(terms), 20)
    for line, term in zip(table, terms, strict=False):
        angle, *multiples, period, amplitude, phase = line.split()
        assert (angle, tuple(map(int, multiples))) == (term.angle, term.multiples)
        assert (float(period), float(amplitude)) == pytest.approx((term.period, term.amplitude), rel=1e-8)
        assert float(phase) == pytest.approx(term.phase, abs=1e-6)


def test_command_leaves_out_the_proper_modes_and_changes_the_unit(moon_file, capsys):
    in_radians, in_seconds = (printed(capsys, moon_file, "--forced", "--terms", 1, *unit)[1] for unit in ((), ("--unit", "arcsec")))
    assert len(in_radians) == 7 and in_seconds[5].split()[-4:-2] == ["amplitude", "[arcsec]"]
    assert in_radians[6].split()[:5] == ["longitude", "0", "0", "0", "1"]
    assert float(in_seconds[6].split()[6]) == pytest.approx(float(in_radians[6].split()[6]) * 648000 / math.pi, rel=1e-7)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--terms", "0"], "whole number from 1"),
        (["--terms", "-3"], "whole number from 1"),
        (["--unit", "furlong"], "choice"),
        (["--forced", "x"], "unrecognized"),
    ],
)
def test_command_refuses_bad_options_in_one_line(moon_file, capsys, arguments, words):
    status, lines, errors = printed(capsys, moon_file, *arguments)
    assert (status, lines) == (2, []) and words in errors and len(errors.splitlines()) == 1


def test_command_names_the_file_and_the_reason_without_a_libration(tmp_path, capsys):
    (tmp_path / "free.toml").write_text(andoyer.Scene(MOON, [0, 0, 0, 1], [0, 0, 1]).to_toml(), encoding="utf-8")
    for name, reason in (("free.toml", "there is no orbit"), ("absent.toml", "No such file")):
        status, lines, errors = printed(capsys, tmp_path / name)
        assert (status, lines) == (2, []) and name in errors and reason in errors and len(errors.splitlines()) == 1


def test_command_is_strict_about_a_missed_tolerance(tmp_path, capsys):
    path = tmp_path / "elongated.toml"
    path.write_text(scene(andoyer.Body([0.5, 0.75, 1.0]), eccentricity=0.01, orbits=50, tolerance=1e-15).to_toml(), encoding="utf-8")
    for options, expected in (((), 0), (("--strict",), 3)):
        status, lines, errors = printed(capsys, path, *options)
        assert status == expected and lines and "exceeds the tolerance" in errors
