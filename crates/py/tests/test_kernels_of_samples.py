"""Kernels of samples and of messages: their gaps, and the estimate of the error between the samples."""

from datetime import datetime

import numpy as np
import pytest
from test_kernels_together import TUMBLER, UNIT, read, spice, worst

import andoyer
from andoyer._quaternions import angle_between
from andoyer.cli import main
from andoyer.output import Kernel, read_aem, write_aem, write_ck


def test_samples_become_a_kernel_with_their_gaps(tmp_path, furnished):
    times = np.concatenate([np.arange(0.0, 50.0, 0.01), np.arange(60.0, 80.0, 0.01)])
    result = write_ck(tmp_path / "a.bc", TUMBLER.at(times), kernel=Kernel(body_frame="SAMPLED"), longest_step=1.0)
    furnished(tmp_path / "a.bc")
    assert result.records == len(times)
    for interval in ((0.0, 49.98), (60.0, 79.98)):
        error = worst("SAMPLED", TUMBLER, interval, count=500)
        # The truth is known here: the estimate is of its size.
        assert result.error / 3 < error < 1.2 * result.error
    with pytest.raises(spice.exceptions.SpiceyError):
        spice.pxform("J2000", "SAMPLED", 55.0)
    first = write_ck(tmp_path / "b.bc", TUMBLER.at(times, scalar_first=True), (0.0, 10.0), Kernel(body_frame="PART"))
    furnished(tmp_path / "b.bc")
    assert first.records == 1001 and worst("PART", TUMBLER, (0.0, 10.0)) < 1.2 * first.error


@pytest.mark.parametrize("kind", ["QUATERNION", "QUATERNION/ANGVEL"])
def test_message_becomes_a_kernel(kind, tmp_path, furnished, capfd):
    times = np.arange(0.0, 20.0, 0.05)
    message = tmp_path / "a.aem"
    write_aem(message, TUMBLER.at(times), andoyer.output.Heading(frame="ICRF", attitude_type=kind, date=datetime(2010, 2, 3)))
    zero = (datetime(2010, 2, 3) - datetime(2000, 1, 1, 12)).total_seconds()
    assert main(["convert", str(message), "-o", str(tmp_path / "a.bc"), "--body-frame", "FROM_AEM", "--instrument", "2000433", "--center", "20000433"]) == 0
    said = capfd.readouterr().out
    assert "400 records of frame FROM_AEM (2000433) against ICRF; estimated error" in said
    furnished(tmp_path / "a.bc")
    error = float(said.split("estimated error")[1].split()[0])
    assert worst("FROM_AEM", TUMBLER, (0.0, 19.9), zero) < 1.3 * error < 1e-3
    again = write_ck(tmp_path / "b.bc", read_aem(message), kernel=Kernel(body_frame="AGAIN"))
    assert again.error == pytest.approx(error, rel=0.1)
    assert main(["convert", str(message), "-o", str(tmp_path / "a.bc")]) == 2
    assert "File exists; --force replaces it" in capfd.readouterr().err


BAD_SAMPLES = {
    "an ensemble": (lambda: andoyer.Ensemble([[1, 1.5, 2]] * 2, UNIT, [0.1, 0.2, 1.0]).at([0.0, 1.0]), "be of one motion"),
    "one time": (lambda: TUMBLER.at([0.0]), "two or more times"),
    "decreasing": (lambda: TUMBLER.at([0.0, 2.0, 1.0]), r"finite times that increase: got times\[2\] = 1.0"),
}


@pytest.mark.parametrize("samples, message", BAD_SAMPLES.values(), ids=BAD_SAMPLES)
def test_samples_that_make_no_kernel_are_refused(samples, message, tmp_path):
    with pytest.raises(andoyer.InputError, match=f"samples must .*{message}"):
        write_ck(tmp_path / "a.bc", samples())
    with pytest.raises(andoyer.InputError, match="longest_step must be positive"):
        write_ck(tmp_path / "a.bc", TUMBLER.at([0.0, 1.0]), longest_step=0.0)
    assert list(tmp_path.iterdir()) == []


def test_samples_half_a_turn_apart_are_refused(tmp_path):
    """With 4 rad/s at 1 Hz SPICE turns the other way; the error was stated as 3e-14, and was 3.12 rad."""
    spinner = andoyer.Scene(andoyer.Body([1, 1.5, 2]), [0, 0, 0, 1], [0, 0, 4.0]).solve()
    for rates in ([0, 0, 4.0], [0, 0, 2 * np.pi]):
        spinner = andoyer.Scene(andoyer.Body([1, 1.5, 2]), [0, 0, 0, 1], rates).solve()
        with pytest.raises(andoyer.InputError, match=r"samples must be so near in time .*: got \d\.\d+ rad between times\[0\] and times\[1\]"):
            write_ck(tmp_path / "a.bc", spinner.at(np.arange(60.0)))
    assert list(tmp_path.iterdir()) == []


def test_two_samples_without_rates_have_no_estimate(tmp_path):
    message = tmp_path / "a.aem"
    write_aem(message, TUMBLER.at([0.0, 3.0]), andoyer.output.Heading(attitude_type="QUATERNION"))
    assert write_ck(tmp_path / "a.bc", read_aem(message)).error == np.inf
    write_aem(message, TUMBLER.at([0.0, 0.3, 0.6, 10.0, 10.3, 10.6]), andoyer.output.Heading(attitude_type="QUATERNION"))
    assert write_ck(tmp_path / "a.bc", read_aem(message), longest_step=0.3).error < 0.1


def test_longest_step_as_long_as_the_step_leaves_no_gap(tmp_path, furnished):
    kernel = Kernel(body_frame="STEPS", date=datetime(2026, 1, 1))
    write_ck(tmp_path / "a.bc", TUMBLER.at(np.arange(1000) * 0.1), kernel=kernel, longest_step=0.1)
    furnished(tmp_path / "a.bc")
    assert len(spice.ckcov(str(tmp_path / "a.bc"), kernel.instrument, True, "INTERVAL", 0.0, "TDB")) == 2


def test_sample_alone_is_in_the_kernel(tmp_path, furnished):
    date = datetime(1960, 1, 1)
    zero = (date - datetime(2000, 1, 1, 12)).total_seconds()
    samples = TUMBLER.at([0.0, 1.0, 2.0, 10.1, 20.0, 21.0])
    write_ck(tmp_path / "a.bc", samples, kernel=Kernel(body_frame="ALONE", date=date), longest_step=2.0)
    furnished(tmp_path / "a.bc")
    assert angle_between(read("ALONE", [zero + 10.1]), samples.attitude[3:4])[0] < 2e-5
