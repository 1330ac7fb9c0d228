"""Hold the averaged theory of the gravity gradient against the integrated method over long spans.

    python benches/long_spans.py [--output docs/data/gravity-spans.csv] [--only apophis]
    python benches/long_spans.py --epochs

Apophis and Toutatis rotate 20,000 times under the torque of the Sun, and a box satellite goes round the Earth 1,000 times. Each scene is solved over three spans by first order ("full") and by second
order. The reference is the integration with a tolerance of 1e-11; SciPy's DOP853 (tests/reference/gravity_gradient.py) checks it over the first rotations. A row has the effect of the torque, the largest
error, the error bound, and the error bound of the reference [rad]; `pole` is the largest error of the direction of the angular momentum [rad]. The script ends with 1 if an error exceeds the sum of both bounds. `--epochs`
prints the bound of second order and the error of Toutatis over 4,000 rotations, with its epoch at the pericentre, a quarter of an orbit later, and at the apocentre.
"""

import argparse
import csv
import math
import sys
import warnings
from pathlib import Path

import numpy as np

import andoyer

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "reference"))

from gravity_gradient import GravityGradient

DAY, HOUR, YEAR = 86400.0, 3600.0, 31557600.0
GAUSS = 0.01720209895 / DAY  # rate of the Sun at 1 au [rad/s]
CHECK_ROTATIONS, SAMPLES = 20, 400


def around_sun(semi_major_axis, eccentricity, inclination):
    """The Sun as seen from a small body; node and pericentre are chosen."""
    return andoyer.Orbit(GAUSS * semi_major_axis**-1.5, eccentricity, inclination=math.radians(inclination), argument_of_pericentre=1.0)


def apophis():
    """Pravec et al. 2014 and JPL's orbit; see examples/scenes/apophis.toml."""
    pole = np.radians([275.0, -85.0])
    scene = andoyer.Scene.from_periods(andoyer.Body.named("apophis"), 27.38 * HOUR, 263 * HOUR, momentum_direction=pole)
    return scene, around_sun(0.9225072, 0.1915217, 3.33675), 27.38 * HOUR, [100, 1000, 20000]


def toutatis():
    """Zhao et al. 2015, Takahashi et al. 2013."""
    pole = np.radians([180.2, -54.75])
    scene = andoyer.Scene.from_periods(andoyer.Body.named("toutatis"), 7.40 * DAY, 5.38 * DAY, mode="long-axis", momentum_direction=pole)
    return scene, around_sun(2.5430472, 0.6246302, 0.44808), 5.38 * DAY, [100, 1000, 20000]


def satellite():
    """A box of 1 × 1.2 × 0.6 m at 500 km that turns by 6° a second; 10, 100 and 1,000 orbits."""
    semi_major_axis = 6378136.3 + 500e3
    orbit = andoyer.Orbit(math.sqrt(3.986004415e14 / semi_major_axis**3), 0.001, inclination=math.radians(51.6))
    spin = math.radians(6)
    scene = andoyer.Scene(andoyer.Body.box(1.0, 1.2, 0.6, mass=100.0), [0, 0, 0, 1], [0.02 * spin, 0.0, spin])
    rotation = 2 * math.pi / spin
    return scene, orbit, rotation, [orbits * 2 * math.pi / orbit.mean_motion / rotation for orbits in (10, 100, 1000)]


SCENES = {"apophis": apophis, "toutatis": toutatis, "satellite": satellite}


def apart(one, other):
    """Angles between attitudes."""
    x, y, z, w = np.moveaxis(one, -1, 0)
    a, b, c, d = np.moveaxis(other, -1, 0)
    vector = np.stack([w * a - d * x - (y * c - z * b), w * b - d * y - (z * a - x * c), w * c - d * z - (x * b - y * a)])
    return 2 * np.arctan2(np.linalg.norm(vector, axis=0), np.abs(w * d + x * a + y * b + z * c))


def pole(motion, times):
    momentum = motion.angular_momentum(times)
    return momentum / np.linalg.norm(momentum, axis=1, keepdims=True)


def compare(name):
    """The rows of one scene."""
    scene, orbit, rotation, spans = SCENES[name]()
    body, attitude, rates = scene.body, scene.attitude, scene.angular_velocity
    state = (body, attitude, rates)
    exact = andoyer.Scene(*state, orbit=orbit, span=(0, spans[-1] * rotation), tolerance=1e-11, method="integrated").solve()
    few = np.linspace(0, CHECK_ROTATIONS * rotation, 9)
    check = apart(GravityGradient(body.moments, attitude, rates, orbit).states(few)[0], exact.attitude(few)).max()
    print(f"{name}: n/spin {orbit.mean_motion * rotation / (2 * math.pi):.1e}, DOP853 apart {check:.1e}, bound {exact.plan.error_bound:.1e}", flush=True)
    for rotations in spans:
        end = rotations * rotation
        times = np.linspace(0, end, SAMPLES + 1)[1:]
        truth, axis = exact.attitude(times), pole(exact, times)
        reference = andoyer.Scene(*state, orbit=orbit, span=(0, end), tolerance=1e-11, method="integrated").solve().plan.error_bound
        effect = apart(andoyer.Scene(*state, method="closed").solve().attitude(times), truth).max()
        for level in ("full", "second-order"):
            motion = andoyer.Scene(*state, orbit=orbit, span=(0, end), tolerance=1e-11, method="closed", averaging="spin", level=level).solve()
            error = apart(motion.attitude(times), truth).max()
            lost = np.linalg.norm(pole(motion, times) - axis, axis=1).max()
            yield name, level, round(rotations), end * orbit.mean_motion / (2 * math.pi), effect, error, motion.plan.error_bound, reference, lost, check


def by_epoch(rotations=4000):
    """Toutatis with three epochs on its orbit: (fraction of an orbit after the pericentre, bound, error)."""
    scene, orbit, rotation, _ = toutatis()
    state = (scene.body, scene.attitude, scene.angular_velocity)
    times = np.linspace(0, rotations * rotation, SAMPLES + 1)[1:]
    for fraction in (0.0, 0.25, 0.5):
        moved = andoyer.Orbit(
            orbit.mean_motion,
            orbit.eccentricity,
            time_of_pericentre=-fraction * 2 * math.pi / orbit.mean_motion,
            inclination=orbit.inclination,
            argument_of_pericentre=orbit.argument_of_pericentre,
        )
        span = {"orbit": moved, "span": (0, times[-1]), "tolerance": 1e-11}
        exact = andoyer.Scene(*state, **span, method="integrated").solve()
        motion = andoyer.Scene(*state, **span, method="closed", averaging="spin", level="second-order").solve()
        yield fraction, motion.plan.error_bound, apart(motion.attitude(times), exact.attitude(times)).max()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--output", type=Path)
    parser.add_argument("--only", choices=SCENES)
    parser.add_argument("--epochs", action="store_true")
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    if options.epochs:
        for fraction, bound, error in by_epoch():
            print(f"epoch {fraction:.2f} orbits after the pericentre: bound {bound:.1e}, error {error:.1e}")
        return 0
    rows, beyond = [], 0
    print("scene      level         rotations   orbits  effect   share    error    bound  bound/error  reference  pole")
    for name in [options.only] if options.only else SCENES:
        for row in compare(name):
            rows.append(row)
            _, level, rotations, orbits, effect, error, bound, reference, lost, _ = row
            beyond += error > bound + reference
            print(
                f"{name:10s} {level:12s} {rotations:10d} {orbits:8.1f}  {effect:.1e}  {error / effect:.1e}  {error:.1e}  {bound:.1e}  {bound / error:11.1f}  {reference:.1e}  {lost:.1e}",
                flush=True,
            )
    if options.output:
        with options.output.open("w", encoding="utf-8", newline="") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow(["scene", "level", "rotations", "orbits", "effect", "error", "bound", "reference", "pole", "dop853"])
            writer.writerows([(name, level, rotations, f"{orbits:.1f}", *(f"{x:.3e}" for x in figures)) for name, level, rotations, orbits, *figures in rows])
    return 1 if beyond else 0


if __name__ == "__main__":
    sys.exit(main())
