"""Bodies given by an inertia tensor: the tensor as given is what moves, to the error bound of the plan."""

import numpy as np
import pytest

from andoyer import Body, Scene, Torque

RATES = [0.6, -0.4, 0.9]
# I11, I22, I33, I12, I13, I23, a time, and the attitude [x, y, z, w] then: Euler's equations of the tensor itself, about the user's axes, by Taylor series of order 36 in
# reals of 113 bits.
MOTIONS = {
    "generic": (
        [0.7891142904423339, 0.5924316878250426, 0.9184540217326239, 0.07866043918212665, -0.004830200311066387, -0.1737008215134468],
        500.0,
        [-0.3487617061728328, 0.39248718295770985, -0.7211306864014726, 0.4519840889361891],
    ),
    "needle": (
        [0.9941766667828218, 0.023308411430741024, 0.9826649217864378, 0.07562885316559947, 0.010104322913270496, -0.13018351590403035],
        200.0,
        [-0.4423024502982012, 0.13346235367226877, -0.5234401103732121, -0.7159377022234162],
    ),
    "thin needle": (
        [0.6595943110396224, 0.6518667694442936, 0.6885400195160838, 0.3442477887724376, -0.3256114441901021, 0.3292864983108728],
        200.0,
        [0.8145268567204106, -0.40195168295520706, 0.20417989503644932, -0.36509096772386596],
    ),
    "nearly symmetric": (
        [1.008056948801498, 1.4177616112929072, 1.0741814399056946, -0.058016238359569636, 0.024447414246494128, -0.17604021660690694],
        500.0,
        [-0.2428937811235825, -0.16520843314374434, 0.6135446203045788, 0.7329882561166914],
    ),
    "products of 1e-13": ([1.0, 1.0, 2.0, 1e-13, 0.0, 0.0], 500.0, [-0.06418701903237868, -0.2983973599090628, 0.8112098889059072, -0.49877606029991456]),
}


@pytest.mark.parametrize("method", ["auto", "integrated"])
@pytest.mark.parametrize("name", MOTIONS)
def test_the_error_of_a_tensors_motion_is_within_its_bound_and_is_verified(name, method):
    (a, b, c, d, e, f), time, true = MOTIONS[name]
    body = Body.from_inertia([[a, d, e], [d, b, f], [e, f, c]])
    motion = Scene(body, [0, 0, 0, 1], RATES, span=(0, time), tolerance=1e-9, method=method).solve()
    found = motion.attitude(time)
    error = 2 * min(np.linalg.norm(found - true), np.linalg.norm(found + true))
    assert error <= motion.plan.error_bound <= 1e-9
    assert not motion.verify(tolerance=1e-12).refuted


# A needle of 1e6 : 1 under torques across its long axis: about the axis they cancel to 1e-16, and what remains is a part of 1e-10 over its moment. The attitudes after 4 are
# those of Taylor series of order 24 in reals of 40 digits, of Euler's equations about the axes of the tensor.
NEEDLE = [0.25604513576708926, 0.9695590779130494, 0.7743963863198619, -0.15048749277100223, -0.4096813236831226, -0.08287030478945588]
SLOW, FAST = [-0.0008278650713566112, -0.00031098087056317085, -0.0004877810182566413], [-0.7644796368216763, -0.189777012904855, -0.4368701984089881]
DIPOLE = ["0.3324843167589114*b2 - 0.12213081070071934*b3", "0.6037700259096546*b3 - 0.3324843167589114*b1", "0.12213081070071934*b1 - 0.6037700259096546*b2"]
TORQUES = {
    "constant": (
        Torque.constant([0.0788131566899674, 0.16169544310337927, -0.20251486706476785]),
        SLOW,
        [0.3364011187329255, 0.47154558361411814, -0.6691244320457725, 0.4655658324326209],
    ),
    "damping": (
        Torque.damping(
            [
                [0.025604439961847948, -0.015048759743089888, -0.040968176437567706],
                [-0.015048759743089888, 0.09695593164848676, -0.008287056969600127],
                [-0.040968176437567706, -0.008287056969600127, 0.07743962838966528],
            ]
        ),
        FAST,
        [-0.8205828821658775, -0.1353718749937245, -0.5068544583004115, -0.22675261202028402],
    ),
    "dipole": (
        Torque.polynomial(DIPOLE, sources={"b": [0, 0.6, 0.8]}),
        SLOW,
        [0.1775081101597097, 0.68579338666027, -0.6385693387830189, -0.3006784016300203],
    ),
}


@pytest.mark.parametrize("name", TORQUES)
@pytest.mark.filterwarnings("ignore::andoyer.ToleranceWarning")
def test_the_error_of_a_torque_about_turned_axes_is_within_the_bound(name):
    torque, rates, true = TORQUES[name]
    a, b, c, d, e, f = NEEDLE
    body = Body.from_inertia([[a, d, e], [d, b, f], [e, f, c]])
    motion = Scene(body, [0, 0, 0, 1], rates, span=(0, 4), tolerance=1e-14, torques=[torque]).solve()
    found = motion.attitude(4.0)
    error = 2 * min(np.linalg.norm(found - true), np.linalg.norm(found + true))
    assert error <= motion.plan.error_bound <= 1e-8
    assert not motion.verify(tolerance=1e-7).refuted


def test_the_bound_next_to_the_separatrix_contains_the_rounding_of_principal_moments():
    # A needle of 1.4e5 : 1; the attitude is that of Jacobi's closed form in 60 digits about axes found in 60 digits. The error was 123 times the bound.
    a, b, c, d, e, f = 0.9880082047693355, 0.29856337539921973, 0.7134306604846328, -0.0916961424679263, 0.05861122791608171, 0.4483413788411725
    rates, time = [0.37426454751720695, -1.0, -0.3682934749120741], 2063.939530803375
    true = [-0.5791388242852417, -0.4668898275818497, -0.6663784774005335, 0.050515700167822676]
    motion = Scene(Body.from_inertia([[a, d, e], [d, b, f], [e, f, c]]), [0, 0, 0, 1], rates, span=(0, time), tolerance=1e-9).solve()
    found = motion.attitude(time)
    error = 2 * min(np.linalg.norm(found - true), np.linalg.norm(found + true))
    assert error <= motion.plan.error_bound <= 1e-9
