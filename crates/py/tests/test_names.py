"""The names that users rely on, what importing costs, and what the stub says of bases and docstrings."""

import ast
import inspect
import subprocess
import sys
from pathlib import Path

import pytest

import andoyer
import andoyer._core as core

NAMES = {
    "": "NormalForm normalize separatrix_action Body Orbit Scene Motion Plan Samples Ensemble Error",
    "NormalForm": "order triaxiality_polynomial paper_polynomial generator direct inverse to_json from_json to_latex to_sympy to_code",
    "BirkhoffNormalForm": "order degree exact frequencies in_actions in_real in_complex generator direct inverse to_normal from_normal",
    "Body": "moments alpha beta gamma omega name named",
    "Orbit": "mean_motion eccentricity time_of_pericentre inclination node argument_of_pericentre mass_fraction",
    "Scene": "body attitude angular_velocity epoch orbit tolerance method order span averaging level name from_toml to_toml solve",
    "Motion": "at attitude angular_velocity angular_momentum andoyer rotation plan frequencies periods scene",
    "Plan": "mode method order harmonics error_bound separatrix_ratio averaging torque skipped",
    "Samples": "times attitude angular_velocity",
    "Ensemble": "at attitude angular_momentum andoyer rotation partials periods energy_ratio plans moments attitudes angular_velocities orbits tolerance span threads",
}
STUB = ast.parse(Path(core.__file__).with_name("_core.pyi").read_text(encoding="utf-8"))
CLASSES = {node.name: node for node in STUB.body if isinstance(node, ast.ClassDef)}
FUNCTIONS = {node.name: node for node in STUB.body if isinstance(node, ast.FunctionDef)}


def public(names):
    return {name for name in names if not name.startswith("_")}


@pytest.mark.parametrize("owner", NAMES)
def test_names_users_rely_on_are_there(owner):
    holder = getattr(andoyer, owner) if owner else andoyer
    assert not [name for name in NAMES[owner].split() if not hasattr(holder, name)]


def test_all_lists_everything_public_and_nothing_else():
    modules = {"cli", "distribution", "fit", "interop", "jax", "mean", "output", "plot", "selftest"}
    assert public(andoyer.__all__) == public(vars(andoyer)) - modules
    assert andoyer.__all__ == sorted(andoyer.__all__) and andoyer.__version__ == core.__version__


def test_every_exception_is_an_error_and_a_value_error():
    exceptions = [value for value in vars(core).values() if isinstance(value, type) and issubclass(value, BaseException)]
    assert len(exceptions) == 7
    exceptions.remove(andoyer.ToleranceWarning)
    assert issubclass(andoyer.ToleranceWarning, UserWarning) and andoyer.ToleranceWarning.__module__ == "andoyer"
    assert all(issubclass(exception, andoyer.Error) and exception.__module__ == "andoyer" for exception in exceptions)
    assert issubclass(andoyer.Error, ValueError)


def test_import_prints_nothing_and_loads_numpy_alone():
    code = "import sys, andoyer; sys.exit(bool({'scipy', 'jax', 'matplotlib', 'mpmath', 'sympy', 'pyarrow'} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_import_costs_less_than_50_ms_beyond_numpy():
    """The least of five, by the interpreter's own account: what andoyer and its own modules take, NumPy's share left out."""
    code = [sys.executable, "-X", "importtime", "-c", "import numpy, andoyer"]
    costs = []
    for _ in range(5):
        lines = subprocess.run(code, capture_output=True, text=True, check=True).stderr.splitlines()
        costs += [int(line.split("|")[1]) for line in lines if line.split("|")[-1] == " andoyer"]
    assert len(costs) == 5 and min(costs) < 50_000, costs


def test_selftest_of_the_installed_wheel_holds():
    done = subprocess.run([sys.executable, "-m", "andoyer.selftest"], capture_output=True, text=True, encoding="utf-8")
    assert done.returncode == 0 and done.stdout.splitlines()[-1].endswith("9 of 9 hold"), done.stdout + done.stderr


@pytest.mark.parametrize("name", ["Body", "Orbit", "Scene", "Motion", "Plan", "NormalForm"])
def test_objects_are_frozen(name, body, scene, motion):
    objects = {"Body": body, "Scene": scene, "Motion": motion, "Plan": motion.plan, "NormalForm": andoyer.NormalForm(1), "Orbit": andoyer.Orbit(1.0)}
    for attribute in ["order", "plan", "name", "eccentricity", "other"]:
        with pytest.raises((AttributeError, TypeError)):
            setattr(objects[name], attribute, 1)


@pytest.mark.parametrize("name", CLASSES)
def test_stub_has_the_bases_of_the_class(name):
    """All else of the stub is held by mypy's own check: test_types.py."""
    assert [ast.unparse(base) for base in CLASSES[name].bases] == [base.__name__ for base in getattr(core, name).__bases__ if base is not object]


def documented():
    for name, node in (FUNCTIONS | CLASSES).items():
        yield pytest.param(node, getattr(core, name), id=name)
        for member in getattr(node, "body", []):
            known = isinstance(member, ast.FunctionDef) and hasattr(getattr(core, name), member.name)
            if known and not member.name.startswith("_"):
                yield pytest.param(member, getattr(getattr(core, name), member.name), id=f"{name}.{member.name}")


@pytest.mark.parametrize("node, value", list(documented()))
def test_stub_says_the_first_line_of_the_docstring(node, value):
    assert ast.get_docstring(node) == inspect.getdoc(value).splitlines()[0]
