"""What cannot fit is refused beforehand, with the figure, and leaves the interpreter as it was."""

import time

import numpy as np
import pytest

import andoyer


def refused(call, error, text):
    start = time.monotonic()
    with pytest.raises(error, match=text):
        call()
    assert time.monotonic() - start < 5


@pytest.mark.parametrize("method", ["at", "attitude"])
def test_an_ensemble_whose_result_cannot_fit_is_refused_with_its_size(method):
    members = 200_000
    ensemble = andoyer.Ensemble(np.tile([1.0, 1.5, 2.0], (members, 1)), [0, 0, 0, 1], [0.1, 0.2, 1.0])
    times = np.zeros(10_000_000)  # 64 TB of quaternions
    refused(lambda: getattr(ensemble, method)(times), MemoryError, r"Unable to allocate .* TiB")
    assert ensemble.attitude([0.0]).shape == (members, 1, 4)


def test_times_that_cannot_fit_are_refused_with_their_size(motion):
    refused(lambda: motion.at(np.broadcast_to(0.0, 10**14)), MemoryError, r"Unable to allocate .* TiB")


@pytest.mark.parametrize("order", [16_382, 10**9, 2**70])
def test_an_order_beyond_every_form_is_refused_with_its_bound(order):
    refused(lambda: andoyer.NormalForm(order), andoyer.RepresentationError, "16381")


@pytest.mark.parametrize("order", [2_000, 16_381])
def test_an_order_beyond_the_memory_is_refused_with_its_size(order):
    refused(lambda: andoyer.NormalForm(order), andoyer.RepresentationError, rf"order {order} would take some \d+ GiB of memory: the bound is 8 GiB")


def test_an_order_beyond_the_series_of_a_scene_is_refused_with_its_bound(body):
    refused(lambda: andoyer.Scene(body, [0, 0, 0, 1], [0.1, 0.2, 1.0], method="series", order=61).solve(), andoyer.RepresentationError, "60")
