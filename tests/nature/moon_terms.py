"""The Moon in a table: terms of its orientation from the kernel of DE421 over 1950 to 2050, docs/data/nature-moon-terms.csv.

    make nature
    python tests/nature/moon_terms.py --terms 60

The angles refer to the ecliptic of date (P_A, Q_A of IAU 2006, axis 1 of ECLIPJ2000 projected on it). Its pole has the components x and y about axes 1 and 2 of the Moon ["]; the longitude is φ + ψ of
the turns φ, θ, ψ about axes 3, 1, 3 ["]. A row of the pole has amplitudes of sin and cos of rate · t for x (1) and y (2), t in seconds of TDB past J2000; one of the longitude has its own (1). The
rows of polynomials, in Julian centuries, have their coefficients as cosines. Each term comes from the largest peak of what is left, then amplitudes and rates of its angles are fitted anew; `left`
is the largest angle that is left with the terms up to this row.
"""

import argparse
import sys
from pathlib import Path

import numpy as np
from earth import ecliptic_pole
from kernels import ARCSECOND, CENTURY, DATA, DAY, YEAR, orientation, write
from moon import FRAME
from numpy.typing import NDArray

from andoyer import output

OBLIQUITY = 84381.448 * ARCSECOND
SPAN = (-50 * YEAR, 49.9 * YEAR)
STEP = 1.8 * DAY
PADDING = 8
Array = NDArray[np.float64]


def angles(times: Array) -> Array:
    """x, y and longitude ["], shape (3, n)."""
    x, y, z, w = output.read_pck(orientation(), FRAME, times).attitude.T
    rows = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    ).transpose(2, 0, 1)
    c, s = np.cos(OBLIQUITY), np.sin(OBLIQUITY)
    pole = ecliptic_pole(times)
    first = np.array([1.0, 0, 0]) - pole * pole[:, :1]
    first /= np.linalg.norm(first, axis=1)[:, None]
    of_date = np.stack([first, np.cross(pole, first), pole], axis=1)
    turn = of_date @ np.array([[1, 0, 0], [0, c, s], [0, -s, c]]) @ rows
    longitude = np.unwrap(np.arctan2(turn[:, 0, 2], -turn[:, 1, 2]) + np.arctan2(turn[:, 2, 0], turn[:, 2, 1]))
    return np.array([turn[:, 2, 0], turn[:, 2, 1], longitude]) / ARCSECOND


class Group:
    """Angles with common rates: what is left of them, and the next peak."""

    def __init__(self, name: str, times: Array, values: Array, degree: int) -> None:
        self.name, self.times, self.values = name, times, values
        self.scale = abs(times).max()
        self.polynomial = np.vander(times / CENTURY, degree + 1, increasing=True)
        self.rates: list[float] = []
        self.left = values
        self.fit()

    def fit(self) -> None:
        """All amplitudes and rates anew; a rate moves by a third of a turn in the span at most."""
        most = 0.3 * np.pi / self.scale
        for _ in range(3 if self.rates else 1):
            rates = np.array(self.rates)
            phases = np.outer(self.times, rates)
            sines, cosines = np.sin(phases), np.cos(phases)
            columns = np.hstack([self.polynomial, sines, cosines])
            self.coefficients = np.linalg.lstsq(columns, self.values.T, rcond=None)[0]
            self.left = self.values - (columns @ self.coefficients).T
            if not self.rates:
                break
            # What is left, by the derivatives with respect to the rates: one step for all angles together.
            by_sine, by_cosine = np.split(self.coefficients[self.polynomial.shape[1] :], 2)
            slopes = [(self.times / self.scale)[:, None] * (cosines * a - sines * b) for a, b in zip(by_sine.T, by_cosine.T, strict=True)]
            normal = np.zeros((len(rates), len(rates)))
            right = np.zeros(len(rates))
            basis, _ = np.linalg.qr(columns)
            for slope, rest in zip(slopes, self.left, strict=True):
                across = slope - basis @ (basis.T @ slope)
                normal += across.T @ across
                right += across.T @ rest
            before = list(self.rates)
            self.rates = [float(rate) for rate in rates + np.clip(np.linalg.lstsq(normal, right, rcond=None)[0] / self.scale, -most, most)]
        if self.rates:
            self.rates = before

    def peak(self) -> tuple[float, float]:
        """Amplitude and rate of the largest line of what is left."""
        size = PADDING * len(self.times)
        window = np.hanning(len(self.times))
        lines = np.sqrt(sum(abs(np.fft.rfft(rest * window, size)) ** 2 for rest in self.left)) * 2 / window.sum()
        lines[:PADDING] = 0
        place = int(lines.argmax())
        return float(lines[place]), 2 * np.pi * place / (size * STEP)


def row(angle: str, period: str, rate: str, sines: Array | None, cosines: Array, left: float | None) -> dict[str, str]:
    """A row of the file; what it does not have is a dash."""
    cells = {"angle": angle, "period_days": period, "rate": rate}
    for name, amplitudes in (("sine", sines), ("cosine", cosines)):
        given = [] if amplitudes is None else [f"{value:.4f}" for value in amplitudes]
        cells |= dict(zip((f"{name}_1", f"{name}_2"), [*given, "–", "–"], strict=False))
    return {**cells, "left": "–" if left is None else f"{left:.3f}"}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--terms", type=int, default=60)
    parser.add_argument("--data", type=Path, default=DATA / "nature-moon-terms.csv")
    options = parser.parse_args()
    times = np.arange(*SPAN, STEP)
    values = angles(times)
    groups = [Group("pole", times, values[:2], 2), Group("longitude", times, values[2:], 2)]
    order: list[tuple[Group, int, float]] = []
    while len(order) < options.terms:
        group, (_, rate) = max(((group, group.peak()) for group in groups), key=lambda found: found[1][0])
        group.rates.append(rate)
        group.fit()
        largest = np.sqrt(sum(rest**2 for group in groups for rest in group.left)).max()
        order.append((group, len(group.rates) - 1, float(largest)))
        if len(order) % 10 == 0:
            print(f'{len(order)} terms, largest angle left {largest:.3f}"', flush=True)
    rows = []
    for group in groups:
        for power in range(group.polynomial.shape[1]):
            rows.append(row(group.name, "–", f"t^{power}", None, group.coefficients[power], None))
    for group, place, largest in order:
        by_sine, by_cosine = np.split(group.coefficients[group.polynomial.shape[1] :], 2)
        rate = group.rates[place]
        rows.append(row(group.name, f"{2 * np.pi / rate / DAY:.6f}", f"{rate:.12e}", by_sine[place], by_cosine[place], largest))
    write(options.data, rows)
    return int(order[-1][2] > 1 and options.terms >= 60)


if __name__ == "__main__":
    sys.exit(main())
