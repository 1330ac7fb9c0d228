"""Files of photometry and of SHAPE: what their numbers mean, and damaged ones with the line."""

import warnings

import numpy as np
import pytest

import andoyer
from andoyer import Body, FileError, InputError, Orbit, Scene
from andoyer.interop import read_alcdef, read_damit, read_shape, write_shape

ALCDEF = """STARTMETADATA
OBJECTNUMBER=43
OBJECTNAME=Ariadne
SESSIONDATE=2014-11-04
SESSIONTIME=09:06:00
FILTER=C
MAGBAND=V
STANDARD=INTERNAL
DIFFERMAGS=FALSE
LTCTYPE=NONE
LTCAPP=NONE
LTCDAYS=-0.005772
REDUCEDMAGS=NONE
PHASE=+12.44
COMMENT=first
COMMENT=second = last
DELIMITER=PIPE
ENDMETADATA
DATA=2456965.735795|+11.521|+0.011|1.881
DATA=2456965.738778|+11.491||1.840
DATA=2456965.741760|11.332|0.013|
ENDDATA

STARTMETADATA
DIFFERMAGS=TRUE
STANDARD=NONE
MAGADJUST=+10.000
LTCAPP=NONE
DELIMITER=TAB
ENDMETADATA
DATA=2456970.5\t-1.25
DATA=2456970.6\t-1.50\t0.02
ENDDATA
"""
SECOND = ALCDEF[ALCDEF.index("\nSTARTMETADATA") + 1 :]

DAMIT = """2
3 1
2456965.735795 1.02 0.8 -1.5 0.1 0.3 -0.4 0.0
2456965.738778 1.04 0.8 -1.5 0.1 0.3 -0.4 0.0
2456965.741760 0.98 0.8 -1.5 0.1 0.3 -0.4 0.0
2 0
2456970.5   7.5E2 0.8 -1.4 0.1 1.0 2.0 2.0
2456970.6   8.5E2 0.8 -1.4 0.1 1.0 2.0 2.0
"""

SHAPE = """{MODEL FILE FOR SHAPE.C VERSION 2.9.7}

{SHAPE DESCRIPTION}
 1 {number of components}

{SPIN STATE}
1992 12 11  0  0  0 {yyyy mo dd hh mm ss of t0}
 f   150.0000000000 {angle 0 (deg) lambda=60.000000}
 f    75.0000000000 {angle 1 (deg) beta=15.000000}
 f    30.0000000000 {angle 2 (deg)}
 f    20.0000000000 {spin 0 (deg/day)}
 f    30.0000000000 {spin 1 (deg/day)}
 c   100.0000000000 {spin 2 (deg/day) P=86.400000}
 f     3.0100000000 {moment of inertia 0}
 f     3.2200000000 {moment of inertia 1}
 c     1.0000000000 {moment of inertia 2}
 c     0.0000000000 {spin 0 dot (deg/day/day)}
 c     0.0000000000 {spin 1 dot (deg/day/day)}
 c     0.0000000000 {spin 2 dot (deg/day/day)}
 c     0.0000000000 {Libration Amplitude (degrees)}
 c     0.0000000000 {Libration Frequency (degrees/day)}
 c     0.0000000000 {Libration Phase (degrees)}
                  0 {number of spin impulses}

{
volume  = 1.0 km^3
}
"""


def at(tmp_path, text):
    path = tmp_path / "file.txt"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def test_alcdef_gives_magnitudes_in_utc(tmp_path):
    curves = read_alcdef(at(tmp_path, ALCDEF))
    assert np.array_equal(curves.times, [2456965.735795, 2456965.738778, 2456965.741760, 2456970.5, 2456970.6]) and curves.time_scale == "UTC"
    assert np.allclose(curves.magnitudes, [11.521, 11.491, 11.332, 8.75, 8.5], rtol=0, atol=1e-14)
    assert np.array_equal(curves.sigma, [0.011, np.nan, 0.013, np.nan, 0.02], equal_nan=True)
    assert list(curves.curves) == [0, 0, 0, 1, 1] and list(curves.relative) == [False, True]
    # LTCDAYS of 1 au.
    assert np.array_equal(curves.distances, [1, 1, 1, np.nan, np.nan], equal_nan=True)
    assert curves.brightness is None and curves.sun is None and curves.observer is None
    assert curves.metadata[0]["OBJECTNAME"] == "Ariadne" and curves.metadata[0]["COMMENT"] == "first\nsecond = last"
    assert repr(curves) == "LightCurves(5 points in 2 curves, JD 2456965.73580 to 2456970.60000 UTC)" and len(curves) == 5


def test_alcdef_with_light_time_applied(tmp_path):
    text = ALCDEF[: ALCDEF.index("\nSTARTMETADATA")].replace("LTCTYPE=NONE\nLTCAPP=NONE", "LTCTYPE=LIGHTTIME\nLTCAPP=AVERAGE")
    assert read_alcdef(at(tmp_path, text.replace("\n", "\r\n"))).time_scale == "UTC (light time applied)"


def test_alcdef_without_errors_and_distances(tmp_path):
    curves = read_alcdef(at(tmp_path, SECOND.replace("\t0.02", "")))
    assert curves.sigma is None and curves.distances is None


def test_alcdef_of_the_database_has_no_enddata_and_warns(tmp_path):
    with pytest.warns(UserWarning, match="no block ends with ENDDATA: the last one, to line 31, may be cut off") as caught:
        curves = read_alcdef(at(tmp_path, ALCDEF.replace("ENDDATA\n", "")))
    assert len(curves) == 5 and caught[0].filename == __file__
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert len(read_alcdef(at(tmp_path, ALCDEF))) == 5


REFUSED_ALCDEF = {
    "empty": (ALCDEF, "", "line 1: the file is empty"),
    "bytes": ("Ariadne", "Ari\x00dne", "line 3: must be text"),
    "another file": ("STARTMETADATA\nOBJECTNUMBER", "CCSDS_OEM_VERS", "line 1: a block must start with STARTMETADATA"),
    "no equals sign": ("FILTER=C", "FILTER C", "line 6: the metadata must have KEYWORD=value or ENDMETADATA: got 'FILTER C'"),
    "data in the metadata": ("FILTER=C", "DATA=2456965.7|1", "line 6: the metadata must have"),
    "no end of the metadata": ("PIPE\nENDMETADATA\n", "PIPE\n", "line 18: the metadata must have"),
    "keyword in the data": ("DATA=2456965.738778|+11.491||1.840", "FILTER=C", "line 20: the data must have DATA=…, ENDDATA"),
    "delimiter": ("=PIPE", "=COMMA", "line 17: DELIMITER must be PIPE or TAB: got 'COMMA'"),
    "no delimiter": ("DELIMITER=PIPE\n", "", "line 17: DELIMITER must be given"),
    "other delimiter": ("DELIMITER=PIPE", "DELIMITER=TAB", "line 19: DATA must be JD, magnitude.*with the delimiter TAB"),
    "two delimiters": ("DELIMITER=PIPE", "DELIMITER=PIPE\nDELIMITER=TAB", "line 18: DELIMITER is given twice, in line 17"),
    "NaN": ("+11.491", "NaN", "line 20: MAG must be a finite number: got 'NaN'"),
    "decimal comma": ("+11.491", "11,491", "line 20: MAG must be a finite number: got '11,491'"),
    "no magnitude": ("|+11.491|", "||", "line 20: MAG must be a finite number: got ''"),
    "too large": ("+11.491", "1e999", "line 20: MAG must be a finite number"),
    "date alone": ("|+11.491||1.840", "", "line 20: DATA must be JD, magnitude"),
    "too many": ("|+11.491||1.840", "|1|2|3|4|5", "line 20: DATA must be JD, magnitude"),
    "modified date": ("=2456965.738778", "=56965.238778", "line 20: JD must be a full Julian date, .*: got 56965.2"),
    "negative error": ("+0.011", "-0.011", "line 19: MAGERR must not be negative: got -0.011"),
    "boolean": ("DIFFERMAGS=FALSE", "DIFFERMAGS=NO", "line 9: DIFFERMAGS must be TRUE or FALSE: got 'NO'"),
    "light time": ("LTCAPP=NONE", "LTCAPP=HG", "line 11: LTCAPP must be NONE or AVERAGE or POINT: got 'HG'"),
    "contradiction": ("LTCAPP=NONE", "LTCAPP=POINT", "line 11: LTCAPP and LTCTYPE contradict each other: POINT and NONE"),
    "sign of LTCDAYS": ("LTCDAYS=-", "LTCDAYS=+", "line 12: LTCDAYS must be negative"),
    "LTCDAYS": ("LTCDAYS=-0.005772", "LTCDAYS=x", "line 12: LTCDAYS must be a finite number: got 'x'"),
    "both times": ("LTCTYPE=NONE\nLTCAPP=NONE", "LTCTYPE=LIGHTTIME\nLTCAPP=POINT", "line 24: this curve has not the light time applied, unlike the first"),
    "no data": (SECOND[SECOND.index("DATA=2") : SECOND.index("ENDDATA")], "", "line 31: a block must have DATA"),
    "cut off in the data": (SECOND[-8:], "", "line 32: block 2 must end with ENDDATA, as other blocks do"),
    "no first ENDDATA": ("ENDDATA\n\n", "", "line 22: block 1 must end with ENDDATA"),
    "cut off in the metadata": (SECOND[SECOND.index("DELIMITER") :], "", "line 28: the file ends in the metadata of a block"),
    "cut off before the data": (SECOND[SECOND.index("DATA=2") :], "", "line 30: the file ends in the data of a block"),
}


@pytest.mark.parametrize("old, new, message", REFUSED_ALCDEF.values(), ids=REFUSED_ALCDEF)
def test_damaged_alcdef_is_refused_with_its_line(tmp_path, old, new, message):
    place = ALCDEF.rindex(old)
    first = ALCDEF.index(old)
    # An end is that of the second block; everything else is in the first.
    place = place if ALCDEF.endswith(old) else first
    refused(read_alcdef, at(tmp_path, ALCDEF[:place] + new + ALCDEF[place + len(old) :]), message)


def refused(reader, path, message):
    with pytest.raises(FileError, match=f".*file.txt: {message}") as caught:
        reader(path)
    assert caught.value.argument == "path" and caught.value.value == str(path)


def test_damit_gives_intensities_and_vectors(tmp_path):
    curves = read_damit(at(tmp_path, DAMIT))
    assert list(curves.brightness) == [1.02, 1.04, 0.98, 750, 850] and curves.times[3] == 2456970.5
    assert list(curves.curves) == [0, 0, 0, 1, 1] and list(curves.relative) == [False, True]
    assert list(curves.sun[0]) == [0.8, -1.5, 0.1] and list(curves.observer[4]) == [1, 2, 2]
    assert np.allclose(curves.distances, [0.5, 0.5, 0.5, 3, 3], rtol=1e-15)
    assert curves.time_scale == "not stated (light time applied)" and curves.magnitudes is None and curves.sigma is None and curves.metadata == [{}, {}]


REFUSED_DAMIT = {
    "empty": (DAMIT, "\n", "line 1: the file is empty"),
    "bytes": (DAMIT, b"2\n3 1\n\xff\xfe", "line 3: must be text"),
    "number of curves": ("2\n3 1", "two\n3 1", "line 1: the first line must be the number of curves: got 'two'"),
    "no curves": ("2\n3 1", "0\n3 1", "line 1: the first line must be the number of curves: got '0'"),
    "more curves": ("2\n3 1", "3\n3 1", "line 8: the file ends after 2 of 3 curves"),
    "fewer curves": ("2\n3 1", "1\n3 1", "line 6: the file must end after curve 1: got '2 0'"),
    "flag": ("3 1\n", "3 2\n", "line 2: a curve must start with its number of points, and 0 .*: got '3 2'"),
    "fewer points": ("3 1\n", "2 1\n", "line 5: a curve must start with its number of points"),
    "more points": ("3 1\n", "4 1\n", "line 6: a point must have 8 numbers, date, intensity, Sun and Earth: got 2"),
    "cut off": (DAMIT[DAMIT.index("2456970.6") :], "", "line 7: the file ends after 1 of 2 points of curve 2"),
    "seven numbers": ("-0.4 0.0\n2456965.738778", "-0.4\n2456965.738778", "line 3: a point must have 8 numbers, .*: got 7"),
    "NaN": ("1.04", "nan", "line 4: intensity must be a finite number: got 'nan'"),
    "magnitude": ("1.04", "-1.04", "line 4: intensity must be above 0: got -1.04"),
    "no Sun": ("1.04 0.8 -1.5 0.1", "1.04 0 0 0", "line 4: the vector to the Sun must not be 0"),
    "modified date": ("2456965.738778", "56965.2", "line 4: JD must be a full Julian date"),
}


@pytest.mark.parametrize("old, new, message", REFUSED_DAMIT.values(), ids=REFUSED_DAMIT)
def test_damaged_damit_is_refused_with_its_line(tmp_path, old, new, message):
    refused(read_damit, at(tmp_path, new if old == DAMIT else DAMIT.replace(old, new, 1)), message)


def matrix_of_shape(phi, theta, psi):
    """The matrix from ecliptic to body components as a product of three turns of the axes."""

    def turn(angle, axis):
        c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
        return np.array({"x": [[1, 0, 0], [0, c, s], [0, -s, c]], "z": [[c, s, 0], [-s, c, 0], [0, 0, 1]]}[axis])

    return turn(psi, "z") @ turn(theta, "x") @ turn(phi, "z")


def body_axes(scene):
    """Rows: body axes in inertial components."""
    return andoyer._quaternions.rotate(np.broadcast_to(scene.attitude, (3, 4)), np.eye(3))


def test_shape_gives_a_scene_with_the_pole_of_its_comment(tmp_path):
    pytest.importorskip("astropy")
    scene = read_shape(at(tmp_path, SHAPE))
    axes = body_axes(scene)
    assert np.allclose(axes, matrix_of_shape(150, 75, 30), rtol=0, atol=1e-15)
    # lambda and beta in the comments of the file.
    longitude, latitude = np.radians([60, 15])
    pole = [np.cos(latitude) * np.cos(longitude), np.cos(latitude) * np.sin(longitude), np.sin(latitude)]
    assert np.allclose(axes[2], pole, rtol=0, atol=1e-15)
    # P = 86.4 h in the comment is a turn about axis 3 in 311040 s.
    assert np.allclose(scene.angular_velocity, 2 * np.pi / 311040 * np.array([0.2, 0.3, 1]), rtol=1e-15)
    assert list(scene.body.moments) == [3.01, 3.22, 1.0]
    # 1992-12-11 0 h UTC was 59.184 s earlier in TT, and TDB differs from it by less than 2 ms: JD 2448967.5.
    assert abs(scene.epoch - ((2448967.5 - 2451545) * 86400 + 59.184)) < 2e-3


def test_shape_of_an_old_version_ends_with_the_moments(tmp_path):
    pytest.importorskip("astropy")
    old = SHAPE[: SHAPE.index(" c     0.0000000000 {spin 0 dot")]
    assert read_shape(at(tmp_path, old)) == read_shape(at(tmp_path, SHAPE))


@pytest.mark.parametrize("angles", [(150, 75, 30), (10, 0, 20), (200, 1e-9, 250), (10, 180, 20), (300, 179.9999, 359)])
def test_shape_is_written_and_read_back(tmp_path, angles):
    pytest.importorskip("astropy")
    text = (
        SHAPE.replace("150.0000000000", str(angles[0]))
        .replace("75.0000000000", f"{angles[1]:.12f}")
        .replace(" f    30.0000000000 {angle", f" f {angles[2]} {{angle")
    )
    scene = read_shape(at(tmp_path, text))
    write_shape(tmp_path / "out.mod", scene)
    again = read_shape(tmp_path / "out.mod")
    assert (tmp_path / "out.mod").read_text().startswith("{SPIN STATE}\n1992 12 11  0  0  0 {yyyy mo dd hh mm ss of t0}\n c ")
    assert np.allclose(body_axes(again), body_axes(scene), rtol=0, atol=3e-15)
    assert np.allclose(again.angular_velocity, scene.angular_velocity, rtol=1e-15)
    assert np.allclose(again.body.moments, np.array([3.01, 3.22, 1.0]) / 3.22, rtol=1e-15) and again.epoch == scene.epoch
    with pytest.raises(FileExistsError):
        write_shape(tmp_path / "out.mod", scene)


def test_shape_of_a_tensor_is_about_principal_axes(tmp_path):
    time = pytest.importorskip("astropy.time").Time("2020-01-01T00:00:00", scale="utc")
    scene = Scene(Body.from_inertia([[2, 0.3, 0], [0.3, 3, 0.1], [0, 0.1, 4]]), [0.1, 0.2, 0.3, 0.86**0.5], [1e-4, 2e-4, 3e-4], epoch=time)
    write_shape(tmp_path / "out.mod", scene)
    again = read_shape(tmp_path / "out.mod")
    # Angular velocity and energy in inertial components do not depend on the axes of the body.
    assert np.allclose(again.angular_velocity @ body_axes(again), scene.angular_velocity @ body_axes(scene), rtol=1e-13)
    scale = scene.body.moments.max()
    assert np.isclose(again.body.moments @ again.angular_velocity**2 * scale, scene.angular_velocity @ scene.body.inertia @ scene.angular_velocity, rtol=1e-13)


REFUSED_SHAPE = {
    "empty": (SHAPE, "", "line 1: the file has no {SPIN STATE}"),
    "bytes": (SHAPE, b"{SPIN STATE}\n\xff", "line 2: must be text"),
    "two": ("{SPIN STATE}", "{SPIN STATE}\n{SPIN STATE}", "line 7: a second {SPIN STATE}: the first is in line 6"),
    "no end of a comment": ("km^3\n}", "km^3\n", "line 25: a comment must begin with { and end with }"),
    "date": ("1992 12 11", "1992 13 11", "line 7: the date of t0 must be in the calendar"),
    "decimals in the date": ("0  0  0 {yyyy", "0  0  0.5 {yyyy", "line 7: second must be a whole number: got '0.5'"),
    "no flag": (" f   150.0", "    150.0", "line 8: angle 0 must begin with c, f or =: got '150.0000000000'"),
    "NaN": (" f    20.0000000000", " f nan", "line 11: spin 0 must be a finite number: got 'nan'"),
    "cut off": (SHAPE[SHAPE.index("1.0000000000 {moment of inertia 2}") :], "", "line 16: the spin state ends before moment of inertia 2"),
    "no body": ("1.0000000000 {moment", "9.0000000000 {moment", "line 16: the spin state to this line is no scene"),
    "YORP": ("0.0000000000 {spin 2 dot", "1e-6 {spin 2 dot", "line 19: spin 2 dot must be 0"),
    "libration": ("0.0000000000 {Libration Amp", "5.0 {Libration Amp", "line 20: libration amplitude must be 0"),
    "impulses": ("0 {number of spin", "1 {number of spin", "line 23: number of spin impulses must be 0"),
    "more": ("{\nvolume", "c {\nvolume", "line 25: the spin state must end after the number of spin impulses: got 'c'"),
}


@pytest.mark.parametrize("old, new, message", REFUSED_SHAPE.values(), ids=REFUSED_SHAPE)
def test_damaged_shape_is_refused_with_its_line(tmp_path, old, new, message):
    pytest.importorskip("astropy")
    refused(read_shape, at(tmp_path, new if old == SHAPE else SHAPE.replace(old, new, 1)), message)


def test_what_shape_cannot_hold_is_refused(tmp_path):
    time = pytest.importorskip("astropy.time").Time("2020-01-01T00:00:00", scale="utc")
    state = (Body([1.0, 1.5, 2.0]), [0, 0, 0, 1], [1e-4, 0, 3e-4])
    for scene, message in (
        (Scene(*state, epoch=5.0), "scene must have a Time of astropy as its epoch"),
        (
            Scene(*state, epoch=type(time)("2020-01-01T00:00:00.25", scale="utc")),
            "scene must have an epoch at a whole second of UTC: 2020-01-01T00:00:00.250 misses it by 0.25",
        ),
        (Scene(*state, epoch=time, orbit=Orbit(1e-7, 0.1)), "scene has an orbit or torques"),
    ):
        with pytest.raises(InputError, match=message) as caught:
            write_shape(tmp_path / "out.mod", scene)
        assert caught.value.argument == "scene" and not (tmp_path / "out.mod").exists()
