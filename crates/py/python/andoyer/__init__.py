"""Rotation of rigid bodies by perturbation series in complex variables.

The exact side is `NormalForm`: the normal form of the free rigid body to any order; `normalize` finds that of any other polynomial
Hamiltonian about an equilibrium. The numerical side is `Scene`, a `Body` with its state,
which is solved into a `Motion` and evaluated at any time; with an `Orbit`, under the gravity gradient of another body; an `Ensemble` is many of
them. No unit is built in; angles are in rad. Attitudes are unit quaternions
[x, y, z, w] that rotate body components into inertial ones.

In every docstring "theory §n" is section n of docs/theory.md, and the scene file is described in docs/scene.md.

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
    Domain,
    Ensemble,
    Error,
    FileError,
    InputError,
    InternalError,
    Motion,
    NormalForm,
    Orbit,
    Partials,
    Plan,
    RepresentationError,
    Samples,
    Scene,
    TabulatedOrbit,
    TheoryError,
    ToleranceWarning,
    __version__,
    normalize,
    separatrix_action,
)
from andoyer.mean import Frequencies, Periods, PeriodsOfMembers

# Names of the errors before this release. They go in the next one; the base stands where an old class held errors of several new ones.
AngularVelocityError = InputError
AttitudeError = InputError
AveragingError = Error
EpochError = InputError
FormatError = FileError
HamiltonianError = Error
IntervalError = InputError
LevelError = InputError
MethodError = InputError
MomentsError = InputError
OrbitError = InputError
OrderError = Error
PeriodsError = InputError
ResonanceError = Error
SceneFileError = FileError
SeparatrixError = TheoryError
SeriesError = Error
ShapeError = InputError
SpanError = InputError
SpinResonanceError = TheoryError
ThreadsError = InputError
TimesError = Error
ToleranceError = InputError
TorqueError = TheoryError
UnitsError = RepresentationError
UnknownBodyError = InputError
UnknownNameError = InputError

__all__ = [
    "BirkhoffNormalForm",
    "Body",
    "Domain",
    "Ensemble",
    "Error",
    "FileError",
    "Frequencies",
    "InputError",
    "InternalError",
    "Motion",
    "NormalForm",
    "Orbit",
    "Partials",
    "Periods",
    "PeriodsOfMembers",
    "Plan",
    "RepresentationError",
    "Samples",
    "Scene",
    "TabulatedOrbit",
    "TheoryError",
    "ToleranceWarning",
    "__version__",
    "normalize",
    "separatrix_action",
]

if not _TYPE_CHECKING:

    def __getattr__(name: str) -> object:
        """`andoyer.fit` and `andoyer.output` are imported when they are first used; type checkers want the import written."""
        if name in ("fit", "output"):
            return _importlib.import_module(f"andoyer.{name}")
        raise AttributeError(f"module 'andoyer' has no attribute {name!r}")
