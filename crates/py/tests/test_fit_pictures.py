"""Pictures of a fit: nights of a light curve, quantities with units, rival minima."""

import warnings
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

pytest.importorskip("scipy")
matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402

from andoyer import Body, InputError, Scene, fit  # noqa: E402
from andoyer.fit._optimum import Optimum  # noqa: E402
from andoyer.fit._verdict import SimpleRotation  # noqa: E402

AXES = np.array([1.0, 0.7, 0.5])
SUN, OBSERVER = np.array([1.0, 0.3, 0.1]), np.array([0.8, -0.3, 0.05])
TRUTH = Scene(Body.ellipsoid(*AXES), [0.1, -0.5, 0.3, np.sqrt(0.65)], [0.9, 0.2, 3.0])
SIGMA = 0.03


@pytest.fixture(autouse=True)
def _no_warnings_and_no_figures_left():
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        yield
    plt.close("all")


def nights(count, points=20):
    """Times [h] of nights of six hours, and the number of each night."""
    generator = np.random.default_rng(1)
    times = np.concatenate([24.0 * night + np.linspace(0, 6, points) + generator.uniform(0, 0.1, points) for night in range(count)])
    return times, np.repeat(np.arange(count), points)


def measured(times):
    """Magnitudes with noise."""
    exact = 17.3 - 2.5 * np.log10(fit.brightness(AXES, TRUTH.solve().attitude(times), SUN, OBSERVER))
    return exact + SIGMA * np.random.default_rng(2).standard_normal(len(times))


def fitted(times, curves=None, **options):
    """The fit of magnitudes from the true state."""
    start, magnitudes = TRUTH.solve().scene_at(times[0]), measured(times)
    return fit.light_curve(AXES, times, magnitudes=magnitudes, sun=SUN, observer=OBSERVER, sigma=SIGMA, curves=curves, scene=start, **options)


@cache
def three():
    """The fit of three nights with a zero point each."""
    return fitted(*nights(3))


def dated(times):
    """The same fit with calendar dates, whose unit of time is the second."""
    units, time = pytest.importorskip("astropy.units"), pytest.importorskip("astropy.time")
    dates = time.Time("2024-03-01T21:00:00", scale="utc") + times * units.h
    start = TRUTH.solve().at(times[0])
    scene = Scene(TRUTH.body, start.attitude, start.angular_velocity / 3600, epoch=dates[0])
    return fit.light_curve(AXES, dates, magnitudes=measured(times), sun=SUN, observer=OBSERVER, sigma=SIGMA, scene=scene)


@cache
def of_attitudes():
    times = np.linspace(0, 10, 30)
    return fit.attitudes(TRUTH, times, TRUTH.solve().attitude(times), sigma=0.01)


def inside(figure):
    """Whether all that is drawn is inside its figure."""
    figure.canvas.draw()
    box, (width, height) = figure.get_tightbbox(), figure.get_size_inches()
    return bool(min(box.x0, box.y0) > -0.01 and box.x1 < width + 0.01 and box.y1 < height + 0.01)


def apart(texts):
    """Whether texts do not overlap."""
    boxes = [text.get_window_extent() for text in texts if text.get_text()]
    return not any(one.overlaps(other) for place, one in enumerate(boxes) for other in boxes[:place])


def test_each_curve_has_its_points_the_model_and_residuals_with_the_bright_end_up():
    (times, curves), found = nights(3), three()
    figure = found.light_curve_picture()
    assert len(figure.axes) == 6 and inside(figure) and apart([panel._left_title for panel in figure.axes])
    for night in range(3):
        upper, lower = figure.axes[2 * night : 2 * night + 2]
        part = curves == night
        assert upper.yaxis_inverted() and lower.yaxis_inverted()
        model, points = upper.lines[0], upper.containers[0].lines[0]
        assert np.allclose(points.get_xdata(), times[part] - times[part][0]) and np.array_equal(points.get_ydata(), measured(times)[part])
        assert np.allclose(model.get_ydata(), found.model(times[part][0] + model.get_xdata(), curve=night)) and len(model.get_xdata()) >= 200
        assert np.allclose(lower.containers[0].lines[0].get_ydata(), found.residuals[part])
        # The bars are those of the magnitudes, though the fit has intensities.
        (bars,) = upper.containers[0].lines[2]
        assert np.allclose([np.ptp(bar[:, 1]) for bar in bars.get_segments()], 2 * SIGMA)
        assert upper.get_title("left") == f"curve {night}: from {times[part][0]:.6g}"
    assert figure.axes[0].get_ylabel() == "magnitude" and figure.axes[1].get_ylabel() == "measured\n− model"
    assert figure.get_supxlabel() == "time since the start of the night"


def test_a_curve_is_parted_at_its_gaps_and_twelve_nights_are_drawn():
    times, _ = nights(14, points=10)
    figure = plt.figure()
    assert fitted(times).light_curve_picture(figure) is figure and len(figure.axes) == 24
    assert figure.get_suptitle() == "The first 12 of 14 nights: 2 are not drawn"
    one = fitted(nights(1)[0]).light_curve_picture()
    assert len(one.axes) == 2 and one.get_suptitle() == ""


def test_dates_stand_in_the_titles_and_hours_on_the_axis():
    times, _ = nights(2)
    # A break of an hour parts no night where the unit of time is known.
    times = times[(times < 2.5) | (times > 3.5)]
    figure = dated(times).light_curve_picture()
    assert [panel.get_title("left") for panel in figure.axes[::2]] == ["2024-03-01 21:03 UTC", "2024-03-02 21:04 UTC"]
    assert figure.get_supxlabel() == "hours since the start of the night" and 5.9 < figure.axes[0].lines[0].get_xdata()[-1] < 6.1


def test_intensities_are_not_reversed():
    times, curves = nights(2)
    intensities = 10 ** (-0.4 * (measured(times) - 17.3))
    start = TRUTH.solve().scene_at(times[0])
    found = fit.light_curve(AXES, times, intensities, sun=SUN, observer=OBSERVER, sigma=0.0276 * intensities, curves=curves, scene=start)
    figure = found.light_curve_picture()
    assert figure.axes[0].get_ylabel() == "intensity" and not any(panel.yaxis_inverted() for panel in figure.axes)
    assert np.allclose(figure.axes[1].containers[0].lines[0].get_ydata(), found.residuals[curves == 0])


def test_a_night_with_too_many_turns_has_the_model_at_its_points():
    times = np.linspace(0, 2000, 60)
    figure = fitted(times).light_curve_picture()
    assert len(figure.axes) == 2 and len(figure.axes[0].lines[0].get_xdata()) == 60
    assert figure.axes[0].lines[0].get_label() == "model at the points" and figure.axes[0].lines[0].get_linestyle() == "None"


def test_the_corner_of_quantities_has_values_deviations_and_units():
    found = three()
    figure = found.corner(quantities=True)
    labels = [panel.get_xlabel() for panel in figure.axes[-6:]]
    summary = {line[2:17].strip(): line[18:].strip() for line in str(found).splitlines()}
    for label, name in zip(labels, ("P_φ", "P_ψ", "pole longitude", "pole latitude", "phase μ", "phase ν")):
        _, value, deviation = label.split("\n")
        assert f"{value} {deviation}" == summary[name].rstrip("°").replace("-", "−")
    assert [label.split("\n")[0] for label in labels] == ["P_φ", "P_ψ", "pole λ [°]", "pole β [°]", "μ [°]", "ν [°]"]
    assert len(figure.axes) == 36 and inside(figure) and apart([panel.xaxis.label for panel in figure.axes[-6:]])
    hours = dated(nights(3)[0]).corner(quantities=True).axes[-6].get_xlabel().split("\n")
    assert hours[0] == "P_φ [h]" and float(hours[1]) == pytest.approx(TRUTH.solve().periods["extremal-axis"].precession, rel=1e-3)


def test_ellipses_of_quantities_are_those_of_draws():
    """The correlation of both periods: 1,000 draws know it to 0.03 or better, the ellipse is to first order."""
    found = of_attitudes()
    periods = np.array(found.ensemble(1000, rng=1).periods["extremal-axis"])
    ellipse = found.corner(quantities=True).axes[9].lines[0].get_xydata()[:-1]
    assert np.mean(ellipse[:, 0] * ellipse[:, 1]) / np.mean(ellipse[:, 0] ** 2) == pytest.approx(np.corrcoef(periods)[0, 1], abs=0.1)


def test_the_corner_of_quantities_leaves_out_what_is_held_or_follows():
    times, curves = nights(3)
    names = [panel.get_ylabel() for panel in fitted(times, curves, shape=True).corner(quantities=True).axes[::8]]
    assert names[-2:] == ["b/a", "c/a"] and len(names) == 8
    spinning = Scene(TRUTH.body, TRUTH.attitude, [0, 0, 3.0])
    # The Sun moves by a radian: under a fixed one the data leave a rotation of the pole open.
    sun = np.stack([np.cos(0.02 * times), np.sin(0.02 * times), 0.3 + 0 * times], axis=1)
    magnitudes = -2.5 * np.log10(fit.brightness(AXES, spinning.solve().attitude(times), sun, OBSERVER))
    given = {"sun": sun, "observer": OBSERVER, "sigma": 0.001, "scene": spinning.solve().scene_at(times[0])}
    spun = fit.light_curve(AXES, times, magnitudes=magnitudes, mode="principal-axis", **given)
    simple = spun.corner(quantities=True)
    assert [panel.get_ylabel() for panel in simple.axes[::4]] == ["P", "pole λ [°]", "pole β [°]", "μ + ν [°]"]
    moments = of_attitudes().corner(quantities=True)
    assert [panel.get_ylabel() for panel in moments.axes[::9]][-3:] == ["I1", "I2", "I3"] and inside(moments)


def test_the_corner_of_parameters_is_as_before():
    found = three()
    figure = found.corner()
    deviations = np.sqrt(np.diag(found.covariance))
    assert [panel.get_xlabel() for panel in figure.axes[-6:]] == [f"{name}\n± {size:.2g}" for name, size in zip(found.parameters, deviations)]
    with pytest.raises(InputError, match="quantities = 1: it must be True or False") as error:
        found.corner(quantities=1)
    assert error.value.argument == "quantities"


def test_a_sphere_has_no_quantity_to_draw():
    times, curves = nights(1)
    sphere = Scene(Body.ellipsoid(1, 1, 1), [0, 0, 0, 1], [0.1, 0.2, 1.0])
    found = fit.light_curve([1, 1, 1], times, np.ones(len(times)), sun=SUN, observer=OBSERVER, sigma=0.1, curves=curves, scene=sphere)
    with pytest.raises(InputError, match="the data determine no period, pole or phase"):
        found.corner(quantities=True)


def rivals_of(found, *minima):
    """The fit with these other minima: mode, factor of the rates, Δχ²."""
    best = found.optima[0]
    others = [
        Optimum(Scene(TRUTH.body, TRUTH.attitude, factor * np.asarray(TRUTH.angular_velocity)), mode, found.chi_square + delta, delta, None)
        for mode, factor, delta in minima
    ]
    return replace(found, optima=(best, *others))


def test_rivals_are_told_from_other_minima_by_marker_and_height():
    found = rivals_of(three(), ("short-axis", 1.0, 1e-9), ("short-axis", 0.5, 9.0), ("short-axis", 0.8, 400.0), ("principal-axis", 0.7, 2000.0))
    axes = found.rivals_picture()
    lines = {line.get_label(): line for line in axes.lines}
    near = 16 * found._photometric.scale
    assert list(lines) == [
        "short-axis, the best",
        "short-axis, rival",
        "short-axis, no rival",
        "principal-axis, no rival",
        f"rivals below Δχ² = {near:.3g}",
    ]
    precession = TRUTH.solve().periods["extremal-axis"].precession
    assert np.allclose(lines["short-axis, rival"].get_xydata(), [[precession, 0.1], [2 * precession, 9.0]])
    assert np.allclose(lines["short-axis, no rival"].get_xydata(), [[precession / 0.8, 400.0]])
    assert lines["principal-axis, no rival"].get_xdata()[0] == pytest.approx(2 * np.pi / np.linalg.norm(TRUTH.angular_velocity) / 0.7)
    assert lines["short-axis, the best"].get_ydata() == [0.1] and lines["short-axis, no rival"].get_markerfacecolor() == "none"
    assert lines["principal-axis, no rival"].get_marker() != lines["short-axis, no rival"].get_marker()
    assert axes.get_yscale() == "log" and axes.get_ylabel() == "Δχ²" and axes.get_ylim()[1] > 2000 and inside(axes.figure)
    assert "≤ 0.1" in [tick.get_text() for tick in axes.get_yticklabels()]


def test_rivals_have_periods_in_hours_where_times_are_dates_and_the_simple_rotation_beside_them():
    assert dated(nights(2)[0]).rivals_picture().get_xlabel().endswith("its period [h]")
    found, axes = three(), plt.subplots()[1]
    spinning = Scene(TRUTH.body, TRUTH.attitude, [0, 0, 3.0])
    simple = SimpleRotation(Optimum(spinning, "principal-axis", found.chi_square + 30.0, 0.0, None), 30.0, 1e-6)
    found = replace(found, _photometric=replace(found._photometric, simple_rotation=simple))
    assert found.rivals_picture(axes) is axes and axes.get_xlabel() == "precession period P_φ, of a simple rotation its period"
    simple = next(line for line in axes.lines if line.get_label().startswith("principal-axis"))
    assert simple.get_xydata()[0] == pytest.approx([2 * np.pi / 3, 30.0])


@pytest.mark.parametrize("name", ["light_curve_picture", "rivals_picture"])
def test_fits_of_attitudes_have_no_light_curve(name):
    with pytest.raises(InputError, match=f"fit is of attitudes: {name} draws a fit of light curves") as error:
        getattr(of_attitudes(), name)()
    assert error.value.argument == "fit"
