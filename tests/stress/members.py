"""Compare the members of ensembles with the scenes that they are, kind by kind, and with themselves in another order, on one thread and after a pickle.

    python tests/stress/members.py                  1,000 members of each of ten kinds, a quarter of an hour of one core
    python tests/stress/members.py --members 50

Exit status 1 for a member that has not the bits of its scene, and for a difference that order, threads or a pickle make.
"""

import argparse
import pickle
import sys
import warnings
from collections.abc import Callable

import numpy as np

import andoyer
from andoyer import Body, Ensemble, Orbit, Scene, TabulatedOrbit, Torque

Random = np.random.Generator
SPAN = (0.0, 60.0)


def state(random: Random) -> tuple[Body, list[float], list[float]]:
    """A body whose moments are not close, an attitude, and rates of a short-axis mode."""
    middle = random.uniform(1.2, 1.6)
    attitude = random.normal(size=4)
    rates = [*random.uniform(-0.1, 0.1, 2), random.uniform(0.8, 1.2)]
    return Body([1.0, middle, random.uniform(middle + 0.1, 1.0 + middle - 0.1)]), list(attitude / np.linalg.norm(attitude)), rates


def ellipse(random: Random) -> Orbit:
    """An orbit that is slow beside the rotation."""
    return Orbit(random.uniform(1e-3, 3e-3), random.uniform(0.0, 0.3), inclination=random.uniform(0, 1))


def nearly_spherical(random: Random) -> tuple[Body, list[float], list[float]]:
    """A state that the averaged theory serves."""
    _, attitude, rates = state(random)
    return Body([1.0, 1.02, 1.05]), attitude, rates


def tensor(random: Random) -> Scene:
    turn, _ = np.linalg.qr(random.normal(size=(3, 3)))
    _, attitude, rates = state(random)
    return Scene(Body.from_inertia(turn @ np.diag([1.0, 1.4, 2.0]) @ turn.T), attitude, rates)


def table(random: Random) -> Scene:
    times = np.linspace(-20.0, 80.0, 51)
    phase, size = 0.05 * times + random.uniform(0, 6), random.uniform(6.5, 7.5)
    positions = size * np.stack([np.cos(phase), np.sin(phase), 0.1 * np.sin(phase)], axis=1)
    return Scene(*state(random), orbit=TabulatedOrbit(times, positions, gm=0.0025 * size**3), span=SPAN, method="integrated", tolerance=1e-9)


def precessing(random: Random) -> Scene:
    orbit = Orbit(2e-3, 0.1, inclination=0.4, node_rate=random.uniform(1e-6, 1e-5))
    return Scene(*nearly_spherical(random), orbit=orbit, span=SPAN, tolerance=1e-6)


def torques(random: Random) -> Scene:
    push = Torque.constant(random.uniform(-1e-3, 1e-3, 3))
    return Scene(*state(random), torques=[push, Torque.damping(1e-3)], span=SPAN, tolerance=1e-9)


def locked(random: Random) -> Scene:
    while True:
        body, orbit = Body([1.0, 1.0 + random.uniform(0.01, 0.02), 1.05]), Orbit(0.1, random.uniform(0.0, 0.01))
        try:
            return Scene.locked(body, orbit, amplitudes=(random.uniform(0, 0.02), 0, 0), span=(0, 6e4), method="libration", tolerance=1e-6)
        except andoyer.TheoryError:
            continue  # one amplitude in a thousand is beyond the range of its series


KINDS: dict[str, Callable[[Random], Scene]] = {
    "free": lambda random: Scene(*state(random)),
    "tensors": tensor,
    "averaged": lambda random: Scene(*nearly_spherical(random), orbit=ellipse(random), span=SPAN, tolerance=1e-5),
    "two bodies": lambda random: Scene(*nearly_spherical(random), orbit=[ellipse(random), ellipse(random)], span=SPAN, tolerance=1e-5),
    "precessing": precessing,
    "one orbit, integrated": lambda random: Scene(*state(random), orbit=ellipse(random), span=SPAN, method="integrated", tolerance=1e-9),
    "table": table,
    "hyperbola": lambda random: Scene(*state(random), orbit=Orbit(0.1, random.uniform(1.2, 1.5)), epoch=-20.0, span=(-20, 20), tolerance=1e-8),
    "torques": torques,
    "locked": locked,
}


def compared(kind: str, members: int, seed: int) -> tuple[int, list[str]]:
    """Members with the bits of their scenes, and what is wrong."""
    random = np.random.default_rng([seed, list(KINDS).index(kind)])
    scenes = [KINDS[kind](random) for _ in range(members)]
    times = np.linspace(*scenes[0].span, 7) if scenes[0].span else np.linspace(0.0, 1e6, 7)
    ensemble = Ensemble.from_scenes(scenes)
    found = ensemble.at(times).attitude
    equal, plans = 0, ensemble.plans
    for scene, rows, plan in zip(scenes, found, plans, strict=True):
        motion = scene.solve()
        equal += bool((motion.attitude(times) == rows).all()) and motion.plan.error_bound == plan.error_bound
    wrong = [] if equal == members else ["members differ from their scenes"]
    others = {
        "another order": Ensemble.from_scenes(scenes[::-1]).at(times).attitude[::-1],
        "one thread": Ensemble.from_scenes(scenes, threads=1).at(times).attitude,
        "a pickle": pickle.loads(pickle.dumps(ensemble)).at(times).attitude,
        "fewer neighbours": Ensemble.from_scenes(scenes[: members // 3]).at(times).attitude,
    }
    wrong += [f"{name} changes members" for name, other in others.items() if not (other == found[: len(other)]).all()]
    return equal, wrong


def main() -> int:
    parser = argparse.ArgumentParser(description="Members of ensembles against their scenes.")
    parser.add_argument("--members", type=int, default=1000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kind", choices=KINDS, help="this one alone")
    options = parser.parse_args()
    warnings.simplefilter("ignore", andoyer.ToleranceWarning)
    failed = False
    print(f"{'kind':24}{'members':>8}{'same bits':>10}")
    for kind in [options.kind] if options.kind else KINDS:
        equal, wrong = compared(kind, options.members, options.seed)
        print(f"{kind:24}{options.members:8}{equal:10}  {'; '.join(wrong)}", flush=True)
        failed |= bool(wrong)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
