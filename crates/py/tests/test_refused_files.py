"""Files and arguments that are refused with an `andoyer.Error`, streams that are closed, kernels from several threads, messages with large numbers."""

import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import andoyer
from andoyer import Body, Ensemble, Orbit, Scene, fit, output
from andoyer.output import Heading, Kernel

HANG = 120
"""Limit [s] for what once did not end."""
LARGEST_FILE = 16 * 2**20


@pytest.fixture
def wobble():
    return Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()


def refused(kind, argument, call, *arguments, **options):
    with pytest.raises(kind) as caught:
        call(*arguments, **options)
    assert isinstance(caught.value, andoyer.Error) and caught.value.argument == argument
    return str(caught.value)


def test_readers_raise_file_errors(tmp_path, wobble):
    (tmp_path / "text.aem").write_text("hello")
    (tmp_path / "text.csv").write_text("t,qx\n1,two\n")
    for name, reader in {"text.aem": output.read_aem, "text.csv": output.read_table, "text.txt": output.read_table}.items():
        assert str(tmp_path / name) in refused(andoyer.FileError, "path", reader, tmp_path / name)
    np.savez(tmp_path / "scale.npz", times=[0.0], attitude=[[0, 0, 0, 1.0]], angular_velocity=np.zeros((1, 3)), time_scale="utc")
    assert "jd1" in refused(andoyer.FileError, "path", output.read_table, tmp_path / "scale.npz")
    output.write_aem(tmp_path / "one.aem", wobble.at([0.0, 1.0]))
    assert refused(andoyer.InputError, "segment", output.read_aem, tmp_path / "one.aem", 3).startswith("segment must be from 0 to 0: got 3")


def test_writers_raise_input_errors(tmp_path, wobble):
    pytest.importorskip("spiceypy")
    samples = wobble.at([0.0, 1.0])
    aem, kernel = tmp_path / "x.aem", tmp_path / "x.bc"
    many = Ensemble([[1, 1.5, 2]] * 2, [0, 0, 0, 1], [0.1, 0.2, 1.0]).at([0.0, 1.0])
    for argument, call, *arguments in [
        ("samples", output.write_csv, tmp_path / "x.csv", many),
        ("samples", output.write_aem, aem, many),
        ("samples", output.write_aem, aem, wobble.at([])),
        ("samples", output.write_aem, aem, wobble.at([1.0, 0.0])),
        ("samples", output.write_aem, aem, wobble.at([0.0, 1e15])),
        ("version", output.write_aem, aem, samples, Heading(version=3)),
        ("attitude_type", output.write_aem, aem, samples, Heading(attitude_type="SPIN")),
        ("time_system", output.write_aem, aem, samples, Heading(time_system="GMT")),
        ("interval", output.write_ck, kernel, wobble, (1.0, 1.0)),
        ("interval", output.write_ck, kernel, wobble, 1.0),
        ("frame", output.write_ck, kernel, wobble, (0.0, 1.0), Kernel(frame="NOWHERE")),
        ("time_system", output.write_ck, kernel, wobble, (0.0, 1.0), Kernel(time_system="GMT")),
        ("path", output.write_ck, tmp_path / ("x" * 250), wobble, (0.0, 1.0)),
    ]:
        refused(andoyer.InputError, argument, call, *arguments)
    refused(andoyer.InputError, "interpolation_error", output.write_ck, kernel, wobble, (0.0, 1.0), interpolation_error=1e-14)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("count", [-1, 1.5, True])
def test_number_of_drawn_states_is_whole(wobble, count):
    pytest.importorskip("scipy")
    times = np.linspace(0, 50, 30)
    found = fit.attitudes(wobble.scene, times, wobble.attitude(times), sigma=0.01)
    assert refused(andoyer.InputError, "n", found.ensemble, count) == f"n = {count!r}: it must be a whole number, 0 or more"
    assert refused(andoyer.InputError, "n", found.ensemble, 10**18) == f"n = {10**18}: it must be at most 10000000"


@pytest.mark.parametrize("brightness, axes, argument", [(1e170, 1.0, "brightness"), (1e-170, 1.0, "brightness"), (1.0, 1e-200, "axes")])
def test_light_curve_in_absurd_units_is_refused(brightness, axes, argument):
    pytest.importorskip("scipy")
    times, values = np.linspace(0, 3, 30), np.linspace(1, 2, 30)
    options = {"sun": [1, 0, 0], "observer": [1, 0, 0], "sigma": 0.01 * brightness, "periods": (1, 2), "starts": 8}
    said = refused(andoyer.InputError, argument, fit.light_curve, np.array([1.0, 0.7, 0.5]) * axes, times, values * brightness, **options)
    assert "it must be from 1e-40 to 1e+40; choose another unit" in said


def test_light_curve_in_extreme_units_has_the_same_state():
    pytest.importorskip("scipy")
    axes, times = np.array([1.0, 0.7, 0.5]), np.linspace(0, 3, 60)
    scene = Scene(Body.ellipsoid(*axes), [0, 0, 0, 1], [0.3, 0.1, 6.0])
    seen = {"sun": [1, 0.5, 0], "observer": [1, 0, 0]}
    measured = fit.brightness(axes, scene.solve().attitude(times), **seen)
    guess = Scene(scene.body, [0.01, 0, 0, 0.99995], [0.3, 0.1, 6.02])
    for of_axes, of_brightness in [(2.0**-125, 1.0), (2.0**125, 2.0**125), (1.0, 2.0**-125), (2.0**-125, 2.0**125)]:
        found = fit.light_curve(of_axes * axes, times, of_brightness * measured, sigma=0.01 * of_brightness, scene=guess, **seen)
        assert np.abs(found.scene.angular_velocity - [0.3, 0.1, 6.0]).max() < 1e-6


def test_table_of_a_spreadsheet_with_a_byte_order_mark_is_read(tmp_path, wobble):
    samples = wobble.at([0.0, 1.0])
    output.write_csv(tmp_path / "plain.csv", samples)
    (tmp_path / "marked.csv").write_bytes(b"\xef\xbb\xbf" + (tmp_path / "plain.csv").read_bytes())
    assert np.array_equal(output.read_table(tmp_path / "marked.csv").samples.attitude, samples.attitude)


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_column_that_is_there_twice_is_refused(tmp_path, wobble, ending):
    path = tmp_path / f"twice.{ending}"
    table = np.column_stack([[0.0, 1.0], wobble.attitude([0.0, 1.0]), wobble.angular_velocity([0.0, 1.0]), [9.0, 9.0]])
    names = [*output.COLUMNS.split(","), "t"]
    if ending == "csv":
        np.savetxt(path, table, delimiter=",", header=",".join(names), comments="")
    else:
        arrow = pytest.importorskip("pyarrow")
        pytest.importorskip("pyarrow.parquet").write_table(arrow.table(list(table.T), names=names), path)
    assert "must have the column t once: got 2 columns" in refused(andoyer.FileError, "path", output.read_table, path)


def andoyer_with(redirection, *arguments):
    # The limit of 8 GB is for /dev/zero, which once filled the memory.
    command = f'ulimit -v 8000000; exec "$0" -m andoyer "$@" {redirection}'
    return subprocess.run(["sh", "-c", command, sys.executable, *arguments], capture_output=True, text=True, timeout=HANG)


@pytest.mark.skipif(os.name != "posix", reason="no shell")
def test_closed_stdout_is_one_line_with_status_2(tmp_path, wobble):
    scene = tmp_path / "wobble.toml"
    scene.write_text(wobble.scene.to_toml())
    for arguments in (["bodies"], ["plan", str(scene)], ["--help"], ["--version"], ["propagate", str(scene), "-o", "-"], ["code", str(scene)]):
        done = andoyer_with(">&-", *arguments)
        assert (done.returncode, done.stderr) == (2, "andoyer: error: [Errno 9] Bad file descriptor\n"), arguments
    done = andoyer_with(">&-", "propagate", str(scene), "-o", str(tmp_path / "out.csv"), "--samples", "3")
    assert done.returncode == 0 and "Error" not in done.stderr
    assert (tmp_path / "out.csv").read_text().count("\n") == 4
    assert andoyer_with("2>&-", "bodies").stdout.startswith("name ")
    done = andoyer_with("2>&-", "nothing")
    assert (done.returncode, done.stdout, done.stderr) == (2, "", "")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
def test_full_stdout_is_one_line_with_status_2():
    done = andoyer_with(">/dev/full", "bodies")
    assert (done.returncode, done.stderr) == (2, "andoyer: error: [Errno 28] No space left on device\n")


def test_scene_file_has_at_most_16_mebibytes(tmp_path, wobble):
    path = tmp_path / "long.toml"
    text = wobble.scene.to_toml()
    path.write_text(text + "#" * (LARGEST_FILE - len(text)))
    assert Scene.from_toml(path) == wobble.scene
    path.write_text(text + "#" * (LARGEST_FILE + 1 - len(text)))
    with pytest.raises(andoyer.FileError, match=rf"long\.toml: file: a scene file must have at most {LARGEST_FILE} bytes, and this one has more"):
        Scene.from_toml(path)
    path.write_bytes(b"\xff\xfe")
    with pytest.raises(andoyer.FileError, match="utf-8"):
        Scene.from_toml(path)


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="no device without an end")
def test_scene_file_without_an_end_is_refused():
    done = andoyer_with("", "plan", "/dev/zero")
    assert done.returncode == 2 and "andoyer: error: /dev/zero: file: a scene file must have at most" in done.stderr


def test_text_kernel_is_beside_the_given_name(tmp_path, wobble):
    pytest.importorskip("spiceypy")
    (tmp_path / "elsewhere").mkdir()
    target, link = tmp_path / "elsewhere" / "real.bc", tmp_path / "link.bc"
    target.touch()
    link.symlink_to(target)
    output.write_ck(link, wobble, (0.0, 10.0), interpolation_error=1e-4)
    assert link.is_symlink() and target.stat().st_size > 0
    assert (tmp_path / "link.tsc").exists() and list(target.parent.iterdir()) == [target]


def test_kernels_are_written_from_several_threads(tmp_path, wobble):
    spice = pytest.importorskip("spiceypy")
    paths = [tmp_path / f"{number}.bc" for number in range(24)]
    with ThreadPoolExecutor(8) as pool:
        written = list(pool.map(lambda path: output.write_ck(path, wobble, (0.0, 300.0), interpolation_error=1e-6), paths, timeout=HANG))
    assert len(set(written)) == 1 and not spice.failed()
    assert len({path.stat().st_size for path in paths}) == 1


def test_progress_may_write_another_kernel(tmp_path, wobble):
    pytest.importorskip("spiceypy")
    inner = []

    def progress(done, total):
        if not inner:
            inner.append(output.write_ck(tmp_path / "inner.bc", wobble, (0.0, 10.0), interpolation_error=1e-4))

    output.write_ck(tmp_path / "outer.bc", wobble, (0.0, 10.0), interpolation_error=1e-4, progress=progress)
    assert (tmp_path / "inner.bc").stat().st_size == (tmp_path / "outer.bc").stat().st_size


def test_numbers_of_a_refused_integration_are_short():
    scene = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1], orbit=Orbit(1e-3, 0.1), span=(0, 1e30), method="integrated")
    with pytest.raises(andoyer.TheoryError, match=r"needs about 1\.0e30 steps, which take 7\.4e22 GB; .* shorter by a factor of 1\.3e23$"):
        scene.solve()


def test_part_without_a_span_is_at_0_from_the_epoch():
    motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1], orbit=Orbit(1e-2, 0.1), span=(0, 20), method="integrated").solve()
    with pytest.raises(andoyer.Error, match="a time must be finite and within 0 of the epoch: the motion is integrated over its span") as caught:
        motion.at(-1.0)
    assert str(caught.value.bound) == "0.0"


def test_tolerance_holds_up_to_the_pericentre():
    # The errors of all steps displace the state at the epoch, and most steps are at the pericentre: "holds from 0 to 0".
    orbit = Orbit(0.3, 0.99, time_of_pericentre=10.0)
    scene = Scene(Body([0.5, 0.8, 1]), [0, 0, 0, 1], [0.1, 0.2, 1], orbit=orbit, span=(0, 150), tolerance=1e-12, method="integrated")
    with pytest.raises(andoyer.TheoryError, match="holds from 0 to 9.99") as caught:
        scene.solve()
    start, stop = caught.value.bound
    # Steps are shorter towards the pericentre: the double number of them does not end much nearer to it.
    assert start == 0.0 and 9.9 < stop < 10.0
    held = Scene(scene.body, [0, 0, 0, 1], [0.1, 0.2, 1], orbit=orbit, span=(0, stop), tolerance=1e-12, method="integrated")
    assert held.solve().plan.meets_tolerance
