"""Draw the pictures of the four cards of the front page, at the size at which it shows them.

python examples/cards.py [FOLDER]        four PNG in FOLDER, by default docs/cards
"""

import math
import sys
from collections.abc import Callable
from pathlib import Path

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt
import numpy as np
from cycler import cycler
from matplotlib.axes import Axes

import andoyer
from andoyer import fit

COLORS = ("#0072B2", "#D55E00", "#009E73")
SIZE = (4.2, 2.1)
"""Width and height [in]; a card is some 400 pixels wide."""
DAY, TURN, ARCSECOND = 86400.0, 2 * math.pi, math.pi / 648000


def spacecraft(axes: Axes) -> None:
    """A satellite with its boom towards the Earth, released with a rate: roll, pitch and yaw over five revolutions."""
    body, orbit, rates = andoyer.Body([0.9, 1.0, 0.2]), andoyer.Orbit(TURN / 5700), [3e-4, 3e-4, 2e-4]
    released = andoyer.Scene.from_orbital(body, [0, 0, 0], rates, orbit=orbit, elements_of="rotating", frame="lvlh", span=(0, 5 * 5700.0), tolerance=1e-6)
    times = np.linspace(0, 5 * 5700, 800)
    angles = np.degrees(released.solve().orbital(times, elements_of="rotating", frame="lvlh").angles)
    for name, values in zip(("yaw", "pitch", "roll"), angles.T, strict=True):
        axes.plot(times / 3600, values, label=name)
    axes.set(xlabel="time [h]", ylabel="angle [°]")
    axes.legend(ncols=3, loc="lower center", bbox_to_anchor=(0.5, 0.95), frameon=False, handlelength=1.2, columnspacing=1.2)


def asteroid(axes: Axes) -> None:
    """The light curve of a tumbler with a noise of 2 %, and its model."""
    semi_axes = [1.0, 0.7, 0.5]
    motion = andoyer.Scene(andoyer.Body.ellipsoid(*semi_axes), [0.1, -0.5, 0.3, math.sqrt(0.65)], [5.5, 0.9, 0.6]).solve()
    generator = np.random.default_rng(1)
    fine, seen = np.linspace(0, 4, 800), np.sort(generator.uniform(0, 4, 90))
    fine_light, light = (fit.brightness(semi_axes, motion.attitude(times), [0.8, 0.6, 0.0], [1.0, 0.0, 0.1]) for times in (fine, seen))
    axes.plot(fine, fine_light / light.mean())
    axes.plot(seen, light / light.mean() + 0.02 * generator.standard_normal(len(seen)), "o", markersize=3)
    axes.set(xlabel="time [h]", ylabel="brightness")


def planet(axes: Axes) -> None:
    """The nutation of the Earth in obliquity under Moon and Sun, with the mean elements of the Moon, over two revolutions of its node."""
    node, span = TURN / (6798.38 * DAY), 37.2 * 365.25 * DAY
    anomaly, latitude = TURN / (27.55455 * DAY), TURN / (27.212221 * DAY)
    moon = andoyer.Orbit(
        anomaly,
        0.0549,
        inclination=math.radians(5.145),
        node=math.radians(125.0),
        node_rate=-node,
        pericentre_rate=latitude - anomaly,
        attraction=4902.8 / 384399.0**3,
    )
    sun = andoyer.Orbit(TURN / (365.2596 * DAY), 0.0167)
    half, moment = math.radians(23.4393) / 2, 1 - 0.0032737548
    scene = andoyer.Scene(
        andoyer.Body([moment, moment, 1.0]),
        [-math.sin(half), 0.0, 0.0, math.cos(half)],
        [0.0, 0.0, 7.2921151467e-5],
        orbit=[moon, sun],
        span=(0, span),
        tolerance=1e-7,
    )
    times = np.arange(0, span, 2 * DAY)
    obliquity = np.arccos(scene.solve().rotation(times).as_matrix()[:, 2, 2])
    axes.plot(times / (365.25 * DAY), (obliquity - obliquity.mean()) / ARCSECOND, linewidth=0.9)
    axes.set(xlabel="time [years]", ylabel='obliquity ["]')


def moon(axes: Axes) -> None:
    """The longitude of the Moon with a free libration of 8 seconds of arc, beside the one that its ellipse forces."""
    body, orbit = andoyer.Body([0.99937142, 0.9995989, 1.0]), andoyer.Orbit(TURN / 27.321661, 0.0549)
    scene = andoyer.Scene.locked(body, orbit, amplitudes=(8 * ARCSECOND, 0, 0), span=(0, 40000.0), tolerance=1e-7, method="libration")
    times = np.linspace(0, 3 * 365.25, 1500)
    libration = scene.solve().libration
    assert libration is not None
    terms = [term for term in libration.terms() if term.angle == "longitude"]
    longitude = sum(term.amplitude * np.sin(term.phase + TURN * times / term.period) for term in terms)
    axes.plot(times / 365.25, longitude / ARCSECOND, linewidth=1)
    axes.set(xlabel="time [years]", ylabel='longitude ["]')


CARDS: dict[str, Callable[[Axes], None]] = {"spacecraft": spacecraft, "asteroid": asteroid, "planet": planet, "moon": moon}


def main() -> None:
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parents[1] / "docs" / "cards")
    folder.mkdir(parents=True, exist_ok=True)
    for name, draw in CARDS.items():
        with plt.rc_context({"font.size": 11, "axes.spines.top": False, "axes.spines.right": False, "axes.prop_cycle": cycler(color=COLORS)}):
            figure, axes = plt.subplots(figsize=SIZE, layout="constrained")
            draw(axes)
            figure.savefig(folder / f"{name}.png", dpi=200, metadata={"Software": None})
            plt.close(figure)


if __name__ == "__main__":
    main()
