"""Picture of how the members of an ensemble tumble at one time."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from andoyer._extra import extra
from andoyer._refusal import refusal
from andoyer.distribution import Distribution
from andoyer.plot._style import BLUE, GREEN, STYLE, VERMILION

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MARKERS = {"short-axis": (BLUE, "o"), "long-axis": (VERMILION, "^")}
"""Colour and marker of a mode; all other modes share the third."""
OTHERS = (GREEN, "s")


def distribution(members: Distribution) -> "Figure":
    """Draw a distribution: energy over momentum, the periods, and the direction of the angular momentum, by mode.

    Parameters
    ----------
    members : Distribution
        Of `Ensemble.after`. Members without a motion are left out.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    InputError
        No member has a motion.
    """
    if not (members.mode != "").any():
        raise refusal("members", "none with a motion", "at least one", "has no member with a motion at its time")
    plt: Any = extra("matplotlib.pyplot", "andoyer.plot")
    with plt.rc_context(STYLE):
        figure: Figure
        figure, (left, middle, right) = plt.subplots(1, 3, figsize=(12, 4), layout="constrained")
        periods, direction = members.periods["extremal-axis"], members.direction
        longitude, latitude = _longitudes(direction), np.arcsin(np.clip(direction[:, 2], -1, 1))
        for mode, share in members.share().items():
            color, marker = MARKERS.get(mode, OTHERS)
            chosen = members.mode == mode
            style = {"color": color, "marker": marker, "s": 12, "linewidths": 0, "alpha": 0.6}
            left.scatter(members.momentum[chosen], members.energy_ratio[chosen], label=f"{mode}, {100 * share:.3g} %", **style)
            finite = chosen & np.isfinite(periods.rotation) & np.isfinite(periods.precession)
            middle.scatter(periods.precession[finite], periods.rotation[finite], **style)
            right.scatter(np.degrees(longitude[chosen]), np.degrees(latitude[chosen]), **style)
        left.set(xlabel="angular momentum [moment × rate]", ylabel="E/E0 [1]")
        left.legend(loc="best")
        middle.set(xlabel="period of precession [time]", ylabel="period of rotation [time]")
        right.set(xlabel="longitude of the momentum [°]", ylabel="latitude [°]")
        changed = int(members.changed.sum())
        figure.suptitle(f"{len(members)} members at {members.time}: {changed} changed their mode", x=0.01, ha="left")
    return figure


def _longitudes(direction: NDArray[np.float64]) -> NDArray[np.float64]:
    """Longitudes within half a turn of that of the mean direction, so that a cloud about ±180° is not torn."""
    mean = np.nanmean(direction, axis=0)
    middle = np.arctan2(mean[1], mean[0])
    longitude = np.arctan2(direction[:, 1], direction[:, 0])
    return np.asarray(middle + np.mod(longitude - middle + np.pi, 2 * np.pi) - np.pi)
