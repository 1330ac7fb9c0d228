"""Pictures: each is rendered, labelled with units, inside its figure, and shows the motion that it is given."""

import importlib.util
import itertools
import re
from datetime import datetime

import numpy as np
import pytest

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402
from conftest import REPOSITORY  # noqa: E402
from matplotlib.backends.backend_agg import FigureCanvasAgg  # noqa: E402

import andoyer  # noqa: E402
from andoyer import output, plot  # noqa: E402
from andoyer.cli import main  # noqa: E402
from andoyer.output.rows import samples_of  # noqa: E402

pytestmark = pytest.mark.filterwarnings("ignore::andoyer.ToleranceWarning")

Rotation = pytest.importorskip("scipy.spatial.transform").Rotation

BODY = andoyer.Body([1.0, 1.5, 2.0])
ORBIT = andoyer.Orbit(1e-3, 0.1, inclination=0.5)


def solved(rates, body=BODY, **options):
    return andoyer.Scene(body, [0, 0, 0, 1], rates, **options).solve()


MOTIONS = {
    "short-axis": solved([0.1, 0.2, 1.0]),
    "long-axis": solved([1.0, 0.1, 0.2]),
    "tiny": solved([1e-5, 0, 1.0]),
    "turned over": solved([0.1, 0.2, -1.0]),
    "left-handed": solved([0.3, 1.0, 0.1], andoyer.Body([1.0, 2.0, 1.5])),
    "oblate": solved([0.1, 0.2, 1.0], andoyer.Body([1, 1, 2])),
    "prolate": solved([0.1, 0.2, 1.0], andoyer.Body([1, 2, 2])),
    "spherical": solved([0.1, 0.2, 1.0], andoyer.Body([1, 1, 1])),
    "principal-axis": solved([0, 0, 1.0]),
    "at rest": solved([0, 0, 0]),
    "torque": solved([0.01, 0.02, 1.0], orbit=ORBIT, tolerance=1e-6),
}
DRAWN = {
    "polhode": plot.polhode,
    "ellipsoid": lambda motion: plot.polhode(motion, surface="ellipsoid"),
    "portrait": plot.phase_portrait,
    "near the pole": plot.polhode_near_pole,
    "path of the pole": plot.pole_path,
    "nutation": plot.nutation,
    "angles": plot.angles,
    "nu": lambda motion: plot.angles(motion, residual=False),
    "rates": plot.rates,
}
LIBRATIONS = {"longitude": plot.librations, "pole": plot.pole_librations, "spectrum": plot.libration_spectrum}
DIAGRAMS = {"error by order": plot.error_by_order, "work and precision": plot.work_precision}


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


def outside(figure):
    """By how much what is drawn sticks out of the figure, in inches: left, bottom, right, top."""
    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    drawn, frame = figure.get_tightbbox(canvas.get_renderer()), figure.bbox_inches
    return max(frame.x0 - drawn.x0, frame.y0 - drawn.y0, drawn.x1 - frame.x1, drawn.y1 - frame.y1)


def test_what_is_cut_off_would_be_seen():
    figure, axes = plt.subplots()
    axes.set_position([0, 0, 1, 1])
    axes.set_ylabel("cut off")
    assert outside(figure) > 0.1


@pytest.mark.parametrize("picture", DRAWN)
@pytest.mark.parametrize("name", MOTIONS)
def test_picture_of_any_motion_is_drawn_without_a_warning(name, picture, recwarn):
    axes = DRAWN[picture](MOTIONS[name])
    axes.figure.canvas.draw()
    assert not [str(warning.message) for warning in recwarn]


@pytest.mark.parametrize("picture", [picture for picture in DRAWN if picture not in ("polhode", "ellipsoid")])
def test_labels_have_units_and_nothing_is_cut_off(picture):
    axes = DRAWN[picture](MOTIONS["torque"])
    labels = axes.get_xlabel(), axes.get_ylabel()
    assert (axes.get_title() or axes.get_title("left")) and all("[" in label or "N/M" in label or label == "time" for label in labels)
    assert outside(axes.figure) < 0.01


def test_picture_is_drawn_into_the_axes_that_are_given(motion):
    figure, axes = plt.subplots()
    for picture in [plot.phase_portrait, plot.pole_path, plot.nutation, plot.angles, plot.rates, plot.polhode_near_pole]:
        assert picture(motion, axes=axes) is axes
    assert plot.polhode(motion, axes) is axes and figure.axes[0] is axes


@pytest.mark.parametrize("diagram", DIAGRAMS)
def test_diagram_is_drawn_into_its_axes_with_labels_and_nothing_cut_off(scene, diagram):
    figure, axes = plt.subplots(layout="constrained")
    assert DIAGRAMS[diagram](scene, orders=[0, 4, 8], axes=axes) is axes
    assert all("[" in label or label == "order N" for label in (axes.get_xlabel(), axes.get_ylabel())) and axes.get_title()
    assert outside(figure) < 0.01
    assert DIAGRAMS[diagram](scene, orders=[1]).figure is not figure


def test_error_by_order_falls_as_the_theory_says(scene):
    series, line, _ = plot.error_by_order(scene, orders=range(0, 7, 2)).lines
    errors = series.get_ydata()
    assert all(later < earlier for earlier, later in itertools.pairwise(errors))
    # Over twenty rotations the frequencies' error adds up to at most 2π·20 times that of the harmonics.
    assert np.all(errors < 130 * line.get_ydata()) and errors[0] > 1e-4


def test_work_and_precision_has_both_methods_and_puts_accuracy_to_the_right():
    axes = plot.work_precision(MOTIONS["long-axis"].scene, orders=[2, 4])
    assert [line.get_label() for line in axes.lines] == ["series, by order", "closed form, by tolerance"]
    errors, costs = axes.lines[0].get_data()
    assert errors[0] > errors[1] > 0 and min(costs) > 0 and axes.get_xlim()[0] > axes.get_xlim()[1]


def test_portrait_shows_the_place_of_the_body(motion):
    axes = plot.phase_portrait(motion)
    variables = motion.andoyer(plot.whole_turns(motion))
    curve, start = axes.lines
    assert start.get_xydata()[0] == pytest.approx([np.degrees(variables[0, 2]), variables[0, 5] / variables[0, 4]], abs=1e-9)
    assert np.nanmax(np.abs(curve.get_ydata() - variables[:, 5] / variables[:, 4])) < 1e-12


def test_portrait_of_a_left_handed_body_has_the_angle_of_andoyer():
    motion = MOTIONS["left-handed"]
    start = plot.phase_portrait(motion).lines[1].get_xydata()[0]
    assert start[0] == pytest.approx(np.degrees(motion.andoyer(motion.scene.epoch)[2]), abs=1e-9)
    assert "−1 (A)" in [text.get_text() for text in plot.polhode(motion).texts]


def test_path_of_the_pole_is_that_of_the_angular_momentum():
    motion = MOTIONS["torque"]
    line = plot.pole_path(motion, [0.0, 1000.0, 5000.0]).lines[0]
    momentum = motion.angular_momentum([0.0, 1000.0, 5000.0])
    directions = momentum / np.linalg.norm(momentum, axis=1, keepdims=True)
    moved = np.linalg.norm(directions - directions[0], axis=1) * 648000 / np.pi
    # The projection loses the second order of the angle.
    assert np.hypot(*line.get_xydata().T) == pytest.approx(moved, rel=1e-3, abs=1e-9) and moved[2] > 1
    assert np.abs(plot.pole_path(MOTIONS["short-axis"]).lines[0].get_xydata()).max() < 1e-9


def test_unknown_surface_is_refused(motion):
    with pytest.raises(ValueError, match='"cube".*"sphere" or "ellipsoid"|cube.*sphere'):
        plot.polhode(motion, surface="cube")


@pytest.mark.parametrize("scene", ["eros", "eros-sun", "ceres"])
def test_summary_has_all_its_panels_and_nothing_cut_off(scene):
    motion = andoyer.Scene.from_toml(REPOSITORY / f"examples/scenes/{scene}.toml").solve()
    figure = plot.summary(motion)
    assert len(figure.axes) == 6 and figure.get_suptitle() == motion.scene.name
    assert outside(figure) < 0.01


@pytest.mark.parametrize("ending, magic", [("png", b"\x89PNG"), ("svg", b"<?xml"), ("pdf", b"%PDF")])
def test_command_writes_the_picture(tmp_path, ending, magic):
    output = tmp_path / f"eros.{ending}"
    assert main(["plot", str(REPOSITORY / "examples/scenes/eros.toml"), "-o", str(output)]) == 0
    assert output.read_bytes().startswith(magic)


@pytest.mark.parametrize("name", ["principal-axis", "at rest", "spherical"])
def test_rounding_of_a_steady_motion_is_not_shown_as_signal(name):
    axes = plot.angles(MOTIONS[name])
    spread = max(np.ptp(line.get_ydata()) for line in axes.get_lines())
    assert axes.get_ylim() == (-1e-6, 1e-6) and spread < 1e-8


def test_angle_that_stands_still_has_no_period():
    assert "ν: period none (constant)" in plot.angles(MOTIONS["principal-axis"], residual=False).get_title("left")
    assert plot.angles(MOTIONS["short-axis"]).get_ylim()[1] > 1e-3


def test_path_of_the_pole_says_over_what():
    axes = plot.pole_path(MOTIONS["torque"])
    assert axes.get_title() == "Path of the angular momentum over one orbit"
    assert plot.pole_path(MOTIONS["torque"], [0.0, 1.0, 2.0]).get_title().endswith("under the gravity gradient")


@pytest.fixture
def files(tmp_path, motion):
    """A motion as files of every kind, and its scene."""
    samples = motion.at(np.linspace(2, 12, 200))
    (tmp_path / "scene.toml").write_text(motion.scene.to_toml(), encoding="utf-8")
    output.write_aem(tmp_path / "motion.aem", samples)
    output.write_npz(tmp_path / "motion.npz", samples)
    output.write_csv(tmp_path / "motion.csv", samples)
    if importlib.util.find_spec("pyarrow"):
        output.write_parquet(tmp_path / "motion.parquet", samples)
    return tmp_path


@pytest.mark.parametrize("ending", ["aem", "npz", "csv", "parquet"])
def test_command_draws_a_file_of_attitudes_against_a_scene(files, ending):
    if ending == "parquet":
        pytest.importorskip("pyarrow")
    arguments = ["plot", str(files / f"motion.{ending}"), "-o", str(files / "out.png")]
    assert main(arguments) == 0
    assert main([*arguments, "--against", str(files / "scene.toml"), "--force"]) == 0
    assert (files / "out.png").read_bytes().startswith(b"\x89PNG")


def test_time_0_of_the_scene_is_moved_by_the_date(files, motion, capfd):
    samples = motion.at(np.linspace(2, 12, 200))
    output.write_aem(files / "dated.aem", samples, output.Heading(date=datetime(2026, 1, 1), time_system="TAI"))
    arguments = ["plot", str(files / "dated.aem"), "-o", str(files / "out.svg"), "--against", str(files / "scene.toml"), "--date", "2026-01-01T00:00:00"]
    assert main(arguments) == 0
    # matplotlib draws texts as outlines; the title is a comment in the picture.
    title = re.search(r"Angle between the file and the scene: (\S+) rad at most", (files / "out.svg").read_text(encoding="utf-8"))
    # Epochs have twelve decimals of the second; the body turns by 1.02 rad in one.
    assert float(title[1]) < 1e-12
    assert main([*arguments[:-1], "2026-01-01T00:00:01", "--force"]) == 0
    title = re.search(r"Angle between the file and the scene: (\S+) rad at most", (files / "out.svg").read_text(encoding="utf-8"))
    assert float(title[1]) > 0.5


def test_angle_between_is_that_of_the_rotation(motion):
    times = np.linspace(0, 5, 50)
    samples = motion.at(times)
    turned = motion.rotation(times) * Rotation.from_rotvec([0, 3e-9, 4e-9])
    other = samples_of(times, turned.as_quat() * -1, samples.angular_velocity)
    axes = plot.difference(other, motion)
    assert axes.lines[0].get_ydata() == pytest.approx(5e-9, rel=1e-6)
    with pytest.raises(ValueError, match="same times"):
        plot.difference(other, motion.at(times + 1))


def test_components_go_on_where_the_sign_of_the_quaternion_changes(motion):
    times = np.linspace(0, 20, 500)
    samples = motion.at(times)
    signs = np.where(np.arange(500) % 3 == 0, -1.0, 1.0)[:, None]
    axes = plot.components(samples_of(times, samples.attitude * signs, samples.angular_velocity))
    drawn = np.array([line.get_ydata() for line in axes.lines])
    assert np.abs(np.diff(drawn, axis=1)).max() < 0.05 and outside(axes.figure) < 0.01


def test_rates_that_a_file_does_not_have_are_said(motion):
    samples = motion.at([0.0, 1.0])
    axes = plot.sampled_rates(samples_of([0, 1], samples.attitude, np.full((2, 3), np.nan)))
    assert axes.get_title("left") == "Body rates: the file has none"


def test_summary_of_samples_has_its_panels_and_nothing_cut_off(motion):
    samples = motion.at(np.linspace(0, 20, 300))
    assert len(plot.samples_summary(samples).axes) == 2
    figure = plot.samples_summary(samples, motion, name="wobble.aem")
    assert len(figure.axes) == 3 and outside(figure) < 0.01
    assert all("[" in axes.get_ylabel() for axes in figure.axes)


def test_pictures_of_a_tensor_are_about_its_principal_axes():
    tensor = np.array([[1.4, 0.2, -0.1], [0.2, 1.6, 0.15], [-0.1, 0.15, 1.2]])
    motion = solved([0.3, 0.5, 1.0], andoyer.Body.from_inertia(tensor))
    start = plot.phase_portrait(motion).lines[1].get_xydata()[0]
    variables = motion.andoyer(motion.scene.epoch)
    assert start == pytest.approx([np.degrees(variables[2]), variables[5] / variables[4]], abs=1e-9)


@pytest.fixture(scope="module")
def libration():
    attitude = Rotation.from_euler("ZYX", [0.01, 0.004, 0.003]).as_quat()
    return solved_about(attitude, andoyer.Body([0.99, 0.996, 1.0]), 0.02)


def solved_about(attitude, body, eccentricity):
    orbit = andoyer.Orbit(2e-3, eccentricity, time_of_pericentre=50.0)
    return andoyer.Scene(body, attitude, [0, 0, 2e-3], epoch=50.0, orbit=orbit, span=(50, 3e5), tolerance=1e-6, method="libration", name="a moon").solve()


@pytest.mark.parametrize("picture", LIBRATIONS)
def test_picture_of_a_libration_is_drawn_with_labels_and_nothing_cut_off(libration, picture, recwarn):
    figure, axes = plt.subplots(layout="constrained")
    assert LIBRATIONS[picture](libration, axes=axes) is axes
    assert all("[" in label for label in (axes.get_xlabel(), axes.get_ylabel())) and axes.get_title("left")
    assert outside(figure) < 0.01
    assert LIBRATIONS[picture](libration).figure is not figure
    assert not [str(warning.message) for warning in recwarn]


def test_libration_beside_a_negligible_body_is_drawn(libration):
    far = andoyer.Orbit(1e-6, 0.1, attraction=1e-20)
    beside = andoyer.Scene(
        libration.scene.body,
        libration.scene.attitude,
        [0, 0, 2e-3],
        epoch=50.0,
        orbit=(libration.scene.orbit, far),
        span=(50, 3e4),
        tolerance=1e-6,
        method="libration",
    )
    assert plot.libration_spectrum(beside.solve()).get_xlabel() == "period [orbits]"


def test_angles_of_a_libration_are_those_of_the_attitude(libration):
    times = np.linspace(50, 2e5, 40)
    orbit, epoch = libration.scene.orbit, libration.scene.epoch
    turned = Rotation.from_rotvec(np.outer(orbit.mean_motion * (times - epoch), [0, 0, 1])).inv() * libration.rotation(times)
    psi, theta, phi = turned.as_euler("ZYX").T
    pole = plot.pole_librations(libration, times).lines
    drawn = [plot.librations(libration, times).lines[0], *pole]
    assert [line.get_label() for line in drawn] == ["ψ", "θ", "φ"]
    assert drawn[0].get_xdata() == pytest.approx((times - epoch) * orbit.mean_motion / (2 * np.pi))
    for line, angle in zip(drawn, (psi, theta, phi), strict=True):
        assert np.radians(line.get_ydata()) == pytest.approx(angle, abs=1e-6)


def test_spectrum_has_each_term_at_its_period_and_marks_the_forced_ones(libration):
    axes = plot.libration_spectrum(libration)
    orbit = 2 * np.pi / libration.scene.orbit.mean_motion
    drawn = {line.get_label(): line for line in axes.lines if "," in line.get_label()}
    assert set(drawn) == {"ψ, free", "ψ, forced", "θ, free", "φ, free"}
    forced = libration.libration.forced()
    assert drawn["ψ, forced"].get_markerfacecolor() == "none" and drawn["ψ, free"].get_markerfacecolor() != "none"
    largest = drawn["ψ, forced"].get_xydata()[0]
    assert largest == pytest.approx([forced[0].period / orbit, np.degrees(forced[0].amplitude)])
    assert largest[0] == pytest.approx(1)
    free = drawn["ψ, free"].get_xydata()[0]
    assert free == pytest.approx([libration.libration.periods[0] / orbit, np.degrees(libration.libration.amplitudes[0])])


def test_pictures_of_a_body_that_does_not_librate_are_drawn():
    still = solved_about([0, 0, 0, 1], andoyer.Body([0.99, 0.996, 1.0]), 0.0)
    figure = plot.libration_summary(still)
    figure.canvas.draw()
    assert len(figure.axes) == 3 and figure.get_suptitle() == "a moon"
    assert not np.any(figure.axes[0].lines[0].get_ydata())


def test_picture_of_a_libration_refuses_other_motions_and_times():
    for picture in (*LIBRATIONS.values(), plot.libration_summary):
        with pytest.raises(andoyer.InputError, match="method=.libration.") as caught:
            picture(MOTIONS["short-axis"])
        assert (caught.value.argument, caught.value.bound) == ("motion", "libration")


def test_times_of_a_libration_must_be_finite(libration):
    with pytest.raises(andoyer.InputError, match="finite") as caught:
        plot.librations(libration, [0.0, np.nan])
    assert caught.value.argument == "times"


def test_command_draws_a_libration(libration, tmp_path):
    (tmp_path / "moon.toml").write_text(libration.scene.to_toml(), encoding="utf-8")
    assert main(["plot", str(tmp_path / "moon.toml"), "-o", str(tmp_path / "moon.svg")]) == 0
    assert "Libration in longitude" in (tmp_path / "moon.svg").read_text(encoding="utf-8")
