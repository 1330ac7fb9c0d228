"""Sources of averaged torques: their distance multiplies every term, and they must be slow."""

import numpy as np
import pytest

from andoyer import Body, InputError, Orbit, Scene, TabulatedOrbit, TheoryError, Torque

BODY, STATE = Body([1.0, 1.5, 2.0]), ([0, 0, 0, 1], [0.05, 0.1, 1.0])
SPAN = (0.0, 400.0)


def lost(torque, **options):
    """The change of the angular momentum by the integration, and what the averages leave of it, both as means over the last rotations."""
    scene = Scene(BODY, *STATE, torques=torque, span=SPAN, tolerance=1e-10)
    times = np.linspace(330, 400, 400)
    truth, averaged = scene.solve().angular_momentum(times), scene.evolve(**options).at(times).momentum
    change = np.linalg.norm(truth.mean(axis=0) - scene.solve().angular_momentum(0.0))
    return change, np.linalg.norm((truth - averaged).mean(axis=0))


def light(at):
    plates = {"normals": [[0.2, 0.1, 1], [1, 0.3, -0.2]], "areas": [2, 1], "centroids": [[1, 0.2, 0.1], [-0.3, 1, 0.2]]}
    return Torque.panels(**plates, specular=0.3, pressure=1e-4, at=at, source=Orbit(0.01, 0.6, semi_major_axis=1.0))


@pytest.mark.parametrize("at", [0.5, 2.0])
def test_light_falls_with_the_distance_in_all_its_terms(at):
    # Plates that are no closed surface have a mean torque over all directions, which falls with the distance too.
    change, left = lost(light(at), average="spin")
    assert change > 1e-3 and left < 0.03 * change


@pytest.mark.parametrize("power", [0, 2, 3])
def test_a_term_without_a_direction_falls_with_the_distance(power):
    source = {"sources": {"s": Orbit(0.01, 0.6)}, "distance_powers": {"s": power}}
    change, left = lost(Torque.polynomial(["0", "0", "1e-4"], **source), average="spin")
    assert change > 1e-2 and left < 2e-3 * change
    # The mean of (a/r)^p over an orbit: 1, 1/√(1 − e²), 1/(1 − e²)^(3/2).
    drift = Scene(BODY, [0, 0, 0, 1], [0, 0, 1], torques=Torque.polynomial(["0", "0", "1e-4"], **source)).drift(average="orbit")
    assert drift.momentum[2] == pytest.approx(1e-4 * {0: 1, 2: 0.64**-0.5, 3: 0.64**-1.5}[power], rel=1e-12)


def test_a_term_with_the_distance_of_another_source_is_refused():
    sources = {"a": Orbit(0.01, 0.1), "b": Orbit(0.01, 0.6)}
    torque = Torque.polynomial(["1e-4*a2*a3", "0", "1e-4"], sources=sources, distance_powers={"b": 3})
    with pytest.raises(InputError, match="the direction or the distance of one source"):
        Scene(BODY, *STATE, torques=torque, span=SPAN).evolve()


def test_fast_sources_are_refused_whatever_gives_their_places():
    def torque(source):
        return Torque.polynomial(["1e-6*s2*s3", "0", "1e-6"], sources={"s": source})

    times = np.linspace(-20, 420, 8000)
    table = TabulatedOrbit(times, Orbit(0.3, 0.05, semi_major_axis=1.0).position(times), 1.0)
    for fast in (Orbit(0.3, 0.05), Orbit(0.05, 0.8), Orbit(0.05, 1.2, time_of_pericentre=200.0), table):
        with pytest.raises(TheoryError, match="the largest rate of the direction to a source"):
            Scene(BODY, *STATE, torques=torque(fast), span=SPAN).evolve()
    # A damped rotation becomes as slow as its source long before the torque is strong.
    damped = [torque(Orbit(0.01, 0.0)), Torque.damping(1e-3)]
    end = Scene(BODY, *STATE, torques=damped).evolve((0, 1e5)).end
    assert end.reason == "slow rotation" and end.time < 1e4


def test_a_span_beside_the_epoch_is_reached_and_one_of_too_many_steps_is_refused_at_once():
    scene = Scene(BODY, *STATE, torques=Torque.damping(1e-4))
    evolution = scene.evolve((100, 200))
    assert tuple(evolution.reached) == (100.0, 200.0)
    states = evolution.at([100.0, 200.0])
    np.testing.assert_allclose(states.momentum, scene.evolve((0, 200)).at([100.0, 200.0]).momentum, rtol=1e-9)
    source = Torque.polynomial(["0", "0", "1e-9*s3"], sources={"s": Orbit(1e-3, 0.1)})
    with pytest.raises(TheoryError, match="the integration needs about 9.5e7 steps") as caught:
        Scene(BODY, *STATE, torques=source).evolve((0, 1e11), average="spin")
    assert "the the" not in str(caught.value)
