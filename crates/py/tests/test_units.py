"""Quantities of pint and unyt become SI units as those of astropy do; a unit of any other package is an error, and no unit is dropped."""

import math

import numpy as np
import pytest

import andoyer
import andoyer.output

pint, unyt = pytest.importorskip("pint"), pytest.importorskip("unyt")
UNITS = pint.UnitRegistry()
BODY = andoyer.Body([1.0, 1.5, 2.0])
A_DAY = 2 * math.pi / 86400

TURNING = {
    "pint": [0, 0, 360] * UNITS.degree / UNITS.day,
    "list of pint": [0.1 * A_DAY * UNITS.radian / UNITS.s, 0 * UNITS.degree / UNITS.day, 360 * UNITS.degree / UNITS.day],
    "objects of pint": np.array([0 * UNITS.degree / UNITS.day, 0 * UNITS.degree / UNITS.day, 360 * UNITS.degree / UNITS.day], dtype=object),
    "unyt": unyt.unyt_array([0, 0, 360], "degree/day"),
    "list of unyt": [unyt.unyt_quantity(x, "degree/day") for x in (0, 0, 360)],
}


@pytest.mark.parametrize("rates", TURNING.values(), ids=TURNING)
def test_one_turn_a_day_is_one_turn_a_day(rates):
    scene = andoyer.Scene(BODY, [0, 0, 0, 1], rates)
    assert scene.angular_velocity[2] == pytest.approx(A_DAY, rel=1e-14)


@pytest.mark.parametrize("minute", [1 * UNITS.minute, unyt.unyt_quantity(1, "min"), [1 * UNITS.minute]], ids=["pint", "unyt", "list"])
def test_a_minute_is_sixty_seconds(minute):
    motion = andoyer.Scene(BODY, [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
    assert np.array_equal(np.squeeze(motion.attitude(minute)), motion.attitude(60.0))


def test_elements_of_an_orbit_have_units():
    turns = andoyer.Orbit(15 * UNITS.turn / UNITS.day, 0.1, inclination=30 * UNITS.degree, semi_major_axis=7000 * UNITS.km)
    assert turns.mean_motion == pytest.approx(15 * A_DAY, rel=1e-14)
    assert (turns.inclination, turns.semi_major_axis) == pytest.approx((math.pi / 6, 7e6), rel=1e-14)
    assert andoyer.Orbit(unyt.unyt_quantity(900, "degree/day")).mean_motion == pytest.approx(2.5 * A_DAY, rel=1e-14)


MECHANICS = {
    "astropy": lambda units: (units.Unit("kN m"), units.Unit("kg m2 deg / h"), units.Unit("N m s / deg"), units.km),
    "pint": lambda units: (
        1 * UNITS.kN * UNITS.m,
        1 * UNITS.kg * UNITS.m**2 * UNITS.degree / UNITS.hour,
        1 * UNITS.N * UNITS.m * UNITS.s / UNITS.degree,
        1 * UNITS.km,
    ),
    "unyt": lambda units: tuple(unyt.unyt_quantity(1, text) for text in ("kN*m", "kg*m**2*degree/hr", "N*m*s/degree", "km")),
}


@pytest.mark.parametrize("made", MECHANICS.values(), ids=MECHANICS)
def test_torques_have_units(made):
    torque, momentum, damping, length = made(pytest.importorskip("astropy.units"))
    degree = math.pi / 180
    assert parts(andoyer.Torque.constant([2.0, 0.0, 0.5] * torque)) == pytest.approx([2000, 0, 500], rel=1e-14)
    assert parts(andoyer.Torque.rotor([0.0, 0.0, 4.0] * momentum)) == pytest.approx([0, 0, 4 * degree / 3600], rel=1e-14)
    for given in (3.0 * damping, [3.0, 3.0, 3.0] * damping, 3.0 * np.eye(3) * damping):
        assert np.array(parts(andoyer.Torque.damping(given))) == pytest.approx(3 / degree * np.eye(3), rel=1e-14)
    source = andoyer.Orbit(1e-3, semi_major_axis=7000 * length)
    falling = {"sources": {"b": source}, "distance_powers": {"b": 3}}
    made_of = andoyer.Torque.polynomial(["b1", "0", "0"], **falling, reference_distances={"b": 6900 * length})
    assert made_of == andoyer.Torque.polynomial(["b1", "0", "0"], **falling, reference_distances={"b": 6.9e6})
    for make in (andoyer.Torque.constant, andoyer.Torque.rotor):
        with pytest.raises(TypeError, match="must be in kg"):
            make([1.0, 0.0, 0.0] * length)
    with pytest.raises(TypeError, match="damping must be in kg"):
        andoyer.Torque.damping(1.0 * torque)
    with pytest.raises(TypeError, match="reference_distances must be in m"):
        andoyer.Torque.polynomial(["b1", "0", "0"], **falling, reference_distances={"b": 1.0 * torque})


def parts(torque):
    """The numbers of a torque."""
    return eval(repr(torque), {"Torque": type("Torque", (), dict.fromkeys(("constant", "rotor", "damping"), staticmethod(lambda numbers: numbers)))})


class Furlongs(float):
    """A number with a unit that no package here knows."""

    units = "furlong"


REFUSED = {
    "length": lambda: andoyer.Scene(BODY, [0, 0, 0, 1], [0, 0, 1] * UNITS.meter),
    "hertz of pint": lambda: andoyer.Orbit(1 * UNITS.Hz),
    "hertz of unyt": lambda: andoyer.Orbit(unyt.unyt_quantity(1, "Hz")),
    "some without": lambda: andoyer.Scene(BODY, [0, 0, 0, 1], [0.0, 0.0, 360 * UNITS.degree / UNITS.day]),
    "unknown package": lambda: andoyer.Orbit(Furlongs(1.0)),
    "unknown package, in objects": lambda: andoyer.Scene(BODY, [0, 0, 0, 1], np.array([0.0, 0.0, Furlongs(1.0)], dtype=object)),
}


@pytest.mark.parametrize("made", REFUSED.values(), ids=REFUSED)
def test_unit_that_is_not_converted_is_refused(made):
    with pytest.raises(TypeError, match="mean_motion|angular_velocity"):
        made()


def test_times_of_pandas_are_named_where_the_epoch_is_a_date():
    pandas, time = pytest.importorskip("pandas"), pytest.importorskip("astropy.time")
    motion = andoyer.Scene(BODY, [0, 0, 0, 1], [0.1, 0.2, 1.0], epoch=time.Time("2026-04-13", scale="tdb")).solve()
    for value in (pandas.Timestamp("2026-04-14"), pandas.Timedelta(days=1), pandas.DatetimeIndex(["2026-04-14"])):
        with pytest.raises(andoyer.InputError, match=f"times is a {type(value).__name__}, .*Time of astropy"):
            motion.attitude(value)


BARE = {
    "pint": [0.25, 0.1] * UNITS.dimensionless,
    "unyt": unyt.unyt_array([0.25, 0.1]),
    "turns": [0.25, 0.1] * UNITS.turn,
    "degrees": unyt.unyt_array([90, 36], "degree"),
}


@pytest.mark.parametrize("phases", BARE.values(), ids=BARE)
def test_phases_without_a_unit_are_turns(phases):
    body = andoyer.Body.named("apophis")
    expected = andoyer.Scene.from_periods(body, 27.38, 263.0, phases=(0.25, 0.1)).attitude
    assert andoyer.Scene.from_periods(body, 27.38, 263.0, phases=phases).attitude == pytest.approx(expected, abs=1e-14)


def test_durations_of_a_kernel_from_a_date_are_refused(tmp_path):
    time = pytest.importorskip("astropy.time")
    motion = andoyer.Scene(BODY, [0, 0, 0, 1], [0.1, 0.2, 1.0], epoch=time.Time("2026-04-13", scale="tdb")).solve()
    with pytest.raises(andoyer.InputError, match="interval is a Quantity"):
        andoyer.output.write_ck(tmp_path / "a.bc", motion, (0 * UNITS.s, 60 * UNITS.s))
