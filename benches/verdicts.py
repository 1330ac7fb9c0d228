"""Measure how well the verdict on fitted light curves is calibrated, on simulated data that are made without the library and without its model.

    python benches/verdicts.py --count 40 --out verdicts.csv       fits data sets, one row each, then prints the tables; seeds that are in the file already are left out
    python benches/verdicts.py --model facets …                    the same with `shape="facets"`; rows of both models may stand in one file
    python benches/verdicts.py --picture docs/verdicts.png         draws the answers of the file --out
    python benches/verdicts.py --test                              compares the simulation with the library, 10 data sets

A data set has a body of facets (ellipsoid, egg, box, smoothed box), whose moments are sums over tetrahedra; a motion from Euler's equations by DOP853 of SciPy; one of three laws of scattering; directions
that change over weeks; 3 to 10 nights of 4 to 8 h with gaps and an unknown zero point each; a noise of 0.005 to 0.05 mag. The classes are tumblers in the short-axis and in the long-axis mode, principal-axis
rotators, and data that do not determine the motion: few points, weak tumblers, near-spheres. The fit has the semi-axes of the ellipsoid of equal moments with an error of 10 %.

Periods are right if both phases agree within half a turn over the data, the pole if it is within 10° or three standard deviations, the mode if it is the same. For simple rotation the period of the
rotation is compared: for a fit in the short-axis mode this is P_φ about the long axis, of frequency 1/P_φ − 1/P_ψ; where the verdict says that simple rotation explains the data as well, its period. That
counts as wrong for every tumbler, however small its wobble. A cell without a value has a dash.

Rules and their bounds were chosen on seeds 0 to 80; `make verdicts` has others.
"""

import argparse
import csv
import re
import time
from pathlib import Path

import numpy as np
from scipy.integrate import solve_ivp
from scipy.special import ellipj, ellipk

CLASSES = ("short-axis", "long-axis", "principal-axis", "underdetermined")
KINDS = ("few points", "weak tumbler", "near-sphere")
SHAPES = ("ellipsoid", "egg", "box", "smoothed box")
LAWS = ("lambert", "lommel-seeliger", "lommel-seeliger + 0.1 lambert")
PARTS = ("periods", "pole", "mode")
ANSWERS = ("secure right", "secure wrong", "ambiguous", "not determined")
NONE = "–"
MODELS = {"ellipsoid": True, "facets": "facets"}
AXES_ERROR, NEAR_POLE, HALF_TURN, STARTS = 0.1, 10.0, 0.5, 20_000


# Bodies


def sphere(levels):
    """Corners (v, 3) on the unit sphere and triangles (f, 3): an icosahedron, each triangle cut into four `levels` times."""
    golden = (1 + 5**0.5) / 2
    corners = [np.roll([0, s, t * golden], k) for k in range(3) for s in (1, -1) for t in (1, -1)]
    corners = [corner / np.linalg.norm(corner) for corner in corners]
    edge = min(np.linalg.norm(corners[0] - other) for other in corners[1:]) * 1.01
    near = [[np.linalg.norm(a - b) < edge for b in corners] for a in corners]
    triangles = [(i, j, k) for i in range(12) for j in range(i) for k in range(j) if near[i][j] and near[j][k] and near[i][k]]
    for _ in range(levels):
        middles = {}

        def middle(i, j, middles=middles):
            key = (min(i, j), max(i, j))
            if key not in middles:
                middles[key] = len(corners)
                total = corners[i] + corners[j]
                corners.append(total / np.linalg.norm(total))
            return middles[key]

        triangles = [
            part for i, j, k in triangles for a, b, c in [(middle(i, j), middle(j, k), middle(k, i))] for part in ((i, a, c), (a, j, b), (c, b, k), (a, b, c))
        ]
    return np.array(corners), np.array(triangles)


def outward(corners, triangles):
    """Triangles of a body that is star-shaped about the origin, each with its corners counterclockwise from outside."""
    a, b, c = (corners[triangles[:, place]] for place in range(3))
    inward = np.einsum("fi,fi->f", np.cross(b - a, c - a), a) < 0
    turned = triangles.copy()
    turned[inward] = turned[inward][:, ::-1]
    return turned


def body(shape, axes, generator, levels=3):
    """Corners and triangles of a convex body about as long as `axes`."""
    if shape == "box":
        corners = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
        triangles = np.array(
            [(0, 1, 3), (0, 3, 2), (4, 5, 7), (4, 7, 6), (0, 1, 5), (0, 5, 4), (2, 3, 7), (2, 7, 6), (0, 2, 6), (0, 6, 4), (1, 3, 7), (1, 7, 5)]
        )
        return corners * axes, outward(corners * axes, triangles)
    corners, triangles = sphere(levels)
    if shape == "egg":
        taper = generator.uniform(0.15, 0.35)
        corners = corners * np.stack([np.ones(len(corners)), *2 * [1 + taper * corners[:, 0]]], axis=1)
    elif shape == "smoothed box":
        corners = corners / np.linalg.norm(corners, ord=4, axis=1)[:, None]
    return corners * axes, outward(corners, triangles)


def centred(corners, triangles):
    """The body about its centre of mass and principal axes, its moments in ascending order for the mass 1, and the semi-axes of the ellipsoid of equal moments."""
    faces = corners[triangles]
    volumes = np.linalg.det(faces) / 6
    sums = faces.sum(axis=1)
    volume = volumes.sum()
    centre = np.einsum("f,fi->i", volumes, sums) / 4 / volume
    second = (np.einsum("f,fvi,fvj->ij", volumes, faces, faces) + np.einsum("f,fi,fj->ij", volumes, sums, sums)) / 20 / volume - np.outer(centre, centre)
    squares, axes = np.linalg.eigh(second)
    squares, axes = squares[::-1], axes[:, ::-1]
    axes = axes * [1, 1, np.linalg.det(axes)]
    return (corners - centre) @ axes, squares.sum() - squares, np.sqrt(5 * squares)


def brightness(corners, triangles, law, sun, observer):
    """Sum over the facets that are lit and seen; directions about body axes, shape (n, 3)."""
    a, b, c = (corners[triangles[:, place]] for place in range(3))
    areas = np.cross(b - a, c - a) / 2
    sizes = np.linalg.norm(areas, axis=1)
    lit, seen = (np.maximum(vectors @ (areas / sizes[:, None]).T, 0) for vectors in (sun, observer))
    product = lit * seen
    over = product / np.maximum(lit + seen, 1e-300)
    scattered = {"lambert": product, "lommel-seeliger": over, "lommel-seeliger + 0.1 lambert": over + 0.1 * product}[law]
    return scattered @ sizes


# Motions


def turned(attitudes, vectors):
    """Inertial vectors (n, 3) about body axes, for attitudes [x, y, z, w] from body to inertial components."""
    imaginary, real = -attitudes[:, :3], attitudes[:, 3:]
    cross = np.cross(imaginary, vectors)
    return vectors + 2 * (real * cross + np.cross(imaginary, cross))


def motion(moments, attitude, rates, times):
    """Attitudes (n, 4) at times from 0 on, by Euler's equations and q' = q (ω, 0) / 2."""
    A, B, C = moments

    def slope(_, state):
        x, y, z, w, p, q, r = state
        return [
            (w * p + y * r - z * q) / 2, (w * q + z * p - x * r) / 2, (w * r + x * q - y * p) / 2, -(x * p + y * q + z * r) / 2,
            (B - C) / A * q * r, (C - A) / B * r * p, (A - B) / C * p * q,
        ]  # fmt: skip

    solution = solve_ivp(slope, (0, times[-1]), [*attitude, *rates], "DOP853", times, rtol=1e-11, atol=1e-12 * np.linalg.norm(rates))
    attitudes = solution.y[:4].T
    return attitudes / np.linalg.norm(attitudes, axis=1, keepdims=True)


def mean_periods(moments, momentum):
    """The mode and the mean periods (P_φ, P_ψ) about the extremal axis, for ascending moments and the angular momentum about body axes.

    With M the momentum and 2T twice the energy, P_ψ = 4K/n of Jacobi's functions, and φ' = M (2T − L²/I)/(M² − L²) for the component L along the axis of moment I.
    """
    square, energy = momentum @ momentum, momentum @ (momentum / moments)
    short = square > energy * moments[1]
    last, middle, first = moments[::-1] if short else moments
    of_first, of_last = square - energy * first, energy * last - square
    rate = np.sqrt((last - middle) * of_first / moments.prod())
    modulus = (middle - first) * of_last / ((last - middle) * of_first)
    quarter = ellipk(modulus)
    component = last * of_first / (last - first) * ellipj((np.arange(4096) + 0.5) / 4096 * quarter, modulus)[2] ** 2
    mean = np.mean(np.sqrt(square) * (energy - component / last) / (square - component))
    return ("short-axis" if short else "long-axis"), 2 * np.pi / mean, 4 * quarter / rate


def unit(generator):
    """A random direction."""
    vector = generator.standard_normal(3)
    return vector / np.linalg.norm(vector)


def nutation(moments, direction, short):
    """The largest angle [degrees] between the extremal axis and the angular momentum, for a unit direction of the momentum about body axes."""
    energy = direction @ (direction / moments)
    last, middle, first = moments[::-1] if short else moments
    least = (energy - 1 / middle) / (1 / last - 1 / middle)
    most = (energy - 1 / first) / (1 / last - 1 / first)
    return np.degrees(np.arccos(np.sqrt(np.clip(min(least, most), 0, 1))))


def direction_of(kind, moments, generator):
    """A direction of the angular momentum about body axes: of this mode with a nutation of 20° to 75°, or of the short-axis mode with 2° to 6°."""
    least, most = (2, 6) if kind == "weak tumbler" else (20, 75)
    short = kind != "long-axis"
    for _ in range(10_000):
        direction = unit(generator)
        if kind == "weak tumbler":
            direction = np.array([0, 0, 1]) + 0.08 * generator.standard_normal(3) * [1, 1, 0]
            direction /= np.linalg.norm(direction)
        energy = direction @ (direction / moments)
        if (
            (energy * moments[1] < 1) == short
            and abs(energy * moments[1] - 1) > 0.02 * (1 - moments[0] / moments[2])
            and least < nutation(moments, direction, short) < most
        ):
            return direction
    return None


# Data


def directions(times, generator):
    """Directions to the Sun and the observer, shape (n, 3) each, for times [h]: the phase angle stays within 5° to 90°."""
    days, degree = times / 24, np.pi / 180
    longitude = generator.uniform(0, 2 * np.pi) + generator.uniform(0.2, 1.0) * degree * days
    latitude = generator.uniform(-15, 15) * degree + generator.uniform(-0.1, 0.1) * degree * days
    roll = generator.uniform(0, 2 * np.pi) + generator.uniform(-1.5, 1.5) * degree * days
    first = generator.uniform(5, 90)
    last = np.clip(first + generator.uniform(-1.5, 1.5) * days[-1], 5, 90)
    phase = np.interp(days, [0, days[-1]], [first, last]) * degree
    sun = np.stack([np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)], axis=1)
    east = np.stack([-np.sin(longitude), np.cos(longitude), 0 * longitude], axis=1)
    aside = np.cos(roll)[:, None] * east + np.sin(roll)[:, None] * np.cross(sun, east)
    return sun, np.cos(phase)[:, None] * sun + np.sin(phase)[:, None] * aside


def calendar(few, generator):
    """Times [h] from 0 on, and the night of each."""
    nights = int(generator.integers(3, 5 if few else 11))
    days = np.concatenate([[0], np.cumsum(generator.choice([1, 1, 1, 2, 3, 6], nights - 1))])
    times, curves = [], []
    for night, day in enumerate(days):
        length = generator.uniform(4, 8)
        count = int(generator.integers(5, 10) if few else generator.integers(25, 75))
        at = 24 * day + generator.uniform(0, 1) + np.sort((np.arange(count) + generator.uniform(0, 0.3, count)) / count * length)
        gap = at[0] + generator.uniform(0, length) + np.array([0, generator.uniform(0, 0.25) * length])
        kept = at[(generator.uniform(size=count) > 0.1) & ((at < gap[0]) | (at > gap[1]))]
        kept = kept if len(kept) >= 4 else at
        times.append(kept)
        curves.append(np.full(len(kept), night))
    times = np.concatenate(times)
    return times - times[0], np.concatenate(curves)


def draw(seed):
    """A data set.

    Returns a dict: times [h], magnitudes, sigma, curves, each of shape (n,); sun, observer (n, 3); axes (3,); periods (shortest, longest) [h]; truth, a dict with class, kind, shape, law, mode, periods
    (P_φ, P_ψ) [h] about the extremal axis, span [h], pole (longitude, latitude) of the angular momentum [degrees], the state at the first time, semi-axes of the ellipsoid of equal moments, noise and signal [mag].
    """
    generator = np.random.default_rng([72, seed])
    name = CLASSES[seed % len(CLASSES)]
    kind = KINDS[seed // len(CLASSES) % len(KINDS)] if name == "underdetermined" else name
    moved = generator.choice(["short-axis", "long-axis"]) if kind in ("few points", "near-sphere") else kind
    direction = None
    while direction is None:
        shape, law = str(generator.choice(SHAPES)), str(generator.choice(LAWS))
        if kind == "near-sphere":
            shape, ratios = "ellipsoid", np.sort(generator.uniform(0.95, 1.0, 2))[::-1]
        else:
            ratios = np.sort(generator.uniform(0.4, 0.9, 2))[::-1] * [1, 0.95]
        corners, triangles = body(shape, np.array([1, *ratios]), generator)
        corners, moments, axes = centred(corners, triangles)
        triangles = outward(corners, triangles)
        direction = np.array([0, 0, 1.0]) if moved == "principal-axis" else direction_of(moved, moments, generator)
    times, curves = calendar(kind == "few points", generator)
    sun, observer = directions(times, generator)
    period = float(np.exp(generator.uniform(np.log(3), np.log(40))))
    if moved == "principal-axis":
        mode, periods, momentum = "principal-axis", (period, np.inf), direction * moments[2] * 2 * np.pi / period
        slow = np.sqrt((moments[2] - moments[0]) * (moments[2] - moments[1]) / (moments[0] * moments[1]))
        bounds = np.array([period / (1 + slow), period])
    else:
        mode, precession, _ = mean_periods(moments, direction)
        momentum = direction * precession / period
        mode, *periods = mean_periods(moments, momentum)
        bounds = np.array([period, period])
    attitude = generator.standard_normal(4)
    attitude /= np.linalg.norm(attitude)
    rates = momentum / moments
    attitudes = motion(moments, attitude, rates, times)
    exact = -2.5 * np.log10(brightness(corners, triangles, law, turned(attitudes, sun), turned(attitudes, observer)))
    noise = float(np.exp(generator.uniform(np.log(0.02 if kind == "near-sphere" else 0.005), np.log(0.05))))
    sigma = noise * generator.uniform(0.8, 1.25, curves.max() + 1)[curves]
    zero = 15 + 0.3 * generator.standard_normal(curves.max() + 1)
    x, y, z = turned(attitude[None] * [-1, -1, -1, 1], momentum[None])[0]
    return {
        "times": times, "magnitudes": exact + zero[curves] + sigma * generator.standard_normal(len(times)), "sigma": sigma, "curves": curves, "sun": sun, "observer": observer,
        "axes": np.sort(axes * np.exp(AXES_ERROR * generator.standard_normal(3)))[::-1],
        "periods": tuple(float(bound) for bound in bounds * np.exp(generator.uniform([-0.7, 0.2], [-0.2, 0.7]))),
        "truth": {
            "class": name, "kind": kind, "shape": shape, "law": law, "mode": mode, "periods": tuple(float(value) for value in periods), "span": float(times[-1]),
            "pole": (float(np.degrees(np.arctan2(y, x)) % 360), float(np.degrees(np.arctan2(z, np.hypot(x, y))))),
            "attitude": attitude, "angular_velocity": rates, "moments": moments, "axes": axes, "noise": noise, "signal": float(np.std(exact - mean_of(exact, curves))),
            "body": (corners, triangles), "exact": exact,
        },
    }  # fmt: skip


def mean_of(values, curves):
    """The mean of its curve for each value."""
    return (np.bincount(curves, values) / np.bincount(curves))[curves]


# Verdicts


def state_of(scene):
    """Mode, periods about the extremal axis, and unit direction of the angular momentum."""
    from andoyer import Scene

    motion = Scene(scene.body, scene.attitude, scene.angular_velocity).solve()
    momentum = np.asarray(motion.angular_momentum(0.0))
    return motion.plan.mode, tuple(float(period) for period in motion.periods["extremal-axis"]), momentum / np.linalg.norm(momentum)


def pole_deviation(found):
    """The standard deviation of the pole [degrees] from the lines of `print(found)`; NaN if they give none."""
    lines = dict(re.findall(r"pole (longitude|latitude) +(.+)", str(found)))
    values = {name: re.match(r"(\S+) ± ([^°\s]+)°", line) for name, line in lines.items()}
    if len(values) < 2 or not all(values.values()):
        return np.nan
    latitude = np.radians(float(values["latitude"][1]))
    return float(np.hypot(float(values["longitude"][2]) * np.cos(latitude), float(values["latitude"][2])))


def direction_to(pole):
    """A unit vector from longitude and latitude [degrees]."""
    longitude, latitude = np.radians(pole)
    return np.array([np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)])


def agreement(state, deviation, truth):
    """Which of periods, pole and mode of a state are those of the truth, and how far apart the poles are [degrees]."""
    mode, periods, pole = state
    frequencies, true = 1 / np.array(periods), 1 / np.array(truth["periods"])
    if truth["mode"] == "principal-axis":
        tumbles = mode == "short-axis" and np.isfinite(periods).all()
        frequencies, true = frequencies[:1] - frequencies[1:] * tumbles, true[:1]
        same = mode != "long-axis"
    else:
        same = mode == truth["mode"]
    apart = float(np.degrees(np.arccos(np.clip(pole @ direction_to(truth["pole"]), -1, 1))))
    return {
        "periods": bool(same and np.all(np.abs(frequencies - true) * truth["span"] < HALF_TURN)),
        "pole": bool(apart <= NEAR_POLE or apart <= 3 * deviation),
        "mode": mode == truth["mode"],
    }, apart


def truth_in(verdict, fit, truth):
    """Whether periods, pole and mode of the best state are right, and, under "secure", whether each of them that the verdict calls secure is right."""
    right, _ = agreement(state_of(fit.scene), pole_deviation(fit), truth)
    if verdict.simple:
        optimum = fit.simple_rotation.optimum
        right["periods"] = agreement(("principal-axis", tuple(optimum.periods), optimum.direction), np.nan, truth)[0]["periods"]
    secure = [part for part in PARTS if getattr(verdict, part) == "secure"]
    return right | {"secure": all(right[part] for part in secure)}


def fitted(data, model, axes=None, **options):
    """The fit of a data set by one of MODELS."""
    from andoyer import fit

    given = {name: data[name] for name in ("sun", "observer", "curves")} | {"shape": MODELS[model]} | options
    axes = data["axes"] if axes is None else axes
    return fit.light_curve(axes, data["times"], magnitudes=data["magnitudes"], sigma=data["sigma"], **given)


def from_truth(data, model):
    """χ² of the minimum next to the true state and the true axes; NaN if the search fails. A best minimum above it was missed by the starts."""
    from andoyer import Body, Error, Scene

    truth = data["truth"]
    try:
        scene = Scene(Body.ellipsoid(*truth["axes"]), truth["attitude"], truth["angular_velocity"])
        return float(fitted(data, model, truth["axes"], scene=scene).chi_square)
    except Error:
        return np.nan


def row(seed, starts, model):
    """One row of the table."""
    from andoyer import Error

    data = draw(seed)
    truth = data["truth"]
    line = {
        "seed": seed, "model": model, "class": truth["class"], "kind": truth["kind"], "shape": truth["shape"], "law": truth["law"], "nights": int(data["curves"].max()) + 1, "points": len(data["times"]),
        "span [h]": f"{truth['span']:.2f}", "noise [mag]": f"{truth['noise']:.4f}", "signal to noise": f"{truth['signal'] / truth['noise']:.2f}", "starts": starts,
        "true mode": truth["mode"], "true P_φ [h]": f"{truth['periods'][0]:.6g}", "true P_ψ [h]": f"{truth['periods'][1]:.6g}",
        "true longitude [°]": f"{truth['pole'][0]:.2f}", "true latitude [°]": f"{truth['pole'][1]:.2f}",
    }  # fmt: skip
    begin = time.process_time()
    try:
        found = fitted(data, model, periods=data["periods"], starts=starts, rng=seed)
    except Error as error:
        return line | {"processor [s]": f"{time.process_time() - begin:.1f}", "error": str(error)}
    verdict = found.verdict
    processor = time.process_time() - begin
    state, deviation = state_of(found.scene), pole_deviation(found)
    apart = agreement(state, deviation, truth)[1]
    right = truth_in(verdict, found, truth)
    places = [
        place
        for place, optimum in enumerate(found.optima)
        if all(agreement(state_of(optimum.scene), deviation, truth)[0][part] for part in ("periods", "pole"))
    ]
    least = found.chi_square
    return line | {
        "best mode": state[0], "P_φ [h]": f"{state[1][0]:.6g}", "P_ψ [h]": f"{state[1][1]:.6g}", "pole apart [°]": f"{apart:.2f}", "pole σ [°]": f"{deviation:.3g}",
        **{f"right {part}": int(right[part]) for part in PARTS}, **{f"verdict {part}": getattr(verdict, part) for part in PARTS}, "secure is right": int(right["secure"]),
        "simple": int(verdict.simple), "P [h]": f"{found.simple_rotation.period:.6g}",
        "reduced χ²": f"{found.reduced_chi_square:.4g}", "χ²": f"{least:.2f}", "χ² from truth": f"{from_truth(data, model):.2f}", "minima": len(found.optima),
        "truth is minimum": places[0] + 1 if places else "", "truth Δχ²": f"{found.optima[places[0]].chi_square - least:.2f}" if places else "",
        **{f"margin {part}": f"{margin:.4g}" for part, margin in zip(PARTS, verdict.margins)}, "reached": verdict.reached,
        "chance": f"{found.simple_rotation.probability:.3g}", "processor [s]": f"{processor:.1f}", "error": "",
    }  # fmt: skip


def answer(line, part):
    """One of ANSWERS, or "" without a verdict."""
    said = line[f"verdict {part}"]
    return f"secure {'right' if line[f'right {part}'] == '1' else 'wrong'}" if said == "secure" else said


BINS = {
    "class": lambda line: line["class"],
    "nights": lambda line: next(f"{low:2d} to {high:2d}" for low, high in ((3, 4), (5, 7), (8, 10)) if int(line["nights"]) <= high),
    "signal to noise": lambda line: next(
        name for high, name in ((3, " 0 to  3"), (10, " 3 to 10"), (np.inf, "above 10")) if float(line["signal to noise"]) < high
    ),
}


def tables(lines):
    """Prints how often each answer was given, by class, number of nights and signal to noise, and without a verdict how often the best state is right."""
    lines = [line for line in lines if line["error"] == NONE]
    for part in PARTS:
        for title, group in BINS.items():
            print(f"\n{part}, by {title}:  " + "  ".join(ANSWERS) + "  | best state right")
            for name in sorted({group(line) for line in lines}):
                of_group = [line for line in lines if group(line) == name]
                counts = "  ".join(f"{sum(answer(line, part) == said for line in of_group):{len(said)}d}" for said in ANSWERS)
                print(f"  {name:16s} {counts}  | {sum(line[f'right {part}'] == '1' for line in of_group)} of {len(of_group)}")


def picture(lines, path):
    """Draw how often each answer on the periods was given: a panel for each of BINS, in it a bar for each group and model."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    colors = ("#0072B2", "#D55E00", "#BBBBBB", "#EEEEEE")
    with plt.rc_context({"font.size": 10, "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False}):
        figure, grid = plt.subplots(1, 3, figsize=(11, 3.6), layout="constrained")
        for axes, (title, group) in zip(grid, BINS.items(), strict=True):
            names = [(name, model) for name in sorted({group(line) for line in lines}) for model in MODELS]
            heights = [-place - 0.4 * (place // len(MODELS)) for place in range(len(names))]
            for height, (name, model) in zip(heights, names, strict=True):
                here = [answer(line, "periods") for line in lines if (group(line), line["model"]) == (name, model)]
                left = 0.0
                for said, color in zip(ANSWERS, colors, strict=True):
                    share = here.count(said) / len(here)
                    axes.barh(height, share, left=left, color=color, label=said if height == 0 else None)
                    left += share
                axes.annotate(str(len(here)), (1.02, height), va="center")
            axes.set(title=f"by {title}", xlabel="share of the sets", xlim=(0, 1.1))
            axes.set_yticks(heights, [f"{name}, {model}" for name, model in names])
        figure.suptitle("The verdict on the periods")
        figure.legend(*grid[0].get_legend_handles_labels(), loc="outside lower center", ncols=4)
        figure.savefig(path, dpi=110, metadata={"Software": None})
        plt.close(figure)


COLUMNS = [
    "seed", "model", "class", "kind", "shape", "law", "nights", "points", "span [h]", "noise [mag]", "signal to noise", "starts", "true mode", "true P_φ [h]", "true P_ψ [h]",
    "true longitude [°]", "true latitude [°]", "best mode", "P_φ [h]", "P_ψ [h]", "pole apart [°]", "pole σ [°]", *(f"right {part}" for part in PARTS), *(f"verdict {part}" for part in PARTS),
    "secure is right", "simple", "P [h]", "reduced χ²", "χ²", "χ² from truth", "minima", "truth is minimum", "truth Δχ²", *(f"margin {part}" for part in PARTS), "reached", "chance", "processor [s]", "error",
]  # fmt: skip


def main(count, seed, out, starts=STARTS, model="ellipsoid"):
    """Fits data sets from a seed on, writes a row each, and prints the tables of all rows of this model."""
    out = Path(out)
    known = list(csv.DictReader(out.open(encoding="utf-8", newline=""))) if out.exists() else []
    done = {int(line["seed"]) for line in known if line["model"] == model}
    with out.open("a", encoding="utf-8", newline="") as file:
        writer = csv.DictWriter(file, COLUMNS, restval=NONE, lineterminator="\n")
        if not known:
            writer.writeheader()
        for place in range(seed, seed + count):
            if place not in done:
                writer.writerow({name: NONE if cell == "" else cell for name, cell in row(place, starts, model).items()})
                file.flush()
    tables([line for line in csv.DictReader(out.open(encoding="utf-8", newline="")) if line["model"] == model])


def test(count):
    """Prints the largest differences of the simulation from the library: brightness of an ellipsoid (relative), attitude [rad], periods (relative). Fails above 1e-2, 1e-6 and 1e-6."""
    from andoyer import Body, Scene, fit

    worst = np.zeros(3)
    for seed in range(count):
        data = draw(seed)
        truth, times = data["truth"], data["times"]
        library = Scene(Body(truth["moments"]), truth["attitude"], truth["angular_velocity"]).solve()
        own = motion(truth["moments"], truth["attitude"], truth["angular_velocity"], times)
        corners, triangles = body("ellipsoid", truth["axes"], None, 5)
        seen = brightness(corners, triangles, LAWS[1], turned(own, data["sun"]), turned(own, data["observer"]))
        closed = fit.brightness(truth["axes"], own, data["sun"], data["observer"])
        apart = (
            2
            * np.arcsin(
                np.minimum(1, np.linalg.norm(own * np.sign(np.sum(own * library.attitude(times), axis=1))[:, None] - library.attitude(times), axis=1) / 2)
            )
            * 2
        )
        periods = np.array(library.periods["extremal-axis"])
        ratio = 0.0 if truth["mode"] == "principal-axis" else np.max(np.abs(periods / truth["periods"] - 1))
        found = np.array([np.max(np.abs(seen / closed - 1)), apart.max(), ratio])
        print(
            f"{seed:3d} {truth['kind']:15s} {truth['shape']:13s} {library.plan.mode:15s} brightness {found[0]:.1e}  attitude {found[1]:.1e}  periods {found[2]:.1e}",
            flush=True,
        )
        worst = np.maximum(worst, found)
    if np.any(worst > [1e-2, 1e-6, 1e-6]):
        raise SystemExit(f"the simulation differs from the library by {worst}")


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", default="verdicts.csv")
    parser.add_argument("--starts", type=int, default=STARTS)
    parser.add_argument("--model", choices=MODELS, default="ellipsoid")
    parser.add_argument("--picture")
    parser.add_argument("--test", action="store_true")
    arguments = parser.parse_args()
    if arguments.test:
        test(10)
    elif arguments.picture:
        with open(arguments.out, encoding="utf-8", newline="") as data:
            picture([line for line in csv.DictReader(data) if line["error"] == NONE], arguments.picture)
    else:
        main(arguments.count, arguments.seed, arguments.out, arguments.starts, arguments.model)
