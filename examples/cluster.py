"""Propagate a catalogue of bodies on many processes with Dask. Catalogue and result are Parquet files.

    python examples/cluster.py --make CATALOGUE.parquet --bodies N          writes an invented catalogue
    python examples/cluster.py CATALOGUE.parquet RESULT --epochs 0 10 20    two processes on this machine, or --scheduler ADDRESS

The catalogue is cut into chunks of rows. Each chunk becomes one file of RESULT, which is written under a temporary name and renamed when it is complete. If a worker dies,
its chunk is given to another worker, which writes the same bytes. Existing files are not computed again, so a stopped run can be continued. RESULT/_plan.json records the
catalogue and the options of the run (readers of a Parquet folder skip names with an underscore). A run with other options is refused. Needs Dask, distributed and PyArrow.
"""

import argparse
import hashlib
import json
import os
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NoReturn

import numpy as np
import pyarrow
import pyarrow.parquet as parquet
from numpy.typing import NDArray

import andoyer

CHUNK = 10_000
"""Number of bodies in a chunk: about 0.1 s of work at ten epochs, and 5.6 MB of result."""
TOLERANCE = 1e-9
MOMENTS, ATTITUDE, RATES = ["A", "B", "C"], ["qx", "qy", "qz", "qw"], ["wx", "wy", "wz"]
RESULT = ["body", "t", *ATTITUDE, *RATES]
PLAN = "_plan.json"


@dataclass(frozen=True)
class Chunk:
    """A range of rows of the catalogue, and the file of their result."""

    catalogue: str
    start: int
    stop: int
    part: str
    epochs: tuple[float, ...]


def plan(catalogue: Path, result: Path, epochs: Sequence[float], size: int = CHUNK) -> list[Chunk]:
    """The chunks of a catalogue, in the order of its rows."""
    bodies = parquet.read_metadata(catalogue).num_rows
    starts = range(0, bodies, size)
    return [Chunk(str(catalogue), start, min(start + size, bodies), str(result / f"part-{start:012}.parquet"), tuple(epochs)) for start in starts]


def settle(catalogue: Path, result: Path, epochs: Sequence[float], size: int = CHUNK) -> None:
    """Record the catalogue and the options of the run before its first chunk. `SystemExit` if the folder belongs to another run."""
    with catalogue.open("rb") as file:
        digest = hashlib.file_digest(file, "sha256").hexdigest()
    bodies = parquet.read_metadata(catalogue).num_rows
    run = {"bytes": catalogue.stat().st_size, "sha256": digest, "bodies": bodies, "chunk": size, "epochs": list(epochs), "andoyer": andoyer.__version__}
    path = result / PLAN
    if path.exists():
        try:
            before = json.loads(path.read_text(encoding="utf-8"))
        except ValueError:
            before = None
        other = [name for name in run if not isinstance(before, dict) or before.get(name) != run[name]]
        if other:
            refuse(f"{result} holds another run ({', '.join(other)} differ): take another folder, or remove that one")
    elif any(result.glob("part-*.parquet")):
        refuse(f"{result} holds parts of a run without {PLAN}: take another folder, or remove that one")
    else:
        result.mkdir(parents=True, exist_ok=True)
        half = result / f"{PLAN}.{os.getpid()}.half"
        half.write_text(json.dumps(run, indent=2) + "\n", encoding="utf-8")
        os.replace(half, path)


def refuse(why: str) -> NoReturn:
    """End with status 2 and one line."""
    print("cluster.py:", why, file=sys.stderr)
    sys.exit(2)


def lines(chunk: Chunk) -> NDArray[np.float64]:
    """Read the rows of a chunk; only the row groups that contain them are read."""
    with parquet.ParquetFile(chunk.catalogue) as file:
        counts = [file.metadata.row_group(group).num_rows for group in range(file.num_row_groups)]
        ends = np.cumsum(counts)
        groups = [group for group, end in enumerate(ends) if end > chunk.start and end - counts[group] < chunk.stop]
        table = file.read_row_groups(groups, columns=[*MOMENTS, *ATTITUDE, *RATES])
    before = int(ends[groups[0]] - counts[groups[0]])
    table = table.slice(chunk.start - before, chunk.stop - chunk.start)
    return np.column_stack([table[name].to_numpy() for name in table.column_names])


def propagate(chunk: Chunk) -> str:
    """Write the result of a chunk, whole or not at all. It uses one thread, because the processes already run in parallel."""
    part = Path(chunk.part)
    if part.exists():
        return chunk.part
    rows = lines(chunk)
    ensemble = andoyer.Ensemble(rows[:, :3], rows[:, 3:7], rows[:, 7:], tolerance=TOLERANCE, threads=1)
    samples = ensemble.at(np.array(chunk.epochs))
    bodies = np.repeat(np.arange(chunk.start, chunk.stop), len(chunk.epochs))
    values = np.concatenate([samples.attitude, samples.angular_velocity], axis=-1).reshape(-1, 7)
    columns = [bodies, np.tile(samples.times, len(rows)), *np.ascontiguousarray(values.T)]
    half = part.with_name(f"{part.name}.{os.getpid()}.half")
    parquet.write_table(pyarrow.table(dict(zip(RESULT, columns, strict=True))), half)
    os.replace(half, part)
    return chunk.part


def run(chunks: Sequence[Chunk], client: Any = None) -> list[str]:
    """Compute all chunks, in this process or by the workers of a client. Returns the files in order."""
    if chunks:
        Path(chunks[0].part).parent.mkdir(parents=True, exist_ok=True)
    if client is None:
        return [propagate(chunk) for chunk in chunks]
    parts: list[str] = client.gather(client.map(propagate, chunks, pure=False, retries=2))
    return parts


def make_catalogue(path: Path, bodies: int, seed: int = 1) -> None:
    """Write an invented catalogue: random triaxial bodies with random spins, some of them near the separatrix."""
    generator = np.random.default_rng(seed)
    names = [*MOMENTS, *ATTITUDE, *RATES]
    writer = None
    for start in range(0, bodies, 10 * CHUNK):
        count = min(10 * CHUNK, bodies - start)
        axes = np.sort(generator.uniform(0.4, 1, (count, 3)), axis=1) ** 2
        moments = np.column_stack([axes[:, 0] + axes[:, 1], axes[:, 0] + axes[:, 2], axes[:, 1] + axes[:, 2]])
        attitudes = generator.standard_normal((count, 4))
        attitudes /= np.linalg.norm(attitudes, axis=1, keepdims=True)
        rates = generator.standard_normal((count, 3))
        table = pyarrow.table(dict(zip(names, np.column_stack([moments, attitudes, rates]).T.copy(), strict=True)))
        writer = writer or parquet.ParquetWriter(path, table.schema)
        writer.write_table(table, row_group_size=CHUNK)
    if writer is not None:
        writer.close()


def arguments() -> argparse.Namespace:
    """The arguments of the command line."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("catalogue", type=Path, help="Parquet file with the columns A B C qx qy qz qw wx wy wz")
    parser.add_argument("result", type=Path, nargs="?", help="folder of the result files")
    parser.add_argument("--make", action="store_true", help="write an invented catalogue instead")
    parser.add_argument("--bodies", type=int, default=1_000_000, help="number of bodies in the invented catalogue (default: %(default)s)")
    parser.add_argument("--epochs", type=float, nargs="+", default=[0.0], help="times, the same for all bodies (default: 0)")
    parser.add_argument("--chunk", type=int, default=CHUNK, help="number of bodies in a chunk (default: %(default)s)")
    parser.add_argument("--workers", type=int, default=2, help="number of processes on this machine; 0 uses this process alone (default: %(default)s)")
    parser.add_argument("--scheduler", help="address of a Dask scheduler, instead of processes on this machine")
    return parser.parse_args()


def main() -> None:
    """The command line."""
    given = arguments()
    if given.make:
        make_catalogue(given.catalogue, given.bodies)
        return
    if given.result is None:
        refuse("a folder for the result must be given")
    if not given.catalogue.is_file():
        refuse(f"there is no file {given.catalogue}")
    if given.chunk < 1:
        refuse(f"--chunk = {given.chunk}: it must be 1 or more")
    settle(given.catalogue, given.result, given.epochs, given.chunk)
    chunks = plan(given.catalogue, given.result, given.epochs, given.chunk)
    if given.workers == 0 and given.scheduler is None:
        print(len(run(chunks)), "parts")
        return
    from distributed import Client, LocalCluster

    if given.scheduler is not None:
        with Client(given.scheduler) as client:
            print(len(run(chunks, client)), "parts")
        return
    with LocalCluster(n_workers=given.workers, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        print(len(run(chunks, client)), "parts")


if __name__ == "__main__":
    main()
