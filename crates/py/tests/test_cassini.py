"""Cassini states: out of resonance, in a spin–orbit resonance, and bad input."""

import math

import pytest

import andoyer

BODY = andoyer.Body([0.98, 0.99, 1.0])


def orbit(eccentricity=0.0, **options):
    return andoyer.Orbit(0.02, eccentricity, **({"inclination": 0.2, "node_rate": -1e-6} | options))


def near(states):
    """The stable state near the normal of the orbit."""
    [state] = [state for state in states if state.stable and abs(state.obliquity) < 0.5]
    return state


def test_fast_body_has_no_resonance_and_precesses_with_the_mean_of_the_torque():
    state = near(andoyer.cassini_states(BODY, orbit(), 1.0))
    alpha = 1.5 * 0.02**2 * 0.015
    assert state.resonance is None
    assert alpha * math.cos(state.obliquity) * math.sin(state.obliquity) == pytest.approx(1e-6 * math.sin(0.2 + state.obliquity), rel=1e-12)


@pytest.mark.parametrize(("eccentricity", "p", "coefficient"), [(0.0, 1.0, 1.0), (0.2, 1.5, 3.5 * 0.2 - 123 / 16 * 0.2**3 + 489 / 128 * 0.2**5)])
def test_state_in_a_resonance_balances_peale_s_torque(eccentricity, p, coefficient):
    state = near(andoyer.cassini_states(BODY, orbit(eccentricity), p * 0.02))
    theta, torque = state.obliquity, 1.5 * 0.02**2 / (p * 0.02)
    mean = 0.015 * (1 - eccentricity**2) ** -1.5 * math.cos(theta) + 0.5 * coefficient * 0.01 / 2 * (1 + math.cos(theta))
    assert state.resonance == p
    # The series of the coefficient ends at the seventh power of the eccentricity.
    assert torque * mean * math.sin(theta) == pytest.approx(1e-6 * math.sin(0.2 + theta), rel=1e-12 if eccentricity == 0 else 1e-5)


def test_body_of_revolution_is_in_no_resonance():
    assert near(andoyer.cassini_states(andoyer.Body([0.98, 0.98, 1.0]), orbit(), 0.02)).resonance is None


@pytest.mark.parametrize("spin_rate", [0.0, -1.0, math.inf, math.nan])
def test_spin_rate_that_is_not_positive_is_refused(spin_rate):
    with pytest.raises(andoyer.InputError) as caught:
        andoyer.cassini_states(BODY, orbit(), spin_rate)
    assert caught.value.argument == "spin_rate"


def test_orbit_without_a_rate_of_its_node_is_refused():
    with pytest.raises(andoyer.InputError) as caught:
        andoyer.cassini_states(BODY, orbit(node_rate=0.0), 1.0)
    assert caught.value.argument == "node_rate"
