"""Ensembles: the bits of single motions for any number of threads, shapes, what is refused and of which member, copies."""

import copy
import itertools
import math
import pickle

import numpy as np
import pytest

import andoyer
from andoyer import Body, Ensemble, Scene

MEMBERS = 200  # of all modes, in blocks for several threads
LEVEL = [0.0, 0.0, 0.0, 1.0]


def random_members():
    generator = np.random.default_rng(20170101)
    moments = np.sort(generator.uniform(0.5, 1.0, (MEMBERS, 3)))
    attitudes = generator.normal(size=(MEMBERS, 4))
    attitudes /= np.linalg.norm(attitudes, axis=1, keepdims=True)
    return moments, attitudes, generator.normal(size=(MEMBERS, 3))


@pytest.fixture(scope="module")
def members():
    return random_members()


@pytest.fixture(scope="module")
def ensemble(members):
    return Ensemble(*members)


def single(members, k, **keywords):
    moments, attitudes, rates = members
    return Scene(Body(moments[k]), attitudes[k], rates[k], **keywords).solve()


@pytest.mark.parametrize("threads", [None, 1, 2, 7])
def test_members_have_the_bits_of_single_motions_for_any_number_of_threads(members, threads):
    times = [-10.0, 0.0, 3.5, 1e6]
    ensemble = Ensemble(*members, threads=threads)
    samples = ensemble.at(times)
    assert samples.attitude.shape == (MEMBERS, 4, 4) and samples.angular_velocity.shape == (MEMBERS, 4, 3)
    assert np.array_equal(ensemble.attitude(times), samples.attitude)
    for k in range(MEMBERS):
        alone = single(members, k).at(times)
        assert np.array_equal(samples.attitude[k], alone.attitude)
        assert np.array_equal(samples.angular_velocity[k], alone.angular_velocity)


def test_members_may_have_their_own_times(ensemble, members):
    times = np.linspace(-100, 100, 3 * MEMBERS).reshape(MEMBERS, 3)
    samples = ensemble.at(times)
    assert np.array_equal(samples.times, times) and samples.times is not times
    for k in range(MEMBERS):
        assert np.array_equal(samples.attitude[k], single(members, k).attitude(times[k]))
        assert np.array_equal(samples.angular_velocity[k], single(members, k).angular_velocity(times[k]))
    same = np.broadcast_to(times[0], (MEMBERS, 3))  # not contiguous: strides of 0
    assert np.array_equal(ensemble.attitude(same), ensemble.attitude(times[0]))


@pytest.mark.parametrize("shape", [(), (0,), (1,), (4,), (MEMBERS, 0), (MEMBERS, 1), (MEMBERS, 4)])
def test_results_have_an_axis_of_members_the_axis_of_times_and_one_more(ensemble, shape):
    samples = ensemble.at(np.zeros(shape))
    each = shape[-1:]
    assert samples.times.shape == shape
    assert samples.attitude.shape == ensemble.attitude(np.zeros(shape)).shape == (MEMBERS, *each, 4)
    assert samples.angular_velocity.shape == (MEMBERS, *each, 3)
    assert len(samples) == MEMBERS
    for array in [samples.attitude, samples.angular_velocity]:
        assert array.dtype == np.float64 and array.flags.c_contiguous and array.flags.writeable


def test_samples_say_of_what_they_are(ensemble):
    shown = {0.0: "a scalar time", (1.0,): "1 time", (1.0, 2.0): "2 times"}
    for times, text in shown.items():
        assert repr(ensemble.at(times)) == f"<Samples of {MEMBERS} members at {text}>"
    assert repr(ensemble.at(np.zeros((MEMBERS, 2)))) == f"<Samples of {MEMBERS} members at 2 times each>"
    assert repr(Ensemble([[1, 1, 1]], LEVEL, [0, 0, 1]).at([[1, 2]])) == "<Samples of 1 member at 2 times each>"


def test_all_kinds_of_arrays_give_the_same_bits(members):
    moments, attitudes, rates = members
    expected = Ensemble(moments, attitudes, rates).attitude([1.0, 2.0])
    fortran = [np.asfortranarray(array) for array in members]
    strided = [np.repeat(array, 2, axis=0)[::2] for array in members]
    backwards = [array[::-1].copy()[::-1] for array in members]
    swapped = [array.astype(">f8") for array in members]
    for kind in [fortran, strided, backwards, swapped, [array.tolist() for array in members]]:
        assert np.array_equal(Ensemble(*kind).attitude(np.array([1, 2])), expected)
    whole = Ensemble(np.array([[2, 3, 4]] * 2), np.array([[0, 0, 0, 1]] * 2), np.array([[0, 1, 5], [5, 1, 0]], dtype=np.int32))
    assert np.array_equal(whole.attitude(7)[1], Scene(Body([2.0, 3.0, 4.0]), LEVEL, [5.0, 1.0, 0.0]).solve().attitude(7.0))


def test_one_row_stands_for_every_member():
    rows = {"moments": [1.0, 1.5, 2.0], "attitudes": [0.6, 0.0, 0.0, 0.8], "angular_velocities": [0.1, 0.2, 1.0]}
    expected = Ensemble(*([row] * 3 for row in rows.values()))
    for many in itertools.chain.from_iterable(itertools.combinations(rows, size) for size in (1, 2)):
        assert Ensemble(**{name: [row] * 3 if name in many else row for name, row in rows.items()}) == expected
    with pytest.raises(andoyer.InputError, match="one row each"):
        Ensemble(**rows)


def test_members_are_motions(ensemble, members):
    times = [0.0, 5.0]
    for k in [0, 17, MEMBERS - 1]:
        motion = ensemble[k]
        assert motion.scene == single(members, k).scene
        assert np.array_equal(motion.attitude(times), ensemble.attitude(times)[k])
    assert np.array_equal(ensemble[-1].attitude(times), ensemble[MEMBERS - 1].attitude(times))
    assert len(ensemble) == len(list(ensemble)) == MEMBERS
    for index in [MEMBERS, -MEMBERS - 1, 2**62]:
        with pytest.raises(IndexError, match=f"member {index} of an ensemble of {MEMBERS}"):
            ensemble[index]


@pytest.mark.parametrize("part", [slice(1, 3), slice(None, None, -2), slice(-2, None), slice(5, 2), slice(None)])
def test_slices_are_ensembles_with_the_bits_of_the_whole(ensemble, part):
    times = [0.0, 1.0, 1e6]
    some = ensemble[part]
    assert (some.tolerance, some.threads) == (ensemble.tolerance, ensemble.threads)
    assert np.array_equal(some.attitude(times), ensemble.attitude(times)[part])
    assert ensemble[:] == ensemble


def test_plans_are_those_of_single_motions(ensemble, members):
    plans = ensemble.plans
    assert plans == [single(members, k).plan for k in range(MEMBERS)]
    assert {plan.mode for plan in plans} == {"short-axis", "long-axis"}


def test_tolerance_is_that_of_every_member(members):
    loose = Ensemble(*members, tolerance=1e-4)
    assert loose.plans == [single(members, k, tolerance=1e-4).plan for k in range(MEMBERS)]
    assert np.array_equal(loose.attitude(3.0)[5], single(members, 5, tolerance=1e-4).attitude(3.0))


def test_what_was_given_can_be_read_and_not_written(ensemble, members):
    for name, given in zip(["moments", "attitudes", "angular_velocities"], members, strict=True):
        array = getattr(ensemble, name)
        assert np.array_equal(array, given) and not array.flags.writeable
    assert (ensemble.tolerance, ensemble.threads) == (1e-12, None)
    with pytest.raises(AttributeError):
        ensemble.tolerance = 1.0


def test_equality_and_text(ensemble, members):
    moments, attitudes, rates = members
    assert ensemble == Ensemble(*members)
    for other in [
        Ensemble(moments[::-1], attitudes, rates),
        Ensemble(moments, attitudes[::-1], rates),
        Ensemble(moments, attitudes, rates[::-1]),
        Ensemble(*members, tolerance=1e-9),
        Ensemble(*members, threads=1),
        Ensemble(*(array[1:] for array in members)),
        None,
    ]:
        assert ensemble != other
    with pytest.raises(TypeError, match="unhashable"):
        hash(ensemble)
    assert repr(ensemble) == f"<Ensemble of {MEMBERS} bodies, tolerance=1e-12>"
    assert repr(Ensemble([1, 1, 1], [LEVEL], [0, 0, 1], threads=2)) == "<Ensemble of 1 body, tolerance=1e-12, threads=2>"


@pytest.mark.parametrize("protocol", range(2, pickle.HIGHEST_PROTOCOL + 1))
def test_ensembles_and_their_samples_are_pickled(members, protocol):
    ensemble = Ensemble(*members, tolerance=1e-9, threads=2)
    again = pickle.loads(pickle.dumps(ensemble, protocol))
    assert again == ensemble and (again.tolerance, again.threads) == (1e-9, 2)
    samples = ensemble.at([1.0, 2.0])
    restored = pickle.loads(pickle.dumps(samples, protocol))
    assert np.array_equal(restored.attitude, samples.attitude) and repr(restored) == repr(samples)


def test_copies_are_itself(ensemble):
    assert copy.copy(ensemble) is ensemble and copy.deepcopy(ensemble) is ensemble


BAD_MEMBERS = {
    "moments": ("moments", [1.0, 1.0, 2.5], andoyer.InputError, r"moments = \[1.0, 1.0, 2.5\]"),
    "moment": ("moments", [1.0, math.nan, 1.0], andoyer.InputError, r"moments\[1\] = NaN"),
    "attitude": ("attitudes", [0.0] * 4, andoyer.InputError, "attitude = "),
    "rates": ("angular_velocities", [0.0, 0.0, math.inf], andoyer.InputError, r"angular_velocity\[2\] = inf"),
}


@pytest.mark.parametrize("name, row, error, message", BAD_MEMBERS.values(), ids=BAD_MEMBERS)
@pytest.mark.parametrize("bad", [[17], [17, 18, 199]])
def test_bad_members_are_named_and_counted(members, name, row, error, message, bad):
    arrays = dict(zip(["moments", "attitudes", "angular_velocities"], (array.copy() for array in members), strict=True))
    arrays[name][bad] = row
    with pytest.raises(error, match=f"^member 17: {message}") as caught:
        Ensemble(**arrays)
    assert caught.value.index == 17
    assert str(caught.value).endswith("(and 2 more bad members)") == (len(bad) == 3)
    again = pickle.loads(pickle.dumps(caught.value))
    assert (type(again), str(again), again.index) == (error, str(caught.value), 17)


def test_a_single_body_has_an_error_without_index():
    with pytest.raises(andoyer.InputError) as caught:
        Body([1.0, 1.0, 2.5])
    assert not hasattr(caught.value, "index")


@pytest.mark.parametrize("call", [lambda e: e.at(0.0), lambda e: e.attitude([0.0]), lambda e: e.plans, lambda e: e[9]])
def test_members_without_a_solution_are_named(members, call):
    moments, attitudes, rates = (array[:12].copy() for array in members)
    moments[9], rates[9] = 1e-200, 1e-200
    ensemble = Ensemble(moments, attitudes, rates)
    with pytest.raises(andoyer.RepresentationError, match="^member 9: moments and angular_velocity") as caught:
        call(ensemble)
    assert caught.value.index == 9


@pytest.mark.parametrize("method", ["at", "attitude"])
def test_bad_times_are_refused(ensemble, method):
    evaluate = getattr(ensemble, method)
    with pytest.raises(andoyer.InputError, match=r"^member 0: times\[1\] = NaN") as caught:
        evaluate([0.0, math.nan])
    assert caught.value.index == 0
    own = np.zeros((MEMBERS, 2))
    own[130, 1] = math.inf
    with pytest.raises(andoyer.InputError, match=r"^member 130: times\[1\] = inf") as caught:
        evaluate(own)
    assert caught.value.index == 130
    for shape in [(MEMBERS + 1, 2), (2, MEMBERS), (1, 2), (MEMBERS, 2, 1)]:
        with pytest.raises(andoyer.InputError, match=rf"times has shape .*: it must be \(\), \(n,\) or \({MEMBERS}, n\)"):
            evaluate(np.zeros(shape))
    for times in ["now", None, [1j], [True]]:
        with pytest.raises(TypeError, match="times"):
            evaluate(times)


def test_out_receives_the_result_itself(ensemble):
    for times in [2.0, [0.0, 1.0], [], np.ones((MEMBERS, 3))]:
        out = np.full((MEMBERS, *np.shape(times)[-1:], 4), np.nan)
        assert ensemble.attitude(times, out=out) is out
        assert np.array_equal(out, ensemble.attitude(times))
    for bad in [np.empty((2, MEMBERS, 4)), np.empty((2 * MEMBERS, 4)), np.empty((MEMBERS, 2, 4), order="F")]:
        with pytest.raises(andoyer.InputError, match="out"):
            ensemble.attitude([0.0, 1.0], out=bad)
    with pytest.raises(TypeError, match="float64"):
        ensemble.attitude([0.0, 1.0], out=np.empty((MEMBERS, 2, 4), np.float32))
    shared = np.zeros(MEMBERS * 8)
    with pytest.raises(andoyer.Error, match="in use"):
        ensemble.attitude(shared[: 2 * MEMBERS].reshape(MEMBERS, 2), out=shared.reshape(MEMBERS, 2, 4))


BAD_ARGUMENTS = {
    "two bodies": (([[1, 1, 1]] * 2, [LEVEL] * 3, [[0, 0, 1]] * 3), {}, andoyer.InputError, "attitudes has 3 entries: it must have 2"),
    "two rates": (([1, 1, 1], [LEVEL] * 3, [[0, 0, 1]] * 2), {}, andoyer.InputError, "angular_velocities has 2"),
    "flat": ((np.ones(6), LEVEL, [[0, 0, 1]]), {}, andoyer.InputError, r"moments has shape \(6,\): it must be \(m, 3\) or \(3,\)"),
    "wide": (([1, 1, 1], [[0, 0, 1]], [0, 0, 1]), {}, andoyer.InputError, r"attitudes has shape \(1, 3\)"),
    "deep": (([1, 1, 1], LEVEL, np.ones((1, 1, 3))), {}, andoyer.InputError, r"angular_velocities has shape \(1, 1, 3\)"),
    "text": (("eros", [LEVEL], [0, 0, 1]), {}, TypeError, "moments"),
    "zero tolerance": (([1, 1, 1], [LEVEL], [0, 0, 1]), {"tolerance": 0}, andoyer.InputError, "^tolerance = 0"),
    "tolerance of none": ((np.empty((0, 3)), LEVEL, [0, 0, 1]), {"tolerance": math.nan}, andoyer.InputError, "NaN"),
    "text for a tolerance": (([1, 1, 1], [LEVEL], [0, 0, 1]), {"tolerance": "small"}, TypeError, "tolerance"),
    "no threads": (([1, 1, 1], [LEVEL], [0, 0, 1]), {"threads": 0}, andoyer.InputError, "threads = 0: it must be from 1 to 1024"),
    "many threads": (([1, 1, 1], [LEVEL], [0, 0, 1]), {"threads": 1025}, andoyer.InputError, "threads = 1025"),
    "negative threads": (([1, 1, 1], [LEVEL], [0, 0, 1]), {"threads": -1}, andoyer.InputError, "threads = -1"),
    "half a thread": (([1, 1, 1], [LEVEL], [0, 0, 1]), {"threads": 0.5}, andoyer.InputError, "threads = 0.5"),
    "boolean threads": (([1, 1, 1], [LEVEL], [0, 0, 1]), {"threads": True}, TypeError, "threads"),
    "three orbits": (([1, 1, 1], [LEVEL] * 2, [0, 0, 1]), {"orbits": [None] * 3}, andoyer.InputError, "orbits has 3 entries: it must have 2"),
    "a mean motion": (([1, 1, 1], [LEVEL], [0, 0, 1]), {"orbits": [1e-3]}, TypeError, r"orbits\[0\] must be an Orbit or None, not float"),
    "one mean motion": (([1, 1, 1], [LEVEL], [0, 0, 1]), {"orbits": 1e-3}, TypeError, "orbits must be an Orbit or a sequence"),
    "a span that runs backwards": (([1, 1, 1], [LEVEL], [0, 0, 1]), {"span": (1, 0)}, andoyer.InputError, "span"),
    "another method": (([1, 1, 1], [LEVEL], [0, 0, 1]), {"method": "euler"}, andoyer.InputError, 'method = "euler"'),
    "an averaging": (([1, 1, 1], [LEVEL], [0, 0, 1]), {"averaging": "spin"}, TypeError, "averaging"),
    "a level": (([1, 1, 1], [LEVEL], [0, 0, 1]), {"level": "third"}, andoyer.InputError, "level"),
}


@pytest.mark.parametrize("arguments, keywords, error, message", BAD_ARGUMENTS.values(), ids=BAD_ARGUMENTS)
def test_bad_arguments_are_refused(arguments, keywords, error, message):
    with pytest.raises(error, match=message) as caught:
        Ensemble(*arguments, **keywords)
    assert not hasattr(caught.value, "index")


def test_no_members_give_empty_results():
    ensemble = Ensemble(np.empty((0, 3)), np.empty((0, 4)), np.empty((0, 3)))
    assert ensemble == Ensemble(np.empty((0, 3)), LEVEL, [0, 0, 1])
    for times, shape in [(0.0, (0,)), ([0.0, 1.0], (0, 2)), (np.empty((0, 2)), (0, 2)), ([], (0, 0))]:
        samples = ensemble.at(times)
        assert samples.attitude.shape == (*shape, 4) and samples.angular_velocity.shape == (*shape, 3)
        assert len(samples) == 0
    assert len(ensemble) == 0 and ensemble.plans == [] and list(ensemble) == []


def test_empty_list_is_refused_with_the_shape_of_no_members():
    with pytest.raises(andoyer.InputError, match=r"moments is empty: it must be \(m, 3\) or \(3,\), and for no members \(0, 3\)"):
        Ensemble([], LEVEL, [0, 0, 1])


SUN = andoyer.Orbit(2e-3, 0.1, inclination=0.3)
MOON = andoyer.Orbit(5e-3, 0.02, mass_fraction=0.5)
FAST = ([[1, 1.02, 1.05], [1, 1.01, 1.03], [1, 1.02, 1.04]], LEVEL, [[0.01, 0.02, 1.0], [0.02, 0.0, 1.1], [0.0, 0.03, -0.9]])


@pytest.mark.filterwarnings("ignore::andoyer.ToleranceWarning")
@pytest.mark.parametrize("orbits", [SUN, [SUN, None, MOON], (SUN,) * 3, [None] * 3, None])
def test_members_under_orbits_have_the_bits_of_their_scenes(orbits):
    ensemble, times, span = Ensemble(*FAST, orbits=orbits, span=(0, 1e5)), [0.0, 1e3, 1e5], (0, 1e5)
    samples, each = ensemble.at(times), list(orbits) if isinstance(orbits, (list, tuple)) else [orbits] * 3
    for k, orbit in enumerate(each):
        motion = Scene(Body(FAST[0][k]), LEVEL, FAST[2][k], orbit=orbit, span=span).solve()
        assert ensemble[k].scene == motion.scene and ensemble.plans[k] == motion.plan
        assert np.array_equal(samples.attitude[k], motion.attitude(times)) and np.array_equal(ensemble.attitude(times)[k], motion.attitude(times))
        assert np.array_equal(samples.angular_velocity[k], motion.angular_velocity(times))
        moved = np.abs(np.diff(ensemble[k].angular_momentum(times), axis=0)).max()
        assert (moved > 1e-4) == (orbit is not None)


@pytest.mark.filterwarnings("ignore::andoyer.ToleranceWarning")
def test_orbits_are_part_of_slices_equality_text_and_pickles():
    ensemble = Ensemble(*FAST, orbits=[SUN, None, MOON], span=(0, 1e5))
    assert ensemble.orbits == [SUN, None, MOON] and ensemble.span == (0.0, 1e5)
    assert ensemble[::-1].orbits == [MOON, None, SUN] and ensemble[1:2].orbits is None and ensemble[:1].orbits == SUN
    assert len(ensemble[:0]) == 0 and ensemble[:] == ensemble == pickle.loads(pickle.dumps(ensemble))
    assert np.array_equal(ensemble[1:].attitude(1e3), ensemble.attitude(1e3)[1:])
    assert Ensemble(*FAST, orbits=SUN) == Ensemble(*FAST, orbits=[SUN] * 3) == pickle.loads(pickle.dumps(Ensemble(*FAST, orbits=SUN)))
    assert Ensemble(*FAST) == Ensemble(*FAST, orbits=[None] * 3) != Ensemble(*FAST, orbits=SUN)
    assert Ensemble(*FAST) != Ensemble(*FAST, span=(0, 1))
    assert repr(ensemble) == "<Ensemble of 3 bodies, 2 under an orbit, tolerance=1e-12, span=(0.0, 100000.0)>"


def test_a_member_that_its_orbit_does_not_let_be_averaged_is_named():
    ensemble = Ensemble(*FAST, orbits=[None, SUN, andoyer.Orbit(0.9)])
    with pytest.raises(andoyer.TheoryError, match="^member 2: ") as caught:
        ensemble.at(0.0)
    assert caught.value.index == 2


def test_refused_member_names_itself_or_is_nan_with_its_reason(body):
    moments = [[1, 1.5, 2], [1, 1, 2.5], [1, 1.5, 2], [1, 1.5, 2]]
    rates = [[0.1, 0.2, 1.0], [0, 0, 1], [0.1, 0.2, 1.0], [0, np.nan, 0]]
    with pytest.raises(andoyer.InputError, match=r"^member 1: moments = .* \(and 1 more bad members\)$") as caught:
        andoyer.Ensemble(moments, [0, 0, 0, 1], rates)
    assert caught.value.index == 1
    ensemble = andoyer.Ensemble(moments, [0, 0, 0, 1], rates, errors="nan")
    samples = ensemble.at([0.0, 5.0])
    expected = andoyer.Scene(body, [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
    for good in (0, 2):
        assert np.array_equal(samples.attitude[good], expected.attitude([0.0, 5.0]))
    for bad in (1, 3):
        assert np.isnan(samples.attitude[bad]).all() and np.isnan(samples.angular_velocity[bad]).all()
    for errors in (samples.errors, ensemble.errors):
        assert list(errors) == [1, 3] and isinstance(errors[1], andoyer.InputError) and isinstance(errors[3], andoyer.InputError)
        assert str(errors[3]).startswith("member 3: angular_velocity[1] = NaN") and errors[3].index == 3
    assert [plan is None for plan in ensemble.plans] == [False, True, False, True]
    assert np.isnan(ensemble.attitude(1.0)[[1, 3]]).all() and pickle.loads(pickle.dumps(ensemble)).errors.keys() == {1, 3}
    assert list(pickle.loads(pickle.dumps(samples)).errors) == [1, 3]
    with pytest.raises(andoyer.InputError, match="^member 1: "):
        ensemble[1]


def test_member_without_a_motion_names_itself_or_is_nan_with_its_reason():
    options = {"orbits": andoyer.Orbit(2e-3), "tolerance": 1.0}
    # The second turns about the middle axis, and without a span it is not integrated.
    rates = [[0, 0.01, 1], [0, 1, 0.001], [0, 0.02, 1]]
    with pytest.raises(andoyer.TheoryError, match="^member 1: ") as caught:
        andoyer.Ensemble([1, 1.02, 1.05], [0, 0, 0, 1], rates, **options).at([0.0])
    assert caught.value.index == 1
    ensemble = andoyer.Ensemble([1, 1.02, 1.05], [0, 0, 0, 1], rates, errors="nan", **options)
    assert np.isnan(ensemble.attitude([0.0]))[:, 0, 0].tolist() == [False, True, False]
    assert {index: type(error) for index, error in ensemble.at([0.0]).errors.items()} == {1: andoyer.TheoryError}
    spanned = andoyer.Ensemble([1, 1.02, 1.05], [0, 0, 0, 1], rates, span=(0, 1e3), **options)
    assert [plan.method for plan in spanned.plans] == ["closed", "integrated", "closed"]


def test_ensemble_without_refusals_has_no_errors_and_another_word_is_refused():
    ensemble = andoyer.Ensemble([1, 1.5, 2], [[0, 0, 0, 1]] * 2, [0.1, 0.2, 1.0], errors="nan")
    assert ensemble.errors == {} and ensemble.at(0.0).errors == {}
    with pytest.raises(andoyer.InputError, match='errors = "ignore": it must be "raise" or "nan"'):
        andoyer.Ensemble([1, 1.5, 2], [[0, 0, 0, 1]] * 2, [0.1, 0.2, 1.0], errors="ignore")


@pytest.mark.filterwarnings("ignore::andoyer.ToleranceWarning")
def test_members_with_an_unknown_attitude_at_the_end_are_served_up_to_there():
    orbit = andoyer.Orbit(1.0, 0.1)
    rates = [[0.01, 0.02, 1.0], [0.05, -0.03, 1.1], [0.0, 0.0, 1.0]]
    options = {"orbits": orbit, "method": "integrated", "tolerance": 1e-8, "span": (0, 2000)}
    with pytest.raises(andoyer.TheoryError, match=r"^member 0: span = \[0, 2000\]: nearby .* the error bound is below half a turn from 0 to "):
        andoyer.Ensemble([0.5, 0.8, 1.0], [0, 0, 0, 1], rates, **options).at([10.0])
    ensemble = andoyer.Ensemble([0.5, 0.8, 1.0], [0, 0, 0, 1], rates, errors="nan", **options)
    first, last = ensemble.plans[0].known
    assert first == 0 and 50 < last < 1000
    with pytest.warns(andoyer.ToleranceWarning, match="unknown at the ends? of (its|their) spans?, and (its|their) rows there are NaN"):
        samples = ensemble.at([0.0, 50.0, last, last + 1e-6])
    assert np.isnan(samples.attitude[0, :, 0]).tolist() == [False, False, False, True] and 0 in samples.errors
    assert "nearby states separate so fast" in str(samples.errors[0])
    again = pickle.loads(pickle.dumps(ensemble[0]))
    assert again.plan.known == (first, last) and np.array_equal(again.attitude(last), ensemble[0].attitude(last))
    assert ensemble[0].verify(samples=3).times[-1] == last
    later = ensemble.after(2000.0)
    assert "2 without a motion" in repr(later) or "3 without a motion" in repr(later)
    assert later.mode[0] == "" and np.isnan(later.energy_ratio[0]) and ensemble.after(50.0).mode[0] != ""
