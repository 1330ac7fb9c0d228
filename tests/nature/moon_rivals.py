"""The table of the Moon's orientation, the series of the WGCCRE and that of Meeus on the same days of 1950 to 2050: docs/data/nature-moon-rivals.csv.

    make nature
    python tests/nature/moon_rivals.py

Each is a matrix from axes of the Moon to the ICRF. The difference from the orientation of DE421 is a rotation about the axes of the Moon ["]: largest angle, root mean square, and the same
without the mean rotation, which is another choice of axes. `mean` is this rotation.

    table     docs/data/moon_orientation.py, 60 terms: principal axes of DE421 (MOON_PA_DE421)
    WGCCRE    right ascension, declination and meridian with 13 arguments (Archinal et al. 2018, Celest. Mech. Dyn. Astron. 130:22, table 2, as NAIF's kernels quote it; frame IAU_MOON of SPICE): mean-Earth axes
    Meeus     Astronomical Algorithms (1998), chapter 53, by PyMeeus: librations and position angle of the axis, at his place of the Moon; true equator and equinox of date, which
              ERFA turns to the ICRF (IAU 2006/2000A): mean-Earth axes

The mean-Earth axes (MOON_ME_DE421) are those of NAIF's moon_080317.tf: v_PA = R3(67.92″) R2(78.56″) R1(0.30″) v_ME.
"""

import csv
import sys

import erfa
import numpy as np
from kernels import ARCSECOND, CENTURY, DATA, DAY, ROOT, YEAR, orientation, write
from moon import FRAME
from numpy.typing import NDArray
from pymeeus.Epoch import Epoch
from pymeeus.Moon import Moon

from andoyer import output

J2000 = 2451545.0
SPAN = (-50 * YEAR, 49.9 * YEAR)
STEP = 4.9 * DAY
MEAN_EARTH = (67.92, 78.56, 0.30)
Array = NDArray[np.float64]


def frame_turn(axis: int, angles: Array | float) -> Array:
    """Matrices that turn the frame about axis 1, 2 or 3."""
    c, s = np.cos(angles), np.sin(angles)
    i, j = axis % 3, (axis + 1) % 3
    matrices = np.zeros((*np.shape(angles), 3, 3))
    matrices[..., axis - 1, axis - 1] = 1
    matrices[..., i, i] = matrices[..., j, j] = c
    matrices[..., i, j], matrices[..., j, i] = s, -s
    return matrices


def to_icrf(angles: Array) -> Array:
    """From axes of the body to the ICRF; the angles turn the frame about axes 3, 1, 3, shape (3, n)."""
    phi, theta, psi = angles
    return np.swapaxes(frame_turn(3, psi) @ frame_turn(1, theta) @ frame_turn(3, phi), -1, -2)


def kernel(times: Array) -> Array:
    """The principal axes of DE421."""
    x, y, z, w = output.read_pck(orientation(), FRAME, times).attitude.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.array(rows).transpose(2, 0, 1)


def table(times: Array) -> Array:
    """The principal axes by the emitted code."""
    names: dict = {}
    exec((DATA / "moon_orientation.py").read_text(encoding="utf-8"), names)
    return to_icrf(np.array([names["moon_orientation"](time) for time in times]).T)


def wgccre(times: Array) -> Array:
    """The mean-Earth axes of IAU_MOON."""
    with (ROOT / "tests" / "data" / "wgccre_moon.csv").open(encoding="utf-8", newline="") as file:
        constant, rate, ra, dec, meridian = np.array([[float(cell) for name, cell in row.items() if name != "argument"] for row in csv.DictReader(file)]).T
    days, centuries = times / DAY, times / CENTURY
    phases = np.radians(constant + np.outer(centuries, rate))
    right = 269.9949 + 0.0031 * centuries + np.sin(phases) @ ra
    declination = 66.5392 + 0.0130 * centuries + np.cos(phases) @ dec
    turned = 38.3213 + 13.17635815 * days - 1.4e-12 * days**2 + np.sin(phases) @ meridian
    return to_icrf(np.radians([90 + right, 90 - declination, turned]))


def meeus(times: Array) -> Array:
    """The mean-Earth axes of chapter 53."""
    matrices = []
    for time in times:
        epoch = Epoch(J2000 + time / DAY)
        ra, dec = (angle.rad() for angle in Moon.apparent_equatorial_pos(epoch)[:2])
        l, b = (angle.rad() for angle in Moon.moon_librations(epoch)[4:])
        position = Moon.moon_position_angle_axis(epoch).rad()
        to_earth = -np.array([np.cos(dec) * np.cos(ra), np.cos(dec) * np.sin(ra), np.sin(dec)])
        north = np.array([-np.sin(dec) * np.cos(ra), -np.sin(dec) * np.sin(ra), np.cos(dec)])
        axis = np.cos(position) * north + np.sin(position) * np.array([-np.sin(ra), np.cos(ra), 0])
        outside = np.stack([to_earth, axis, np.cross(to_earth, axis)], axis=1)
        below = np.array([np.cos(b) * np.cos(l), np.cos(b) * np.sin(l), np.sin(b)])
        pole = np.array([-np.sin(b) * np.cos(l), -np.sin(b) * np.sin(l), np.cos(b)])
        inside = np.stack([below, pole, np.cross(below, pole)], axis=1)
        matrices.append(erfa.pnm06a(J2000, time / DAY).T @ outside @ inside.T)
    return np.array(matrices)


def differences(found: Array, exact: Array) -> Array:
    """The small rotations from one matrix to the other about the axes of the Moon ["], shape (n, 3)."""
    turn = np.swapaxes(exact, 1, 2) @ found
    return np.stack([turn[:, 2, 1] - turn[:, 1, 2], turn[:, 0, 2] - turn[:, 2, 0], turn[:, 1, 0] - turn[:, 0, 1]], axis=1) / (2 * ARCSECOND)


def main() -> int:
    times = np.arange(*SPAN, STEP)
    principal = kernel(times)
    third, second, first = (angle * ARCSECOND for angle in MEAN_EARTH)
    mean_earth = principal @ frame_turn(3, third) @ frame_turn(2, second) @ frame_turn(1, first)
    rows = []
    for name, what, terms, found, exact in (
        ("table", "principal axes", "60 terms", table(times), principal),
        ("WGCCRE", "mean-Earth axes", "13 arguments", wgccre(times), mean_earth),
        ("Meeus", "mean-Earth axes", "chapter 53", meeus(times), mean_earth),
    ):
        apart = differences(found, exact)
        mean = apart.mean(axis=0)
        sizes = [np.linalg.norm(vectors, axis=1) for vectors in (apart, apart - mean)]
        measured = dict(
            zip(
                ("largest", "rms", "largest_about_mean", "rms_about_mean"),
                (f"{value:.2f}" for size in sizes for value in (size.max(), np.sqrt(np.mean(size**2)))),
                strict=True,
            )
        )
        described = {"series": name, "size": terms, "axes": what, "days": str(len(times)), **measured}
        rows.append({**described, "mean": " ".join(f"{round(value, 1) + 0.0:.1f}" for value in mean)})
        print(", ".join(f"{key} {value}" for key, value in rows[-1].items()), flush=True)
    write(DATA / "nature-moon-rivals.csv", rows)
    return int(float(rows[0]["largest"]) > 1)


if __name__ == "__main__":
    sys.exit(main())
