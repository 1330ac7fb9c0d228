"""The command line, run as its users run it."""

import io
import os
import re
import shlex
import subprocess
import sys

import numpy as np
import pytest

import andoyer
from andoyer import output
from andoyer.cli import EXAMPLES, _terminal, main, parser

COLUMNS = "t,qx,qy,qz,qw,wx,wy,wz"


def run(*arguments, **environment):
    command = [sys.executable, "-m", "andoyer", *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, encoding="utf-8", env=os.environ | environment)


@pytest.fixture
def scene_file(scene, tmp_path):
    path = tmp_path / "wobble.toml"
    path.write_text(scene.to_toml(), encoding="utf-8")
    return path


def read(path):
    table = np.genfromtxt(path, delimiter=",", names=True, ndmin=1)
    assert ",".join(table.dtype.names) == COLUMNS
    return np.column_stack([table[name] for name in table.dtype.names])


def test_csv_holds_the_motion_to_the_last_bit(scene_file, motion, tmp_path):
    output = tmp_path / "out.csv"
    done = run("propagate", scene_file, "-o", output, "--start", "-3", "--stop", "7.5", "--samples", "37")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    samples = motion.at(np.linspace(-3, 7.5, 37))
    assert np.array_equal(read(output), np.column_stack([samples.times, samples.attitude, samples.angular_velocity]))


def test_dash_writes_the_same_csv_to_stdout(scene_file, tmp_path):
    output = tmp_path / "out.csv"
    span = ["--stop", "7.5", "--step", "0.25"]
    assert run("propagate", scene_file, "-o", output, *span).returncode == 0
    done = run("propagate", scene_file, "-o", "-", *span)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout == output.read_text(encoding="utf-8") and done.stdout.startswith(f"{COLUMNS}\n")


def test_help_says_what_the_columns_are():
    done = run("propagate", "--help")
    text = " ".join(done.stdout.split())
    assert COLUMNS in text and "body components to inertial ones" in text and "rad per unit of time" in text


@pytest.mark.parametrize("stop, step, times", [(0.3, 0.1, 4), (1, 0.3, 4), (1, 5, 1), (0, 1, 1), (7, 7, 2)])
def test_steps_go_from_the_first_time_up_to_the_last(scene_file, tmp_path, stop, step, times):
    output = tmp_path / "out.csv"
    assert main(["propagate", str(scene_file), "-o", str(output), "--start", "0", "--stop", str(stop), "--step", str(step)]) == 0
    assert read(output)[:, 0] == pytest.approx(step * np.arange(times), abs=1e-15)
    assert read(output)[-1, 0] <= stop


@pytest.mark.parametrize("spacing", [["--step", "100"], ["--samples", "11"]])
def test_samples_more_than_half_a_rotation_apart_are_noted(scene_file, motion, tmp_path, spacing):
    done = run("propagate", scene_file, "-o", tmp_path / "out.csv", "--start", "0", "--stop", "1000", *spacing)
    apart = 100 / motion.periods["long-axis"].precession
    assert done.returncode == 0 and done.stdout == "" and done.stderr.count("\n") == 1
    found = re.match(r"andoyer: note: samples are (\S+) rotations apart; --step (\S+) ", done.stderr)
    assert float(found[1]) == pytest.approx(apart, rel=5e-3)
    assert run("propagate", scene_file, "-o", tmp_path / "out.csv", "--stop", "1000", "--step", found[2], "--force").stderr == ""
    assert len(read(tmp_path / "out.csv")) > 10_000


def test_npz_holds_the_motion(scene_file, motion, tmp_path):
    output = tmp_path / "out.NPZ"
    assert run("propagate", scene_file, "-o", output, "--samples", "5").returncode == 0
    with np.load(output) as file:
        assert sorted(file) == ["angular_velocity", "attitude", "convention", "scene", "times", "units"]
        assert np.array_equal(file["attitude"], motion.attitude(file["times"]))
        assert np.array_equal(file["angular_velocity"], motion.angular_velocity(file["times"]))


def test_default_is_a_thousand_samples_of_ten_rotations_from_the_epoch(scene_file, motion, tmp_path):
    output = tmp_path / "out.csv"
    assert main(["propagate", str(scene_file), "-o", str(output)]) == 0
    times = read(output)[:, 0]
    assert len(times) == 1000 and times[0] == 2.0
    assert times[-1] == 2.0 + 10 * motion.periods["long-axis"].precession


def test_span_of_the_scene_is_the_default_if_there_is_one(scene, tmp_path):
    given = andoyer.Scene(scene.body, scene.attitude, scene.angular_velocity, span=(1, 4))
    path, output = tmp_path / "span.toml", tmp_path / "out.csv"
    path.write_text(given.to_toml(), encoding="utf-8")
    assert main(["propagate", str(path), "-o", str(output), "--samples", "4"]) == 0
    assert read(output)[:, 0].tolist() == [1, 2, 3, 4]
    assert main(["propagate", str(path), "-o", str(output), "--samples", "1", "--start", "3", "--force"]) == 0
    assert read(output)[:, 0].tolist() == [3]


def test_plan_prints_name_plan_and_periods(scene_file, motion):
    done = run("plan", scene_file)
    assert done.returncode == 0 and done.stderr == ""
    assert "wobble" in done.stdout and str(motion.plan) in done.stdout
    for convention in ["long-axis", "short-axis"]:
        assert re.search(rf"periods +{convention}: P_phi [\d.]+, P_psi [\d.]+", done.stdout)


def test_bodies_prints_the_catalogue_with_its_sources():
    done = run("bodies")
    assert done.returncode == 0
    for name in andoyer.Body.catalogue():
        assert re.search(rf"^{name} .*{re.escape(andoyer.Body.source(name))}$", done.stdout, re.MULTILINE)


def test_series_prints_polynomials_that_python_reads():
    done = run("series", "--order", "8")
    assert done.returncode == 0 and done.stderr == ""
    lines = done.stdout.splitlines()
    assert len(lines) == 9 and lines[4] == "P_4 = -3/4*beta**2 - 9/32*beta**4"
    normal_form = andoyer.NormalForm(8)
    for n, line in enumerate(lines):
        value = eval(line.removeprefix(f"P_{n} = "), {"beta": 0.5})
        assert value == float(sum(c * 2**-l if l else c for l, c in normal_form.triaxiality_polynomial(n).items()))


def test_console_script_is_installed():
    script = os.path.join(os.path.dirname(sys.executable), "andoyer")
    done = subprocess.run([script, "--version"], capture_output=True, text=True)
    assert done.stdout == f"andoyer {andoyer.__version__}\n"


BAD_LINES = {
    "unknown command": (["dance"], "dance"),
    "missing scene": (["plan", "absent.toml"], "absent.toml"),
    "missing output": (["propagate", "SCENE"], "--output"),
    "unknown ending": (["propagate", "SCENE", "-o", "out.txt"], r"out\.txt.*\.csv, \.npz, \.parquet, \.aem, \.bc or \.bpc"),
    "no ending": (["propagate", "SCENE", "-o", "out"], r"\.csv, \.npz, \.parquet, \.aem, \.bc or \.bpc"),
    "no directory": (["propagate", "SCENE", "-o", "absent/out.csv"], "absent"),
    "NaN start": (["propagate", "SCENE", "-o", "out.csv", "--start", "nan"], "--start: must be a finite number: got 'nan'"),
    "text start": (["propagate", "SCENE", "-o", "out.csv", "--start", "noon"], "argument --start: must be a finite number: got 'noon'"),
    "date start": (
        ["propagate", "SCENE", "-o", "out.csv", "--start", "2013-01-09T12:00:00"],
        r"--start: must be a finite number, a time in the unit of the scene \(if its epoch is a date, TDB seconds since J2000\): got '2013-01-09T12:00:00'",
    ),
    "text stop": (["propagate", "SCENE", "-o", "out.csv", "--stop", "later"], "--stop.*later"),
    "stop before start": (["propagate", "SCENE", "-o", "out.csv", "--start", "5", "--stop", "4"], "--stop.*4.0.*5.0"),
    "no samples": (["propagate", "SCENE", "-o", "out.csv", "--samples", "0"], "--samples"),
    "too many samples": (["propagate", "SCENE", "-o", "out.csv", "--samples", "1" + "0" * 30], "--samples"),
    "half a sample": (["propagate", "SCENE", "-o", "out.csv", "--samples", "1.5"], "--samples.*1.5"),
    "float of samples": (["propagate", "SCENE", "-o", "out.csv", "--samples", "1e3"], "--samples: must be a whole number from 1 .*: got '1e3'"),
    "no step": (["propagate", "SCENE", "-o", "out.csv", "--step", "0"], "--step: must be a finite number above 0: got '0'"),
    "NaN step": (["propagate", "SCENE", "-o", "out.csv", "--step", "nan"], "--step.*finite"),
    "tiny step": (["propagate", "SCENE", "-o", "out.csv", "--step", "1e-300"], "--step.*at most 1000000000 samples"),
    "samples and step": (["propagate", "SCENE", "-o", "out.csv", "--samples", "3", "--step", "1"], "--samples.*--step|--step.*--samples"),
    "date of a table": (["propagate", "SCENE", "-o", "out.csv", "--date", "2026-01-01"], "--date: goes with a .aem or .bc or .bpc alone"),
    "no date": (["propagate", "SCENE", "-o", "out.aem", "--date", "noon"], "--date: must be a date like .*: got 'noon'"),
    "date in a zone": (["propagate", "SCENE", "-o", "out.aem", "--date", "2026-01-01T00:00:00+01:00"], "--date.*without a zone"),
    "unknown time system": (["propagate", "SCENE", "-o", "out.aem", "--time-system", "UT1"], "--time-system.*UT1"),
    "Z beside a time system": (
        ["propagate", "SCENE", "-o", "out.aem", "--date", "2026-01-01T00:00:00Z", "--time-system", "TT"],
        "--date: Z is UTC, but --time-system is TT",
    ),
    "UTC of old": (["propagate", "SCENE", "-o", "out.aem", "--date", "1969-01-01T00:00:00Z"], "whole leap seconds from 1972-01-01 on"),
    "steps of a kernel": (["propagate", "SCENE", "-o", "out.bc", "--step", "1"], "--step: a .bc chooses its times itself"),
    "clock of a message": (["propagate", "SCENE", "-o", "out.aem", "--clock", "x.tsc"], "--clock: goes with a .bc alone, not with out.aem"),
    "object of a kernel": (["propagate", "SCENE", "-o", "out.bc", "--object-id", "x"], "--object-id: goes with a .aem alone, not with out.bc"),
    "degree of text": (["propagate", "SCENE", "-o", "out.aem", "--interpolation", "HERMITE"], "--interpolation: must be METHOD:DEGREE"),
    "degree above the samples": (["propagate", "SCENE", "-o", "out.aem", "--samples", "3", "--interpolation", "HERMITE:3"], "degree 1 to 2"),
    "rates of version 1": (["propagate", "SCENE", "-o", "out.aem", "--aem-version", "1", "--attitude-type", "QUATERNION/ANGVEL"], "attitude_type.*version 1"),
    "nutation of a triaxial body": (["propagate", "SCENE", "-o", "out.aem", "--attitude-type", "SPIN/NUTATION_MOM"], "equal moments about axes 1 and 2"),
    "spin that wobbles": (["propagate", "SCENE", "-o", "out.aem", "--attitude-type", "SPIN"], "about body axis 3 alone"),
    "picture of a missing file": (["plot", "absent.aem", "-o", "out.png"], "absent.aem"),
    "scene against a scene": (["plot", "SCENE", "-o", "out.png", "--against", "SCENE"], "--against: goes with a file of attitudes alone"),
    "two words": (["propagate", "SCENE", "-o", "out.aem", "--frame", "my frame"], "--frame: must be one word"),
    "year 10000": (["propagate", "SCENE", "-o", "out.aem", "--stop", "1e12"], "years from 1 to 9999"),
    "time stands still": (["propagate", "SCENE", "-o", "out.aem", "--start", "3", "--stop", "3", "--samples", "2"], "ascending times"),
    "picture of text": (["plot", "SCENE", "-o", "out.txt"], r"\.png, \.svg, \.pdf, \.html"),
    "time without a phase": (["propagate", "SCENE", "-o", "out.csv", "--stop", "1e308"], r"times\[\d+\]"),
    "negative order": (["series", "--order", "-1"], "order"),
    "huge order": (["series", "--order", "100000"], "order.*16381"),
    "part of code": (["series", "--order", "2", "--to", "c", "--part", "direct"], "--part.*latex.*not with --to c"),
    "beta of text": (["series", "--order", "2", "--beta", "0.3"], "--beta.*c or rust or python.*not with --to text"),
    "beta of no body": (["series", "--order", "2", "--to", "c", "--beta", "1"], r"beta = 1 is outside \[0, 0\.99"),
    "unknown form": (["series", "--order", "2", "--to", "fortran"], "--to.*fortran"),
    "text order": (["series", "--order", "ten"], "argument --order: must be a whole number: got 'ten'"),
}


@pytest.mark.parametrize("arguments, message", BAD_LINES.values(), ids=BAD_LINES)
def test_bad_line_is_refused_in_one_line_with_status_2(arguments, message, scene_file, monkeypatch, capfd):
    monkeypatch.chdir(scene_file.parent)
    assert main([str(scene_file) if argument == "SCENE" else argument for argument in arguments]) == 2
    output, errors = capfd.readouterr()
    assert output == "" and errors.count("\n") == 1
    assert errors.startswith("andoyer: error: ") and re.search(message, errors)


BAD_SCENES = {
    "unknown key": ("colour = 1\n", "colour"),
    "bad tolerance": ("tolerance = -1\n", "tolerance.*-1"),
    "text for number": ("epoch = 'now'\n", "epoch"),
    "no TOML": ("epoch = =\n", "line 1"),
    "high order": ("order = 61\n", "order.*60"),
    "moments": ("[body]\nmoments = [1, 1, 3]\n", r"moments.*\[1.0, 1.0, 3.0\].*sum"),
}


@pytest.mark.parametrize("text, message", BAD_SCENES.values(), ids=BAD_SCENES)
def test_bad_scene_is_refused_with_file_key_and_bound(text, message, tmp_path):
    path = tmp_path / "bad.toml"
    body = "" if "[body]" in text else "[body]\nmoments = [1, 1.5, 2]\n"
    path.write_text(f"{text}{body}[state]\nattitude = [0, 0, 0, 1]\nangular_velocity = [0, 0, 1]\n", encoding="utf-8")
    done = run("propagate", path, "-o", tmp_path / "out.csv")
    assert done.returncode == 2 and done.stdout == "" and done.stderr.count("\n") == 1
    assert re.search(rf"bad\.toml: .*{message}", done.stderr)
    assert not (tmp_path / "out.csv").exists()


NOT_SERVED = {
    "near separatrix": ("[0.0001, 1, 0.0001]", "too near the separatrix"),
    "units": ("[0, 1e-310, 1e-310]", "units"),
}


@pytest.mark.parametrize("command", ["plan", "propagate"])
@pytest.mark.parametrize("rates, message", NOT_SERVED.values(), ids=NOT_SERVED)
def test_motion_that_is_not_served_is_refused_with_the_file(tmp_path, capfd, command, rates, message):
    path = tmp_path / "unserved.toml"
    state = f"[state]\nattitude = [0, 0, 0, 1]\nangular_velocity = {rates}\n"
    path.write_text(f"method = 'series'\n[body]\nmoments = [1, 1.5, 2]\n{state}")
    output = ["-o", str(tmp_path / "out.csv")] if command == "propagate" else []
    assert main([command, str(path), *output]) == 2
    errors = capfd.readouterr().err
    assert errors.startswith(f"andoyer: error: {path}: ") and message in errors and errors.count("\n") == 1


def test_body_at_rest_needs_a_last_time(tmp_path, capfd):
    path, output = tmp_path / "rest.toml", tmp_path / "out.csv"
    path.write_text("[body]\nmoments = [1, 1.5, 2]\n[state]\nattitude = [0, 0, 0, 1]\nangular_velocity = [0, 0, 0]\n")
    assert main(["propagate", str(path), "-o", str(output)]) == 2
    assert "--stop" in capfd.readouterr().err
    assert main(["propagate", str(path), "-o", str(output), "--stop", "5", "--samples", "2"]) == 0
    assert read(output)[:, 4].tolist() == [1, 1]


def test_name_that_the_terminal_cannot_show_is_escaped(scene, tmp_path):
    path = tmp_path / "named.toml"
    path.write_text(andoyer.Scene(scene.body, scene.attitude, [0, 0, 1], name="Δ").to_toml(), encoding="utf-8")
    done = run("plan", path, PYTHONIOENCODING="ascii")
    assert done.returncode == 0 and "\\u0394" in done.stdout


FORMS = {
    "text": ([], lambda n: "P_0 = 2\nP_1 = -1\nP_2 = -1/2*beta**2\nP_3 = -5/8*beta**2\n"),
    "json": ([], lambda n: n.to_json() + "\n"),
    "latex": (["--part", "direct"], lambda n: n.to_latex("direct")),
    "c": (["--beta", "0.3"], lambda n: n.to_code("c", 0.3)),
    "rust": ([], lambda n: n.to_code("rust")),
    "python": (["--beta", "0"], lambda n: n.to_code("python", 0.0)),
}


@pytest.mark.parametrize("form", FORMS)
def test_series_are_written_in_the_form_that_is_asked_for(form, capsys):
    options, expected = FORMS[form]
    assert main(["series", "--order", "3", "--to", form, *options]) == 0
    assert capsys.readouterr().out == expected(andoyer.NormalForm(3))


@pytest.mark.skipif(sys.platform == "win32", reason="pipes close otherwise there")
def test_reader_that_has_seen_enough_is_no_error():
    command = [sys.executable, "-m", "andoyer", "series", "--order", "20"]
    child = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    child.stdout.close()
    assert child.stderr.read() == "" and child.wait() == 0
    child.stderr.close()


class Terminal(io.StringIO):
    def isatty(self):
        return True


def test_bar_is_for_terminals_and_long_work(monkeypatch):
    monkeypatch.setattr(_terminal, "PATIENCE", 0.0)
    shown, piped = Terminal(), io.StringIO()
    for stream in (shown, piped):
        bar = _terminal.ProgressBar("order", stream)
        for done in range(5):
            bar(done, 4)
        bar.close()
    assert "order [###############---------------]  50 %  2 of 4" in shown.getvalue() and shown.getvalue().endswith("\r\x1b[K")
    assert piped.getvalue() == ""
    monkeypatch.setattr(_terminal, "PATIENCE", 1e9)
    quick = Terminal()
    bar = _terminal.ProgressBar("order", quick)
    bar(1, 2)
    bar.close()
    assert quick.getvalue() == ""


def test_long_tables_tell_how_far_they_are(motion, tmp_path):
    heard = []
    output.write_csv(tmp_path / "long.csv", motion.at(np.arange(25_000.0)), lambda done, of: heard.append((done, of)))
    assert heard == [(10_000, 25_000), (20_000, 25_000), (25_000, 25_000)]
    assert len((tmp_path / "long.csv").read_text().splitlines()) == 25_001


def test_names_are_bold_on_terminals_alone(monkeypatch):
    monkeypatch.setenv("TERM", "xterm")
    monkeypatch.delenv("NO_COLOR", raising=False)
    assert _terminal.label("mode", Terminal()) == "\x1b[1mmode         \x1b[0m"
    assert _terminal.label("mode", io.StringIO()) == "mode         "
    monkeypatch.setenv("NO_COLOR", "1")
    assert _terminal.label("mode", Terminal()) == "mode         "


@pytest.mark.parametrize("command", ["", *EXAMPLES])
def test_help_ends_with_examples_that_are_parsed(command, capsys):
    with pytest.raises(SystemExit) as left:
        main([command, "--help"] if command else ["--help"])
    text = capsys.readouterr().out
    assert left.value.code == 0 and "\x1b" not in text
    lines = [line.strip() for line in text.partition("examples:\n")[2].splitlines() if line.strip()]
    assert lines and all(line.startswith("andoyer ") for line in lines)
    for line in lines:
        assert parser().parse_args(shlex.split(line.partition(" > ")[0])[1:]).run


def test_no_command_is_one_line_that_names_the_commands():
    done = run()
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr == "andoyer: error: a command is missing: propagate, convert, plot, code, plan, librations, evolve, bodies, series (--help says more)\n"


@pytest.mark.parametrize("ending", ["csv", "npz", "parquet", "aem", "png"])
def test_folder_that_is_not_there_is_one_line_in_the_words_of_the_system(scene_file, tmp_path, ending):
    if ending in ("parquet", "png"):
        pytest.importorskip("pyarrow" if ending == "parquet" else "matplotlib")
    output = tmp_path / "absent" / f"out.{ending}"
    done = run("plot" if ending == "png" else "propagate", scene_file, "-o", output)
    assert done.returncode == 2 and done.stdout == ""
    assert done.stderr == f"andoyer: error: argument -o/--output: {output}: No such file or directory\n"
