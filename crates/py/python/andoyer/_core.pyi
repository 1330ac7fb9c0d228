# Types of the compiled core. Docstrings here are the first lines of those at run time, which say the rest; a test holds the two together.
import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from fractions import Fraction
from typing import Any, Literal, TypeAlias, final, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray
from pandas import DataFrame  # type: ignore[import-untyped, import-not-found, unused-ignore]
from scipy.spatial.transform import Rotation  # type: ignore[import-untyped, import-not-found, unused-ignore]
from xarray import Dataset  # type: ignore[import-untyped, import-not-found, unused-ignore]

from andoyer.distribution import Distribution
from andoyer.mean import Frequencies, Periods, PeriodsOfMembers

_Array: TypeAlias = NDArray[np.float64]
_Gaussian: TypeAlias = tuple[Fraction, Fraction]
_Form: TypeAlias = dict[tuple[int, int, int], _Gaussian]
_Number: TypeAlias = Fraction | float
_Polynomial: TypeAlias = dict[tuple[int, ...], Fraction] | dict[tuple[int, ...], float]
# A text, a dictionary of coefficients by exponents, or a SymPy expression.
_Expression: TypeAlias = str | dict[tuple[int, ...], Any] | Any

__version__: str

class Error(ValueError):
    """The base of every error of this package."""

    argument: str | None
    value: Any
    bound: Any
    index: int  # only for a member of an ensemble: its number

class FileError(Error):
    """A scene file or a JSON text that cannot be read."""

class InputError(Error):
    """An invalid argument."""

class InternalError(Error):
    """A fault of this package: no input should lead to it."""

class RepresentationError(Error):
    """Units, times or orders that doubles, exact rationals or memory cannot hold."""

class TheoryError(Error):
    """No theory holds: series near the separatrix, a spin resonance, a torque that is too strong, a motion that cannot be averaged, a small divisor, or a Hamiltonian that cannot be diagonalized."""

class ToleranceWarning(UserWarning):
    """The error bound of a motion, or of members of an ensemble, exceeds the tolerance over the span, or that of an evolution a tenth of its angular momentum."""

@final
class Body:
    """A rigid body, given by its principal moments of inertia."""

    def __new__(cls, moments: ArrayLike, *, name: str | None = None, gravity: Gravity | None = None) -> Body: ...
    @staticmethod
    def from_inertia(tensor: ArrayLike, *, name: str | None = None, gravity: Gravity | None = None) -> Body:
        """A body from its inertia tensor about axes that you choose. Attitudes, rates, momenta and derivatives of its scenes are about these axes."""
    @staticmethod
    def ellipsoid(a: float, b: float, c: float, *, mass: float = 1.0, name: str | None = None) -> Body:
        """A homogeneous ellipsoid with semi-axes a, b, c along body axes 1, 2, 3. Its moments are m (b² + c²)/5, m (a² + c²)/5, m (a² + b²)/5."""
    @staticmethod
    def box(x: float, y: float, z: float, *, mass: float = 1.0, name: str | None = None) -> Body:
        """A homogeneous box with edges x, y, z along body axes 1, 2, 3. Its moments are m (y² + z²)/12, m (x² + z²)/12, m (x² + y²)/12."""
    def period_ratios(
        self,
        mode: Literal["short-axis", "long-axis"] = "short-axis",
        *,
        convention: Literal["extremal-axis", "long-axis", "short-axis"] = "extremal-axis",
    ) -> tuple[float, float]:
        """The interval of the ratios P_ψ/P_φ that this body can have in a mode. Each ratio in the interval belongs to one motion."""
    @staticmethod
    def named(name: str) -> Body:
        """A body of the catalogue."""
    @staticmethod
    def catalogue() -> list[str]:
        """The names of the catalogue, which `Body.named` accepts."""
    @staticmethod
    def source(name: str) -> str:
        """The source of the figures of a catalogue body."""
    @property
    def moments(self) -> _Array:
        """The moments of inertia about body axes 1, 2, 3 in the given order: a read-only array, shape (3,)."""
    @property
    def has_tensor(self) -> bool:
        """Whether the body was made by `from_inertia`. `Motion.partials` then has twelve parameters instead of nine."""
    @property
    def inertia(self) -> _Array:
        """The inertia tensor about the user's axes: a read-only array, shape (3, 3). It is diagonal unless the body was made by `from_inertia`."""
    @property
    def principal_axes(self) -> _Array:
        """The principal axes in the user's components, as the columns of a rotation matrix in the order of `moments`: a read-only array, shape (3, 3)."""
    @property
    def alpha(self) -> float:
        """Asphericity α = [(C/A − 1) + (C/B − 1)]/2 of the sorted moments A ≤ B ≤ C (theory §1); 0 for a sphere."""
    @property
    def beta(self) -> float:
        """Triaxiality β, 0 ≤ β ≤ 1 (theory §1); 0 for A = B and for a sphere, 1 for B = C."""
    @property
    def gamma(self) -> float:
        """γ = √((C/A − 1)(C/B − 1)) (theory §1)."""
    @property
    def omega(self) -> float:
        """ω = √((1 + β)/(1 − β)) (theory §1); 1 for a sphere, infinite for B = C."""
    @property
    def name(self) -> str | None:
        """The name, or None."""
    @property
    def gravity(self) -> Gravity | None:
        """The gravity field of degree 3 and 4, or None."""
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __copy__(self) -> Body: ...
    def __deepcopy__(self, _memo: Any) -> Body: ...

@final
class Orbit:
    """The relative Keplerian orbit of a body whose gravity gradient acts on the rotating body (theory §9)."""

    def __new__(
        cls,
        mean_motion: float,
        eccentricity: float = 0.0,
        *,
        time_of_pericentre: float = 0.0,
        inclination: float = 0.0,
        node: float = 0.0,
        argument_of_pericentre: float = 0.0,
        mass_fraction: float = 1.0,
        node_rate: float = 0.0,
        pericentre_rate: float = 0.0,
        attraction: float | None = None,
        semi_major_axis: float | None = None,
    ) -> Orbit: ...
    @staticmethod
    def from_state(position: ArrayLike, velocity: ArrayLike, gm: float, time: float | Any, *, mass_fraction: float = 1.0) -> Orbit:
        """The Keplerian orbit through a position with a velocity at a time: an ellipse or a hyperbola."""
    def position(self, times: ArrayLike | Any) -> _Array:
        """The positions at some times, in inertial components and in the unit of the semi-major axis."""
    @staticmethod
    def around_oblate(
        gm: float,
        semi_major_axis: float,
        eccentricity: float,
        inclination: float,
        *,
        j2: float,
        radius: float,
        node: float = 0.0,
        argument_of_pericentre: float = 0.0,
        time_of_pericentre: float = 0.0,
    ) -> Orbit:
        """The orbit of a satellite about an oblate primary from its mean elements, with its secular rates of first order in J2 (Kaula, Theory of Satellite Geodesy, 1966, chapter 3)."""
    @property
    def mean_motion(self) -> float:
        """Mean motion n, in rad per unit of time."""
    @property
    def eccentricity(self) -> float:
        """Eccentricity: less than 1 for an ellipse, above 1 for a hyperbola."""
    @property
    def time_of_pericentre(self) -> float:
        """A time of passage through the pericentre."""
    @property
    def inclination(self) -> float:
        """Inclination of the orbit plane, in rad."""
    @property
    def node(self) -> float:
        """Longitude of the ascending node, in rad."""
    @property
    def argument_of_pericentre(self) -> float:
        """Argument of the pericentre, from the node, in rad."""
    @property
    def mass_fraction(self) -> float:
        """Disturbing mass divided by the sum of both masses."""
    @property
    def node_rate(self) -> float:
        """Secular rate of the node, in rad per unit of time."""
    @property
    def pericentre_rate(self) -> float:
        """Secular rate of the argument of the pericentre, in rad per unit of time."""
    @property
    def attraction(self) -> float:
        """G × disturbing mass / a³, in 1/time²: by default mean_motion² × mass_fraction."""
    @property
    def semi_major_axis(self) -> float | None:
        """Semi-major axis a, in units of length, or None."""
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...
    def __copy__(self) -> Orbit: ...
    def __deepcopy__(self, _memo: Any) -> Orbit: ...

@final
class TabulatedOrbit:
    """A table of the position of a disturbing body relative to the rotating body. Only the integrated method uses it."""

    def __new__(cls, times: ArrayLike | Any, positions: ArrayLike, gm: float, *, velocities: ArrayLike | None = None) -> TabulatedOrbit: ...
    @classmethod
    def from_spk(
        cls,
        files: str | os.PathLike[str] | Sequence[str | os.PathLike[str]],
        target: int | str,
        observer: int | str,
        span: ArrayLike | Sequence[Any],
        *,
        gm: float,
        frame: str = "J2000",
        error: float = 1e-09,
        epoch: float | Any | None = None,
    ) -> TabulatedOrbit:
        """The orbit of a body from SPICE's ephemerides (SPK of type 2, 3, 9 or 13), read without SpiceyPy. Rows with velocities have the longest step that keeps the error."""
    @property
    def times(self) -> _Array:
        """The times, a read-only array of shape (n,)."""
    @property
    def positions(self) -> _Array:
        """The positions, a read-only array of shape (n, 3)."""
    @property
    def velocities(self) -> _Array | None:
        """The velocities, a read-only array of shape (n, 3), or None."""
    @property
    def gm(self) -> float:
        """G × mass of the disturbing body."""
    def position(self, time: float) -> _Array:
        """The position at a time within the table: an array of shape (3,)."""
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...
    def __copy__(self) -> TabulatedOrbit: ...
    def __deepcopy__(self, _memo: Any) -> TabulatedOrbit: ...

@final
class Gravity:
    """The gravity field of a rotating body of degree 3 and 4, for `Body(..., gravity=...)`. Disturbing bodies exert torques on it beside the gravity gradient; a scene with them is integrated."""

    def __new__(cls, coefficients: dict[str, float], radius: float, *, inertia_factor: float | None = None) -> Gravity: ...
    @classmethod
    def named(cls, name: str) -> Gravity:
        """The field of a body by its name."""
    @classmethod
    def ellipsoid(cls, a: float, b: float, c: float, *, radius: float | None = None) -> Gravity:
        """The field of degree 4 of a homogeneous ellipsoid with semi-axes a, b, c along body axes 1, 2, 3 (G. Balmino 1994). That of degree 3 is 0."""
    @property
    def coefficients(self) -> dict[str, float]:
        """The coefficients by their names, as they were given."""
    @property
    def radius(self) -> float:
        """The reference radius."""
    @property
    def inertia_factor(self) -> float | None:
        """C/(M R²) as it was given, or None."""
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...
    def __copy__(self) -> Gravity: ...
    def __deepcopy__(self, _memo: Any) -> Gravity: ...

@final
class Field:
    """A magnetic field along an orbit, for `Torque.dipole` and `Torque.eddy`. It is made by one of the class methods below."""

    @classmethod
    def dipole(cls, *, radius: float, equatorial: float, orbit: Orbit, axis: ArrayLike = (0, 0, 1), rotation_rate: float = 0.0) -> Field:
        """The field of a dipole in the centre of a planet, B_e (R/r)³ (3 (m·r) r − m) with the unit vectors m of its moment and r of the position."""
    @classmethod
    def table(cls, times: ArrayLike | Any, vectors: ArrayLike) -> Field:
        """A table of the field at the body, of any model."""
    def at(self, times: ArrayLike) -> _Array:
        """The field at times, in inertial components."""
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __copy__(self) -> Field: ...
    def __deepcopy__(self, _memo: Any) -> Field: ...

@final
class Torque:
    """A torque beside the gravity gradient, in body axes. It is made by one of the class methods below. A scene with torques is integrated: it needs a span."""

    @classmethod
    def constant(cls, torque: ArrayLike) -> Torque:
        """A constant torque."""
    @classmethod
    def damping(cls, damping: ArrayLike) -> Torque:
        """The torque −Dω, with the angular velocity relative to inertial space."""
    @classmethod
    def rotor(cls, momentum: ArrayLike) -> Torque:
        """Rotors with a constant angular momentum relative to the body: a gyrostat. The torque is −ω × h."""
    @classmethod
    def dipole(cls, moment: ArrayLike | Sequence[str], field: Field | ArrayLike) -> Torque:
        """m × B of a magnetic moment fixed in the body, or commanded by the rates and the field."""
    @classmethod
    def eddy(cls, conductivity: ArrayLike, field: Field | ArrayLike) -> Torque:
        """(K(ω × B)) × B of eddy currents in a conducting body, with the magnetic tensor K (N. Ortiz Gómez and S. J. I. Walker 2015): it brakes the rotation across the field."""
    @classmethod
    def dissipation(cls, loss: Dissipation | Callable[[float], float]) -> Torque:
        """Internal friction, which takes energy at constant angular momentum: a term of `Scene.evolve` and `Scene.drift` alone. A scene with it is not solved."""
    @classmethod
    def polynomial(
        cls,
        texts: Sequence[str],
        *,
        sources: dict[str, Orbit | TabulatedOrbit | Field | ArrayLike] | None = None,
        distance_powers: dict[str, float] | None = None,
        reference_distances: dict[str, float] | None = None,
    ) -> Torque:
        """Three polynomials in directions and rates, times powers of distances."""
    @classmethod
    def from_facets(
        cls,
        vertices: ArrayLike | str | os.PathLike[str],
        triangles: ArrayLike | None = None,
        *,
        specular: float = 0.0,
        diffuse: float = 0.0,
        emission: float = 1.0,
        pressure: float,
        source: Orbit | TabulatedOrbit | ArrayLike,
        at: float | None = None,
        degree: int = 8,
        scale: float = 1.0,
    ) -> Torque:
        """The torque of light on a shape of triangles, as polynomials in the direction to the light (weak torques, section 3). The shape casts no shadows on itself."""
    @classmethod
    def panels(
        cls,
        normals: ArrayLike,
        areas: ArrayLike,
        centroids: ArrayLike,
        *,
        two_sided: bool = False,
        specular: ArrayLike = 0.0,
        diffuse: ArrayLike = 0.0,
        emission: ArrayLike = 1.0,
        pressure: float,
        source: Orbit | TabulatedOrbit | ArrayLike,
        at: float | None = None,
        degree: int = 8,
    ) -> Torque:
        """The torque of light on flat plates, as polynomials in the direction to the light, without shadows."""
    @classmethod
    def sphere(
        cls,
        table: Callable[[_Array], ArrayLike] | ArrayLike,
        *,
        source: Orbit | TabulatedOrbit | ArrayLike,
        at: float | None = None,
        power: float = 2.0,
        law: Callable[[_Array], ArrayLike] | None = None,
        degree: int = 8,
    ) -> Torque:
        """The torque with given values for all directions to a source, as polynomials."""
    def value(self, u: ArrayLike) -> _Array:
        """The torque for directions to its source, at the reference distance."""
    @property
    def degree(self) -> int:
        """The largest degree in directions and rates."""
    @property
    def truncation(self) -> float:
        """What the polynomials of a shape leave out: root mean square over all directions, relative to that of the torque; 0 for torques that are not made of shapes."""
    @property
    def kind(self) -> Literal["constant", "damping", "rotor", "polynomial", "dissipation"]:
        """The kind: "constant", "damping", "rotor", "polynomial" or "dissipation"."""
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __copy__(self) -> Torque: ...
    def __deepcopy__(self, _memo: Any) -> Torque: ...

@final
class Scene:
    """A body, its state at an epoch, and the requested accuracy of the solution."""

    def __new__(
        cls,
        body: Body,
        attitude: ArrayLike | Rotation,
        angular_velocity: ArrayLike,
        *,
        epoch: float | Any = 0.0,
        orbit: Orbit | TabulatedOrbit | Sequence[Orbit | TabulatedOrbit] | None = None,
        tolerance: float = 1e-12,
        method: Literal["auto", "series", "closed", "integrated", "libration"] = "auto",
        order: int | None = None,
        span: ArrayLike | None = None,
        averaging: Literal["auto", "orbit", "spin"] = "auto",
        level: Literal["auto", "full", "second-order", "moving", "paper"] = "auto",
        torques: Torque | Sequence[Torque] | None = None,
        name: str | None = None,
        source: str | None = None,
        scalar_first: bool = False,
    ) -> Scene: ...
    @classmethod
    def from_periods(
        cls,
        body: Body,
        precession: float,
        rotation: float,
        *,
        mode: Literal["short-axis", "long-axis"] = "short-axis",
        convention: Literal["extremal-axis", "long-axis", "short-axis"] = "extremal-axis",
        momentum_direction: ArrayLike | None = None,
        phases: ArrayLike | None = None,
        epoch: Any = None,
        attitude: Any = None,
        sense: float | None = None,
        **options: Any,
    ) -> Scene:
        """The scene of a torque-free body that tumbles with these periods (theory §7). In each mode there is one such motion."""
    @classmethod
    def from_andoyer(cls, body: Body, andoyer: ArrayLike, *, epoch: Any = None, **options: Any) -> Scene:
        """The scene with given Andoyer variables at the epoch (theory §1). It is the inverse of `Motion.andoyer`."""
    @classmethod
    def locked(
        cls,
        body: Body,
        orbit: Orbit,
        *,
        resonance: float | Fraction = 1,
        amplitudes: ArrayLike = (0.0, 0.0, 0.0),
        phases: ArrayLike = (0.0, 0.0, 0.0),
        epoch: Any = 0.0,
        **options: Any,
    ) -> Scene:
        """The scene of a body that is locked to an orbit: relaxed, or with free librations (docs: locked rotation)."""
    @classmethod
    def from_orbital(
        cls,
        body: Body,
        attitude: ArrayLike,
        angular_velocity: ArrayLike,
        *,
        orbit: Orbit | TabulatedOrbit | Sequence[Orbit | TabulatedOrbit],
        elements_of: Literal["rotating", "disturbing"],
        frame: Literal["rtn", "lvlh"] = "rtn",
        relative: bool = True,
        sequence: str = "ZYX",
        epoch: Any = 0.0,
        of: int = 0,
        **options: Any,
    ) -> Scene:
        """The scene of a state that is given against the orbital frame. It is the inverse of `Motion.orbital`."""
    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> Scene:
        """Reads a scene from a TOML file."""
    def to_toml(self) -> str:
        """Writes the scene as TOML text. `from_toml` reads this text from a file as an equal scene."""
    def drift(self, *, average: Literal["auto", "orbit", "spin"] = "auto") -> Drift:
        """The mean rates of angular momentum, excess of energy, spin period and obliquity at the epoch: torques averaged over the rotation (weak torques, section 1)."""
    def evolve(
        self,
        span: ArrayLike | None = None,
        *,
        average: Literal["auto", "orbit", "spin"] = "auto",
        tolerance: float = 1e-06,
        members: int | None = None,
        progress: Callable[[int, int], object] | None = None,
    ) -> Evolution:
        """The motion averaged over the rotation, over years to millions of years: angular momentum and excess of energy, without attitude and phases."""
    def solve(self) -> Motion:
        """Solves the scene: computes everything that does not depend on time, and returns the motion."""
    @property
    def body(self) -> Body:
        """The body."""
    @property
    def attitude(self) -> _Array:
        """The attitude at the epoch: unit quaternion [x, y, z, w], normalized, a read-only array of shape (4,)."""
    @property
    def angular_velocity(self) -> _Array:
        """The angular velocity at the epoch, in body components, in rad per unit of time: a read-only array of shape (3,)."""
    @property
    def epoch(self) -> float:
        """The time of the state."""
    @property
    def tolerance(self) -> float:
        """The requested attitude error, in rad."""
    @property
    def method(self) -> Literal["auto", "series", "closed", "integrated", "libration"]:
        """The method: "auto", "series", "closed", "integrated" or "libration"."""
    @property
    def order(self) -> int | None:
        """The fixed order of the series, or None."""
    @property
    def span(self) -> tuple[float, float] | None:
        """The span, the times over which the tolerance is requested: (start, stop), or None."""
    @property
    def orbit(self) -> Orbit | TabulatedOrbit | tuple[Orbit | TabulatedOrbit, ...] | None:
        """The orbit of the disturbing body, an `Orbit` or a `TabulatedOrbit`; of several a tuple of them; or None."""
    @property
    def averaging(self) -> Literal["auto", "orbit", "spin"]:
        """The averaging: "auto", "orbit" or "spin"."""
    @property
    def level(self) -> Literal["auto", "full", "second-order", "moving", "paper"]:
        """The level: "auto", "full", "second-order", "moving" or "paper"."""
    @property
    def torques(self) -> tuple[Torque, ...]:
        """The torques beside the gravity gradient, a tuple."""
    @property
    def name(self) -> str | None:
        """The name, or None."""
    @property
    def source(self) -> str | None:
        """The source of the figures, or None."""
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...
    def __copy__(self) -> Scene: ...
    def __deepcopy__(self, _memo: Any) -> Scene: ...

@final
class Motion:
    """A solved motion, from `Scene.solve`. It is immutable, and several threads can evaluate it in parallel."""

    def at(self, times: ArrayLike, *, scalar_first: bool = False) -> Samples:
        """Evaluates attitudes and angular velocities in one pass."""
    def attitude(self, times: ArrayLike, out: _Array | None = None, *, scalar_first: bool = False) -> _Array:
        """Evaluates attitudes: unit quaternions [x, y, z, w] that rotate body components into inertial ones (theory §8)."""
    def angular_velocity(self, times: ArrayLike, out: _Array | None = None) -> _Array:
        """Evaluates angular velocities in body components, in rad per unit of time."""
    def angular_momentum(self, times: ArrayLike) -> _Array:
        """Evaluates the angular momentum in inertial components, in the unit of moment × rate. It is constant unless the scene has an orbit or torques."""
    def andoyer(self, times: ArrayLike) -> _Array:
        """Evaluates the Andoyer variables (λ, μ, ν, Λ, M, N) (theory §1)."""
    def rotation(self, times: ArrayLike) -> Rotation:
        """Evaluates attitudes as a `scipy.spatial.transform.Rotation`, body to inertial. This method imports SciPy."""
    def partials(
        self,
        times: ArrayLike,
        with_respect_to: str | tuple[str, int] | Sequence[str | tuple[str, int]] = ("attitude", "angular_velocity", "moments"),
    ) -> Partials:
        """Evaluates the derivatives of attitude and angular velocity with respect to the initial state, the moments, and the orbits of disturbing bodies (theory §12)."""
    def scene_at(self, time: float | Any) -> Scene:
        """The scene of the state at a time: the same body, disturbing bodies and options, with this time as the epoch."""
    def verify(self, span: ArrayLike | None = None, samples: int = 64, *, tolerance: float | None = None) -> Verification:
        """Measures the error of the attitude: integrates the full equations from the epoch and compares the attitudes."""
    def to_code(self, language: Literal["c", "rust", "python", "javascript"] = "c") -> str:
        """Writes a source file with a self-contained function `rotation(time)` that evaluates this motion (theory §8)."""
    def _code(self, language: Literal["c", "rust", "python", "javascript"]) -> tuple[str, float, float]:
        """The source file, and the bounds of the differences in its head: of the attitude [rad], and of the angular velocity divided by its length."""
    @property
    def plan(self) -> Plan:
        """The plan: method, order, error bound and other facts about this motion."""
    def orbital(
        self,
        times: ArrayLike | Any,
        *,
        elements_of: Literal["rotating", "disturbing"],
        frame: Literal["rtn", "lvlh"] = "rtn",
        sequence: str = "ZYX",
        of: int = 0,
    ) -> Orbital:
        """Attitudes and angular velocities against the orbital frame."""
    @property
    def libration(self) -> Libration | None:
        """The proper modes and the terms of a body locked to its orbit: a `Libration`, or None if the method is not "libration"."""
    @property
    def scene(self) -> Scene:
        """The scene that was solved."""
    @property
    def frequencies(self) -> Frequencies:
        """Mean frequencies dℓ′/dt, dy′/dt (theory §7): a named tuple (anomaly, longitude), in rad per unit of time."""
    @property
    def periods(self) -> dict[Literal["long-axis", "short-axis", "extremal-axis"], Periods]:
        """Mean periods (P_φ, P_ψ) in three conventions: a dict with the keys "long-axis", "short-axis" and "extremal-axis"."""
    @property
    def energy_ratio(self) -> float:
        """E/E0: the rotational energy divided by the energy of rotation about the axis of greatest inertia with the same angular momentum (theory §5)."""
    @property
    def elliptic_parameter(self) -> float:
        """k², the parameter of the elliptic functions of the polhode (theory §10): 0 for rotation about a principal axis, 1 on the separatrix."""
    def __copy__(self) -> Motion: ...
    def __deepcopy__(self, _memo: Any) -> Motion: ...

@final
class Plan:
    """The method, order, error bound and other facts about a motion, from `Motion.plan`. ``str(plan)`` is a table."""

    @property
    def mode(self) -> Literal["short-axis", "long-axis", "separatrix", "axisymmetric", "spherical", "principal-axis", "at-rest"]:
        """The kind of motion: "short-axis", "long-axis", "separatrix", "axisymmetric", "spherical", "principal-axis" or "at-rest"."""
    @property
    def method(self) -> Literal["series", "closed", "integrated", "libration"]:
        """The method of evaluation: "series", "closed" for theta functions and elementary formulas, "integrated" or "libration"."""
    @property
    def order(self) -> int:
        """Order N of the series, or of the steps of an integration. It is 0 if there is no series, or if the harmonic oscillator alone meets the tolerance."""
    @property
    def steps(self) -> int:
        """Number of steps of the integration; 0 for the other methods."""
    @property
    def resonance(self) -> Fraction | None:
        """The resonance of a libration, in rotations an orbit: a Fraction; None for the other methods."""
    @property
    def known(self) -> tuple[float, float] | None:
        """The first and the last time at which the error bound is below half a turn, of a member of an ensemble with ``errors="nan"`` that is not served over its whole span; otherwise None."""
    @property
    def harmonics(self) -> int:
        """The number of harmonics of a libration; otherwise the highest multiple of the anomaly ℓ′ in the evaluation, or 0 if the method has no harmonics."""
    @property
    def error_bound(self) -> float:
        """Estimated bound of the attitude error over the span, in rad; it is not proved. It includes truncation, dropped harmonics and rounding."""
    @property
    def rate_error_bound(self) -> float:
        """Estimated bound of the error of the angular velocity over the span, in body components, in rad per unit of time: twice the largest rate times the error bound of the attitude."""
    @property
    def tolerance(self) -> float:
        """The requested attitude error over the span, in rad."""
    @property
    def meets_tolerance(self) -> bool:
        """True if the error bound is at most the tolerance. If the tolerance is below the rounding error of doubles, the bound must be at most 2e-14 rad."""
    @property
    def missed_tolerance(self) -> str | None:
        """The text of the `ToleranceWarning` if the tolerance is not met, otherwise None."""
    @property
    def separatrix_ratio(self) -> float:
        """σ/σ_sep (theory §5): 0 for rotation about the axis of the mode, 1 on the separatrix."""
    @property
    def averaging(self) -> Literal["orbit", "spin"] | None:
        """The averaging of a scene with an orbit: "orbit" or "spin" (theory §9); None without an orbit and for an integrated motion."""
    @property
    def level(self) -> Literal["full", "second-order", "moving", "paper"] | None:
        """The level of the gravity-gradient theory: "full", "second-order", "moving" or "paper" (theory §9); None without an orbit and for an integrated motion."""
    @property
    def torque(self) -> float:
        """The size of the torque: the sum of the short-period corrections of the averaged theory, in rad; 0 without an orbit, and for an integrated or a locked motion, which has none."""
    @property
    def first_neglected(self) -> float:
        """The first neglected term of the gravity gradient, in rad: a short-period term of second order in the torque, which no level has, or one of first order that was dropped; 0 without an orbit."""
    @property
    def partials(self) -> Literal["closed", "series", "variational"] | None:
        """The method of `Motion.partials`: "closed" (theory §12); "series", power series in time where the closed form cancels: next to a sphere, to the separatrix and to the middle axis, and for a body from a tensor also with nearly equal moments; "variational" equations, integrated from the epoch, for a scene with a torque (farther from the epoch of an averaged motion than 2,500 steps, some 200 rotations, differences of fourth order of motions by the same theory, with an error of some 1e-9 of the largest derivative; with respect to an element of an orbit the error of the theory counts, up to 3e-5); or None on the separatrix, where the derivatives do not exist."""
    @property
    def skipped(self) -> list[str]:
        """The steps that this scene did not need, with the reasons: a list of str."""
    def __eq__(self, other: object, /) -> bool: ...
    __hash__: None  # type: ignore[assignment]
    def __copy__(self) -> Plan: ...
    def __deepcopy__(self, _memo: Any) -> Plan: ...

@final
class Libration:
    """The libration of a body whose rotation is locked to its orbit, from `Motion.libration`."""

    @property
    def frequencies(self) -> _Array:
        """Rates of the proper modes, longitude first and then the two of the pole, in rad per unit of time, shape (3,)."""
    @property
    def periods(self) -> _Array:
        """Proper periods in the unit of time, shape (3,). They are those in the frame that turns with the resonance."""
    @property
    def amplitudes(self) -> _Array:
        """The largest angle of each proper mode, in rad, shape (3,)."""
    @property
    def phases(self) -> _Array:
        """The phase of this angle at the epoch, in rad, shape (3,); 0 for a mode without amplitude."""
    @property
    def obliquity(self) -> float:
        """The obliquity of a Cassini state, from the orbit's normal to axis 3 of the frame in which the body librates, in rad; 0 if the node is fixed."""
    @property
    def residual(self) -> float:
        """What the series leaves in the equations of motion, as an angle in rad; it is part of the error bound."""
    @property
    def mean_motion(self) -> float:
        """The mean motion of the orbit that locks the body, in rad per unit of time."""
    def terms(self) -> list[LibrationTerm]:
        """All terms, the largest first."""
    def forced(self) -> list[LibrationTerm]:
        """The terms without proper modes, which the orbit forces, the largest first: the table that papers print."""

@final
class LibrationTerm:
    """A term of a libration: amplitude · sin(phase + 2π (t − epoch)/period)."""

    @property
    def multiples(self) -> tuple[int, ...]:
        """Multiples of the three proper angles and of the mean anomaly M; if the node moves, a fifth one of the angle r M + ω + ψ₀ from the node."""
    @property
    def period(self) -> float:
        """The period in the unit of time, positive also where the rate of the multiples is negative; infinite for a constant."""
    @property
    def amplitude(self) -> float:
        """The amplitude, in rad."""
    @property
    def phase(self) -> float:
        """The phase at the epoch, in rad, from −π to π."""
    @property
    def angle(self) -> Literal["longitude", "pole-1", "pole-2"]:
        """The angle that has this term: "longitude" (ψ), "pole-1" (θ) or "pole-2" (φ)."""

@final
class Samples:
    """Attitudes and angular velocities of a motion or an ensemble at given times, from `Motion.at` or `Ensemble.at`; those of any other origin come from `Samples.from_arrays`."""

    @staticmethod
    def from_arrays(
        times: ArrayLike | Any,
        attitudes: ArrayLike | Any,
        angular_velocity: ArrayLike | Any | None = None,
        *,
        epoch: Any = None,
        scalar_first: bool = False,
    ) -> Samples:
        """Samples from arrays of any origin: a star tracker, another propagator. They go where the samples of a motion go: tables, CK, AEM, pictures, `fit.attitudes`."""
    @property
    def times(self) -> Any:
        """The times, float64, shape (n,), or (m, n) for an ensemble whose members have their own times. Times of astropy are returned as given."""
    @property
    def errors(self) -> dict[int, Error]:
        """The errors of members whose samples are NaN, by index, for an ensemble with ``errors="nan"``; otherwise empty."""
    @property
    def attitude(self) -> _Array:
        """Unit quaternions [x, y, z, w] that rotate body components into inertial ones, shape (n, 4) or (m, n, 4)."""
    @property
    def angular_velocity(self) -> _Array:
        """Angular velocities in body components, in rad per unit of time, shape (n, 3) or (m, n, 3)."""
    @property
    def scalar_first(self) -> bool:
        """True if the quaternions are [w, x, y, z]."""
    def to_pandas(self) -> DataFrame:
        """Converts the samples to a pandas table with the columns qx, qy, qz, qw, wx, wy, wz, indexed by time or by member and time. This method imports pandas."""
    def to_xarray(self) -> Dataset:
        """Converts the samples to an xarray data set: attitude and angular_velocity by (member,) time, and quaternion or axis. This method imports xarray."""
    def __len__(self) -> int: ...

@final
class Drift:
    """Mean rates of a scene, from `Scene.drift`."""

    @property
    def momentum(self) -> _Array:
        """Rate of the angular momentum, inertial, in moment × rate²: a read-only array of shape (3,)."""
    @property
    def excess(self) -> float:
        """Rate of the excess of energy ξ (`Evolution`), in 1/time."""
    @property
    def spin_period(self) -> float:
        """Rate of the spin period, a plain number."""
    @property
    def obliquity(self) -> float | None:
        """Rate of the obliquity, in rad/time; None without an orbit."""
    @property
    def by_degree(self) -> list[tuple[_Array, float]]:
        """Rates of momentum and excess by the harmonics of each degree, from 0: tuples (momentum (3,), excess)."""
    @property
    def wobble_rate(self) -> float:
        """Growth rate of a small excess of energy, in 1/time: uniform rotation about the axis of the mode is unstable if it is positive."""
    def __eq__(self, other: object, /) -> bool: ...
    def __copy__(self) -> Drift: ...
    def __deepcopy__(self, _memo: Any) -> Drift: ...

@final
class Evolution:
    """The motion averaged over the rotation, from `Scene.evolve`. It has no attitude and no phases."""

    def at(self, times: Any) -> EvolvedStates:
        """The averaged state at times of the span, up to the end of the evolution."""
    def motion_at(self, time: float | Any, phases: ArrayLike) -> Scene:
        """A scene at a time whose averaged motion this is: torques, orbits and options are those of `scene`, without a span. The averages do not contain the phases, so they are given; what the averages leave out at these phases is added to them."""
    def through(self, members: int = 64, seed: int = 0) -> list[tuple[float, Evolution]]:
        """What becomes of it beyond the separatrix, where the mode depends on phases that the averages have lost: members with evenly spread phases pass it by the full equations, and each outcome goes on in averages."""
    @property
    def end(self) -> EvolutionEnd:
        """Why and when it ends."""
    @property
    def plan(self) -> EvolutionPlan:
        """What is known of its error; each call integrates the full equations over thirty rotations. A `ToleranceWarning` names an error bound above a tenth of the angular momentum."""
    @property
    def members(self) -> list[EvolutionEnd]:
        """The ends of the members that `evolve` was asked for: the same momentum and energy at the epoch with evenly spread phases."""
    @property
    def reached(self) -> tuple[float, float]:
        """The first and the last time that it reaches."""
    @property
    def average(self) -> Literal["orbit", "spin"]:
        """The averaging: "orbit" or "spin"."""
    @property
    def scene(self) -> Scene:
        """The scene."""
    def __copy__(self) -> Evolution: ...
    def __deepcopy__(self, _memo: Any) -> Evolution: ...

@final
class EvolutionEnd:
    """The end of an evolution, from `Evolution.end`."""

    @property
    def reason(self) -> Literal["span", "separatrix", "slow rotation", "near sphere"]:
        """Why it ends: "span"; "separatrix", after which the mode depends on lost phases; "slow rotation" or "near sphere", where rotation or wobble is no longer fast against the torque."""
    @property
    def time(self) -> float:
        """When it ends."""
    @property
    def spread(self) -> float | None:
        """How much earlier or later it may end. With ``members=`` of `Scene.evolve` the standard deviation of the members that end for the same reason. Otherwise, at the separatrix, the time in which the averages pass what they leave out; None for other reasons."""
    def __eq__(self, other: object, /) -> bool: ...
    def __copy__(self) -> EvolutionEnd: ...
    def __deepcopy__(self, _memo: Any) -> EvolutionEnd: ...

@final
class EvolutionPlan:
    """What is known of the error of an evolution, from `Evolution.plan`."""

    @property
    def error_bound(self) -> float:
        """Estimated error of the angular momentum at the farther end, over its size at the epoch: the rate of second order times the time, the truncation times the change, and the jumps of `resonances`."""
    @property
    def large_error(self) -> str | None:
        """The text of the `ToleranceWarning` if the error bound is above a tenth, otherwise None."""
    @property
    def truncation(self) -> float:
        """What the polynomials of shapes leave out, relative to the torque."""
    @property
    def second_order(self) -> tuple[float, float]:
        """Rates at which averages and full equations separate, in 1/time: of the angular momentum over its size, and of the excess of energy."""
    @property
    def resonances(self) -> list[tuple[int, int, float, float, bool]]:
        """Resonances h dℓ′/dt + m dy′/dt = 0 between wobble and rotation that are passed: tuples (h, m, time, jump, capture)."""
    def __eq__(self, other: object, /) -> bool: ...
    def __copy__(self) -> EvolutionPlan: ...
    def __deepcopy__(self, _memo: Any) -> EvolutionPlan: ...

@final
class EvolvedStates:
    """Averaged states at times, from `Evolution.at`: arrays whose first axis is that of the times."""

    @property
    def times(self) -> _Array:
        """The times, shape (n,)."""
    @property
    def momentum(self) -> _Array:
        """Angular momentum, inertial, in moment × rate, shape (n, 3)."""
    @property
    def direction(self) -> _Array:
        """Its direction: unit vectors, shape (n, 3)."""
    @property
    def excess(self) -> _Array:
        """ξ, the excess of energy, shape (n,): 2CE/M² − 1 in the short-axis mode, 1 − 2AE/M² in the long-axis mode."""
    @property
    def band(self) -> _Array:
        """What the averages leave out, shape (n, 2): root mean square over the phases of the short-period parts of the angular momentum, over its size, and of the excess of energy. It is computed when it is asked for."""
    @property
    def spin_period(self) -> _Array:
        """2π M/2E, the spin period, of a tumbler an effective one, shape (n,)."""
    @property
    def obliquity(self) -> _Array | None:
        """Angle between the angular momentum and the normal of the first orbit, in rad, shape (n,); None without an orbit."""
    @property
    def mode(self) -> Literal["short-axis", "long-axis"] | None:
        """The mode: "short-axis" or "long-axis"; an evolution stays in its mode."""
    @property
    def periods(self) -> dict[str, PeriodsOfMembers]:
        """Mean periods of the precession of the axis and of the motion about it, by convention as `Motion.periods`, arrays of shape (n,)."""
    def __len__(self) -> int: ...
    def __copy__(self) -> EvolvedStates: ...
    def __deepcopy__(self, _memo: Any) -> EvolvedStates: ...

@final
class Orbital:
    """Attitudes and angular velocities against the orbital frame, from `Motion.orbital`, or of all members with a leading axis from `Ensemble.orbital`. For a scalar time there is no axis of times."""

    @property
    def times(self) -> Any:
        """The times, float64, shape (n,). Times of astropy are returned as given."""
    @property
    def attitude(self) -> _Array:
        """Unit quaternions [x, y, z, w] that rotate body components into components of the orbital frame, shape (n, 4)."""
    @property
    def angles(self) -> _Array:
        """Angles of the intrinsic sequence, in rad, shape (n, 3): yaw, pitch, roll for "ZYX". Where only the sum or the difference of the first and the third is determined, the third is 0."""
    @property
    def angular_velocity(self) -> _Array:
        """Angular velocities relative to the turning frame, in body components, in rad per unit of time, shape (n, 3)."""
    def __len__(self) -> int: ...

@final
class Partials:
    """Derivatives of attitude and angular velocity at given times, from `Motion.partials` and `Ensemble.partials`."""

    @property
    def times(self) -> _Array:
        """The times, float64, shape (n,); of an ensemble whose members have their own times (m, n)."""
    @property
    def attitude(self) -> _Array:
        """Derivatives of the attitude as a rotation vector about body axes, shape (n, 3, k) for k parameters, of an ensemble (m, n, 3, k)."""
    @property
    def angular_velocity(self) -> _Array:
        """Derivatives of the angular velocity in body components, shape (n, 3, k) for k parameters, of an ensemble (m, n, 3, k)."""
    @property
    def parameters(self) -> tuple[str, ...]:
        """The names of the columns, in their order."""
    def __len__(self) -> int: ...

@final
class Verification:
    """The difference between a motion and an integration of the full equations, from `Motion.verify`. ``str(verification)`` is a sentence."""

    @property
    def times(self) -> _Array:
        """The times at which the attitudes were compared, shape (n,), read-only. If the epoch of the scene is a Time, they are TDB seconds since J2000."""
    @property
    def errors(self) -> _Array:
        """The angle between the two attitudes at each time, in rad, shape (n,), read-only."""
    @property
    def error(self) -> float:
        """The largest of the errors, in rad."""
    @property
    def integration_bound(self) -> float:
        """The error bound of the integration, in rad."""
    @property
    def error_bound(self) -> float:
        """The error bound of the motion's plan, in rad."""
    @property
    def holds(self) -> bool:
        """True if error + integration_bound ≤ error_bound."""
    @property
    def refuted(self) -> bool:
        """True if error − integration_bound > error_bound. If neither this nor `holds` is True, the integration is not accurate enough to decide."""
    def __copy__(self) -> Verification: ...
    def __deepcopy__(self, _memo: Any) -> Verification: ...

@final
class Ensemble:
    """Many bodies with their states. They are solved in groups and evaluated on all cores, in memory proportional to the result."""

    def __new__(
        cls,
        moments: ArrayLike | None,
        attitudes: ArrayLike | Rotation,
        angular_velocities: ArrayLike,
        *,
        bodies: Body | Iterable[Body] | None = None,
        epochs: ArrayLike | Any | None = None,
        orbit: Orbit | TabulatedOrbit | Iterable[Orbit | TabulatedOrbit] | None = None,
        orbits: Orbit | TabulatedOrbit | Iterable[Orbit | TabulatedOrbit | Iterable[Orbit | TabulatedOrbit] | None] | None = None,
        torques: Torque | Iterable[Torque] | None = None,
        tolerance: float = 1e-12,
        method: Literal["auto", "series", "closed", "integrated", "libration"] = "auto",
        level: Literal["auto", "full", "second-order", "moving", "paper"] = "auto",
        span: ArrayLike | Any | None = None,
        threads: int | None = None,
        errors: Literal["raise", "nan"] = "raise",
        scalar_first: bool = False,
    ) -> Ensemble: ...
    @staticmethod
    def from_scenes(scenes: Iterable[Scene], *, threads: int | None = None, errors: Literal["raise", "nan"] = "raise") -> Ensemble:
        """An ensemble of scenes of any kind: free bodies, one or several orbits, tables, torques, locked rotation, each with its own options."""
    @staticmethod
    def from_periods(
        bodies: Body | Iterable[Body] | ArrayLike,
        precession: ArrayLike,
        rotation: ArrayLike,
        mode: Literal["short-axis", "long-axis"] | Iterable[Literal["short-axis", "long-axis"]] | None = None,
        directions: ArrayLike | None = None,
        *,
        phases: ArrayLike | None = None,
        convention: Literal["extremal-axis", "long-axis", "short-axis"] = "extremal-axis",
        epoch: float | Any | None = None,
        threads: int | None = None,
        errors: Literal["raise", "nan"] = "raise",
        **options: Any,
    ) -> Ensemble:
        """An ensemble of torque-free bodies that tumble with these periods, each as `Scene.from_periods` has it: clones of a tumbler whose periods, pole and phases are uncertain."""
    @staticmethod
    def from_orbital(
        bodies: Body | Iterable[Body] | ArrayLike,
        attitudes: ArrayLike | Any,
        angular_velocities: ArrayLike,
        *,
        orbit: Orbit | TabulatedOrbit | Sequence[Orbit | TabulatedOrbit] | None = None,
        orbits: Any = None,
        elements_of: Literal["rotating", "disturbing"],
        frame: Literal["rtn", "lvlh"] = "rtn",
        relative: bool = True,
        sequence: str = "ZYX",
        epoch: float | Any = 0.0,
        of: int = 0,
        threads: int | None = None,
        errors: Literal["raise", "nan"] = "raise",
        scalar_first: bool = False,
        **options: Any,
    ) -> Ensemble:
        """An ensemble of states that are given against the orbital frame, each as `Scene.from_orbital` has it: satellites that are released with a spread of angles and rates."""
    def orbital(
        self, times: ArrayLike, *, elements_of: Literal["rotating", "disturbing"], frame: Literal["rtn", "lvlh"] = "rtn", sequence: str = "ZYX", of: int = 0
    ) -> Orbital:
        """Attitudes and angular velocities of all members against the orbital frame."""
    def after(self, time: float | Any) -> Distribution:
        """How all members tumble at a time: the free motions from their states then."""
    @property
    def scenes(self) -> list[Scene | None]:
        """The scene of every member, a list. With ``errors="nan"`` the scene of a member that is not a valid body or state is None."""
    @property
    def torques(self) -> tuple[Torque, ...] | None:
        """The torques beside the gravity gradient on all members, a tuple; None where members of `from_scenes` differ."""
    @property
    def level(self) -> str | None:
        """The level asked for: "auto", "full", "second-order", "moving" or "paper"; None where members of `from_scenes` differ."""
    def at(self, times: ArrayLike, *, scalar_first: bool = False, progress: Callable[[int, int], object] | None = None) -> Samples:
        """Evaluates attitudes and angular velocities of all members in one pass."""
    def attitude(self, times: ArrayLike, out: _Array | None = None, *, scalar_first: bool = False) -> _Array:
        """Evaluates attitudes of all members: unit quaternions [x, y, z, w] that rotate body components into inertial ones."""
    def angular_momentum(self, times: ArrayLike) -> _Array:
        """Evaluates the angular momenta of all members in inertial components, in the unit of moment × rate. They are constant unless a member has an orbit."""
    def andoyer(self, times: ArrayLike) -> _Array:
        """Evaluates the Andoyer variables (λ, μ, ν, Λ, M, N) of all members, as defined in `Motion.andoyer` (theory §1)."""
    def rotation(self, times: ArrayLike) -> Rotation:
        """Evaluates attitudes of all members as a `scipy.spatial.transform.Rotation`, body to inertial. This method imports SciPy."""
    def partials(self, times: ArrayLike) -> Partials:
        """Evaluates the derivatives of attitude and angular velocity of all members, as defined in `Motion.partials` (theory §12)."""
    @property
    def periods(self) -> dict[Literal["long-axis", "short-axis", "extremal-axis"], PeriodsOfMembers]:
        """Mean periods (P_φ, P_ψ) of all members in three conventions, as defined in `Motion.periods`."""
    @property
    def energy_ratio(self) -> _Array:
        """E/E0 of all members, shape (m,): the rotational energy divided by the energy of rotation about the axis of greatest inertia with the same angular momentum (theory §5)."""
    @property
    def plans(self) -> list[Any]:
        """The plan of every member: a list of `Plan`. With ``errors="nan"`` the plan of an invalid member is None."""
    @property
    def errors(self) -> dict[int, Error]:
        """The errors of members that have no motion, by index. This property solves all members; it is empty if every member has a motion."""
    @property
    def epochs(self) -> Any:
        """The times of the states: a float for all members, or a read-only array, shape (m,)."""
    @property
    def moments(self) -> _Array:
        """The moments about body axes 1, 2, 3: a read-only array, shape (m, 3). If tensors were given, they are the principal moments, as `Body.moments`."""
    @property
    def inertia(self) -> _Array:
        """The inertia tensors as given, diagonal if moments were given: a read-only array, shape (m, 3, 3)."""
    @property
    def attitudes(self) -> _Array:
        """The attitudes at the epoch as given: unit quaternions [x, y, z, w], a read-only array, shape (m, 4)."""
    @property
    def angular_velocities(self) -> _Array:
        """The angular velocities at the epoch in body components, in rad per unit of time: a read-only array, shape (m, 3)."""
    @property
    def tolerance(self) -> float | None:
        """The requested attitude error, in rad; None where members of `from_scenes` differ."""
    @property
    def method(self) -> Literal["auto", "series", "closed", "integrated", "libration"] | None:
        """The method asked for: "auto", "series", "closed", "integrated" or "libration"; None where members of `from_scenes` differ."""
    @property
    def orbits(self) -> Orbit | list[Orbit | None] | None:
        """The orbits: an Orbit for all members, a list of one or None for each, or None."""
    @property
    def span(self) -> tuple[float, float] | None:
        """The span, the times over which `tolerance` is requested, or None; None too where members of `from_scenes` differ."""
    @property
    def threads(self) -> int | None:
        """The requested number of threads, or None."""
    def __len__(self) -> int: ...
    def __iter__(self) -> Iterator[Motion]: ...
    @overload
    def __getitem__(self, index: int, /) -> Motion: ...
    @overload
    def __getitem__(self, index: slice, /) -> Ensemble: ...
    def __eq__(self, other: object, /) -> bool: ...
    __hash__: None  # type: ignore[assignment]
    def __copy__(self) -> Ensemble: ...
    def __deepcopy__(self, _memo: Any) -> Ensemble: ...

@final
class NormalForm:
    """The normal form of the free rigid body to any order: exact, and symbolic in the triaxiality β (theory §4, §6)."""

    def __new__(cls, order: int, *, progress: Callable[[int, int], object] | None = None) -> NormalForm: ...
    @property
    def order(self) -> int:
        """The order."""
    def triaxiality_polynomial(self, n: int) -> dict[int, Fraction]:
        """The triaxiality polynomial P_n in real form: K = M²/(2C) [1 + γ Σ P_n κⁿ σⁿ⁺¹] (theory §4)."""
    def paper_polynomial(self, n: int) -> dict[int, _Gaussian]:
        """The triaxiality polynomial p_n = (−i)ⁿ⁺¹ P_n in the form of the paper (theory §4; §11 for the misprint)."""
    def generator(self, m: int) -> _Form:
        """The generating function S_m · (√γ V/α)ᵐ = Σ c uʲ Uᵏ βˡ, including the factor (m−1)! (theory §4)."""
    def direct(self, name: Literal["u", "U", "y"], n: int) -> _Form:
        """Order n of an old variable as a function of the new variables, including the factor 1/n! (theory §6)."""
    def inverse(self, name: Literal["u", "U", "y"], n: int) -> _Form:
        """Order n of a new variable as a function of the old variables, scaled as in `direct` (theory §6)."""
    def to_json(self) -> str:
        """Writes this normal form as JSON text with a format version; numbers are exact "p/q" strings."""
    @classmethod
    def from_json(cls, text: str) -> NormalForm:
        """Reads a normal form from the text of `to_json`. Each order is computed again and compared."""
    def to_latex(self, what: Literal["hamiltonian", "generator", "direct", "inverse"] = "hamiltonian") -> str:
        """Writes a part of this normal form as LaTeX, for a document that uses amsmath."""
    def to_sympy(self, what: Literal["hamiltonian", "generator", "direct", "inverse"] = "hamiltonian") -> Any:
        """Converts a part of this normal form to exact SymPy expressions. This method imports SymPy."""
    def to_code(self, language: Literal["c", "rust", "python"] = "c", beta: float | None = None) -> str:
        """Writes a source file with a function that evaluates the direct transformation and the frequencies to this order."""
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __copy__(self) -> NormalForm: ...
    def __deepcopy__(self, _memo: Any) -> NormalForm: ...

@final
class Material:
    """A homogeneous, slightly inelastic material, for `Dissipation`."""

    def __new__(
        cls,
        *,
        density: float,
        rigidity: float,
        poisson: float = 0.25,
        quality: float | None = None,
        viscosity: float | None = None,
        loss: Callable[[float], float] | None = None,
        shear_only: bool = False,
    ) -> Material: ...
    @property
    def density(self) -> float:
        """The density ϱ, in mass/length³."""
    @property
    def rigidity(self) -> float:
        """The rigidity S, in mass/(length time²)."""
    @property
    def poisson(self) -> float:
        """Poisson's ratio ν."""
    @property
    def quality(self) -> float | None:
        """The quality factor Q, or None."""
    @property
    def viscosity(self) -> float | None:
        """The viscosity η, in mass/(length time), or None."""
    @property
    def loss(self) -> Callable[[float], float] | None:
        """The loss function χ(f), or None."""
    @property
    def shear_only(self) -> bool:
        """True if compression has no loss."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...
    def __copy__(self) -> Material: ...
    def __deepcopy__(self, _memo: Any) -> Material: ...

@final
class Dissipation:
    """The inner dissipation of a homogeneous ellipsoid that rotates freely: it loses energy at constant angular momentum, and ends in rotation about its short axis."""

    def __new__(cls, body: Body, radius: ArrayLike | None = None, material: Material | None = None, *, semi_axes: ArrayLike | None = None) -> Dissipation: ...
    @property
    def body(self) -> Body:
        """The body."""
    @property
    def material(self) -> Material:
        """The material."""
    @property
    def radius(self) -> float:
        """The radius of the sphere of the same volume, (R1 R2 R3)^(1/3)."""
    @property
    def semi_axes(self) -> _Array:
        """The semi-axes along body axes 1, 2, 3: a read-only array, shape (3,)."""
    @property
    def moments(self) -> _Array:
        """The moments of the homogeneous ellipsoid about body axes 1, 2, 3, in density × length⁵: a read-only array, shape (3,)."""
    @property
    def inertia_response(self) -> _Array:
        """The change of the inertia tensor in elastic equilibrium, by products of rates: a read-only array, shape (6, 6)."""
    def compliance(self, scene: Scene | Motion) -> float:
        """ϱ (M/C)² R1²/S, with the longest semi-axis R1: the relative error of the power by theory of first order in the deformation is of this size."""
    def power(self, scene: Scene | Motion) -> float:
        """The loss of energy in the unit of time, averaged over the polhode of the state. It is 0 at rest, in rotation about a principal axis, and on the separatrix."""
    def rate(self, scene: Scene | Motion) -> float:
        """dx/dt of x = sin² θ, with θ the largest angle between the angular momentum and the axis of the mode: negative in the short-axis mode, positive in the long-axis mode."""
    def harmonics(self, scene: Scene | Motion) -> list[LoadHarmonic]:
        """The harmonics of the load along the polhode, from the first, with their shares of the power, down to 1e-17 of the largest."""
    def relax(self, scene: Scene | Motion) -> Relaxation:
        """The relaxation of the free body of a scene: the angle and the energy at any time, before and after."""
    def age(self, scene: Scene | Motion, start_angle: float, mode: Literal["short-axis", "long-axis"] | None = None) -> float:
        """The age of the state of a scene: the time since the largest angle between the angular momentum and the axis of a mode was `start_angle`."""
    def quality_from_age(self, scene: Scene | Motion, age: float, start_angle: float, mode: Literal["short-axis", "long-axis"] | None = None) -> float:
        """The quality factor with which the state of a scene has this age. Ages are proportional to the product of rigidity and quality factor."""
    def viscosity_from_age(self, scene: Scene | Motion, age: float, start_angle: float, mode: Literal["short-axis", "long-axis"] | None = None) -> float:
        """The viscosity of a Maxwell body with which the state of a scene has this age, in mass/(length time). Ages are proportional to it."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...
    def __copy__(self) -> Dissipation: ...
    def __deepcopy__(self, _memo: Any) -> Dissipation: ...

@final
class LoadHarmonic:
    """A harmonic of the load along a polhode, from `Dissipation.harmonics`."""

    @property
    def multiple(self) -> int:
        """m, the multiple of the rate dℓ′/dt of the polhode. Odd ones load shear with axis 3, even ones the other strains."""
    @property
    def frequency(self) -> float:
        """m dℓ′/dt, in rad per unit of time."""
    @property
    def energy(self) -> float:
        """W_m, the sum over the components of the load of the peak strain energies. The mean energy is half of it."""
    @property
    def power(self) -> float:
        """f χ(f) W_m at the frequency f, the loss of energy in the unit of time."""
    def __eq__(self, other: object, /) -> bool: ...

@final
class Relaxation:
    """The relaxation of a free body at constant angular momentum, from `Dissipation.relax`."""

    def at(self, times: ArrayLike) -> RelaxedStates:
        """The states at times after that of the scene."""
    def time_to(self, angle: float, mode: Literal["short-axis", "long-axis"] = "short-axis") -> float:
        """The time after the state of the scene at which the largest angle between the angular momentum and the axis of a mode is `angle`."""
    @property
    def dissipation(self) -> Dissipation:
        """The dissipation."""
    @property
    def scene(self) -> Scene | Motion:
        """The scene or the motion whose state relaxes."""
    def __copy__(self) -> Relaxation: ...
    def __deepcopy__(self, _memo: Any) -> Relaxation: ...

@final
class RelaxedStates:
    """States of a relaxation at given times, from `Relaxation.at`. For a scalar time the arrays have no axis."""

    @property
    def times(self) -> _Array:
        """The times after the state of the scene, shape (n,)."""
    @property
    def mode(self) -> NDArray[np.str_]:
        """The modes, "long-axis" or "short-axis": an array of texts, shape (n,)."""
    @property
    def angle(self) -> _Array:
        """The largest angle between the angular momentum and the axis of the mode on the polhode, in rad, shape (n,)."""
    @property
    def energy_ratio(self) -> _Array:
        """E/E0, the rotational energy over that of rotation about the axis of greatest inertia with the same angular momentum, shape (n,)."""
    @property
    def power(self) -> _Array:
        """The loss of energy in the unit of time, shape (n,)."""
    def __len__(self) -> int: ...

@final
class CassiniState:
    """A Cassini state, from `cassini_states`."""

    @property
    def obliquity(self) -> float:
        """θ, the angle from the normal of the orbit to the pole of the body [rad], in (−π, π]: positive away from inertial axis 3, in the plane of both."""
    @property
    def stable(self) -> bool:
        """Whether nearby poles stay near."""
    @property
    def rate(self) -> float:
        """Frequency of small librations about a stable state, or the rate at which poles leave an unstable one [rad/time]."""
    @property
    def resonance(self) -> float | None:
        """p, the number of rotations an orbit if the body is in a spin–orbit resonance, otherwise None."""
    def __eq__(self, other: object, /) -> bool: ...

def cassini_states(body: Body, orbit: Orbit, spin_rate: float) -> list[CassiniState]:
    """The Cassini states of a body: places of its pole that turn with the node of a precessing orbit (theory, section 9)."""

def separatrix_action(beta: float) -> float:
    """The action σ_sep(β) = (2/π) atan √((1−β)/2β) of the separatrix, in units of M. It is the radius of convergence of the series (theory §5)."""

@final
class BirkhoffNormalForm:
    """The Birkhoff normal form of a Hamiltonian, from `normalize`: the new Hamiltonian K and the transformation in both directions."""

    @property
    def order(self) -> int:
        """The order N."""
    @property
    def degree(self) -> int:
        """The degree N + 2."""
    @property
    def exact(self) -> bool:
        """True if the coefficients are exact (`Fraction`), False if they are floats."""
    @property
    def variables(self) -> tuple[tuple[str, str], ...]:
        """The pairs (q, p)."""
    @property
    def parameters(self) -> tuple[str, ...]:
        """The parameters."""
    @property
    def driven(self) -> dict[str, tuple[_Number, float]]:
        """The driven phases: {name: (frequency, phase at time 0)}."""
    @property
    def frequencies(self) -> tuple[_Number | complex, ...]:
        """The frequencies ω at the origin. A centre has a real frequency, negative if its energy is negative; a saddle has iλ; a quartet has iσ − ν and iσ + ν."""
    @property
    def kinds(self) -> tuple[Literal["elliptic", "hyperbolic", "complex"], ...]:
        """The kind of every mode: "elliptic", "hyperbolic" or "complex"."""
    @property
    def ratios(self) -> tuple[_Number | None, ...]:
        """The ratios r = √(a/b) of the centres, None for other modes."""
    @property
    def linear_change(self) -> tuple[tuple[_Number, ...], ...]:
        """The symplectic matrix M of the linear change z = M z′ that diagonalizes the quadratic part, by rows. It is the unit matrix if the quadratic part is already diagonal."""
    @property
    def resonances(self) -> tuple[tuple[int, ...], ...]:
        """The resonances that were kept: vectors k with k·ω = 0, and with driven phases (k, j) with k·ω + j·n = 0. Their terms depend on the resonant angles k·φ + j·M."""
    def in_actions(self) -> _Polynomial:
        """K as a function of the actions: coefficients by exponents of I₁, I₂, …, parameters. It includes the constant term of H."""
    def in_angles(self) -> dict[tuple[int, ...], dict[tuple[int, ...], tuple[float, float]]]:
        """K in the actions and the resonant angles: the terms of each angle k·φ, by k."""
    def in_complex(self) -> dict[tuple[int, ...], tuple[_Number, _Number]]:
        """K in the complex variables: (re, im) by exponents of u₁, U₁, u₂, U₂, …, parameters."""
    def in_real(self) -> _Polynomial:
        """K in the new real variables."""
    def centre_manifold(self) -> _Polynomial:
        """The Hamiltonian on the centre manifold: K in the new real variables of the centres, with q = p = 0 for the saddles."""
    def generator(self, m: int) -> _Polynomial:
        """The generating function S_m in the real variables, of degree m + 2."""
    def direct(self, function: _Expression) -> _Polynomial:
        """Expresses a function of the old variables in the new variables. It is complete to degree d + N, where d is its lowest positive degree."""
    def inverse(self, function: _Expression) -> _Polynomial:
        """Expresses a function of the new variables in the old variables. It is complete to degree d + N, where d is its lowest positive degree."""
    def to_normal(self, states: ArrayLike, parameters: dict[str, float] | None = None, time: ArrayLike | None = None) -> _Array:
        """Transforms states to the new variables."""
    def from_normal(self, states: ArrayLike, parameters: dict[str, float] | None = None, time: ArrayLike | None = None) -> _Array:
        """Transforms new variables to states. The errors are those of `to_normal`."""
    def actions(self, states: ArrayLike, parameters: dict[str, float] | None = None, time: ArrayLike | None = None) -> _Array:
        """The actions of states. Along a motion they are almost constant, unless a resonance exchanges them."""
    def from_centre_manifold(self, states: ArrayLike, parameters: dict[str, float] | None = None, time: ArrayLike | None = None) -> _Array:
        """Transforms points of the centre manifold, given by the new variables of the centres, to states."""
    def energy(self, normal: ArrayLike, parameters: dict[str, float] | None = None, time: ArrayLike | None = None) -> _Array:
        """The energy: the value of K at new variables."""
    def rates(self, normal: ArrayLike, parameters: dict[str, float] | None = None, time: ArrayLike | None = None) -> _Array:
        """The rates of new variables, by Hamilton's equations of K."""
    def domain(self, parameters: dict[str, float] | None = None) -> Domain:
        """Estimates the range of validity of the form: the sizes of its orders, and the best order at an amplitude."""
    def frequency_map(self, actions: ArrayLike, parameters: dict[str, float] | None = None) -> _Array:
        """The frequencies Ω = ∂K/∂I at actions. For a saddle Ω is the rate; for a quartet it is rate and frequency."""
    def trajectory(self, state: ArrayLike, times: ArrayLike, parameters: dict[str, float] | None = None, time: float = 0.0) -> _Array:
        """Propagates a state by the normal form to times after the state."""
    def to_json(self) -> str:
        """Writes this normal form as JSON text with a format version: exact numbers as "p/q" strings, floats with all their digits."""
    @classmethod
    def from_json(cls, text: str, symbols: dict[str, Any] | None = None) -> BirkhoffNormalForm:
        """Reads a normal form from the text of `to_json`, and computes the form again to compare every coefficient."""
    def to_latex(self, what: Literal["hamiltonian", "generator", "direct", "inverse"] = "hamiltonian") -> str:
        """Writes a part of this normal form as LaTeX, for a document that uses amsmath."""
    def to_code(self, language: Literal["c", "rust", "python"] = "c") -> str:
        """Writes a source file with functions that evaluate this normal form. The file needs only the standard library of its language."""
    def to_sympy(self, what: Literal["hamiltonian", "generator", "direct", "inverse"] = "hamiltonian") -> Any:
        """Converts a part of this normal form to SymPy expressions. This method imports SymPy."""
    def __eq__(self, other: object, /) -> bool: ...
    def __copy__(self) -> BirkhoffNormalForm: ...
    def __deepcopy__(self, _memo: Any) -> BirkhoffNormalForm: ...

@final
class Domain:
    """An estimate of the range of validity of a normal form by the sizes of its orders, from `BirkhoffNormalForm.domain`."""

    @property
    def norms(self) -> list[float]:
        """The norms ‖T_1‖ … ‖T_N‖ of the generating functions T_m = S_m/(m−1)! at the amplitude 1."""
    @property
    def radii(self) -> list[float]:
        """The radii ρ_m = (‖T_{m−2}‖/‖T_m‖)^½, m = 3 … N. At the amplitude ρ_m order m is as large as order m − 2."""
    def sizes(self, amplitude: float) -> list[float]:
        """The sizes (m + 2) ‖T_m‖ a^(m+1) of the orders of the transformation at an amplitude."""
    def best_order(self, amplitude: float) -> int:
        """The order whose size is least at an amplitude."""
    def __eq__(self, other: object, /) -> bool: ...

@final
class Driven:
    """Coefficients that are periodic functions of driven phases M = n t, for `normalize`: the normal form about the periodic motion."""

    def __new__(cls, rate: ArrayLike, samples: Callable[..., dict[tuple[int, ...], float]] | None = None, names: Sequence[str] | None = None) -> Driven: ...
    @property
    def rates(self) -> list[float]:
        """The rates of the phases [rad per unit of time]."""
    @property
    def names(self) -> list[str]:
        """The names of the phases."""

@final
class DrivenNormalForm:
    """The normal form of a Hamiltonian about a periodic motion, from `normalize` with driven phases."""

    @property
    def order(self) -> int:
        """The order N: terms to degree N + 2."""
    @property
    def variables(self) -> tuple[tuple[str, str], ...]:
        """The pairs (q, p)."""
    @property
    def driven(self) -> dict[str, tuple[float, float]]:
        """The driven phases: {name: (rate, phase at time 0)}."""
    @property
    def frequencies(self) -> tuple[float | complex, ...]:
        """Floquet's exponents on the branch of the rotation number: ω of a centre, the mean rate at which a real solution turns, negative if it turns backwards; iλ of a saddle."""
    @property
    def kinds(self) -> tuple[Literal["elliptic", "hyperbolic"], ...]:
        """The kind of every mode: "elliptic" or "hyperbolic"."""
    @property
    def times(self) -> int:
        """The number of times at which a coefficient is held."""
    @property
    def memory(self) -> int:
        """The memory of the form [bytes]."""
    @property
    def divisors(self) -> list[tuple[tuple[int, ...], float]]:
        """The smallest divisors k·ω + j·n of the transformation: pairs of the integers (k, j) and the value [rad per unit of time], the smallest first."""
    def periodic(self, phases: ArrayLike) -> _Array:
        """The periodic motion at phases."""
    def in_actions(self) -> dict[tuple[int, ...], float]:
        """K as a function of the actions: coefficients by exponents of I₁, I₂, …."""
    def direct(self, function: _Expression, time: float = 0.0) -> dict[tuple[int, ...], float]:
        """Expresses a function of the old variables in the new ones at a time."""
    def inverse(self, function: _Expression, time: float = 0.0) -> dict[tuple[int, ...], float]:
        """Expresses a function of the new variables in the old ones at a time. Arguments, result and errors are as of `direct`, with old and new variables exchanged."""
    def to_normal(self, states: ArrayLike, time: ArrayLike | None = None) -> _Array:
        """Transforms states to the new variables, by iteration on the inverse of this transformation."""
    def from_normal(self, states: ArrayLike, time: ArrayLike | None = None) -> _Array:
        """Transforms new variables to states. Shapes and errors are those of `to_normal`."""
    def actions(self, states: ArrayLike, time: ArrayLike | None = None) -> _Array:
        """The actions of states, shape (n,) or (m, n). Along a motion they are almost constant. The errors are those of `to_normal`."""
    def frequency_map(self, actions: ArrayLike) -> _Array:
        """The rates ∂K/∂I at actions: frequencies of centres, growth rates of saddles."""
    def trajectory(self, state: ArrayLike, times: ArrayLike, time: float = 0.0) -> _Array:
        """Propagates a state by the normal form to times after it."""
    def domain(self) -> Domain:
        """The sizes of the orders, and the best order at an amplitude."""
    def to_json(self) -> str:
        """Writes the Hamiltonian and what was asked of its form as JSON text with a format version. Samples are written as cosines and sines."""
    @classmethod
    def from_json(cls, text: str) -> DrivenNormalForm:
        """Reads the text of `to_json`, and computes the form again."""
    def to_latex(self, what: Literal["hamiltonian", "generator", "direct", "inverse"] = "hamiltonian") -> str:
        """Writes a part of this normal form as LaTeX, for a document that uses amsmath."""
    def to_code(self, language: Literal["c", "rust", "python"] = "c") -> str:
        """Writes a source file with functions that evaluate this normal form. The file needs only the standard library of its language."""
    def __eq__(self, other: object, /) -> bool: ...
    def __copy__(self) -> DrivenNormalForm: ...
    def __deepcopy__(self, _memo: Any) -> DrivenNormalForm: ...

@overload
def normalize(  # type: ignore[overload-overlap]  # a call with `exact` or `parameters` matches the second one only
    hamiltonian: _Expression | None,
    order: int,
    variables: Sequence[tuple[Any, Any]],
    *,
    driven: Driven | dict[Any, Any],
    smallest_divisor: float = 1e-6,
    progress: Callable[[int, int], object] | None = None,
    start: Any = None,
) -> DrivenNormalForm: ...
@overload
def normalize(
    hamiltonian: _Expression,
    order: int,
    variables: Sequence[tuple[Any, Any]],
    *,
    parameters: Sequence[Any] | dict[Any, Any] | None = None,
    driven: dict[Any, Any] | None = None,
    degrees: dict[str, int] | None = None,
    frequency: tuple[str, str] | None = None,
    resonances: Sequence[Sequence[int]] | None = None,
    keep: Literal["hyperbolic"] | None = None,
    smallest_divisor: float = 1e-6,
    exact: bool | None = None,
    progress: Callable[[int, int], object] | None = None,
    start: None = None,
) -> BirkhoffNormalForm:
    """Computes the Birkhoff normal form of a polynomial Hamiltonian about an equilibrium at the origin."""

def _read_pck(files: Any, code: int, times: ArrayLike) -> tuple[_Array, _Array]:
    """Attitudes and angular velocities in body components of a body frame at times, from binary PCK files."""

def _frame_code(body_frame: str) -> int:
    """The code of a frame that has no other: computed from its name."""

def _clock_code(instrument: int, users: bool) -> int:
    """The code of the clock of a frame, if none is given; `users`: of a clock that the user has."""

def _write_motion(
    path: Any, motion: Motion, interval: tuple[float, float], pck: bool, names: tuple[Any, ...], options: tuple[Any, ...]
) -> tuple[int, int, float]:
    """Writes a motion as a C-kernel, or as a binary PCK; type, number of records and error."""

def _write_samples(
    path: Any, times: Any, attitudes: Any, rates: Any, longest_step: float, names: tuple[Any, ...], options: tuple[Any, ...]
) -> tuple[int, int, float]:
    """Writes attitudes at given times as a C-kernel."""
