"""The examples in the docstrings are run."""

import doctest
import inspect

import pytest

import andoyer
from andoyer import fit, interop, output

JAX = ("jax.angular_velocity", "jax.attitude", "jax.state")
NEEDS = dict.fromkeys(("fit.attitudes", "fit.light_curve", "fit.Fit", "fit.Fit.ensemble"), "scipy") | dict.fromkeys(JAX, "jax")


def documented():
    yield "andoyer", andoyer
    for name in andoyer.__all__:
        value = getattr(andoyer, name)
        yield name, value
        if inspect.isclass(value):
            yield from (
                (f"{name}.{member}", getattr(value, member)) for member in vars(value) if not member.startswith("_") and getattr(value, member) is not None
            )
    for name in fit.__all__:
        yield f"fit.{name}", getattr(fit, name)
    yield from ((f"fit.Fit.{member}", value) for member, value in vars(fit.Fit).items() if not member.startswith("_") and callable(value))
    yield from ((f"interop.{name}", getattr(interop, name)) for name in interop.__all__)
    yield from ((f"output.{name}", getattr(output, name)) for name in output.__all__ if callable(getattr(output, name)) and name != "Progress")


EXAMPLES = {name: value for name, value in documented() if ">>>" in (inspect.getdoc(value) or "")}


def of_jax():
    """The functions of andoyer.jax, which is imported only with JAX."""
    return {f"jax.{name}": getattr(andoyer.jax, name) for name in andoyer.jax.__all__}


@pytest.mark.parametrize("name", [*EXAMPLES, *JAX])
def test_example_of_the_docstring_holds(name, tmp_path, monkeypatch):
    pytest.importorskip(NEEDS.get(name, "numpy"))
    monkeypatch.chdir(tmp_path)
    text = inspect.getdoc(of_jax()[name] if name in JAX else EXAMPLES[name])
    test = doctest.DocTestParser().get_doctest(text, vars(andoyer).copy(), name, None, None)
    results = doctest.DocTestRunner().run(test)
    assert results.attempted > 0 and results.failed == 0


def test_every_class_has_an_example_and_everything_public_a_docstring():
    assert set(EXAMPLES) >= {
        "andoyer",
        "Body",
        "Orbit",
        "Scene",
        "Motion",
        "Plan",
        "Samples",
        "Ensemble",
        "NormalForm",
        "BirkhoffNormalForm",
        "normalize",
        "separatrix_action",
    }
    assert not [name for name, value in documented() if name != "__version__" and not inspect.getdoc(value)]


def test_every_function_for_jax_is_among_those_whose_example_is_run():
    pytest.importorskip("jax")
    assert set(of_jax()) == set(JAX)
