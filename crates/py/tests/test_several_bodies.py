"""The averaged theory with several disturbing bodies and with precessing orbits, against the integration of the full equations."""

import math

import numpy as np
import pytest
from test_integration import ATTITUDE, EARTH, TILTED, angle

import andoyer
from andoyer import Body, Orbit, Scene, TabulatedOrbit

pytestmark = pytest.mark.filterwarnings("ignore::andoyer.ToleranceWarning")
BODY = Body([0.85, 0.9, 1.0])
RATES = [0.12, -0.05, 1.0]
PRECESSING = Orbit(4e-3, 0.2, node_rate=-1e-3, pericentre_rate=5e-4, time_of_pericentre=-300.0, **TILTED)
SECOND = Orbit(1e-3, 0.5, attraction=4e-6, inclination=1.2, node=0.3, argument_of_pericentre=2.0)
SCENES = {
    "precessing": PRECESSING,
    "two bodies": [Orbit(4e-3, 0.2, **TILTED), SECOND],
    "two bodies, one precessing": [PRECESSING, SECOND],
    "eccentric": [Orbit(1e-3, 0.8, node_rate=1e-4, **TILTED), Orbit(2e-3)],
    "circles": [Orbit(4e-3, inclination=0.5, node_rate=-4e-4), Orbit(3e-3, attraction=1e-6)],
}


@pytest.mark.parametrize("orbit", SCENES.values(), ids=SCENES)
@pytest.mark.parametrize("span", [(0, 6000), (-6000, 0)], ids=["after", "before"])
def test_theory_leaves_an_error_of_second_order_within_its_bound(orbit, span):
    options = {"orbit": orbit, "span": span, "tolerance": 1e-12}
    theory = Scene(BODY, ATTITUDE, RATES, method="closed", **options).solve()
    exact = Scene(BODY, ATTITUDE, RATES, method="integrated", **options).solve()
    free = Scene(BODY, ATTITUDE, RATES, span=span).solve()
    times = np.linspace(*span, 400)
    truth = exact.attitude(times)
    error, effect = (angle(motion.attitude(times), truth).max() for motion in (theory, free))
    assert theory.plan.method == "closed" and theory.plan.averaging == "spin"
    assert error < theory.plan.error_bound < 300 * error
    assert error < 1e-4 * effect
    start = theory.at(0.0)
    assert angle(start.attitude, ATTITUDE / np.linalg.norm(ATTITUDE)) < 1e-14 and np.abs(start.angular_velocity - RATES).max() < 1e-14


def test_error_is_of_second_order_in_the_torques_of_two_bodies():
    errors = []
    for factor in (1.0, 0.25):
        orbits = [Orbit(o.mean_motion, o.eccentricity, attraction=factor * o.attraction, node_rate=o.node_rate, **TILTED) for o in (PRECESSING, SECOND)]
        options = {"orbit": orbits, "span": (0, 3000), "tolerance": 1e-13}
        theory, exact = (Scene(BODY, ATTITUDE, RATES, method=method, **options).solve() for method in ("closed", "integrated"))
        times = np.linspace(0, 3000, 300)
        errors.append(angle(theory.attitude(times), exact.attitude(times)).max())
    # A quarter of both torques leaves a sixteenth; terms of third order change it by their relative size, 1e-3.
    assert 14 < errors[0] / errors[1] < 18


def test_a_precessing_orbit_without_rates_is_the_fixed_orbit():
    still, moving = (Orbit(4e-3, 0.3, node_rate=rate, **TILTED) for rate in (0.0, 1e-30))
    times = np.linspace(-3000, 3000, 200)
    quarters, arcs = (
        Scene(BODY, ATTITUDE, RATES, orbit=orbit, averaging="spin", level="moving", span=(-3000, 3000)).solve().attitude(times) for orbit in (still, moving)
    )
    # Both solve the same averaged equations, one on quarters of the orbit and one on arcs of time, to rounding.
    assert angle(quarters, arcs).max() < 1e-13


def test_method_is_the_theory_where_its_bound_meets_the_tolerance_and_without_a_span():
    orbit = [PRECESSING, SECOND]
    coarse, fine = (Scene(BODY, ATTITUDE, RATES, orbit=orbit, span=(0, 1000), tolerance=tolerance).solve().plan for tolerance in (1e-4, 1e-11))
    assert (coarse.method, fine.method) == ("closed", "integrated")
    assert coarse.meets_tolerance and fine.meets_tolerance and "its error bound is" in fine.skipped[0]
    with pytest.warns(andoyer.ToleranceWarning):
        endless = Scene(BODY, ATTITUDE, RATES, orbit=orbit).solve()
    known = Scene(BODY, ATTITUDE, RATES, orbit=orbit, method="closed", span=(0, 1000)).solve()
    assert endless.plan.method == "closed" and angle(endless.attitude(1000.0), known.attitude(1000.0)) < known.plan.error_bound
    with pytest.raises(andoyer.RepresentationError, match="solved no farther"):
        endless.attitude(1e9)


def test_options_that_need_one_fixed_orbit_are_refused():
    for option in ({"averaging": "orbit"}, {"level": "second-order"}):
        [(name, value)] = option.items()
        for orbit in (PRECESSING, [SECOND, SECOND]):
            with pytest.raises(andoyer.InputError, match=f'{name} = "{value}" needs one disturbing body') as caught:
                Scene(BODY, ATTITUDE, RATES, orbit=orbit, span=(0, 100), **option).solve()
            assert caught.value.argument == name and caught.value.value == value
    with pytest.raises(andoyer.TheoryError, match="the averaged equations are solved up to") as caught:
        Scene(BODY, ATTITUDE, RATES, orbit=PRECESSING, span=(0, 1e9), method="closed").solve()
    assert caught.value.argument == "span" and 1e7 < caught.value.bound < 1e9
    times = np.linspace(-1, 11, 50)
    table = TabulatedOrbit(times, np.stack([np.cos(times), np.sin(times), 0 * times], axis=1), 1e-6)
    with pytest.raises(andoyer.TheoryError, match='method = "closed".*a table of positions is integrated'):
        Scene(BODY, ATTITUDE, RATES, orbit=[SECOND, table], span=(0, 10), method="closed").solve()


def test_satellite_with_the_node_of_an_oblate_earth_is_that_of_the_integration_for_a_month():
    semi_major_axis = EARTH["radius"] + 500e3
    orbit = Orbit.around_oblate(EARTH["gm"], semi_major_axis, 0.001, math.radians(51.6), j2=EARTH["j2"], radius=EARTH["radius"])
    assert math.degrees(orbit.node_rate) * 86400 == pytest.approx(-4.75, abs=0.01)
    spin = math.radians(5.0)
    for days in (1, 7, 30):
        options = {"orbit": orbit, "span": (0, days * 86400.0), "tolerance": 1e-9}
        theory, exact = (
            Scene(Body.box(1.0, 1.2, 0.6, mass=100.0), [0, 0, 0, 1], [0.02 * spin, 0, spin], method=method, **options).solve()
            for method in ("closed", "integrated")
        )
        times = np.linspace(0, days * 86400.0, 500)
        error = angle(theory.attitude(times), exact.attitude(times)).max()
        assert exact.plan.error_bound < error < theory.plan.error_bound


def test_derivatives_of_a_motion_under_two_bodies_are_those_of_the_integration():
    options = {"orbit": [PRECESSING, SECOND], "span": (0, 300), "tolerance": 1e-11}
    theory, exact = (Scene(BODY, ATTITUDE, RATES, method=method, **options).solve() for method in ("closed", "integrated"))
    assert theory.plan.partials == "variational"
    found, expected = (np.asarray(motion.partials(200.0).attitude) for motion in (theory, exact))
    # The theory's error, 1e-6, changes over the scale of the variables.
    assert np.abs(found - expected).max() < 1e-4 * np.abs(expected).max()
