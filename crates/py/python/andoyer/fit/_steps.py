"""The parameters of a fit, as dimensionless steps from a first state.

A step has three components for the attitude, R → R exp([s]×) with s in rad about body axes; three for the angular velocity, in units of its size at the first state; three for
the logarithms of the moments, or two for those of the axis ratios of a homogeneous ellipsoid. So no step leads to a moment below 0, and all have the size of a relative change.
A body from an inertia tensor has six components for its elements too, in units of their mean principal moment.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from andoyer._core import Body, Scene
from andoyer._quaternions import Array, product
from andoyer.fit._rotations import exponential, right_jacobian

LABELS = {
    "attitude": ("θ1", "θ2", "θ3"),
    "angular_velocity": ("ω1", "ω2", "ω3"),
    "spin": ("ω",),
    "moments": ("I1", "I2", "I3"),
    "inertia": ("I11", "I22", "I33", "I12", "I13", "I23"),
    "shape": ("b/a", "c/a"),
}
"""Names of the components: a rotation vector, body rates or that about one axis, principal moments, elements of the inertia tensor, ratios of semi-axes."""
WORDS = {
    "θ1": "the attitude about axis 1", "θ2": "the attitude about axis 2", "θ3": "the attitude about axis 3",
    "ω1": "the angular velocity about axis 1", "ω2": "the angular velocity about axis 2", "ω3": "the angular velocity about axis 3",
    "ω": "the angular velocity",
    "I1": "the moment about axis 1", "I2": "the moment about axis 2", "I3": "the moment about axis 3",
    "I11": "the element I11", "I22": "the element I22", "I33": "the element I33", "I12": "the element I12", "I13": "the element I13", "I23": "the element I23",
    "b/a": "the axis ratio b/a", "c/a": "the axis ratio c/a",
}  # fmt: skip
FIXED_MOMENTS = 6
"""Components of a state before those of the body."""
ELEMENTS = ([0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2])
"""Rows and columns of the six elements of a tensor."""


@dataclass(frozen=True, eq=False)
class Steps:
    """Steps from the state of a scene, of which some components are free."""

    origin: Scene
    free: tuple[str, ...]
    semi_axes: Array | None = None
    """Of a homogeneous ellipsoid, along principal axes 1, 2, 3; None where moments are parameters."""
    pace: float = 1.0
    """Rate that stands for that of a body at rest."""
    spin: int = 2
    """The body axis of a simple rotation, where "spin" is free."""

    @property
    def labels(self) -> tuple[str, ...]:
        """Names of the free components."""
        return tuple(label for name in self.free for label in LABELS[name])

    @property
    def _body(self) -> str:
        return "inertia" if "inertia" in self.free else "moments" if self.semi_axes is None else "shape"

    @property
    def _places(self) -> list[int]:
        """Where the free components are among all."""
        starts = {"attitude": 0, "angular_velocity": 3, "spin": 3 + self.spin, self._body: FIXED_MOMENTS}
        return [starts[name] + place for name in self.free for place in range(len(LABELS[name]))]

    @property
    def rate(self) -> float:
        """Rate in units of which angular velocities step."""
        size = float(np.linalg.norm(self.origin.angular_velocity))
        return size if size > 0 else self.pace

    def full(self, steps: ArrayLike) -> Array:
        """All components, 0 for those that are not free."""
        steps = np.asarray(steps, dtype=np.float64)
        full = np.zeros((*steps.shape[:-1], FIXED_MOMENTS + len(LABELS[self._body])))
        full[..., self._places] = steps
        return full

    def axes(self, steps: ArrayLike) -> Array:
        """Semi-axes of the ellipsoid, whose first stays."""
        assert self.semi_axes is not None
        logarithms = self.full(steps)[..., FIXED_MOMENTS:]
        axes: Array = self.semi_axes * np.exp(np.concatenate([np.zeros((*logarithms.shape[:-1], 1)), logarithms], axis=-1))
        return axes

    def tensors(self, steps: ArrayLike) -> Array:
        """Inertia tensors about the user's axes, whose elements are free, shape (…, 3, 3)."""
        elements = self.full(steps)[..., FIXED_MOMENTS:] * self.size
        changes = np.zeros((*elements.shape[:-1], 3, 3))
        changes[..., ELEMENTS[0], ELEMENTS[1]] = elements
        changes[..., ELEMENTS[1], ELEMENTS[0]] = elements
        tensors: Array = self.origin.body.inertia + changes
        return tensors

    @property
    def size(self) -> float:
        """Mean principal moment, in units of which the elements of a tensor step."""
        return float(np.mean(self.origin.body.moments))

    def moments(self, steps: ArrayLike) -> Array:
        """Principal moments."""
        if self._body == "inertia":
            moments: Array = np.asarray(np.linalg.eigvalsh(self.tensors(steps)), dtype=np.float64)
        elif self.semi_axes is None:
            moments = np.asarray(self.origin.body.moments * np.exp(self.full(steps)[..., FIXED_MOMENTS:]), dtype=np.float64)
        else:
            moments = moments_of_ellipsoid(self.axes(steps))
        return moments

    def states(self, steps: ArrayLike) -> tuple[Array, Array, Array]:
        """Principal moments, attitudes and angular velocities, each with the leading axes of the steps."""
        full = self.full(steps)
        attitudes = product(np.broadcast_to(self.origin.attitude, (*full.shape[:-1], 4)), exponential(full[..., :3]))
        return self.moments(steps), attitudes, self.origin.angular_velocity + self.rate * full[..., 3:6]

    def principal_axes(self, steps: ArrayLike) -> Array:
        """Principal axes as the columns of rotations, in the order of `moments`, with the leading axes of the steps."""
        if self._body != "inertia":
            return np.broadcast_to(self.origin.body.principal_axes, (*np.shape(steps)[:-1], 3, 3))
        _, axes = np.linalg.eigh(self.tensors(steps))
        axes[..., 2] *= np.linalg.det(axes)[..., None]
        return axes

    def common_factor(self, step: ArrayLike) -> Array | None:
        """The direction in which all elements of the tensor change by a common factor, or None where they are not free."""
        if self._body != "inertia":
            return None
        factor = np.zeros(len(self.labels))
        factor[self.labels.index("I11") :] = self.tensors(step)[ELEMENTS]
        normalized: Array = factor / np.linalg.norm(factor)
        return normalized

    def scene(self, step: ArrayLike) -> Scene:
        """The scene that a step leads to, with the options of the first.

        Raises
        ------
        InputError
            Moments that no body has.
        """
        moments, attitude, rates = self.states(step)
        body = self.origin.body
        if self._body == "inertia":
            body = Body.from_inertia(self.tensors(step), name=body.name)
        elif np.any(moments != body.moments):
            axes = body.principal_axes
            body = Body.from_inertia(axes * moments @ axes.T, name=body.name) if body.has_tensor else Body(moments, name=body.name)
        _, options = self.origin.__getnewargs_ex__()
        return Scene(body, attitude, rates, **options)

    def columns(self, partials: Array, step: ArrayLike, body: Body) -> Array:
        """Convert derivatives by the nine or twelve parameters of `Motion.partials` into derivatives by the free components."""
        full = self.full(step)
        attitude, rates = partials[..., :3] @ right_jacobian(full[:3]), partials[..., 3:6] * self.rate
        by_body = partials[..., FIXED_MOMENTS:]
        if self._body == "inertia":
            by_step = by_body * self.size
        else:
            if body.has_tensor:
                by_body = by_body @ elements_by_moments(self.origin.body.principal_axes)
            by_step = by_body * self.moments(step)
            if self.semi_axes is not None:
                by_step = by_step @ logarithms_by_shape(self.axes(step))
        columns: Array = np.concatenate([attitude, rates, by_step], axis=-1)[..., self._places]
        return columns

    def units(self, step: ArrayLike) -> Array:
        """The change of each free parameter, in its unit, for a small unit step."""
        if self._body == "inertia":
            body = np.full(6, self.size)
        else:
            body = self.moments(step) if self.semi_axes is None else self.axes(step)[1:] / self.axes(step)[0]
        units: Array = np.concatenate([np.ones(3), np.full(3, self.rate), body])[self._places]
        return units


def root(covariance: Array, steps: Steps) -> Array:
    """A square root of the covariance of the steps, which may be singular, from that of the parameters."""
    units = steps.units(np.zeros(len(covariance)))
    values, vectors = np.linalg.eigh((covariance + covariance.T) / 2 / np.outer(units, units))
    square_root: Array = vectors * np.sqrt(np.maximum(values, 0.0))
    return square_root


def elements_by_moments(axes: Array) -> Array:
    """Derivatives of the elements of a tensor with respect to its principal moments, about fixed principal axes, shape (6, 3)."""
    elements: Array = axes[ELEMENTS[0]] * axes[ELEMENTS[1]]
    return elements


def moments_of_ellipsoid(axes: Array) -> Array:
    """Moments of homogeneous ellipsoids of mass 5: b² + c², a² + c², a² + b²."""
    squares = axes**2
    moments: Array = np.sum(squares, axis=-1, keepdims=True) - squares
    return moments


def logarithms_by_shape(axes: Array) -> Array:
    """Derivatives of the logarithms of the moments with respect to those of b/a and c/a, shape (…, 3, 2)."""
    squares = axes**2
    first, second, third = np.moveaxis(squares, -1, 0)
    zero = np.zeros_like(first)
    rows = np.stack([second, third, zero, third, second, zero], axis=-1).reshape(*first.shape, 3, 2)
    derivatives: Array = 2 * rows / moments_of_ellipsoid(axes)[..., None]
    return derivatives
