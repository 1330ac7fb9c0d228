"""Internal friction in averaged motions, against its own quadrature, closed forms and the full equations; members, progress."""

import pickle

import numpy as np
import pytest

import andoyer

BODY = andoyer.Body([1.0, 1.5, 2.0])
STATE = ([0, 0, 0, 1], [0.1, 0.5, 1.0])


def rock(body):
    return andoyer.Dissipation(body, 100.0, andoyer.Material(density=2000.0, rigidity=5e9, quality=100.0))


@pytest.mark.parametrize("rates", [[2e-5, 1.6e-4, 2e-4], [3e-4, 1e-4, 5e-5]])
def test_friction_alone_is_the_relaxation(rates):
    body = andoyer.Body.ellipsoid(100, 70, 50)
    scene = andoyer.Scene(body, [0, 0, 0, 1], rates)
    dissipation = rock(body)
    relaxation = dissipation.relax(scene)
    long_axis = scene.solve().plan.mode == "long-axis"
    with_friction = andoyer.Scene(body, [0, 0, 0, 1], rates, torques=[andoyer.Torque.dissipation(dissipation)])
    span = relaxation.time_to(1.2, mode="long-axis") if long_axis else relaxation.time_to(0.1)
    evolution = with_friction.evolve((0, span), tolerance=1e-10)
    times = np.linspace(0, span, 9)
    a, b, c = sorted(body.moments)
    separatrix = 1 - a / b if long_axis else c / b - 1
    found = np.arcsin(np.sqrt(evolution.at(times).excess / separatrix))
    assert np.allclose(found, relaxation.at(times).angle, rtol=1e-8, atol=0)
    assert np.allclose(evolution.at(times).momentum, evolution.at(0).momentum, rtol=1e-15, atol=0)
    assert with_friction.drift().excess == pytest.approx(
        -2 * dissipation.power(scene) / (dissipation.moments.max() * (np.linalg.norm(evolution.at(0).momentum) / c) ** 2) * (-a / c if long_axis else 1),
        rel=1e-12,
    )


def test_a_power_of_the_excess_gives_its_exponential():
    scene = andoyer.Scene(BODY, *STATE, torques=[andoyer.Torque.dissipation(lambda excess: 3e-9 * excess)])
    evolution = scene.evolve((0, 1e9), tolerance=1e-9)
    momentum = evolution.at(0).momentum
    rate = 2 * 2.0 * 3e-9 / (momentum @ momentum)  # ξ̇ = −2CP/M²
    assert evolution.at(1e9).excess / evolution.at(0).excess == pytest.approx(np.exp(-rate * 1e9), rel=1e-7)


def test_friction_and_a_torque_add_their_rates():
    torque, friction = andoyer.Torque.constant([0, 1e-6, 2e-6]), andoyer.Torque.dissipation(lambda excess: 1e-6 * excess)
    drifts = [andoyer.Scene(BODY, *STATE, torques=torques).drift() for torques in ([torque], [friction], [torque, friction])]
    assert drifts[2].excess == pytest.approx(drifts[0].excess + drifts[1].excess, rel=1e-12)
    assert drifts[1].momentum == pytest.approx(np.zeros(3)) and drifts[2].momentum == pytest.approx(drifts[0].momentum)
    assert drifts[2].by_degree[0][1] == pytest.approx(drifts[0].by_degree[0][1] + drifts[1].excess)


def test_friction_leads_through_the_separatrix_to_either_sense_of_the_short_axis():
    scene = andoyer.Scene(BODY, [0, 0, 0, 1], [1.0, 0.35, 0.1], torques=[andoyer.Torque.dissipation(lambda excess: 2e-5 * excess)])
    evolution = scene.evolve((0, 1e6))
    assert evolution.end.reason == "separatrix"
    outcomes = evolution.through(members=32)
    assert {str(one.at(one.end.time).mode) for _, one in outcomes} == {"short-axis"}
    assert sum(share for share, _ in outcomes) == pytest.approx(1.0)
    # No sense is preferred by the symmetry of the body.
    assert len(outcomes) == 2 and min(share for share, _ in outcomes) > 0.25
    assert outcomes[0][1].scene.torques == scene.torques


def test_what_is_no_friction_is_refused():
    friction = andoyer.Torque.dissipation(lambda excess: excess * 1e-6)
    with pytest.raises(andoyer.InputError, match="evolve"):
        andoyer.Scene(BODY, *STATE, torques=[friction], span=(0, 10)).solve()
    with pytest.raises(andoyer.InputError, match="evolve"):
        andoyer.Ensemble([[1, 1.5, 2]], [STATE[0]], [STATE[1]], torques=[friction], span=(0, 10)).at([1.0])
    with pytest.raises(andoyer.InputError, match="file"):
        andoyer.Scene(BODY, *STATE, torques=[friction]).to_toml()
    with pytest.raises(TypeError, match="Dissipation or a callable"):
        andoyer.Torque.dissipation(1e-6)
    for power, said in ((lambda x: 1e-9, "excess 0"), (lambda x: -1e-9 * x, "at least 0"), (lambda x: np.nan * x, "finite")):
        with pytest.raises(andoyer.InputError, match=said):
            andoyer.Scene(BODY, *STATE, torques=[andoyer.Torque.dissipation(power)]).evolve((0, 1e6))
    other = andoyer.Torque.dissipation(rock(andoyer.Body.ellipsoid(100, 70, 50)))
    with pytest.raises(andoyer.InputError, match="body"):
        andoyer.Scene(BODY, *STATE, torques=[other]).evolve((0, 1e6))


def test_the_exception_of_a_power_is_raised_as_it_is():
    def power(excess):
        if 1e-6 < excess < 0.02:
            raise ZeroDivisionError("own")
        return 1e-6 * excess

    scene = andoyer.Scene(BODY, *STATE, torques=[andoyer.Torque.dissipation(power)])
    scene.drift()
    with pytest.raises(ZeroDivisionError, match="own"):
        scene.evolve((0, 1e8))
    assert scene.evolve((0, 1e3)).end.reason == "span"


def test_the_torque_is_its_origin():
    dissipation = rock(andoyer.Body.ellipsoid(100, 70, 50))
    torque = andoyer.Torque.dissipation(dissipation)
    assert torque.kind == "dissipation" and torque == torque and torque != andoyer.Torque.dissipation(dissipation)
    assert "Torque.dissipation(" in repr(torque) and pickle.loads(pickle.dumps(torque)).kind == "dissipation"


def test_members_spread_the_end_and_progress_is_told():
    torque = andoyer.Torque.polynomial(["0", "3e-4*s1 - 1e-4", "-2e-4*s2"], sources={"s": [0.6, 0, 0.8]})
    friction = andoyer.Torque.dissipation(lambda excess: 4e-4 * excess)
    scene = andoyer.Scene(BODY, [0, 0, 0, 1], [1.0, 0.3, 0.1], torques=[torque, friction])
    told = []
    evolution = scene.evolve((0, 1e5), members=12, progress=lambda done, of: told.append((done, of)))
    assert evolution.end.reason == "separatrix" and len(evolution.members) == 12
    times = [end.time for end in evolution.members if end.reason == "separatrix"]
    assert evolution.end.spread == pytest.approx(np.std(times, ddof=1)) and evolution.end.spread > 0
    assert told[-1] == (100, 100) and told == sorted(told)
    assert scene.evolve((0, 1e5)).members == []
    with pytest.raises(andoyer.InputError, match="members"):
        scene.evolve((0, 1e5), members=-1)
    with pytest.raises(andoyer.InputError, match="10000"):
        scene.evolve((0, 1e5), members=10001)


def test_an_exception_of_progress_ends_the_evolution():
    def stop(done, of):
        raise KeyError("enough")

    with pytest.raises(KeyError, match="enough"):
        andoyer.Scene(BODY, *STATE, torques=[andoyer.Torque.constant([0, 0, 1e-9])]).evolve((0, 1e6), progress=stop)
