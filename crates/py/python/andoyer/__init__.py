"""Attitude of rigid bodies, free and under gravity gradient, in closed form; exact and symbolic perturbation series.

Numerical part: a `Scene` is a `Body` with its state. It is solved into a `Motion`, which is evaluated at any time. With an `Orbit` the gravity gradient
of another body acts. An `Ensemble` is many scenes. Exact part: `NormalForm` is the normal form of the free rigid body to any order, and `normalize` finds
the normal form of any other polynomial Hamiltonian about an equilibrium. Units are any consistent set; angles are in rad. Attitudes are unit quaternions
[x, y, z, w] that rotate body components into inertial ones.

In every docstring "theory §n" is section n of docs/theory.md. docs/scene.md describes the scene file.

>>> import andoyer
>>> scene = andoyer.Scene(andoyer.Body([1.0, 1.5, 2.0]), [0, 0, 0, 1], [0.1, 0.2, 1.0])
>>> motion = scene.solve()
>>> motion.plan.mode
'short-axis'
>>> motion.attitude([0.0, 10.0]).shape
(2, 4)
"""

import importlib as _importlib
from typing import TYPE_CHECKING as _TYPE_CHECKING

from andoyer._core import (
    BirkhoffNormalForm,
    Body,
    CassiniState,
    Dissipation,
    Domain,
    Drift,
    Driven,
    DrivenNormalForm,
    Ensemble,
    Error,
    Evolution,
    EvolutionEnd,
    EvolutionPlan,
    EvolvedStates,
    Field,
    FileError,
    Gravity,
    InputError,
    InternalError,
    Libration,
    LibrationTerm,
    LoadHarmonic,
    Material,
    Motion,
    NormalForm,
    Orbit,
    Orbital,
    Partials,
    Plan,
    Relaxation,
    RelaxedStates,
    RepresentationError,
    Samples,
    Scene,
    TabulatedOrbit,
    TheoryError,
    ToleranceWarning,
    Torque,
    Verification,
    __version__,
    cassini_states,
    normalize,
    separatrix_action,
)
from andoyer.distribution import Distribution
from andoyer.mean import Frequencies, Periods, PeriodsOfMembers

__all__ = [
    "BirkhoffNormalForm",
    "Body",
    "CassiniState",
    "Dissipation",
    "Distribution",
    "Domain",
    "Drift",
    "Driven",
    "DrivenNormalForm",
    "Ensemble",
    "Error",
    "Evolution",
    "EvolutionEnd",
    "EvolutionPlan",
    "EvolvedStates",
    "Field",
    "FileError",
    "Frequencies",
    "Gravity",
    "InputError",
    "InternalError",
    "Libration",
    "LibrationTerm",
    "LoadHarmonic",
    "Material",
    "Motion",
    "NormalForm",
    "Orbit",
    "Orbital",
    "Partials",
    "Periods",
    "PeriodsOfMembers",
    "Plan",
    "Relaxation",
    "RelaxedStates",
    "RepresentationError",
    "Samples",
    "Scene",
    "TabulatedOrbit",
    "TheoryError",
    "ToleranceWarning",
    "Torque",
    "Verification",
    "__version__",
    "cassini_states",
    "normalize",
    "separatrix_action",
]

if not _TYPE_CHECKING:

    def __getattr__(name: str) -> object:
        """`andoyer.fit`, `andoyer.interop`, `andoyer.jax` and `andoyer.output` are imported when they are first used; type checkers want the import written."""
        if name in ("fit", "interop", "jax", "output"):
            return _importlib.import_module(f"andoyer.{name}")
        raise AttributeError(f"module 'andoyer' has no attribute {name!r}")
