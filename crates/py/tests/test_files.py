"""A file is written whole or not at all, whatever happens: full disk, folder without leave, file that is there, Ctrl-C."""

import errno
import os
import resource
import sys
from pathlib import Path

import numpy as np
import pytest

from andoyer import output
from andoyer.cli import main
from andoyer.output.files import whole_file

FORMATS = ["csv", "npz", "parquet", "aem", "bc", "png", "svg", "bpc", "html", "c", "js"]
NEEDS = {"parquet": "pyarrow", "png": "matplotlib", "svg": "matplotlib"}
OLD = b"what was there"

# The processes of `child` do not use JAX, which warns of every fork once another test has imported it.
pytestmark = pytest.mark.filterwarnings("ignore:os.fork:RuntimeWarning")
unix = pytest.mark.skipif(sys.platform == "win32", reason="limits and users of Unix")


@pytest.fixture
def scene_file(scene, tmp_path_factory):
    path = tmp_path_factory.mktemp("scene") / "wobble.toml"
    path.write_text(scene.to_toml(), encoding="utf-8")
    return path


def line(scene_file, path):
    """The command that writes a file of some hundred kilobytes; code has five."""
    if path.suffix in (".png", ".svg"):
        return ["plot", str(scene_file), "-o", str(path)]
    if path.suffix == ".html":
        return ["plot", str(scene_file), "-o", str(path)]
    if path.suffix in (".c", ".js"):
        return ["code", str(scene_file), "-o", str(path)]
    if path.suffix == ".bpc":
        return ["propagate", str(scene_file), "-o", str(path), "--start", "0", "--stop", "2000", "--interpolation-error", "1e-9"]
    if path.suffix == ".bc":
        return ["propagate", str(scene_file), "-o", str(path), "--start", "0", "--stop", "20", "--interpolation-error", "1e-7"]
    return ["propagate", str(scene_file), "-o", str(path), "--start", "0", "--stop", "20", "--samples", "3000"]


def error_line(capfd):
    said, errors = capfd.readouterr()
    errors = [line for line in errors.splitlines() if "note:" not in line]
    assert said == "" and len(errors) == 1 and errors[0].startswith("andoyer: error: ")
    return errors[0]


def child(action):
    """Run in a process of its own, which shares everything up to now; its exit status."""
    pid = os.fork()
    if pid == 0:
        status = 99
        try:
            status = action()
        finally:
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(status)
    return os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])


@pytest.mark.parametrize("ending", FORMATS)
def test_file_that_is_there_is_kept_unless_it_is_forced(scene_file, tmp_path, capfd, ending):
    pytest.importorskip(NEEDS.get(ending, "numpy"))
    path = tmp_path / f"out.{ending}"
    path.write_bytes(OLD)
    assert main(line(scene_file, path)) == 2
    assert error_line(capfd) == f"andoyer: error: argument -o/--output: {path}: File exists; --force replaces it"
    assert path.read_bytes() == OLD and list(tmp_path.iterdir()) == [path]
    assert main([*line(scene_file, path), "--force"]) == 0
    assert path.read_bytes() != OLD and not list(tmp_path.glob(".*"))


@unix
@pytest.mark.parametrize("old", [True, False])
@pytest.mark.parametrize("ending", FORMATS)
def test_disk_that_is_full_is_one_line_and_leaves_what_was_there(scene_file, tmp_path, capfd, ending, old):
    pytest.importorskip(NEEDS.get(ending, "numpy"))
    path = tmp_path / f"out.{ending}"
    if old:
        path.write_bytes(OLD)

    def limited():
        # A file may grow to 20 kB here and no further: the system fails the next write as it does on a full disk.
        most = 1000 if ending in ("c", "js") else 20_000
        resource.setrlimit(resource.RLIMIT_FSIZE, (most, most))
        return main([*line(scene_file, path), "--force"])

    if ending == "png":
        import andoyer.plot  # noqa: F401  (caches of fonts are written on import)
    assert child(limited) == 2
    assert str(path) in error_line(capfd)
    assert list(tmp_path.iterdir()) == ([path] if old else []) and (not old or path.read_bytes() == OLD)


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
@pytest.mark.parametrize("ending", ["csv", "npz", "aem", "svg", "html", "c"])
def test_device_that_is_full_is_one_line_in_the_words_of_the_system(scene_file, tmp_path, capfd, ending):
    pytest.importorskip(NEEDS.get(ending, "numpy"))
    path = tmp_path / f"out.{ending}"
    path.symlink_to("/dev/full")
    assert main([*line(scene_file, path), "--force"]) == 2
    assert error_line(capfd) == f"andoyer: error: argument -o/--output: {path}: No space left on device"
    assert list(tmp_path.iterdir()) == [path] and path.is_symlink()


@unix
@pytest.mark.parametrize("ending", FORMATS)
def test_folder_that_may_not_be_written_is_one_line(scene_file, tmp_path, capfd, ending):
    pytest.importorskip(NEEDS.get(ending, "numpy"))
    if ending in ("png", "svg"):
        import andoyer.plot  # noqa: F401
    folder = tmp_path / "locked"
    folder.mkdir(mode=0o555)
    for parent in folder.parents:
        if parent.name.startswith("pytest-"):  # pytest's own folders are for one user
            parent.chmod(0o755)
    tmp_path.chmod(0o755)
    path = folder / f"out.{ending}"
    text = scene_file.read_text()
    copy = tmp_path / "wobble.toml"
    copy.write_text(text)

    def unprivileged():
        if os.getuid() == 0:
            os.setgid(65534)
            os.setuid(65534)
        return main(line(copy, path))

    assert child(unprivileged) == 2
    assert error_line(capfd) == f"andoyer: error: argument -o/--output: {path}: Permission denied"
    assert list(folder.iterdir()) == []


@pytest.mark.parametrize("ending", ["csv", "aem", "bc"])
def test_ctrl_c_leaves_what_was_there_and_nothing_else(motion, tmp_path, ending):
    pytest.importorskip(NEEDS.get(ending, "numpy"))
    path = tmp_path / f"out.{ending}"
    path.write_bytes(OLD)

    def stop(*_):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        if ending == "csv":
            output.write_csv(path, motion.at(np.arange(25_000.0)), stop)
        elif ending == "bc":
            output.write_ck(path, motion, (0.0, 20.0), progress=stop, interpolation_error=1e-6)
        else:
            with whole_file(path) as temporary:
                temporary.write_bytes(b"half a")
                stop()
    assert list(tmp_path.iterdir()) == [path] and path.read_bytes() == OLD


def test_file_that_comes_to_be_meanwhile_is_kept(tmp_path):
    path = tmp_path / "out.csv"
    with pytest.raises(FileExistsError) as caught, whole_file(path, force=False) as temporary:
        temporary.write_bytes(b"new")
        path.write_bytes(OLD)
    assert caught.value.errno == errno.EEXIST and path.read_bytes() == OLD and list(tmp_path.iterdir()) == [path]


def test_file_system_without_links_renames(tmp_path, monkeypatch):
    def none(*_):
        raise OSError(errno.EPERM, "no links")

    monkeypatch.setattr(os, "link", none)
    path = tmp_path / "out.csv"
    with whole_file(path, force=False) as temporary:
        temporary.write_bytes(b"new")
    assert path.read_bytes() == b"new"
    with pytest.raises(FileExistsError), whole_file(path, force=False):
        pass


@unix
def test_mode_and_links_are_those_of_a_file_that_is_opened(tmp_path):
    target, link = tmp_path / "target.csv", tmp_path / "link.csv"
    target.write_bytes(OLD)
    link.symlink_to(target)
    with whole_file(link) as temporary:
        temporary.write_bytes(b"new")
    assert link.is_symlink() and target.read_bytes() == b"new"
    plain = tmp_path / "plain"
    plain.write_bytes(b"")
    assert target.stat().st_mode == plain.stat().st_mode


@unix
def test_device_is_written_directly():
    with whole_file("/dev/null", force=False) as path, path.open("w") as file:
        file.write("nothing")
    assert path == Path("/dev/null").resolve()


def test_folder_is_no_file(tmp_path):
    with pytest.raises(IsADirectoryError), whole_file(tmp_path):
        pass


def test_library_replaces_unless_it_is_told_not_to(motion, tmp_path):
    samples = motion.at([0.0, 1.0])
    writers = [output.write_csv, output.write_npz, output.write_aem]
    for number, write in enumerate(writers):
        path = tmp_path / f"{number}.out"
        write(path, samples)
        write(path, samples)
        with pytest.raises(FileExistsError):
            write(path, samples, force=False)
