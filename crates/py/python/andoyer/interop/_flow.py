"""Numerical integration of the motion of a normal form with resonant terms. Only `trajectory` imports SciPy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from andoyer import BirkhoffNormalForm

RELATIVE = 1e-12
"""Relative tolerance of the integration; absolute, the same of the largest new variable at the start."""


def trajectory(normal_form: BirkhoffNormalForm, state: list[float], times: ArrayLike, parameters: dict[str, float] | None, time: float) -> Any:
    """The states at times after `state`, which is that at `time`: integrates Hamilton's equations of K from the new variables of the state, and transforms back."""
    try:
        from scipy.integrate import solve_ivp
    except ImportError as error:
        raise ImportError("the trajectory of a resonant normal form needs SciPy, which is not installed: pip install scipy", name="scipy") from error
    start, asked = normal_form.to_normal(state, parameters, time), np.asarray(times, dtype=float)
    moments = np.atleast_1d(asked)
    normal = np.tile(start, (moments.size, 1))
    absolute = RELATIVE * float(np.max(np.abs(start), initial=1e-300))
    for side in (moments > 0, moments < 0):
        if not side.any():
            continue
        ends = np.unique(np.abs(moments[side]))
        sign = float(np.sign(moments[side][0]))
        flow: Any = lambda t, z, sign=sign: sign * normal_form.rates(z, parameters, time + sign * t)  # noqa: E731
        done = solve_ivp(
            flow,
            (0.0, ends[-1]),
            start,
            method="DOP853",
            t_eval=ends,
            rtol=RELATIVE,
            atol=absolute,
        )
        if not done.success:
            raise ArithmeticError(f"the integration of the normal form ended at t = {sign * done.t[-1] if done.t.size else 0.0}: {done.message}")
        normal[side] = done.y.T[np.searchsorted(ends, np.abs(moments[side]))]
    states = normal_form.from_normal(normal, parameters, time + moments)
    return states.reshape(*asked.shape, start.size)
