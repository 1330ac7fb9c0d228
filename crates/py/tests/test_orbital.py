"""Attitude and rates against the orbital frame, in and out: against an own derivation, SciPy, CSPICE and the equilibrium of the gravity gradient."""

import numpy as np
import pytest

import andoyer
from andoyer import Body, Orbit, Scene, TabulatedOrbit
from andoyer._quaternions import angle_between, product
from andoyer.cli import main

Rotation = pytest.importorskip("scipy.spatial.transform").Rotation

SEQUENCES = ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX", "XYX", "XZX", "YXY", "YZY", "ZXZ", "ZYZ"]
SATELLITE = Body([1.5, 2.0, 1.0])
"""Moments about roll, pitch and yaw: the largest about the normal, the smallest about the line to the primary."""


def triad(orbit, time, frame, sign):
    """The axes of the frame as rows, from positions alone."""
    step = 1e-4 / orbit.mean_motion
    before, r, after = (orbit.position(time + shift) for shift in (-step, 0.0, step))
    normal = np.cross(before, after)
    radial, normal = sign * r / np.linalg.norm(r), normal / np.linalg.norm(normal)
    across = np.cross(normal, radial)
    return np.array([radial, across, normal] if frame == "rtn" else [across, -normal, -radial])


def drawn(count, seed):
    """Random orbits, attitudes and rates."""
    random = np.random.default_rng(seed)
    for _ in range(count):
        eccentricity = random.choice([0.0, random.uniform(0, 0.9), random.uniform(1.05, 3.0)])
        angles = dict(zip(("inclination", "node", "argument_of_pericentre"), random.uniform(0, 3, 3)))
        orbit = Orbit(10 ** random.uniform(-4, -1), eccentricity, time_of_pericentre=random.uniform(-5, 5), semi_major_axis=1.0, **angles)
        attitude = random.normal(size=4)
        yield random, orbit, attitude / np.linalg.norm(attitude), random.normal(size=3)


def test_a_thousand_states_are_those_of_an_own_derivation_there_and_back():
    for random, orbit, attitude, rates in drawn(1000, 1):
        frame, of = random.choice(["rtn", "lvlh"]), random.choice(["rotating", "disturbing"])
        time, relative = random.uniform(-3, 3) / orbit.mean_motion, bool(random.integers(2))
        scene = Scene.from_orbital(
            SATELLITE, attitude, rates, orbit=orbit, elements_of=of, frame=frame, relative=relative, epoch=time, span=(time, time), method="integrated"
        )
        axes = triad(orbit, time, frame, 1 if of == "rotating" else -1)
        expected = Rotation.from_matrix(axes.T) * Rotation.from_quat(attitude)
        assert angle_between(scene.attitude[None], expected.as_quat()[None])[0] < 2e-8  # positions by differences
        back = scene.solve().orbital(time, elements_of=of, frame=frame)
        assert angle_between(back.attitude[None], attitude[None])[0] < 1e-14
        found = back.angular_velocity if relative else scene.angular_velocity
        assert np.abs(found - rates).max() < 1e-14 * np.linalg.norm(rates) + 1e-15


@pytest.mark.filterwarnings("ignore::andoyer.ToleranceWarning")
def test_rates_are_those_of_the_attitudes():
    """Differences of attitudes against the frame, for a precessing orbit and for a table too."""
    precessing = Orbit(1e-3, 0.3, inclination=1.0, node=0.3, argument_of_pericentre=0.2, node_rate=1e-4, pericentre_rate=-3e-4, semi_major_axis=1.0)
    times = np.arange(-3000.0, 3001.0, 25.0)
    table = TabulatedOrbit(times, precessing.position(times), 1e-6)
    for orbit, tolerance in ((precessing, 1e-9), (table, 1e-9)):
        for frame in ("rtn", "lvlh"):
            scene = Scene.from_orbital(
                SATELLITE, [0.3, 0.2, 0.1], [1e-3, 2e-3, 5e-3], orbit=orbit, elements_of="rotating", frame=frame, span=(-2000, 2000), method="integrated"
            )
            motion = scene.solve()
            for time in (-1500.0, 0.0, 900.0):
                step = 0.05
                sample = motion.orbital([time - step, time, time + step], elements_of="rotating", frame=frame)
                turn = Rotation.from_quat(sample.attitude[0]).inv() * Rotation.from_quat(sample.attitude[2])
                assert turn.as_rotvec() / (2 * step) == pytest.approx(sample.angular_velocity[1], abs=tolerance)


@pytest.mark.parametrize("sequence", SEQUENCES)
def test_angles_are_those_of_scipy(sequence):
    random = np.random.default_rng(2)
    orbit = Orbit(1e-3)
    for _ in range(100):
        angles = random.uniform([-3.1, -1.5, -3.1], [3.1, 1.5, 3.1])
        if sequence[0] == sequence[2]:
            angles[1] = random.uniform(0.05, 3.1)
        scene = Scene.from_orbital(SATELLITE, angles, [0, 0, 0], orbit=orbit, elements_of="rotating", sequence=sequence, span=(0, 0), method="integrated")
        back = scene.solve().orbital(0.0, elements_of="rotating", sequence=sequence)
        assert angle_between(back.attitude[None], Rotation.from_euler(sequence, angles).as_quat()[None])[0] < 2e-15
        assert np.abs((back.angles - angles + np.pi) % (2 * np.pi) - np.pi).max() < 1e-13


def test_angles_at_the_singularity_give_the_attitude():
    for sequence in SEQUENCES:
        for middle in (np.pi / 2, -np.pi / 2) if sequence[0] != sequence[2] else (0.0, np.pi):
            scene = Scene.from_orbital(
                SATELLITE, [0.4, middle, -0.9], [0, 0, 0], orbit=Orbit(1e-3), elements_of="rotating", sequence=sequence, span=(0, 0), method="integrated"
            )
            back = scene.solve().orbital(0.0, elements_of="rotating", sequence=sequence)
            assert angle_between(Rotation.from_euler(sequence, back.angles).as_quat()[None], back.attitude[None])[0] < 1e-7


def test_frame_is_the_two_vector_frame_of_spice():
    spice = pytest.importorskip("spiceypy")
    orbit = Orbit.from_state([7000e3, -200e3, 300e3], [-500.0, 5000.0, 5600.0], 3.986004418e14, 10.0)
    for frame, axis, vector in (("rtn", 1, 1.0), ("lvlh", 3, -1.0)):
        matrix = spice.twovec(vector * np.array([7000e3, -200e3, 300e3]), axis, [-500.0, 5000.0, 5600.0], 2 if frame == "rtn" else 1)
        scene = Scene.from_orbital(SATELLITE, [0, 0, 0, 1], [0, 0, 0], orbit=orbit, elements_of="rotating", frame=frame, epoch=10.0)
        assert np.abs(Rotation.from_quat(scene.attitude).as_matrix() - matrix.T).max() < 1e-14
        # h/r² about the normal: the published rate of the frame.
        r, v = np.array([7000e3, -200e3, 300e3]), np.array([-500.0, 5000.0, 5600.0])
        inertial = Rotation.from_quat(scene.attitude).apply(np.array(scene.angular_velocity))
        assert inertial == pytest.approx(np.cross(r, v) / (r @ r), rel=1e-13)


@pytest.mark.parametrize("of", ["rotating", "disturbing"])
def test_satellite_at_its_equilibrium_stays_there(of):
    """On a circle the orientation with the largest moment about the normal and the smallest to the primary is constant in the frame (Hughes 1986, chapter 9)."""
    period = 2 * np.pi / 1e-3
    scene = Scene.from_orbital(
        SATELLITE,
        [0, 0, 0],
        [0, 0, 0],
        orbit=Orbit(1e-3, inclination=0.9, node=0.4),
        elements_of=of,
        frame="lvlh",
        span=(0, 5 * period),
        tolerance=1e-10,
        method="integrated",
    )
    motion = scene.solve()
    found = motion.orbital(np.linspace(0, 5 * period, 100), elements_of=of, frame="lvlh")
    assert np.abs(found.angles).max() < motion.plan.error_bound + 1e-13 < 1e-9
    assert np.abs(found.angular_velocity).max() < 1e-12


def test_small_pitch_librates_with_the_published_frequency():
    """n √(3 (I_roll − I_yaw)/I_pitch) (Hughes, Spacecraft Attitude Dynamics, 1986, section 9.1)."""
    frequency = 1e-3 * np.sqrt(3 * (1.5 - 1.0) / 2.0)
    scene = Scene.from_orbital(
        SATELLITE, [0, 1e-4, 0], [0, 0, 0], orbit=Orbit(1e-3), elements_of="rotating", frame="lvlh", span=(0, 2e4), tolerance=1e-10, method="integrated"
    )
    times = np.linspace(0, 2e4, 200)
    pitch = scene.solve().orbital(times, elements_of="rotating", frame="lvlh").angles[:, 1]
    assert pitch == pytest.approx(1e-4 * np.cos(frequency * times), abs=1e-10)


def test_frame_of_one_of_several_bodies():
    orbits = [Orbit(1e-3), Orbit(2e-4, 0.1, inclination=1.0, argument_of_pericentre=0.5)]
    scene = Scene.from_orbital(SATELLITE, [0.1, 0.2, 0.3], [0, 0, 0], orbit=orbits, elements_of="disturbing", of=1, span=(0, 1), method="integrated")
    one = Scene.from_orbital(SATELLITE, [0.1, 0.2, 0.3], [0, 0, 0], orbit=orbits[1], elements_of="disturbing")
    assert len(scene.orbit) == 2 and np.array_equal(scene.attitude, one.attitude)
    assert scene.solve().orbital(0.0, elements_of="disturbing", of=1).angles == pytest.approx([0.1, 0.2, 0.3], abs=1e-15)


def test_calendar_epochs_and_quaternions_with_the_scalar_first():
    time = pytest.importorskip("astropy.time").Time
    epoch = time("2026-03-01", scale="utc")
    orbit = Orbit(1e-3, time_of_pericentre=8.2e8)
    scene = Scene.from_orbital(
        SATELLITE, [1, 0, 0, 0], [0, 0, 0], orbit=orbit, elements_of="rotating", epoch=epoch, scalar_first=True, span=(epoch, epoch), method="integrated"
    )
    found = scene.solve().orbital(time(["2026-03-01"], scale="utc"), elements_of="rotating")
    assert angle_between(found.attitude, np.array([[0, 0, 0, 1.0]]))[0] < 1e-14 and found.times[0] == epoch


REFUSED = {
    "elements": ({"elements_of": "sun"}, 'elements_of = "sun": it must be "rotating" or "disturbing"'),
    "frame": ({"frame": "ntw"}, 'frame = "ntw": it must be "rtn" or "lvlh"'),
    "sequence": ({"sequence": "ZZX"}, 'sequence = "ZZX": it must be three of X, Y and Z'),
    "body": ({"of": 1}, "of = 1: it must be the index of one of the 1 disturbing bodies"),
    "angle": ({"attitude": [0, np.nan, 0]}, r"attitude\[1\]"),
    "attitude": ({"attitude": [0, 1]}, "attitude has shape"),
    "quaternion": ({"attitude": [0, 1, 1, 1]}, "attitude = "),
    "rate": ({"angular_velocity": [0, np.inf, 1]}, r"angular_velocity\[1\]"),
}


@pytest.mark.parametrize("given, message", REFUSED.values(), ids=REFUSED)
def test_what_makes_no_frame_is_refused(given, message):
    arguments = {"attitude": [0, 0, 0], "angular_velocity": [0, 0, 0], "orbit": Orbit(1e-3), "elements_of": "rotating"} | given
    with pytest.raises(andoyer.InputError, match=message):
        Scene.from_orbital(SATELLITE, **arguments)


def test_scene_without_an_orbit_has_no_frame():
    with pytest.raises(andoyer.InputError, match="without one there is no orbital frame"):
        Scene(SATELLITE, [0, 0, 0, 1], [0, 0, 1]).solve().orbital([], elements_of="rotating")


FILE = """
span = [0.0, 100.0]
method = "integrated"
[body]
moments = [1.5, 2.0, 1.0]
[state]
frame = "lvlh"
elements_of = "rotating"
attitude = [0.1, 0.2, 0.3]
angular_velocity = [0.0, 0.0, 0.0]
[orbit]
mean_motion = 1e-3
"""


def test_scene_file_and_command_have_the_frame(tmp_path, capfd):
    path, out = tmp_path / "satellite.toml", tmp_path / "out.csv"
    path.write_text(FILE, encoding="utf-8")
    scene = Scene.from_toml(path)
    expected = Scene.from_orbital(SATELLITE, [0.1, 0.2, 0.3], [0, 0, 0], orbit=Orbit(1e-3), elements_of="rotating", frame="lvlh")
    assert np.array_equal(scene.attitude, expected.attitude) and np.array_equal(scene.angular_velocity, expected.angular_velocity)
    assert main(["propagate", str(path), "-o", str(out), "--samples", "5", "--orbital", "lvlh", "--elements-of", "rotating"]) == 0
    lines = out.read_text().splitlines()
    assert lines[0] == "t,qx,qy,qz,qw,wx,wy,wz,ox,oy,oz,ow,angle_1,angle_2,angle_3,rx,ry,rz"
    assert [float(number) for number in lines[1].split(",")[12:15]] == pytest.approx([0.1, 0.2, 0.3])
    assert len(andoyer.output.read_table(out).samples) == 5
    for ending in ("npz", "parquet"):
        pytest.importorskip("pyarrow")
        assert main(["propagate", str(path), "-o", str(tmp_path / f"out.{ending}"), "--samples", "5", "--orbital", "rtn", "--elements-of", "rotating"]) == 0
        assert len(andoyer.output.read_table(tmp_path / f"out.{ending}").samples) == 5
    capfd.readouterr()
    assert main(["propagate", str(path), "-o", "-", "--orbital", "lvlh"]) == 2
    assert "--elements-of: must be given with --orbital" in capfd.readouterr().err
    path.write_text(FILE.replace('elements_of = "rotating"\n', ""), encoding="utf-8")
    with pytest.raises(andoyer.FileError, match="state.elements_of"):
        Scene.from_toml(path)
    path.write_text(FILE.replace('frame = "lvlh"\n', ""), encoding="utf-8")
    with pytest.raises(andoyer.FileError, match="state.elements_of: needs state.frame|state.elements_of needs state.frame"):
        Scene.from_toml(path)


def test_samples_are_pickled():
    import pickle

    orbital = Scene.from_orbital(SATELLITE, [0.1, 0, 0], [0, 0, 0], orbit=Orbit(1e-3), elements_of="rotating", span=(0, 1), method="integrated").solve()
    found = orbital.orbital([0.0, 1.0], elements_of="rotating")
    again = pickle.loads(pickle.dumps(found))
    assert np.array_equal(again.angles, found.angles) and len(again) == 2 and repr(again) == "<Orbital at 2 times>"
    assert angle_between(product(np.array([[0, 0, 0, 1.0]]), again.attitude), found.attitude).max() == 0


def test_angles_have_units_and_the_frame_any_case():
    units = pytest.importorskip("astropy.units")
    arguments = {"orbit": Orbit(1e-3), "elements_of": "rotating"}
    scene = Scene.from_orbital(SATELLITE, np.radians([10, 20, 30]), [0, 0, 0], frame="LVLH", **arguments)
    for angles in ([10, 20, 30] * units.deg, [10 * units.deg, 20 * units.deg, 30 * units.deg]):
        given = Scene.from_orbital(SATELLITE, angles, [0, 0, 0], frame="lvlh", **arguments)
        assert angle_between(given.attitude[None], scene.attitude[None])[0] < 1e-15


def test_files_say_what_the_columns_against_the_frame_are(tmp_path):
    motion = Scene.from_orbital(SATELLITE, [0.1, 0, 0], [0, 0, 0], orbit=Orbit(1e-3), elements_of="rotating", span=(0, 1), method="integrated").solve()
    against = motion.orbital([0.0, 1.0], elements_of="rotating")
    andoyer.output.write_npz(tmp_path / "a.npz", motion.at([0.0, 1.0]), orbital=against)
    with np.load(tmp_path / "a.npz") as file:
        assert "body components to those of the orbital frame" in str(file["convention"]) and '"angle_1": "rad"' in str(file["units"])
    assert andoyer.output.read_table(tmp_path / "a.npz").units["rx"] == "rad per unit of time of the scene"
