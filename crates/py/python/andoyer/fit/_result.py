"""`Fit`: a state with its uncertainty."""

from __future__ import annotations

import warnings
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from andoyer._core import Ensemble, Scene
from andoyer._quaternions import Array
from andoyer._refusal import refusal
from andoyer.fit._degeneracy import sentence, undetermined
from andoyer.fit._draws import Candidates, Model, candidates
from andoyer.fit._facets import FacetAreas
from andoyer.fit._given import generator_of, whole_number
from andoyer.fit._magnitudes import ZeroPoints
from andoyer.fit._members import members_of
from andoyer.fit._message import NEAR as NEAR_BEST
from andoyer.fit._observed import Light
from andoyer.fit._optimum import Alias, Optimum, aliases, free_motion
from andoyer.fit._steps import Steps
from andoyer.fit._summary import described
from andoyer.fit._verdict import NEAR, SimpleRotation, Verdict

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


FEWEST = 50
"""Candidates of a minimum at least, where draws are about several."""
LITTLE = 0.5
"""Effective size, in parts of the number of draws, below which there is a warning."""


class Draws(NamedTuple):
    """States drawn from a fit, by `Fit.draws`."""

    states: Ensemble
    """The states, about principal axes."""
    delta_chi_square: Array
    """χ² of each state less that of the best, shape (n,)."""
    effective_size: float
    """The number of independent states that the draws are worth, at most n: (Σw)²/Σw² of the weights."""
    optima: NDArray[np.intp]
    """The place in `Fit.optima` of the minimum about which each state was drawn, shape (n,)."""


@dataclass(frozen=True, eq=False)
class Photometric:
    """What the fit of light curves has beside that of attitudes."""

    zero_points: ZeroPoints
    verdict: Verdict
    simple_rotation: SimpleRotation | None
    light: Light
    """The data with their model."""
    scale: float
    """By what the verdict divides differences of χ²."""


@dataclass(frozen=True, eq=False, repr=False)
class Fit:
    """The state that fits the data best, with its uncertainty, from `attitudes` or `light_curve`.

    `print` shows mean periods in the convention "extremal-axis", the direction of the angular momentum (pole), the Andoyer angles μ and ν at the epoch, and the moments. Each has its standard
    deviation, to first order in the covariance. With an orbit these are osculating values at the epoch.

    Examples
    --------
    >>> import numpy as np
    >>> from andoyer import Body, Scene, fit
    >>> scene = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0])
    >>> times = np.linspace(0, 50, 100)
    >>> found = fit.attitudes(scene, times, scene.solve().attitude(times), sigma=0.01)
    >>> found.message
    'The data do not determine a common factor of the moments.'
    >>> found.covariance.shape, found.ensemble(500, rng=1).attitude(10.0).shape
    ((9, 9), (500, 4))
    """

    scene: Scene
    """The scene of the best state, with the options of the given scene."""
    parameters: tuple[str, ...]
    """Names of the free parameters: a small rotation θ1…θ3 about body axes at the epoch [rad], angular velocities ω1…ω3, principal moments I1…I3, elements of the tensor I11…I23, axis ratios b/a, c/a."""
    covariance: Array
    """Covariance of the free parameters, shape (k, k), in their units; 0 along directions that the data do not determine (see `undetermined`)."""
    undetermined: Array
    """Directions that the data do not determine, shape (d, k), as unit vectors of relative changes (of angles: in rad)."""
    residuals: Array
    """Measured minus model: rotation vectors about body axes, shape (n, 3), in rad; or brightnesses or magnitudes as given, shape (n,)."""
    chi_square: float
    """Sum of the squared residuals over their variances; with facets of the logarithms, and with the squares of their prior."""
    degrees_of_freedom: int
    """Number of data minus number of parameters that they determine. Facets are none: each brings a row of its prior."""
    message: str
    """Sentences that say if the fit is bad, which other minima lie within Δχ² = 25 of the best, and which directions the data do not determine."""
    times: Any
    """The times of the data as given."""
    _steps: Steps
    _model: Model
    optima: tuple[Optimum, ...] = ()
    """All minima within Δχ² of the best, the best first; of `light_curve`."""
    semi_axes: Array | None = None
    """Semi-axes of the ellipsoid along principal axes 1, 2, 3; of `light_curve`."""
    _photometric: Photometric | None = None

    @property
    def reduced_chi_square(self) -> float:
        """χ² divided by the degrees of freedom: near 1 if the model and `sigma` are right; NaN if there are no degrees of freedom."""
        return self.chi_square / self.degrees_of_freedom if self.degrees_of_freedom > 0 else float("nan")

    @property
    def aliases(self) -> list[Alias]:
        """The best minimum with each pair of periods other than that of the best state, the best first; of `light_curve`.

        Two pairs of periods count as different if one of their phases differs by more than half a turn over the data. A fit of attitudes, or one that began from a `scene`, has none.
        """
        return aliases(self.optima, self._model.duration)

    @property
    def zero_points(self) -> ZeroPoints | None:
        """The zero point of each curve with its error; of `light_curve`."""
        return self._photometric.zero_points if self._photometric else None

    @property
    def facets(self) -> FacetAreas | None:
        """Normals and areas of the facets of the best state; of `light_curve` with ``shape="facets"``."""
        return self._photometric.light.facets if self._photometric else None

    @property
    def verdict(self) -> Verdict | None:
        """What the data determine: periods, pole and mode; of `light_curve`."""
        return self._photometric.verdict if self._photometric else None

    @property
    def simple_rotation(self) -> SimpleRotation | None:
        """The hypothesis of rotation about the axis of greatest inertia, fitted to the same data; of `light_curve` without a mode or a scene."""
        return self._photometric.simple_rotation if self._photometric else None

    @property
    def units(self) -> tuple[str, ...]:
        """The unit of each of `parameters`: "rad", "rad per unit of time", "unit of the moments" or "1"."""
        kinds = {"θ": "rad", "ω": "rad per unit of time", "I": "unit of the moments"}
        return tuple(kinds.get(name[0], "1") for name in self.parameters)

    def model(self, times: Any = None, *, sun: ArrayLike | None = None, observer: ArrayLike | None = None, curve: Any = None) -> Array:
        """What the best state would show: attitudes, shape (n, 4), or brightnesses or magnitudes as given, shape (n,).

        Parameters
        ----------
        times : array_like, shape (n,), optional
            By default those of the data. Of a light curve with `distances`, times at the body.
        sun, observer : array_like, shape (3,) or (n, 3), optional
            Directions as of `light_curve`. By default those of the data, between them interpolated; needed for times outside the data.
        curve : int, optional
            The curve whose zero point is used, by default the first.

        Raises
        ------
        InputError
            Times outside the data without directions; a curve that does not exist.
        """
        if self._photometric is not None:
            return self._photometric.light.at(times, sun, observer, curve)
        attitudes: Array = self.scene.solve().attitude(self.times if times is None else times)
        return attitudes

    def ensemble(self, n: int, rng: Any = None, *, threads: int | None = None) -> Ensemble:
        """Draws states by their χ², as an `Ensemble` about principal axes: the states of `draws`, where parameters and errors are listed.

        Examples
        --------
        >>> from andoyer import Body, Scene, fit
        >>> scene = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0])
        >>> times = range(100)
        >>> found = fit.attitudes(scene, times, scene.solve().attitude(times), sigma=0.01)
        >>> len(found.ensemble(20, rng=1))
        20
        """
        return self.draws(n, rng, threads=threads).states

    def draws(self, n: int, rng: Any = None, *, optima: bool = False, threads: int | None = None) -> Draws:
        """Draws states about the best one, or about all minima, from the density exp(−χ²/2), with their Δχ² and effective size.

        The density is per rotation vector of the attitude, angular velocity, and logarithms of moments or axis ratios. Components that the data do not determine are equal in all states of a
        minimum. 2n draws from the covariance get the weight exp(−χ²/2) over their own density. If their effective size is below n, nonlinear
        equations are solved for each draw (Bardsley and others, SIAM J. Sci. Comput. 36, A1895, 2014): some milliseconds a state. A state of large weight can be drawn several times.

        Parameters
        ----------
        n : int
            Number of states.
        rng : int or numpy.random.Generator, optional
            A seed or a generator of random numbers.
        optima : bool, optional
            If True, the states are about all of `optima` within Δχ² = 25 of the best, about each in proportion to the integral of exp(−χ²/2) there: a wide minimum gets more states than a narrow one of the same
            χ². A direction that the data do not determine at one of them counts as 1 rad or 100 %. Two minima in one valley both count it.
        threads : int, optional
            Number of threads, as for `Ensemble`.

        Returns
        -------
        Draws
            The states, Δχ² of each, the effective size, and the minimum of each. About one minimum the mean Δχ² is near the number of parameters that the data determine.

        Raises
        ------
        InputError
            An `n` below 0. An `optima` that is neither True nor False. No draw has a motion: the moments are too uncertain, for example. A scene with several disturbing bodies or a `TabulatedOrbit`.

        Warns
        -----
        UserWarning
            The effective size is below n/2.

        Examples
        --------
        >>> from andoyer import Body, Scene, fit
        >>> scene = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0])
        >>> times = range(100)
        >>> drawn = fit.attitudes(scene, times, scene.solve().attitude(times), sigma=0.01).draws(1000, rng=1)
        >>> drawn.effective_size > 900
        True
        >>> bool(7.5 < drawn.delta_chi_square.mean() < 8.5)    # nine parameters without a common factor of the moments
        True
        """
        count, generator = whole_number("n", n, 0), generator_of(rng)
        if not isinstance(optima, (bool, np.bool_)):
            raise refusal("optima", repr(optima), "True or False", f"= {optima!r}: it must be True or False")
        fits = [self, *(optimum.fit() for optimum in self.optima[1:] if optimum.delta_chi_square <= NEAR_BEST)] if optima else [self]
        if not count:
            return Draws(members_of([(self._steps, np.zeros((0, len(self.parameters))))], threads=threads), np.zeros(0), 0.0, np.zeros(0, dtype=np.intp))
        found = [fit._candidates(self, count, generator) for fit in fits]
        logarithms = np.concatenate([part.logarithms for part in found])
        minima = np.repeat(np.arange(len(found)), [len(part.steps) for part in found])
        together = Candidates(np.concatenate([part.steps for part in found]), np.concatenate([part.chi_squares for part in found]), logarithms)
        size = min(together.effective_size, float(count))
        if not size > 0:
            raise refusal("n", count, 0, f"= {count}: no draw has a motion whose χ² could be found; fit fewer parameters, or hold the moments")
        if size < LITTLE * count:
            warnings.warn(
                f"the {count} draws have the effective size {size:.0f}: the data determine the state loosely, and few draws have most of the weight",
                stacklevel=2,
            )
        places = together.drawn(count, generator)
        of = minima[places]
        states = members_of([(fit._steps, together.steps[places[of == number]]) for number, fit in enumerate(fits)], threads=threads)
        return Draws(states, together.chi_squares[places] - self.chi_square, size, of)

    def _candidates(self, best: Fit, count: int, generator: np.random.Generator) -> Candidates:
        """Candidates about this minimum for a part of the draws of the best one, weighted per angular velocity: steps of it are in parts of that of the state."""
        part = max(min(count, FEWEST), int(np.ceil(count * np.exp(-max(0.0, self.chi_square - best.chi_square) / 2))))
        found = candidates(self._model, self.undetermined, part, generator)
        rates = sum(label.startswith("ω") for label in self.parameters)
        return found._replace(logarithms=found.logarithms + rates * np.log(self._steps.rate))

    def __repr__(self) -> str:
        motion = free_motion(self.scene)
        if "spin" in self._steps.free:
            of_motion = f"principal-axis, P={2 * np.pi / np.linalg.norm(self.scene.angular_velocity):.6g}"
        else:
            precession, rotation = motion.periods["extremal-axis"]
            of_motion = f"{motion.plan.mode}, P_φ={precession:.6g}, P_ψ={rotation:.6g}"
        return f"Fit({of_motion}, reduced χ²={self.reduced_chi_square:.4g}, {len(self.parameters)} parameters, {self.residuals.size} data)"

    def __str__(self) -> str:
        lines = [
            ("reduced χ²", f"{self.reduced_chi_square:.4g}  (χ² {self.chi_square:.6g}, {self.degrees_of_freedom} degrees of freedom)"),
            ("mode", f"{free_motion(self.scene).plan.mode}  (state at the epoch {self.scene.epoch:g})"),
            *((quantity.name, str(quantity)) for quantity in described(self._steps, self.covariance, self.undetermined)),
        ]
        if len(self.optima) > 1:
            lines.append(("minima", f"{len(self.optima)}, the second with Δχ² {self.optima[1].chi_square - self.optima[0].chi_square:.3g}"))
        if self.simple_rotation is not None:
            lines.append(
                (
                    "simple rotation",
                    f"P {self.simple_rotation.period:.6g}, Δχ² {self.simple_rotation.delta_chi_square:.4g}, by chance {self.simple_rotation.probability:.2g}",
                )
            )
        if self.verdict is not None:
            lines.append(("verdict", str(self.verdict)))
        title = f"Fit of {len(self.parameters)} parameters ({', '.join(self.parameters)}) to {self.residuals.size} data"
        return "\n".join([title, *(f"  {name:<15} {text}" for name, text in lines), self.message])

    def corner(self, figure: Figure | None = None, *, quantities: bool = False) -> Figure:
        """Draws the ellipses of one and two standard deviations of every pair of free parameters, or of quantities. Needs matplotlib.

        Parameters
        ----------
        figure : matplotlib.figure.Figure, optional
            By default a new one.
        quantities : bool, optional
            If True, the quantities of `print(fit)` are drawn instead of the parameters, each with its value, standard deviation and unit: periods, pole, phases, and the moments or axis ratios
            that are free. Those that are held or not determined are left out. Their covariance is to first order. Periods have the unit of the times; with units of astropy they are in s, h or d.

        Raises
        ------
        InputError
            `quantities` is neither True nor False, or the data determine no quantity.
        """
        from andoyer.fit._pictures import corner, quantity_corner

        if not isinstance(quantities, (bool, np.bool_)):
            raise refusal("quantities", repr(quantities), "True or False", f"= {quantities!r}: it must be True or False")
        if not quantities:
            return corner(self.parameters, self.covariance, figure)
        found = [quantity for quantity in described(self._steps, self.covariance, self.undetermined) if quantity.free]
        if not found:
            raise refusal("quantities", True, "False", "= True: the data determine no period, pole or phase; the corner of the parameters remains")
        return quantity_corner(found, self.times, figure)

    def light_curve_picture(self, figure: Figure | None = None) -> Figure:
        """Draws the measured points of each night with their standard deviations, the model between them, and the residuals below. Needs matplotlib.

        A curve is parted into nights at gaps of more than ten times the median step, and with units of time of more than six hours too. The first twelve nights are drawn. Magnitudes are
        drawn with the bright end up.

        Parameters
        ----------
        figure : matplotlib.figure.Figure, optional
            By default a new one.

        Returns
        -------
        matplotlib.figure.Figure
            With two axes for each night.

        Raises
        ------
        InputError
            A fit of attitudes.
        """
        from andoyer.fit._pictures import nights_picture

        return nights_picture(self._light("light_curve_picture").light, figure)

    def rivals_picture(self, axes: Axes | None = None) -> Axes:
        """Draws Δχ² of every minimum in `optima` against its precession period P_φ, and the simple rotation against its period. Needs matplotlib.

        Filled markers are minima that the verdict counts as rivals, whose Δχ² over its scale is below 16. Δχ² below 0.1 is drawn at 0.1.

        Parameters
        ----------
        axes : matplotlib.axes.Axes, optional
            By default those of a new figure.

        Raises
        ------
        InputError
            A fit of attitudes.
        """
        from andoyer.fit._pictures import Minimum, minima_picture

        photometric = self._light("rivals_picture")
        minima = [Minimum(optimum.mode, optimum.periods.precession, optimum.delta_chi_square) for optimum in self.optima]
        if self.simple_rotation is not None:
            minima.append(Minimum("principal-axis", self.simple_rotation.period, self.simple_rotation.delta_chi_square))
        return minima_picture(minima, NEAR * photometric.scale, self.times, axes)

    def _light(self, method: str) -> Photometric:
        if self._photometric is None:
            raise refusal("fit", "of attitudes", "of light curves", f"is of attitudes: {method} draws a fit of light curves")
        return self._photometric

    def residual_picture(self, axes: Axes | None = None) -> Axes:
        """Draws the residuals against time. Needs matplotlib.

        Parameters
        ----------
        axes : matplotlib.axes.Axes, optional
            By default those of a new figure.
        """
        from andoyer.fit._pictures import residuals

        return residuals(self.times, self.residuals, axes)


def judged(steps: Steps, step: Array, whitened: Array) -> tuple[Array, Array, str | None]:
    """Covariance of the parameters, directions that are not determined, and the sentence about them if there are any, from the whitened Jacobian at a step."""
    _, singular, directions = np.linalg.svd(whitened, full_matrices=True)
    lost = undetermined(singular, directions)
    kept = len(directions) - len(lost)
    known = directions[:kept] / singular[:kept, None]
    units = steps.units(step)
    relative = known.T @ known
    return relative * np.outer(units, units), lost, sentence(lost, steps, step, relative)
