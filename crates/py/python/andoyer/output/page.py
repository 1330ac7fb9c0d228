"""One HTML file with an animation of a motion: body, axes, angular momentum, polhode and herpolhode, with a slider of time. The page needs no network.

The page calls `evaluate(t)`, which returns the attitude and the angular velocity at a time; `evaluator` writes its source and finds its error. The page computes
everything else, including the Andoyer variables, from these seven numbers and the moments.
"""

from __future__ import annotations

import base64
import html
import json
import math
import os
from importlib import resources
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from andoyer._core import Motion, RepresentationError
from andoyer._quaternions import angle_between, conjugate, product
from andoyer._refusal import refusal
from andoyer.output.attitude_types import derivative
from andoyer.output.files import whole_file
from andoyer.output.span import within_span

PERIODS = 3
"""Periods of the polhode that are shown if no interval is given."""

MOST_ROTATIONS = 60
"""Rotations that are shown at most then: of a small wobble the polhode takes far more."""

NODES = 192
"""Nodes of the table a rotation."""

MOST_NODES = 40_000
"""Seven doubles each: 3 MB of page."""

LEAST_NODES = 64


def page(
    motion: Motion,
    path: str | os.PathLike[str],
    *,
    interval: tuple[float, float] | None = None,
    mesh: tuple[ArrayLike, ArrayLike] | None = None,
    unit: str = "s",
    elements_of: Literal["rotating", "disturbing"] | None = None,
    force: bool = True,
) -> float:
    """Write one self-contained HTML page with an animation of the motion.

    The page shows the body (the homogeneous ellipsoid of its moments, or a mesh), its axes, the angular momentum M upwards, the angular velocity ω, the
    polhode on the body and the herpolhode in inertial space. It shows the Andoyer angles, J and the rates as numbers. The animation runs, or the user sets the time with a slider.

    Parameters
    ----------
    motion : Motion
        The motion to show.
    path : path-like
        File to write.
    interval : pair of float, optional
        First and last time. By default three periods of the polhode from the epoch, at most 60 rotations.
    mesh : pair of array_like, optional
        Vertices (n, 3) in body components, in any unit of length, and faces (m, 3), as indices of vertices, counterclockwise from outside.
    unit : str, optional
        Name of the unit of time.
    elements_of : {"rotating", "disturbing"}, optional
        Whose orbit the scene has, as in `Scene.from_orbital`. With it the page shows roll, pitch and yaw against "lvlh", and has a box "turn with the orbit": the view keeps this frame at rest,
        the primary downwards, with arrows forward and to the primary. The default interval is then the span, at most 60 rotations.
    force : bool, optional
        If True, an existing file is replaced.

    Returns
    -------
    float
        Largest angle [rad] found between the attitude of the page and that of the motion.

    Raises
    ------
    FileExistsError
        The file exists, and ``force=False``.
    InputError
        An interval of zero length; an unknown `elements_of`, or one of a scene without an orbit; for a motion without code (`Motion.to_code`) an interval of more than 208 rotations; a mesh of another shape.

    Examples
    --------
    >>> from andoyer import plot
    >>> motion = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0], name="wobble").solve()
    >>> plot.page(motion, "wobble.html") < 1e-13
    True
    """
    start, stop = _interval(motion, elements_of is not None) if interval is None else (float(interval[0]), float(interval[1]))
    if not (math.isfinite(start) and math.isfinite(stop) and start < stop):
        raise refusal("interval", (start, stop), "two finite times", f"must be two finite times, the first below the second: got {(start, stop)!r}")
    source, error = evaluator(motion, start, stop)
    scene = motion.scene
    data = _data(motion, start, stop, unit, error, mesh)
    if elements_of is not None:
        data["orbit"] = _frames(motion, start, stop, elements_of)
    title = html.escape(scene.name or scene.body.name or "A rigid body")
    parts = {
        "@TITLE@": title,
        "@DATA@": _script(data),
        "@EVALUATOR@": source,
        "@DRAWING@": _part("_page_drawing.js"),
    }
    text = _part("_page.html")
    for mark, part in parts.items():
        text = text.replace(mark, part)
    with whole_file(path, force) as temporary:
        temporary.write_text(text, encoding="utf-8")
    return error


def evaluator(motion: Motion, start: float, stop: float) -> tuple[str, float]:
    """JavaScript that defines `evaluate(t)` between two times, and the largest angle [rad] between its attitude and that of the motion.

    The evaluator is the code of the motion (`Motion.to_code`). For a motion without code, on the separatrix or under a torque, it is a table.
    """
    try:
        text, error, _ = motion._code("javascript")
    except RepresentationError:
        return _table(motion, start, stop)
    return f"const evaluate = (() => {{\n{text}return t => Array.from(rotation(t));\n}})();", error


def _table(motion: Motion, start: float, stop: float) -> tuple[str, float]:
    """A table with cubic Hermite interpolation of the quaternion: between nodes a 192th of a rotation apart it leaves some 1e-9 rad."""
    rate = _largest_rate(motion, start, stop)
    count = max(LEAST_NODES, math.ceil(rate * (stop - start) / (2 * math.pi) * NODES))
    if count > MOST_NODES:
        rotations = MOST_NODES // NODES
        asked = rate * (stop - start) / (2 * math.pi)
        raise refusal("interval", asked, rotations, f"must have at most {rotations} rotations: got {asked:.4g}")
    times = np.linspace(start, stop, count + 1)
    samples = motion.at(times)
    turned = np.concatenate([[False], np.cumsum(np.sum(samples.attitude[1:] * samples.attitude[:-1], axis=1) < 0) % 2 == 1])
    attitude = samples.attitude * np.where(turned, -1.0, 1.0)[:, None]
    rows = np.column_stack([attitude, samples.angular_velocity])
    table = {"start": start, "stop": stop, "values": base64.b64encode(rows.astype("<f8").tobytes()).decode("ascii")}
    return f"const TABLE = {_script(table)};\n{_part('_page_table.js')}", _error(motion, times, rows)


def _error(motion: Motion, times: Any, rows: Any) -> float:
    """The largest angle that the interpolation of the table leaves between its nodes, at three places between each two."""
    step, attitude = times[1] - times[0], rows[:, :4]
    change = step * derivative(attitude, rows[:, 4:])
    worst = 0.0
    for part in (0.2, 0.5, 0.8):
        rest = 1 - part
        here = (1 + 2 * part) * rest**2 * attitude[:-1] + part * rest**2 * change[:-1]
        here += (1 + 2 * rest) * part**2 * attitude[1:] - rest * part**2 * change[1:]
        here /= np.linalg.norm(here, axis=1, keepdims=True)
        worst = max(worst, float(np.max(angle_between(here, motion.attitude(times[:-1] + part * step)))))
    return worst


def _interval(motion: Motion, whole: bool) -> tuple[float, float]:
    """Three periods of the polhode, or the `whole` span if there is one, at most sixty rotations; a unit of time at rest."""
    start = motion.scene.epoch
    precession, rotation = motion.periods["long-axis"]
    rate = float(np.linalg.norm(motion.scene.angular_velocity))
    if whole and motion.scene.span is not None:
        start, stop = motion.scene.span
        return start, min(stop, start + MOST_ROTATIONS * 2 * math.pi / rate) if rate > 0 else stop
    spans = [PERIODS * rotation, MOST_ROTATIONS * 2 * math.pi / rate if rate > 0 else math.inf, MOST_ROTATIONS * precession]
    span = min(span for span in [*spans, math.inf])
    return within_span(motion, start, start + (span if math.isfinite(span) else 1.0))


def _frames(motion: Motion, start: float, stop: float, elements_of: Literal["rotating", "disturbing"]) -> dict[str, Any]:
    """Quaternions from the frame "lvlh" to inertial components at equal steps. Between them the page interpolates linearly, to some 0.01° times the eccentricity."""
    few = np.linspace(start, stop, 512)
    turning = motion.angular_velocity(few) - motion.orbital(few, elements_of=elements_of, frame="lvlh").angular_velocity
    turns = float(np.max(np.linalg.norm(turning, axis=1))) * (stop - start) / (2 * math.pi)
    times = np.linspace(start, stop, min(MOST_NODES, max(LEAST_NODES, math.ceil(turns * NODES))) + 1)
    frames = product(motion.attitude(times), conjugate(motion.orbital(times, elements_of=elements_of, frame="lvlh").attitude))
    turned = np.concatenate([[False], np.cumsum(np.sum(frames[1:] * frames[:-1], axis=1) < 0) % 2 == 1])
    return {"frames": (frames * np.where(turned, -1.0, 1.0)[:, None]).round(9).tolist()}


def _largest_rate(motion: Motion, start: float, stop: float) -> float:
    return float(np.max(np.linalg.norm(motion.angular_velocity(np.linspace(start, stop, 512)), axis=1)))


def _data(motion: Motion, start: float, stop: float, unit: str, error: float, mesh: tuple[ArrayLike, ArrayLike] | None) -> dict[str, Any]:
    """The data of the motion in the page, except the evaluator."""
    moments = motion.scene.body.moments
    order = np.argsort(moments, kind="stable")
    rate = _largest_rate(motion, start, stop)
    rotation = motion.periods["long-axis"].rotation
    data: dict[str, Any] = {
        "moments": moments.tolist(),
        "axes": motion.scene.body.principal_axes.T.tolist(),
        "order": order.tolist(),
        "reversed": bool(np.linalg.det(np.eye(3)[order]) < 0),
        "start": start,
        "stop": stop,
        "polhodeStop": min(stop, start + rotation) if math.isfinite(rotation) else stop,
        "largestRate": rate,
        "rotations": rate * (stop - start) / (2 * math.pi),
        "unit": unit,
        "semiaxes": np.sqrt(np.maximum(moments.sum() - 2 * moments, 1e-4 * moments.max())).tolist(),
        "facts": _facts(motion, unit, error),
    }
    if mesh is not None:
        data["mesh"] = _mesh(*mesh)
    return data


def _facts(motion: Motion, unit: str, error: float) -> list[list[str]]:
    plan = motion.plan
    facts = [["mode", plan.mode], ["method", plan.method]]
    for convention, (precession, rotation) in motion.periods.items():
        facts += [[f"P_φ, {convention}", f"{precession:.8g} {unit}"], [f"P_ψ, {convention}", f"{rotation:.8g} {unit}"]]
    facts += [
        ["E/E₀", f"{motion.energy_ratio:.8g}"],
        ["error bound", f"{plan.error_bound:.2g} rad" if plan.error_bound < np.pi else "unknown"],
        ["error of this page", f"{error:.2g} rad"],
    ]
    return facts


def _mesh(vertices: ArrayLike, faces: ArrayLike) -> dict[str, Any]:
    points, corners = np.asarray(vertices, dtype=np.float64), np.asarray(faces)
    if points.ndim != 2 or points.shape[1] != 3 or not np.isfinite(points).all():
        raise refusal("mesh", points.shape, "(n, 3)", f"must have finite vertices of shape (n, 3): got {points.shape}")
    if corners.ndim != 2 or corners.shape[1] != 3 or corners.dtype.kind not in "iu" or corners.size == 0 or corners.min() < 0 or corners.max() >= len(points):
        bound = f"of shape (m, 3), whole numbers from 0 to {len(points) - 1}"
        raise refusal("mesh", corners.shape, bound, f"must have faces {bound}: got shape {corners.shape}")
    return {"vertices": points.tolist(), "faces": corners.tolist()}


def _part(name: str) -> str:
    return resources.files("andoyer.output").joinpath(name).read_text(encoding="utf-8")


def _script(value: Any) -> str:
    """JSON for a script element, escaped so that no text in it can end the element."""
    return json.dumps(value, ensure_ascii=True, allow_nan=False).replace("<", "\\u003c")
