"""A rigid Earth at DE440 positions beside REN-2000: docs/data/nature-earth.csv and docs/nature-earth.png.

    make nature                                  both bodies; some minutes
    python tests/nature/earth.py --years 40      another span, about J2000
    python tests/nature/earth.py --picture       the picture alone

The Earth has the dynamical ellipticity of REN-2000, H = (C − A)/C = 0.0032737548, and A = B. Moon and Sun are point masses at geometric positions. The integration has fixed axes, those of
ECLIPJ2000. At J2000 the figure axis stands where REN-2000 has it: the mean equinox decides the arguments with Ω, and 14" of it change terms by 1e-4 of themselves.

Angles of date: ε is the angle between the figure axis and the pole of the ecliptic of date (P_A and Q_A of IAU 2006), ψ that of the equinox along this ecliptic from the projection of axis 1, positive
backwards. What this origin does, the precession and the mean obliquity, is a polynomial. Arguments are those of REN-2000 with their accelerations, and REN-2000 is subtracted with its rates, before
a fit of one amplitude in sine and one in cosine for each term of 100 µas that the span separates: what it finds are the differences. A term that no turn in the span separates from a larger one is
in the sum with it. The fit has a polynomial and the free wobble of the initial state, too.
"""

import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np
from kernels import ARCSECOND, CENTURY, DAY, ROOT, YEAR, options, read, table, write
from numpy.typing import NDArray

import andoyer

MAIN, TERMS = (ROOT / "tests" / "data" / f"ren2000_{name}.csv" for name in ("main_terms", "terms"))
PICTURE = ROOT / "docs" / "nature-earth.png"
ELLIPTICITY, OBLIQUITY, ROTATION = 0.0032737548, 84381.448 * ARCSECOND, 7.2921151467e-5
MICRO = 1e-6 * ARCSECOND
STEP = 0.7 * DAY
"""No fraction of the fast periods."""
DEGREE = 5
SMALLEST = 100.0
"""The smallest term that is fitted [µas]."""
SPANS = (40, 120)
NAMES = ("l", "lp", "F", "D", "Om")
Array = NDArray[np.float64]


class Series(NamedTuple):
    """Terms of REN-2000: names, arguments at any time, amplitudes [µas] and their rates [µas/century]: ψ sine, ψ cosine, ε cosine, ε sine."""

    names: list[str]
    arguments: Array
    amplitudes: Array
    rates: Array

    def angle(self, index: int, times: Array) -> Array:
        """The argument of a term."""
        phase, rate, acceleration = self.arguments[index]
        return phase + (rate + acceleration * times / 2) * times

    def value(self, times: Array) -> Array:
        """Δψ and Δε [µas], shape (2, n)."""
        sums = np.zeros((2, len(times)))
        for index in range(len(self.names)):
            sine, cosine = np.sin(self.angle(index, times)), np.cos(self.angle(index, times))
            amplitudes = self.amplitudes[index, :, None] + self.rates[index, :, None] * times / CENTURY
            sums += [amplitudes[0] * sine + amplitudes[1] * cosine, amplitudes[2] * cosine + amplitudes[3] * sine]
        return sums


def series() -> Series:
    """The terms of the file, the largest first."""
    rows = read(TERMS)
    columns = ("dpsi_sin", "dpsi_cos", "deps_cos", "deps_sin")
    arguments, amplitudes, rates = (
        np.array([[float(row[name]) for name in names] for row in rows])
        for names in (("phase", "rate", "acceleration"), columns, [f"{name}_rate" for name in columns])
    )
    return Series([argument(row) for row in rows], arguments, amplitudes, rates)


def argument(row: dict[str, str]) -> str:
    """The argument as it is printed."""
    text = ""
    for name, letter in zip(NAMES, ("l", "l'", "F", "D", "Ω")):
        multiple = int(row[name] or 0)
        if multiple:
            text += ("−" if multiple < 0 else "+" if text else "") + (str(abs(multiple)) if abs(multiple) > 1 else "") + letter
    return text or "planetary"


def integrated(years: float, start: Array) -> tuple[Array, Array, float]:
    """Times, figure axes in ECLIPJ2000, and the bound of the integration ["]. `start`: Δψ and Δε at J2000 [µas]."""
    span = (-years / 2 * YEAR, years / 2 * YEAR)
    psi, epsilon = start * MICRO + [0, OBLIQUITY]
    attitude = [
        -np.sin(epsilon / 2) * np.cos(psi / 2),
        np.sin(epsilon / 2) * np.sin(psi / 2),
        -np.cos(epsilon / 2) * np.sin(psi / 2),
        np.cos(epsilon / 2) * np.cos(psi / 2),
    ]
    bodies = [table(name, "EARTH", span, frame="ECLIPJ2000", error=1e-11) for name in ("MOON", "SUN")]
    earth = andoyer.Body([1 - ELLIPTICITY, 1 - ELLIPTICITY, 1.0])
    tolerance = 1e-11 * max(1, years / 40)
    motion = andoyer.Scene(earth, attitude, [0, 0, ROTATION], orbit=bodies, span=span, tolerance=tolerance).solve()
    times = np.arange(*span, STEP)
    return times, motion.rotation(times).as_matrix()[:, :, 2], motion.plan.error_bound / ARCSECOND


def ecliptic_pole(times: Array) -> Array:
    """The pole of the ecliptic of date in ECLIPJ2000, shape (n, 3): P_A and Q_A of Capitaine, Wallace and Chapront 2003, IAU 2006."""
    t = times / CENTURY
    p = (4.199094 * t + 0.1939873 * t**2 - 0.00022466 * t**3) * ARCSECOND
    q = (-46.811015 * t + 0.0510283 * t**2 + 0.00052413 * t**3) * ARCSECOND
    return np.stack([p, -q, np.sqrt(1 - p**2 - q**2)], axis=1)


def angles_of_date(times: Array, axis: Array) -> Array:
    """ψ and ε of date [µas], shape (2, n)."""
    pole = ecliptic_pole(times)
    equinox = np.cross(axis, pole)
    sine, cosine = np.linalg.norm(equinox, axis=1), np.einsum("ij,ij->i", axis, pole)
    # Axis 1 projected on the ecliptic of date, and the direction a quarter ahead.
    first = np.array([1.0, 0, 0]) - pole * pole[:, :1]
    ahead = np.cross(pole, first)
    psi = -np.unwrap(np.arctan2(np.einsum("ij,ij->i", equinox, ahead), np.einsum("ij,ij->i", equinox, first)))
    return np.array([psi, np.arctan2(sine, cosine)]) / MICRO


def separated(terms: Series, years: float) -> tuple[list[int], dict[int, list[int]]]:
    """The terms that the span separates from all larger ones, and for each of them the others that are in its sum."""
    turn = 2 * np.pi / (years * YEAR)
    alone: list[int] = []
    beside: dict[int, list[int]] = {}
    speeds = abs(terms.arguments[:, 1])
    for index in np.flatnonzero(abs(terms.amplitudes).max(axis=1) >= SMALLEST):
        near = [other for other in alone if abs(speeds[index] - speeds[other]) < turn]
        if near:
            beside.setdefault(near[0], []).append(index)
        elif speeds[index] > turn:
            alone.append(index)
    return alone, beside


def differences(terms: Series, years: float) -> list[dict[str, str]]:
    """The rows of the file for a span."""
    times, axis, bound = integrated(years, terms.value(np.zeros(1))[:, 0])
    left = angles_of_date(times, axis) - terms.value(times)
    alone, beside = separated(terms, years)
    angles = np.array([terms.angle(index, times) for index in alone]).T
    wobble = ROTATION / (1 - ELLIPTICITY) * times
    columns = np.hstack(
        [np.polynomial.chebyshev.chebvander(times / times[0], DEGREE), np.sin(wobble)[:, None], np.cos(wobble)[:, None], np.sin(angles), np.cos(angles)]
    )
    both, *_ = np.linalg.lstsq(columns, left.T, rcond=None)
    first = DEGREE + 3
    sines, cosines = both[first : first + len(alone)], both[first + len(alone) :]
    main = {argument(row) for row in read(MAIN)}
    rows = []
    for place, index in enumerate(alone):
        published = terms.amplitudes[index]
        apart = [sines[place, 0], cosines[place, 0], cosines[place, 1], sines[place, 1]]
        row = {"years": f"{years:g}", "argument": terms.names[index], "period_days": f"{2 * np.pi / abs(terms.arguments[index, 1]) / DAY:.3f}"}
        row["main"] = "yes" if terms.names[index] in main else "no"
        row["with"] = "; ".join(terms.names[other] for other in beside.get(index, [])) or "–"
        for name, value, difference in zip(("dpsi_sin", "dpsi_cos", "deps_cos", "deps_sin"), published, apart):
            row |= {f"{name}_uas": f"{value:.2f}", f"{name}_found_uas": f"{value + difference:.2f}", f"{name}_difference_uas": f"{difference:.2f}"}
        rows.append(row)
    rest = left - (columns @ both).T
    print(f'{years:g} years: {len(alone)} terms, integration within {bound:.1e}", left over {rest[0].std():.0f} and {rest[1].std():.0f} µas')
    return rows


def summary(rows: list[dict[str, str]]) -> bool:
    """Print the medians and the terms that are further off than 100 µas and 1e-3 of themselves. True if there are none among the main ones."""
    kept = True
    for years in dict.fromkeys(row["years"] for row in rows):
        here = [row for row in rows if row["years"] == years]
        for name in ("dpsi_sin", "deps_cos"):
            apart = np.array([abs(float(row[f"{name}_difference_uas"])) for row in here])
            allowed = np.array([max(100.0, 1e-3 * abs(float(row[f"{name}_uas"]))) for row in here])
            off = [row["argument"] for row, far in zip(here, apart > allowed) if far]
            kept &= not {row["argument"] for row in here if row["main"] == "yes"} & set(off)
            print(
                f"{years} years, {name}: median {np.median(apart):.2f} µas, largest {apart.max():.1f}, {np.sum(apart <= 100)} of {len(here)} within 100 µas, off: {off}"
            )
    return kept


def draw(rows: list[dict[str, str]], path: Path) -> None:
    """Write the picture: amplitudes and differences by period."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    longest = max(rows, key=lambda row: float(row["years"]))["years"]
    here = [row for row in rows if row["years"] == longest]
    periods = [float(row["period_days"]) for row in here]
    with plt.rc_context({"font.size": 10, "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False}):
        figure, grid = plt.subplots(1, 2, figsize=(11, 4.6), sharex=True, sharey=True, layout="constrained")
        for axes, name, title in zip(grid, ("dpsi_sin", "deps_cos"), ("longitude", "obliquity"), strict=True):
            axes.loglog(periods, [max(abs(float(row[f"{name}_uas"])), 1e-2) for row in here], "o", color="#0072B2", markersize=4, label="REN-2000")
            axes.loglog(periods, [max(abs(float(row[f"{name}_difference_uas"])), 1e-2) for row in here], "x", color="#D55E00", markersize=5, label="difference")
            axes.axhline(100, color="#999999", linewidth=0.8)
            axes.set(title=f"{title}, {longest} years", xlabel="period [d]")
            axes.grid(visible=True, which="major", alpha=0.3)
        grid[0].set_ylabel("amplitude [µas]")
        grid[0].legend(loc="upper left")
        figure.savefig(path, dpi=110)
        plt.close(figure)


def main() -> int:
    asked = options(__doc__, SPANS, "nature-earth.csv")
    if not asked.picture:
        terms = series()
        write(asked.data, [row for years in asked.years for row in differences(terms, years)])
    rows = read(asked.data)
    draw(rows, PICTURE)
    return 0 if summary(rows) else 1


if __name__ == "__main__":
    sys.exit(main())
