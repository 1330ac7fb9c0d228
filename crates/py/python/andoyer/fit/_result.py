"""`Fit`: a state with its uncertainty."""

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from andoyer._core import Ensemble, Orbit, Scene
from andoyer._quaternions import Array
from andoyer.fit._degeneracy import sentence, undetermined
from andoyer.fit._given import refusal
from andoyer.fit._steps import Steps

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST_DRAWS = 100
"""Largest number of draws for each valid state."""


@dataclass(frozen=True, eq=False)
class Optimum:
    """A minimum of χ² from a search with many starts."""

    scene: Scene
    mode: str
    """The mode of its motion, such as "short-axis"."""
    chi_square: float
    """χ² at the minimum."""


@dataclass(frozen=True, eq=False)
class Fit:
    """The state that fits the data best, with its uncertainty, from `attitudes` or `light_curve`.

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
    """Names of the free parameters: a small rotation θ1…θ3 about body axes at the epoch [rad], angular velocities ω1…ω3, principal moments I1…I3, axis ratios b/a, c/a."""
    covariance: Array
    """Covariance of the free parameters, shape (k, k), in their units; 0 along directions that the data do not determine (see `undetermined`)."""
    undetermined: Array
    """Directions that the data do not determine, shape (d, k), as unit vectors of relative changes (of angles: in rad)."""
    residuals: Array
    """Measured minus model: rotation vectors about body axes, shape (n, 3), in rad; or brightnesses, shape (n,)."""
    chi_square: float
    """Sum of the squared residuals over their variances."""
    degrees_of_freedom: int
    """Number of data minus number of parameters that they determine."""
    message: str
    """A sentence on the directions that the data do not determine."""
    times: Any = field(repr=False)
    """The times of the data as given."""
    optima: tuple[Optimum, ...] = ()
    """All minima within Δχ² of the best, the best first; of `light_curve`."""
    semi_axes: Array | None = None
    """Semi-axes of the ellipsoid along principal axes 1, 2, 3; of `light_curve`."""

    @property
    def reduced_chi_square(self) -> float:
        """χ² divided by the degrees of freedom: near 1 if the model and `sigma` are right; NaN if there are no degrees of freedom."""
        return self.chi_square / self.degrees_of_freedom if self.degrees_of_freedom > 0 else float("nan")

    def ensemble(self, n: int, rng: Any = None, *, threads: int | None = None) -> Ensemble:
        """Draw states from the covariance, as an `Ensemble` about principal axes.

        Attitude and rates are drawn from a normal distribution, moments and axis ratios from a log-normal distribution. A draw with impossible moments is repeated. Components that the data do not
        determine are equal in all states.

        Parameters
        ----------
        n : int
            Number of states.
        rng : int or numpy.random.Generator, optional
            A seed or a generator of random numbers.
        threads : int, optional
            Number of threads, as for `Ensemble`.

        Raises
        ------
        InputError
            A number of states that is negative or not whole. The moments are so uncertain that less than one draw in a hundred is valid. A scene with several disturbing bodies or a `TabulatedOrbit`.

        Examples
        --------
        >>> from andoyer import Body, Scene, fit
        >>> scene = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0])
        >>> times = range(100)
        >>> found = fit.attitudes(scene, times, scene.solve().attitude(times), sigma=0.01)
        >>> len(found.ensemble(20, rng=1))
        20
        """
        if not isinstance(n, (int, np.integer)) or isinstance(n, bool) or n < 0:
            raise refusal("n", n, 0, f"= {n!r}: it must be a whole number, 0 or more")
        orbit = self.scene.orbit
        if not (orbit is None or isinstance(orbit, Orbit)):
            raise refusal("scene", type(orbit).__name__, "Orbit", "has several disturbing bodies or a table of positions: an Ensemble takes one Orbit at most")
        steps = Steps(self.scene, self._names(), self.semi_axes)
        root = _root(self.covariance / np.outer(*[steps.units(np.zeros(len(self.parameters)))] * 2))
        generator = np.random.default_rng(rng)
        chosen: list[Array] = []
        missing = n
        for _ in range(MOST_DRAWS):
            draws = generator.standard_normal((missing, len(root))) @ root.T
            moments = steps.moments(draws)
            chosen.append(draws[2 * moments.max(axis=1) <= moments.sum(axis=1)])
            missing -= len(chosen[-1])
            if not missing:
                break
        if missing:
            raise refusal("n", n, n - missing, f"= {n}: only {n - missing} draws of the covariance are bodies; fit fewer parameters, or hold the moments")
        moments, attitudes, rates = steps.states(np.concatenate(chosen))
        _, options = self.scene.__getnewargs_ex__()
        shared = {"epochs": options.get("epoch", 0.0), "orbits": orbit, "tolerance": self.scene.tolerance, "span": self.scene.span}
        return Ensemble(moments, _about_principal_axes(self.scene, attitudes), rates @ self.scene.body.principal_axes, threads=threads, **shared)

    def _names(self) -> tuple[str, ...]:
        from andoyer.fit._steps import LABELS

        return tuple(name for name, labels in LABELS.items() if labels[0] in self.parameters)

    def corner(self, figure: "Figure | None" = None) -> "Figure":
        """Draws the ellipses of one and two standard deviations of every pair of free parameters. Needs matplotlib.

        Parameters
        ----------
        figure : matplotlib.figure.Figure, optional
            By default a new one.
        """
        from andoyer.fit._pictures import corner

        return corner(self, figure)

    def residual_picture(self, axes: "Axes | None" = None) -> "Axes":
        """Draws the residuals against time. Needs matplotlib.

        Parameters
        ----------
        axes : matplotlib.axes.Axes, optional
            By default those of a new figure.
        """
        from andoyer.fit._pictures import residuals

        return residuals(self, axes)


def _root(covariance: Array) -> Array:
    """A square root of a covariance that may be singular."""
    values, vectors = np.linalg.eigh((covariance + covariance.T) / 2)
    root: Array = vectors * np.sqrt(np.maximum(values, 0.0))
    return root


def _about_principal_axes(scene: Scene, attitudes: Array) -> Array:
    """Attitudes of the principal axes."""
    axes = scene.body.principal_axes
    if np.array_equal(axes, np.eye(3)):
        return attitudes
    from scipy.spatial.transform import Rotation

    turned: Array = (Rotation.from_quat(attitudes) * Rotation.from_matrix(np.array(axes))).as_quat()
    return turned


def judged(steps: Steps, step: Array, whitened: Array) -> tuple[Array, Array, str]:
    """Covariance of the parameters, directions that are not determined, and the sentence about them, from the whitened Jacobian at a step."""
    _, singular, directions = np.linalg.svd(whitened, full_matrices=True)
    lost = undetermined(singular, directions)
    kept = len(directions) - len(lost)
    known = directions[:kept] / singular[:kept, None]
    units = steps.units(step)
    covariance = known.T @ known * np.outer(units, units)
    return covariance, lost, sentence(lost, steps.labels)
