"""Write HTML pages with animations of three motions: Apophis, Toutatis, and a box satellite under the gravity of the Earth.

    python examples/pages.py [FOLDER]

`make docs` writes them into the site.
"""

import math
import sys
from pathlib import Path

import andoyer
from andoyer.plot import page

SCENES = Path(__file__).parent / "scenes"
DAY = 86400.0


def apophis() -> andoyer.Motion:
    """The motion of examples/scenes/apophis.toml: short-axis mode with the periods 27.38 h and 263 h."""
    return andoyer.Scene.from_toml(SCENES / "apophis.toml").solve()


def toutatis() -> andoyer.Motion:
    """A long-axis mode. The long axis precesses in 7.40 d, and its least angle to the angular momentum is 50.0° (Zhao et al. 2015)."""
    body = andoyer.Body.named("toutatis")
    tilt, (least, _, greatest) = math.radians(50.005), body.moments

    def tumbling(rate: float) -> andoyer.Scene:
        rates = [rate * math.cos(tilt) / least, 0.0, rate * math.sin(tilt) / greatest]
        return andoyer.Scene(body, [0, 0, 0, 1], rates, name="Toutatis, tumbling")

    return tumbling(tumbling(1.0).solve().periods["long-axis"].precession / (7.40 * DAY)).solve()


def satellite() -> andoyer.Motion:
    """A box of 1 × 1.2 × 0.6 m that rotates once a minute, on an orbit of 96 minutes."""
    a, b, c = 1.0, 1.2, 0.6
    box = andoyer.Body([(b * b + c * c) / 12, (a * a + c * c) / 12, (a * a + b * b) / 12])
    orbit = andoyer.Orbit(2 * math.pi / 5760.0, inclination=math.radians(30))
    spin = 2 * math.pi / 60
    rates = [0.1 * spin, 0.05 * spin, spin]
    return andoyer.Scene(box, [0, 0, 0, 1], rates, orbit=orbit, tolerance=1e-3, span=(0, 5760.0), name="A box satellite, gravity gradient").solve()


MOTIONS = {"apophis": apophis, "toutatis": toutatis, "satellite": satellite}


def main() -> None:
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "out")
    folder.mkdir(parents=True, exist_ok=True)
    for name, motion in MOTIONS.items():
        path = folder / f"{name}.html"
        error = page(motion(), path)
        print(f"{path}: {path.stat().st_size / 1e3:.0f} kB, attitude within {error:.1e} rad of the motion")


if __name__ == "__main__":
    main()
