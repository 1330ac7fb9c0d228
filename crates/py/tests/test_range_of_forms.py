"""Numbers far outside the series of a normal form are refused by every method, for one state and for arrays; near the equilibrium they are those of an integration."""

import warnings

import numpy as np
import pytest

from andoyer import TheoryError, normalize

PAIR, PLANE = [("q", "p")], [("x", "X"), ("y", "Y")]
SADDLE = "x*X/500 + (y^2 + Y^2)/2 + x*y^2/4 + X^2*y/2 - y^3/3"
FORMS = {
    "exact": normalize("(p^2 + q^2)/2 - q^3/3", 8, PAIR),
    "float": normalize("(p^2 + q^2)/2 - q^3/3", 8, PAIR, exact=False),
    "resonant": normalize("(x^2 + X^2 + y^2 + Y^2)/2 + x^2*y - y^3/3", 6, PLANE, resonances=[(1, -1)]),
    "saddle": normalize(SADDLE, 6, PLANE),
    "hyperbolic": normalize(SADDLE, 6, PLANE, keep="hyperbolic"),
    "quartet": normalize("x*X + y*Y + (y*X - x*Y) + x^3/3 + y^2*X/2 + Y^3", 5, PLANE, exact=False),
    "driven": normalize("(p^2 + q^2)/2 + q^4/4 - 0.05*q*cos(M)", 6, PAIR, driven={"M": 1.7}),
    "driven saddle": normalize("(p^2 - q^2)/2 + q^4/4 - 0.05*q*cos(M)", 6, PAIR, driven={"M": 1.7}),
}


def methods(name, form, states):
    yield form.to_normal
    yield form.from_normal
    yield form.actions
    if name in ("exact", "float", "resonant", "saddle", "hyperbolic"):
        centres = form.kinds.count("elliptic")
        yield lambda states: form.from_centre_manifold(np.asarray(states)[..., -2 * centres :])


@pytest.mark.parametrize("name", FORMS)
def test_every_method_refuses_states_far_outside_alone_and_among_others(name):
    form = FORMS[name]
    far = np.tile([3.0, 2.5], len(form.variables))
    for method in methods(name, form, far):
        with pytest.raises(TheoryError, match="beyond the range of the series"):
            method(far)
        assert np.isfinite(method(1e-3 * far)).all()
        with pytest.raises(TheoryError, match="beyond the range of the series"):
            method([1e-3 * far, far])
    for times in (1.0, [0.0, 1.0]):
        with pytest.raises(TheoryError, match="beyond the range of the series"):
            form.trajectory(far, times)
    if name not in ("resonant", "hyperbolic"):
        with pytest.raises(TheoryError, match="beyond the range of the series"):
            form.frequency_map(np.full(len(form.variables), 20.0))
        assert form.frequency_map(np.full(len(form.variables), 1e-6)).shape == (len(form.variables),)


@pytest.mark.parametrize("name", FORMS)
def test_state_returns_to_one_percent_or_is_refused(name):
    form, direction = FORMS[name], np.tile([0.8, -0.6], len(FORMS[name].variables))
    kept = []
    for size in np.geomspace(1e-3, 10, 80):
        try:
            back = form.from_normal(form.to_normal(size * direction))
        except TheoryError:
            continue
        kept.append(size)
        assert np.abs(back - size * direction).max() <= 0.0101 * max(size, 0.05)
    assert kept[0] == 1e-3 and max(kept) < 9


def test_trajectories_within_the_range_are_those_of_an_integration():
    integrate = pytest.importorskip("scipy.integrate").solve_ivp
    times = np.linspace(0, 3, 7)
    for size in np.linspace(0.1, 3, 30):
        start = size * np.array([0.8, 0.6])
        try:
            found = FORMS["exact"].trajectory(start, times)
        except TheoryError:
            continue
        true = integrate(lambda t, z: [z[1], z[0] ** 2 - z[0]], (0, 3), start, t_eval=times, rtol=1e-11, atol=1e-12)
        assert np.abs(found - true.y.T).max() < 0.05 * size
    assert size == 3


def test_emitted_numbers_never_come_with_a_warning_instead():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(TheoryError) as caught:
            FORMS["float"].to_normal([0.9, 0.6])
    assert caught.value.argument == "state" and caught.value.value == 0.9
