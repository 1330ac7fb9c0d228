"""Compare satellites under a dipole and eddy currents in a tilted, turning dipole field over a day with SciPy's DOP853.

    python tests/stress/fields.py                200 random orbits, states, moments and conductivities, half an hour of one core
    python tests/stress/fields.py --cases 10

The reference is integrated twice, with relative tolerances of 1e-12 and 1e-13: the difference is what it leaves unknown. Exit status 1 if an error exceeds the error bound plus ten times that.
"""

import argparse
import sys
import warnings
from pathlib import Path

import numpy as np

import andoyer

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "crates" / "py" / "tests"))
import test_field_torque as field

DAY = 86400.0
warnings.simplefilter("ignore", andoyer.ToleranceWarning)


def case(seed: int) -> tuple[float, float, float] | None:
    """None where the attitude is unknown at the end; otherwise the error of the attitude at the end [rad], the error bound, and what the reference leaves unknown."""
    random = np.random.default_rng([74, seed])
    path = field.orbit(1000 + seed)
    moment, tensor = random.normal(size=3) * 10 ** random.uniform(-2, 0), np.diag(random.uniform(1, 4, size=3)) * 10 ** random.uniform(4, 6)
    start = random.normal(size=4)
    start, rates = start / np.linalg.norm(start), random.normal(size=3) * 10 ** random.uniform(-3, -2.3)
    torques = [andoyer.Torque.dipole(moment, field.earth(path)), andoyer.Torque.eddy(tensor, field.earth(path))]
    try:
        motion = andoyer.Scene(andoyer.Body(field.BODY), start, rates, torques=torques, span=(0, DAY), tolerance=1e-8).solve()
    except andoyer.TheoryError:
        return None

    def torque(b, w):
        return np.cross(moment, b) + np.cross(tensor @ np.cross(w, b), b)

    coarse, fine = (field.integrated(path, torque, start, rates, DAY, rtol, 1e-6 * rtol) for rtol in (1e-12, 1e-13))
    fine = fine[:4] / np.linalg.norm(fine[:4])
    return field.difference(motion.attitude(DAY), fine), motion.plan.error_bound, field.difference(fine, coarse[:4])


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--cases", type=int, default=200)
    asked = parser.parse_args().cases
    found = [row for row in map(case, range(asked)) if row]
    print(f"{asked} cases, {asked - len(found)} of them with an unknown attitude at the end; 5, 50, 95, 100 %:")
    errors, bounds, unknown = np.array(found).T
    for name, values in {
        "error [rad]": errors,
        "error bound [rad]": bounds,
        "reference [rad]": unknown,
        "error / (bound + 10 reference)": errors / (bounds + 10 * unknown),
    }.items():
        print(f"{name:32}", "  ".join(f"{value:.1e}" for value in np.quantile(values, [0.05, 0.5, 0.95, 1])))
    return int((errors > bounds + 10 * unknown).any())


if __name__ == "__main__":
    sys.exit(main())
