"""The commands that print: `andoyer plan`, `librations` and `bodies`."""

import argparse
import math

import numpy as np

import andoyer
from andoyer.cli._arguments import InputError, sample_count, time
from andoyer.cli._solving import MISSED, interval, solved, status, strictly
from andoyer.cli._terminal import label

ANGLES = {"rad": 1.0, "deg": math.pi / 180, "arcsec": math.pi / 648000}
"""Units of the amplitudes of a libration, in rad."""


def add_plan(command: argparse.ArgumentParser) -> None:
    """Add the arguments of `andoyer plan`."""
    command.add_argument("scene", metavar="SCENE", help="scene file (TOML)")
    command.add_argument("--verify", action="store_true", help="integrate the full equations, and print the largest error of the attitude")
    command.add_argument("--start", type=time, metavar="T", help="first time of --verify (default: start of the scene's span, or its epoch)")
    command.add_argument("--stop", type=time, metavar="T", help="last time of --verify (default: end of the scene's span)")
    strictly(command)
    command.set_defaults(run=plan)


def plan(arguments: argparse.Namespace) -> int:
    """Print the plan of a scene, the periods of its motion and, on request, its measured error."""
    for option in ("start", "stop"):
        if getattr(arguments, option) is not None and not arguments.verify:
            raise InputError(f"argument --{option}: goes with --verify alone")
    motion = solved(arguments.scene)
    scene = motion.scene
    print(label("scene"), scene.name or arguments.scene)
    print(label("body"), repr(scene.body))
    for line in str(motion.plan).splitlines():
        print(label(line[:13].rstrip()), line[14:])
    print(label("energy"), f"E/E0 {motion.energy_ratio:.8g}, k^2 {motion.elliptic_parameter:.8g}")
    for convention, (precession, rotation) in motion.periods.items():
        print(label("periods"), f"{convention}: P_phi {precession:.10g}, P_psi {rotation:.10g}")
    return max(status(arguments, motion), verified(arguments, motion))


def verified(arguments: argparse.Namespace, motion: andoyer.Motion) -> int:
    """Print the measured error, if it is asked for; return the exit status."""
    asked = arguments.start is not None or arguments.stop is not None
    if not arguments.verify:
        return 0
    verification = motion.verify(interval(motion, arguments.start, arguments.stop) if asked else None)
    print(label("verified"), verification)
    return MISSED if arguments.strict and verification.refuted else 0


def add_librations(command: argparse.ArgumentParser) -> None:
    """Add the arguments of `andoyer librations`."""
    command.add_argument("scene", metavar="SCENE", help="scene file (TOML)")
    command.add_argument("--forced", action="store_true", help="only the terms that the orbit forces")
    command.add_argument("--terms", type=sample_count, default=20, metavar="N", help="number of terms (default: 20)")
    command.add_argument("--unit", choices=list(ANGLES), default="rad", metavar="UNIT", help=f"unit of amplitudes: {', '.join(ANGLES)} (default: rad)")
    strictly(command)
    command.set_defaults(run=librations)


def librations(arguments: argparse.Namespace) -> int:
    """Print the proper modes of a body locked to its orbit, and the largest terms of its three angles."""
    motion = solved(arguments.scene, librates=True)
    libration = motion.libration
    assert libration is not None, "the method is libration"
    unit, size = arguments.unit, ANGLES[arguments.unit]
    print(label("resonance"), f"{motion.plan.resonance} rotations an orbit, order {motion.plan.order}, error bound {motion.plan.error_bound:.1e} rad")
    print(label("periods"), "in the unit of time of the scene, in the frame that turns with the resonance")
    modes = zip(("longitude", "pole, first", "pole, second"), libration.periods, libration.amplitudes, libration.phases, strict=True)
    for name, period, amplitude, phase in modes:
        print(label(name), f"period {period:.10g}, amplitude {amplitude / size:.6e} {unit}, phase {phase:.6f} rad")
    heading = f"amplitude [{unit}]"
    print(f"{'angle':10} {'modes and M':>14} {'period':>17} {heading:>18} {'phase [rad]':>12}")
    for term in (libration.forced() if arguments.forced else libration.terms())[: arguments.terms]:
        multiples = " ".join(f"{k:2d}" for k in term.multiples)
        print(f"{term.angle:10} {multiples:>14} {term.period:17.10g} {term.amplitude / size:18.8e} {term.phase:12.6f}")
    return status(arguments, motion)


def bodies(_arguments: argparse.Namespace) -> int:
    """Print the catalogue."""
    print(f"{'name':10} {'A/C':>10} {'B/C':>10} {'beta':>10}  source")
    for name in andoyer.Body.catalogue():
        body = andoyer.Body.named(name)
        a, b, c = np.sort(body.moments)
        print(f"{name:10} {a / c:10.8f} {b / c:10.8f} {body.beta:10.8f}  {andoyer.Body.source(name)}")
    return 0
