"""Time axes of pictures: dates, the unit that the user names, or none; and the span of a motion that is not periodic."""

import numpy as np
import pytest

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.dates import num2date  # noqa: E402

import andoyer  # noqa: E402
from andoyer import plot  # noqa: E402

pytestmark = pytest.mark.filterwarnings("ignore::andoyer.ToleranceWarning")

OVER_TIME = [plot.nutation, plot.angles, plot.rates]
HOUR = 3600.0


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


def free(**options):
    return andoyer.Scene(andoyer.Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0], **options).solve()


@pytest.mark.parametrize("picture", OVER_TIME)
def test_axis_of_a_scene_without_dates_has_its_own_times(picture):
    motion = free(epoch=5e4)
    axes = picture(motion)
    assert axes.get_xlabel() == "time" and axes.get_xlim()[0] == 5e4
    named = picture(motion, time_unit="h")
    assert named.get_xlabel() == "time [h]" and named.get_xlim() == axes.get_xlim()
    # The unit is a name: numbers are as they are in the scene.
    assert all(np.array_equal(a.get_ydata(), b.get_ydata()) for a, b in zip(axes.lines, named.lines, strict=True))
    with pytest.raises(TypeError, match="time_unit"):
        picture(motion, time_unit=3600)


def test_rates_and_periods_have_the_unit_of_the_scene():
    assert plot.rates(free()).get_ylabel() == "[deg per unit of time]"
    assert plot.rates(free(), time_unit="h").get_ylabel() == "[deg/h]"
    title = plot.angles(free(), residual=False, time_unit="d").get_title("left")
    assert title.count(" d") == 2 and " s" not in title
    assert " s" not in plot.angles(free(), residual=False).get_title("left").replace("less", "")


@pytest.mark.parametrize("picture", OVER_TIME)
def test_axis_of_a_calendar_epoch_has_dates(picture):
    time = pytest.importorskip("astropy.time")
    epoch = time.Time("2029-04-10T06:00:00", scale="tdb")
    motion = free(epoch=epoch)
    axes = picture(motion, [motion.scene.epoch, motion.scene.epoch + 36 * HOUR])
    assert axes.get_xlabel() == "date (TDB)"
    first, last = (num2date(edge) for edge in axes.get_xlim())
    assert first.strftime("%Y-%m-%d %H:%M") == "2029-04-10 06:00" and last.strftime("%Y-%m-%d %H:%M") == "2029-04-11 18:00"
    same = picture(motion, epoch + time.TimeDelta([0.0, 36 * HOUR], format="sec"))
    assert same.get_xlim() == pytest.approx(axes.get_xlim(), abs=1e-9)
    with pytest.raises(andoyer.InputError, match="time_unit"):
        picture(motion, time_unit="s")


def test_samples_have_dates_or_their_own_times():
    time = pytest.importorskip("astropy.time")
    epoch = time.Time("2029-04-10T06:00:00", scale="tdb")
    dated = free(epoch=epoch).at(epoch + time.TimeDelta([0.0, 10.0, 20.0], format="sec"))
    plain = free().at([100.0, 110.0, 120.0])
    for picture in (plot.components, plot.sampled_rates):
        assert picture(dated).get_xlabel() == "date (TDB)"
        assert picture(plain).get_xlabel() == "time" and picture(plain).get_xlim() == (100.0, 120.0)
        assert picture(plain, time_unit="min").get_xlabel() == "time [min]"


def flyby(epoch=0.0):
    """A hyperbola with its pericentre after half of a week, in seconds."""
    orbit = andoyer.Orbit(2.4e-3, 4.3, time_of_pericentre=3.5 * 86400, inclination=0.6)
    return andoyer.Scene.from_periods(
        andoyer.Body([0.61, 0.965, 1.0]), 27.38 * HOUR, 263 * HOUR, epoch=epoch, orbit=orbit, span=(0, 7 * 86400), tolerance=1e-8, method="integrated"
    ).solve()


@pytest.mark.parametrize("epoch", [0.0, 2 * 86400.0])
def test_summary_of_a_flyby_covers_its_span(epoch):
    motion = flyby(epoch)
    figure = plot.summary(motion)
    path, panels = figure.axes[1], figure.axes[2:]
    assert path.get_title() == "Path of the angular momentum over the span"
    ends = motion.angular_momentum([0.0, 7 * 86400.0])
    ends /= np.linalg.norm(ends, axis=1, keepdims=True)
    # The picture is a projection along the first direction.
    turned = np.degrees(np.linalg.norm(np.cross(*ends)))
    drawn = path.lines[0].get_xydata()
    assert np.linalg.norm(drawn[-1]) == pytest.approx(turned, rel=1e-9) and turned > 10
    assert path.get_xlabel().endswith("[deg]")
    assert all(panel.get_xlim() == (0.0, 7 * 86400.0) for panel in panels)


def test_damped_motion_is_drawn_over_its_span():
    torque = andoyer.Torque.damping(0.01 * np.eye(3))
    motion = andoyer.Scene(andoyer.Body([1, 1.5, 2]), [0, 0, 0, 1], [0.9, 0.1, 0.5], torques=torque, span=(-5, 200), tolerance=1e-8).solve()
    assert plot.nutation(motion).get_xlim() == (-5, 200)
    assert plot.pole_path(motion).get_title() == "Path of the angular momentum over the span"


@pytest.mark.parametrize("moments", [[1, 1.5, 2], [1, 2, 1.5], [2, 1, 1.5]])
def test_summary_of_a_long_axis_body_is_about_the_long_axis(moments):
    rates = np.where(np.equal(moments, 1), 1.0, 0.1)
    motion = andoyer.Scene(andoyer.Body(moments), [0, 0, 0, 1], rates).solve()
    assert motion.plan.mode == "long-axis"
    figure = plot.summary(motion)
    assert figure.axes[2].get_title("left") == "Nutation J: long axis from the angular momentum"
    angle = figure.axes[2].lines[0].get_ydata()
    # The angle of the long axis, from attitudes and the inertial angular momentum.
    times = plot.whole_turns(motion)
    momentum = motion.angular_momentum(times)
    axis = motion.rotation(times).as_matrix()[:, :, moments.index(1)]
    cosine = np.sum(axis * momentum, axis=1) / np.linalg.norm(momentum, axis=1)
    assert angle == pytest.approx(np.degrees(np.arccos(cosine)), abs=1e-6)
    # ν is the rotation about it, with the published period of the long axis, and μ its precession.
    precession, rotation = motion.periods["long-axis"]
    title = figure.axes[3].get_title("left").replace(" retrograde", "")
    assert title == f"ν: period {rotation:.5g}, μ: period {precession:.5g}"
    assert plot.nutation(motion).get_title("left").startswith("Nutation J: short axis")
    with pytest.raises(andoyer.InputError, match="axis"):
        plot.nutation(motion, axis="middle")
