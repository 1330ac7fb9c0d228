"""Many processes: the chunk plan of examples/cluster.py, the same bits as one process, and a worker that is killed at its work."""

import hashlib
import itertools
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

distributed = pytest.importorskip("distributed")
parquet = pytest.importorskip("pyarrow.parquet")

from conftest import REPOSITORY  # noqa: E402

sys.path.insert(0, str(REPOSITORY / "examples"))
import cluster  # noqa: E402

BODIES, CHUNK, EPOCHS = 2000, 150, [0.0, 3.0, 1e6]


@pytest.fixture(scope="module")
def catalogue(tmp_path_factory):
    path = tmp_path_factory.mktemp("catalogue") / "bodies.parquet"
    cluster.make_catalogue(path, BODIES)
    return path


@pytest.fixture(scope="module")
def alone(catalogue):
    """The digests of the parts that one process writes."""
    chunks = cluster.plan(catalogue, catalogue.parent / "alone", EPOCHS, CHUNK)
    return digests(cluster.run(chunks))


@pytest.fixture
def client(tmp_path, monkeypatch):
    # Workers import the example by its name.
    monkeypatch.setenv("PYTHONPATH", str(REPOSITORY / "examples"))
    options = {"n_workers": 2, "threads_per_worker": 1, "dashboard_address": None, "local_directory": str(tmp_path)}
    with distributed.LocalCluster(**options) as processes, distributed.Client(processes) as client:
        yield client


def digests(parts):
    return {Path(part).name: hashlib.sha256(Path(part).read_bytes()).hexdigest() for part in parts}


def test_plan_of_a_million_bodies_covers_each_once(tmp_path):
    path = tmp_path / "million.parquet"
    cluster.make_catalogue(path, 1_000_000)
    chunks = cluster.plan(path, tmp_path / "result", [0.0])
    assert len(chunks) == 100 and chunks[0].start == 0 and chunks[-1].stop == 1_000_000
    assert all(one.stop == other.start for one, other in itertools.pairwise(chunks))
    assert len({chunk.part for chunk in chunks}) == 100
    assert cluster.lines(chunks[37]).shape == (10_000, 10)


def test_one_process_writes_every_body_and_epoch_once(alone, catalogue):
    table = parquet.read_table(catalogue.parent / "alone")
    assert len(alone) == -(-BODIES // CHUNK)
    assert np.array_equal(table["body"].to_numpy(), np.repeat(np.arange(BODIES), len(EPOCHS)))
    whole = np.column_stack([parquet.read_table(catalogue)[name].to_numpy() for name in [*cluster.MOMENTS, *cluster.ATTITUDE, *cluster.RATES]])
    ensemble = cluster.andoyer.Ensemble(whole[:, :3], whole[:, 3:7], whole[:, 7:], tolerance=cluster.TOLERANCE)
    found = np.column_stack([table[name].to_numpy() for name in cluster.ATTITUDE])
    assert np.array_equal(found, ensemble.attitude(EPOCHS).reshape(-1, 4))


def test_two_processes_write_the_bytes_of_one(client, catalogue, alone, tmp_path):
    assert digests(cluster.run(cluster.plan(catalogue, tmp_path / "two", EPOCHS, CHUNK), client)) == alone


def slow(chunk):
    """A chunk by a worker that takes its time, and says who it is."""
    (Path(chunk.part).parent / f"{os.getpid()}.working").touch()
    time.sleep(0.3)
    return cluster.propagate(chunk)


def test_chunk_of_a_killed_worker_is_done_again_and_nothing_lost_or_doubled(client, catalogue, alone, tmp_path):
    folder = tmp_path / "killed"
    folder.mkdir()
    chunks = cluster.plan(catalogue, folder, EPOCHS, CHUNK)
    futures = client.map(slow, chunks, pure=False, retries=2)
    victims = []
    while not victims:
        time.sleep(0.05)
        victims = list(folder.glob("*.working"))
    victim = int(victims[0].stem)
    time.sleep(0.35)
    os.kill(victim, signal.SIGKILL)
    assert digests(client.gather(futures)) == alone
    assert {path.name for path in folder.glob("part-*.parquet")} == set(alone)
    workers = {int(path.stem) for path in folder.glob("*.working")}
    assert victim in workers and len(workers) == 3  # the one that was started in its place


def test_parts_that_are_there_are_left_alone(catalogue, alone, tmp_path):
    chunks = cluster.plan(catalogue, tmp_path / "again", EPOCHS, CHUNK)
    cluster.run(chunks[:5])
    before = [Path(chunk.part).stat().st_mtime_ns for chunk in chunks[:5]]
    assert digests(cluster.run(chunks)) == alone
    assert [Path(chunk.part).stat().st_mtime_ns for chunk in chunks[:5]] == before


def command(*arguments):
    script = [sys.executable, str(REPOSITORY / "examples" / "cluster.py"), *map(str, arguments), "--workers", "0"]
    return subprocess.run(script, capture_output=True, text=True, check=False)


def test_folder_of_another_run_is_refused_and_that_of_the_same_run_goes_on(catalogue, tmp_path):
    folder = tmp_path / "result"
    one = [catalogue, folder, "--chunk", CHUNK, "--epochs", 0, 10, 20]
    first = command(*one)
    assert first.returncode == 0, first.stderr
    before = digests(folder.iterdir())
    last = sorted(folder.glob("part-*.parquet"))[-1]
    last.unlink()
    assert command(*one).returncode == 0
    other = tmp_path / "other.parquet"
    cluster.make_catalogue(other, BODIES, seed=2)
    for what, asked in {
        "epochs": [catalogue, folder, "--chunk", CHUNK, "--epochs", 0, 500],
        "chunk": [catalogue, folder, "--chunk", CHUNK + 1, "--epochs", 0, 10, 20],
        "sha256": [other, folder, "--chunk", CHUNK, "--epochs", 0, 10, 20],
    }.items():
        done = command(*asked)
        assert done.returncode == 2 and done.stderr.count("\n") == 1 and what in done.stderr, done.stderr
    assert digests(folder.iterdir()) == before
    assert parquet.read_table(folder).num_rows == 3 * BODIES
    (folder / cluster.PLAN).unlink()
    assert command(*one).returncode == 2


def test_missing_catalogue_is_said_in_one_line(tmp_path):
    done = command(tmp_path / "none.parquet", tmp_path / "result")
    assert done.returncode == 2 and done.stderr.count("\n") == 1 and "none.parquet" in done.stderr
    assert not (tmp_path / "result").exists()
