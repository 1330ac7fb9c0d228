"""What a solution costs is known beforehand: a libration makes no order, and an integration takes no steps, that nobody asked for. The limits are counts, not times."""

import math
import re

import pytest

from andoyer import Body, Orbit, Scene, TheoryError, Torque

pytestmark = pytest.mark.filterwarnings("ignore::andoyer.ToleranceWarning")
TURN = 2 * math.pi


def precessing(eccentricity, pericentre_rate=0.0, moments=(0.9065, 0.9071, 1.0), **options):
    """A body in the 1 : 1 resonance near the normal of an orbit that precesses."""
    orbit = Orbit(1.0, eccentricity, inclination=0.3, node_rate=-0.002, pericentre_rate=pericentre_rate)
    options = {"span": (0, 10 * TURN), "tolerance": 1e-9, "method": "libration"} | options
    return Scene(Body(moments), [0.16, 0.0, 0.0, math.sqrt(1 - 0.16**2)], [0.0, 0.0, 1.0], orbit=orbit, **options)


def cost(text):
    """The order and the multiplications that are not made, and the bound."""
    found = re.search(
        r"orders to (\d+) take about (\S+) multiplications \((\d+) times of the orbit's phases\), and at most (\S+) are made unless order=(\d+)", text
    )
    assert found, text
    order, work, times, bound, asked = found.groups()
    assert order == asked
    return int(order), float(work), int(times), float(bound)


def test_an_order_that_costs_too_much_is_named_and_not_made():
    motion = precessing(0.05).solve()
    order, work, times, bound = cost("\n".join(motion.plan.skipped))
    assert motion.plan.order == order - 2
    # C(N + 14, 12) products of two polynomials in six variables to degree N + 2, for each time of the grid and each term, beside the search for the periodic motion.
    forms = 33 * sum(math.comb(below + 14, 12) * (times + 16) for below in range(4, order + 1, 2))
    assert 0.97 * forms < work < forms + bound
    assert work > bound
    assert motion.verify().holds


def test_a_search_that_costs_too_much_is_named_and_ends():
    with pytest.raises(TheoryError, match="the periodic motion takes more multiplications .* unless order=4 asks"):
        precessing(0.2, pericentre_rate=0.0014, moments=(0.99999445, 0.99999762, 1.0)).solve()


def test_auto_does_without_the_order_and_says_so():
    plan = precessing(0.25, pericentre_rate=0.0071, method="auto").solve().plan
    assert plan.method == "integrated"


# A sphere turns at the rate of the torque's integral, and the steps of its rotation are equally long: their number grows as the angle.
SPHERE = Body([1.0, 1.0, 1.0])


def steps(torque, rate, span):
    scene = Scene(SPHERE, [0, 0, 0, 1], [0, 0, rate], torques=torque, span=(0, span), tolerance=1e-15)
    return scene.solve().plan.steps


@pytest.mark.parametrize(
    ("torque", "angle", "short", "span"),
    [
        (Torque.constant([0, 0, 1.0]), lambda t: t + t * t / 2, 200.0, 2e4),
        (Torque.damping(-1.0), lambda t: math.exp(t) - 1, math.log(2e4), math.log(3e8)),
    ],
    ids=["constant", "negative damping"],
)
def test_the_steps_of_a_body_that_spins_up_are_predicted(torque, angle, short, span):
    with pytest.raises(TheoryError, match="the integration needs about") as caught:
        Scene(SPHERE, [0, 0, 0, 1], [0, 0, 1.0], torques=torque, span=(0, span), tolerance=1e-15).solve()
    assert caught.value.value == pytest.approx(steps(torque, 1.0, short) * angle(span) / angle(short), rel=0.1)
