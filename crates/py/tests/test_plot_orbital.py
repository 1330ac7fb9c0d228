"""Pictures against the orbital frame: what is drawn is what `Motion.orbital` and `Ensemble.orbital` return; summaries of satellites; the command."""

import math

import numpy as np
import pytest
from conftest import REPOSITORY
from scipy.spatial.transform import Rotation

from andoyer import Body, Ensemble, InputError, Orbit, Scene
from andoyer.cli import main

matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402

from andoyer import plot  # noqa: E402
from andoyer.plot._orbital import continuous  # noqa: E402

pytestmark = pytest.mark.filterwarnings("ignore::andoyer.ToleranceWarning")

ORBIT = Orbit(1.1e-3, eccentricity=0.01, inclination=0.9)
BODY = Body([1.5, 2.0, 1.0])
GIVEN = {"elements_of": "rotating", "frame": "lvlh"}
SPAN = {"span": (0.0, 20000.0), "tolerance": 1e-8, "method": "integrated"}
TIMES = np.linspace(0, 20000, 400)
LABELS = ["roll [deg]", "pitch [deg]", "yaw [deg]"]


@pytest.fixture(autouse=True)
def closed():
    yield
    plt.close("all")


def satellite(angles=(0.3, 0.25, -0.2), rates=(1e-4, 2e-4, 0), **options):
    return Scene.from_orbital(BODY, angles, rates, orbit=ORBIT, **GIVEN, **SPAN | options)


def released(count, spread=0.1):
    random = np.random.default_rng(1)
    return Ensemble.from_orbital(BODY, spread * random.standard_normal((count, 3)), 1e-4 * random.standard_normal((count, 3)), orbit=ORBIT, **GIVEN, **SPAN)


def drawn(figure):
    return [axes.lines[0].get_ydata() for axes in figure.axes[:3]]


def test_angles_and_rates_are_those_of_the_motion():
    motion = satellite().solve()
    figure = plot.orbital(motion, TIMES, **GIVEN, time_unit="s")
    seen = motion.orbital(TIMES, **GIVEN)
    assert [axes.get_ylabel() for axes in figure.axes] == [*LABELS, "[deg/s]"] and figure.axes[3].get_xlabel() == "time [s]"
    # "ZYX" is yaw, pitch, roll.
    assert np.abs(np.degrees(seen.angles[:, ::-1]) - np.transpose(drawn(figure))).max() < 1e-12
    rates = np.transpose([line.get_ydata() for line in figure.axes[3].lines])
    assert np.abs(rates - np.degrees(seen.angular_velocity)).max() < 1e-15
    assert "LVLH" in figure.axes[0].get_title("left") and "ZYX" in figure.axes[0].get_title("left")


def test_the_whole_span_is_drawn_and_of_a_scene_without_one_five_orbits():
    figure = plot.orbital(satellite().solve(), **GIVEN)
    assert figure.axes[0].get_xlim() == figure.axes[3].get_xlim() == (0, 20000) and len(figure.axes[3].lines[0].get_xdata()) >= 3000
    spinning = Scene(Body([1.0, 1.5, 2.0]), [0, 0, 0, 1], [0.01, 0, 1.0], orbit=Orbit(0.01), tolerance=1e-3).solve()
    assert plot.orbital(spinning, elements_of="disturbing").axes[0].get_xlim()[1] == pytest.approx(5 * 2 * math.pi / 0.01)
    fast = satellite(rates=(0, 0, 100.0), span=(0, 1000)).solve()
    title = plot.orbital(fast, **GIVEN).axes[0].get_title("left")
    assert title.endswith("% of the span")


def test_a_tumbling_satellite_has_no_vertical_lines():
    motion = satellite((0, 0.25, 1e-4), (0, 4e-3, 0)).solve()
    roll, pitch, yaw = drawn(plot.orbital(motion, **GIVEN))
    # The pitch runs on through ±90°, where that of `Motion.orbital` turns back.
    assert np.ptp(pitch) > 3600 and np.degrees(motion.orbital(TIMES, **GIVEN).angles[:, 1]).max() <= 90
    assert max(np.abs(np.diff(angle)).max() for angle in (roll, pitch, yaw)) < 45
    attitude = motion.orbital(np.linspace(0, 20000, len(pitch)), **GIVEN).attitude
    shown = Rotation.from_euler("ZYX", np.transpose([yaw, pitch, roll]), degrees=True)
    assert (shown * Rotation.from_quat(attitude).inv()).magnitude().max() < 1e-9


@pytest.mark.filterwarnings("ignore:Gimbal lock")
@pytest.mark.parametrize("sequence", ["ZYX", "XYZ", "ZXY", "ZXZ", "YXY"])
def test_continuous_angles_are_the_same_attitudes(sequence):
    # SciPy's rotations about a turning axis pass near both poles of every sequence.
    time = np.linspace(0, 30, 20001)
    turns = Rotation.from_rotvec(np.column_stack([np.sin(time), 0.7 * time, 0.3 * np.cos(2 * time)]))
    angles = turns.as_euler(sequence)
    whole = continuous(angles, sequence)
    assert (Rotation.from_euler(sequence, whole) * turns.inv()).magnitude().max() < 1e-7
    assert np.abs(np.diff(whole, axis=0)).sum() <= np.abs(np.diff(np.unwrap(angles, axis=0), axis=0)).sum() + 1e-9
    assert np.array_equal(continuous(np.stack([angles, angles]), sequence)[1], whole) and continuous(angles[:1], sequence).shape == (1, 3)


def test_angles_have_the_names_of_their_axes():
    motion = satellite().solve()
    seen = motion.orbital(TIMES, **GIVEN, sequence="XYZ").angles
    figure = plot.orbital(motion, TIMES, **GIVEN, sequence="XYZ")
    assert [axes.get_ylabel() for axes in figure.axes[:3]] == LABELS
    assert np.abs(np.degrees(seen) - np.transpose(drawn(figure))).max() < 1e-12
    radial = plot.orbital(motion, TIMES, elements_of="rotating", frame="rtn")
    assert [axes.get_ylabel() for axes in radial.axes[:3]] == ["about X [deg]", "about Y [deg]", "about Z [deg]"]
    proper = plot.orbital(motion, TIMES, **GIVEN, sequence="ZXZ")
    assert [axes.get_ylabel() for axes in proper.axes[:3]] == ["first, about Z [deg]", "second, about X [deg]", "third, about Z [deg]"]


def test_few_members_are_lines_and_many_are_quantiles():
    few, many = released(12), released(30)
    seen = np.degrees(few.orbital(TIMES, **GIVEN).angles)
    roll = plot.orbital(few, TIMES, **GIVEN).axes[0]
    lines = np.array([line.get_ydata() for line in roll.lines if len(line.get_ydata()) == len(TIMES)])
    assert np.abs(lines - seen[:, :, 2]).max() < 1e-9
    seen = many.orbital(TIMES, **GIVEN)
    figure = plot.orbital(many, TIMES, **GIVEN)
    for axes, angle in zip(figure.axes[:3], (2, 1, 0), strict=True):
        values = np.degrees(seen.angles[:, :, angle])
        assert np.abs(axes.lines[0].get_ydata() - np.median(values, axis=0)).max() < 1e-9
        heights = [axes.collections[band].get_paths()[0].vertices[:, 1] for band in (0, 1)]
        for height, (lower, upper) in zip(heights, [(0.05, 0.95), (0.25, 0.75)], strict=True):
            assert height.min() == pytest.approx(np.quantile(values, lower, axis=0).min()) and height.max() == pytest.approx(
                np.quantile(values, upper, axis=0).max()
            )
    size = np.degrees(np.linalg.norm(seen.angular_velocity, axis=2))
    assert np.abs(figure.axes[3].lines[0].get_ydata() - np.median(size, axis=0)).max() < 1e-9
    assert figure.get_suptitle() == "30 members" and plot.orbital(many, **GIVEN).axes[0].get_xlim() == (0, 20000)


def test_members_about_half_a_turn_stay_together():
    around = np.column_stack([math.pi + np.linspace(-0.1, 0.1, 25), np.zeros(25), np.zeros(25)])
    ensemble = Ensemble.from_orbital(BODY, around, [0, 0, 0], orbit=ORBIT, **GIVEN, **SPAN)
    yaw = plot.orbital(ensemble, [0.0, 1.0], **GIVEN).axes[2].collections[0].get_paths()[0].vertices[:, 1]
    assert np.ptp(yaw) < 12


def test_members_without_a_motion_are_left_out():
    angles = np.zeros((3, 3))
    angles[1] = np.nan
    given = {"orbit": ORBIT, **GIVEN, **SPAN, "errors": "nan"}
    figure = plot.orbital(Ensemble.from_orbital(BODY, angles, [0, 0, 0], **given), TIMES, **GIVEN)
    assert figure.get_suptitle() == "2 members, 1 without a motion"
    with pytest.raises(InputError, match="no member"):
        plot.orbital(Ensemble.from_orbital(BODY, angles[1:2], [0, 0, 0], **given), TIMES, **GIVEN)


@pytest.mark.parametrize(
    ("changes", "error", "said"),
    [
        ({"elements_of": "satellite"}, InputError, "elements_of"),
        ({"frame": "ntw"}, InputError, "frame"),
        ({"sequence": "ZZX"}, InputError, "sequence"),
        ({"of": 3}, InputError, "of"),
        ({"times": []}, InputError, "times"),
        ({"times": [[0.0, 1.0]]}, InputError, "times"),
        ({"time_unit": 3600}, TypeError, "time_unit"),
        ({"motion": "satellite"}, TypeError, "motion"),
    ],
)
def test_refusals(changes, error, said):
    count = len(plt.get_fignums())
    with pytest.raises(error, match=said):
        plot.orbital(**{"motion": satellite().solve(), **GIVEN, **changes})
    assert len(plt.get_fignums()) == count
    with pytest.raises(TypeError, match="elements_of"):
        plot.orbital(satellite().solve())


def test_refusals_of_scenes_and_ensembles():
    free = Scene(Body([1, 1.5, 2]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
    for picture in (plot.orbital, plot.summary):
        with pytest.raises(InputError, match="no orbital frame"):
            picture(free, elements_of="rotating")
    apart = Ensemble.from_scenes([satellite(), satellite(epoch=50000.0, span=(50000, 60000))])
    with pytest.raises(InputError, match="in common"):
        plot.orbital(apart, **GIVEN)


def test_a_calendar_epoch_has_dates():
    time = pytest.importorskip("astropy.time")
    start = time.Time("2029-04-10T06:00:00", scale="tdb")
    motion = satellite(epoch=start, span=(start, start + time.TimeDelta(20000.0, format="sec"))).solve()
    figure = plot.orbital(motion, **GIVEN)
    assert figure.axes[3].get_xlabel() == "date (TDB)" and figure.axes[3].get_ylabel() == "[deg/h]"
    with pytest.raises(InputError, match="time_unit"):
        plot.orbital(motion, **GIVEN, time_unit="s")


def test_summary_of_a_satellite_covers_its_span_in_degrees():
    motion = satellite(span=(0.0, 86400.0)).solve()
    plain = plot.summary(motion)
    assert plain.axes[-1].get_xlim() == (0, 86400)
    # The momentum of a captured satellite moves by degrees: 1e5 arcseconds before.
    assert plain.axes[1].get_xlabel() == "east of where it starts [deg]" and np.abs(plain.axes[1].lines[0].get_xdata()).max() > 5
    named = plot.summary(motion, elements_of="rotating", time_unit="s")
    labels = [axes.get_ylabel() for axes in named.axes]
    assert [label for label in labels if label in LABELS] == LABELS and "[deg/s]" in labels
    roll = named.axes[labels.index("roll [deg]")]
    assert roll.get_xlim() == (0, 86400)
    times = roll.lines[0].get_xdata()
    assert np.abs(roll.lines[0].get_ydata() - np.degrees(motion.orbital(times, **GIVEN).angles[:, 2])).max() < 1e-9
    with pytest.raises(InputError, match="elements_of"):
        plot.summary(motion, elements_of="satellite")


def test_small_paths_stay_in_arcseconds_and_rounding_is_not_stretched():
    fast = Scene(Body([1.0, 1.5, 2.0]), [0, 0, 0, 1], [0.01, 0, 1.0], orbit=Orbit(1e-3, inclination=0.5), tolerance=1e-3, span=(0, 5000)).solve()
    assert plot.pole_path(fast, [0.0, 1.0, 2.0]).get_xlabel() == "east of where it starts [arcsec]"
    still = plot.orbital(satellite((0, 0.1, 0), (0, 0, 0)).solve(), TIMES, **GIVEN).axes[0]
    assert np.diff(still.get_ylim())[0] >= 0.02


@pytest.fixture
def scene_file(tmp_path):
    path = tmp_path / "satellite.toml"
    path.write_text(satellite().to_toml(), encoding="utf-8")
    return path


def test_command_draws_angles_against_the_orbit(scene_file, tmp_path, capsys):
    for ending, options in [
        (".png", ["--orbital", "lvlh"]),
        (".svg", ["--orbital", "RTN", "--sequence", "ZXZ"]),
        (".pdf", []),
        (".html", ["--orbital", "lvlh"]),
    ]:
        out = tmp_path / f"out{ending}"
        assert main(["plot", str(scene_file), "-o", str(out), "--elements-of", "rotating", *options]) == 0 and out.stat().st_size > 5000
    for options, said in [
        (["--orbital", "lvlh"], "--elements-of: must be given"),
        (["--orbital", "ntw", "--elements-of", "rotating"], "--orbital"),
        (["--orbital", "lvlh", "--elements-of", "rotating", "--sequence", "ZZX"], "sequence"),
        (["--orbital", "lvlh", "--elements-of", "rotating", "--of", "2"], "of"),
        (["--sequence", "ZYX"], "--sequence: goes with --orbital alone"),
    ]:
        assert main(["plot", str(scene_file), "-o", str(tmp_path / "bad.png"), *options]) == 2
        error = capsys.readouterr().err
        assert error.startswith("andoyer: error:") and error.count("\n") == 1 and said in error
    assert not (tmp_path / "bad.png").exists()


def test_command_knows_whose_orbit_a_scene_file_names(scene_file, tmp_path, monkeypatch):
    seen = []
    monkeypatch.setattr(plot, "summary", lambda motion, elements_of=None: seen.append(elements_of) or plt.figure())
    text = scene_file.read_text(encoding="utf-8")
    scene_file.write_text(text.replace("[state]", '[state]\nframe = "lvlh"\nelements_of = "rotating"'), encoding="utf-8")
    assert main(["plot", str(scene_file), "-o", str(tmp_path / "one.png")]) == 0
    assert main(["plot", str(REPOSITORY / "examples/scenes/eros.toml"), "-o", str(tmp_path / "two.png")]) == 0
    assert seen == ["rotating", None]


def test_command_refuses_an_orbit_of_a_file_of_attitudes(scene_file, tmp_path, capsys):
    table = tmp_path / "out.csv"
    assert main(["propagate", str(scene_file), "-o", str(table), "--samples", "5"]) == 0
    assert main(["plot", str(table), "-o", str(tmp_path / "out.png"), "--orbital", "lvlh", "--elements-of", "rotating"]) == 2
    assert "--orbital: goes with a scene alone" in capsys.readouterr().err
