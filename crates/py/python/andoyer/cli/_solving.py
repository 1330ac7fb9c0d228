"""The motion of a scene file, its interval of time, and the exit status that it gives."""

import argparse
import math
import sys
import warnings

import andoyer
from andoyer.cli._arguments import InputError

ROTATIONS = 10
"""Rotations from the epoch that are propagated if neither the scene nor the command line has a span."""

MISSED = 3
"""Exit status of a tolerance that is not met, under --strict."""


def strictly(command: argparse.ArgumentParser) -> None:
    """Add the option that makes a missed tolerance a failure."""
    command.add_argument("--strict", action="store_true", help=f"exit with status {MISSED} if the tolerance is not met")


def read_scene(path: str) -> andoyer.Scene:
    """Read the scene of a file, and print its warnings on stderr."""
    with warnings.catch_warnings(record=True) as doubts:
        warnings.simplefilter("always")
        scene = andoyer.Scene.from_toml(path)
    for doubt in doubts:
        print(f"andoyer: warning: {path}: {doubt.message}", file=sys.stderr)
    return scene


def solved(path: str, *, librates: bool = False) -> andoyer.Motion:
    """Solve the scene of a file, as a libration if asked. A scene without a motion is an error of the file."""
    scene = read_scene(path)
    if librates and scene.method != "libration":
        state = (scene.body, scene.attitude, scene.angular_velocity)
        scene = andoyer.Scene(*state, epoch=scene.epoch, orbit=scene.orbit, tolerance=scene.tolerance, span=scene.span, method="libration")
    with warnings.catch_warnings():
        # `status` says it in one line.
        warnings.simplefilter("ignore", andoyer.ToleranceWarning)
        try:
            return scene.solve()
        except andoyer.Error as error:
            raise InputError(f"{path}: {error}") from error


def status(arguments: argparse.Namespace, motion: andoyer.Motion) -> int:
    """The exit status of a command for this motion. A tolerance that is not met is printed on stderr."""
    missed = motion.plan.missed_tolerance
    if missed is None:
        return 0
    print(f"andoyer: warning: {missed}", file=sys.stderr)
    return MISSED if arguments.strict else 0


def interval(motion: andoyer.Motion, start: float | None, stop: float | None) -> tuple[float, float]:
    """First and last time: the requested ones, or the span of the scene, or ten rotations from the epoch."""
    scene = motion.scene
    if scene.span is not None:
        start, stop = scene.span[0] if start is None else start, scene.span[1] if stop is None else stop
    start = scene.epoch if start is None else start
    if stop is None:
        rotation = motion.periods["long-axis"].precession
        if math.isinf(rotation):
            raise InputError("argument --stop: the body is at rest and has no rotation to count, so a last time must be given")
        stop = start + ROTATIONS * rotation
    if not start <= stop:
        raise InputError(f"argument --stop: {stop!r} is before the first time, {start!r}")
    return start, stop
