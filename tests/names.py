"""Check that a type name has one meaning in crates/propagate and a name of the Python package one in it, and that the tuned numbers of the gravity gradient stand in one file.

    python tests/names.py              exit status 1 for a name that two files declare, a float constant elsewhere, or a line of ALLOWED, TWICE or EXACT that is not needed
    python tests/names.py --planted    the same check of the constants and of Python on invented files

Types are structs, enums, traits and type aliases outside of tests, private ones included. Names of Python are classes, type aliases and functions of modules, without those that begin with _. The field itself uses some words twice: they stand in ALLOWED with the reason.
"""

import ast
import re
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

from layers import ROOT, text

ALLOWED = {
    "Motion": "motion_code/kernel is the text of a printed program; its Motion is that program's",
}

TWICE = {
    "main": "what runs a program: the command line, and the self-test",
    "librations": "the command prints what the picture draws",
    "add_arguments": "the arguments of a command, in the file of each",
    "add_options": "the options of a group of formats, in the file of each",
}

EXACT = {
    "terms/term.rs: CONTRACTED": "largest values of the contractions",
    "first_order/epoch_solution.rs: DIFFERENCE": "coefficients of a power series",
    "first_order/epoch_solution.rs: SINE": "coefficients of a power series",
}
CONSTANTS = "constants.rs"

FLOAT = re.compile(r"^ *(?:pub(?:\([^)]*\))? )?(?:const|static) (\w+): \[*f64", re.MULTILINE)
DECLARATION = re.compile(r"^(?:[ ]*(?:pub(?:\([^)]*\))? )?(?:struct|enum|trait)|(?:pub(?:\([^)]*\))? )?type) (\w+)", re.MULTILINE)


def declared(source: Path) -> dict[str, list[str]]:
    """The files that declare each type name."""
    files = defaultdict(list)
    for file in sorted(source.rglob("*.rs")):
        if "tests" not in file.relative_to(source).with_suffix("").parts:
            for name in sorted(set(DECLARATION.findall(text(file)))):
                files[name].append(str(file.relative_to(source)))
    return files


def declared_in_python(source: Path) -> dict[str, list[str]]:
    """The files that declare each class, type alias and function of a module."""
    files = defaultdict(list)
    for file in sorted(source.rglob("*.py")):
        for node in ast.parse(file.read_text(encoding="utf-8")).body:
            alias = isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name) and ast.unparse(node.annotation) == "TypeAlias"
            name = node.target.id if alias else getattr(node, "name", "_")
            if not name.startswith("_"):
                files[name].append(str(file.relative_to(source)))
    return files


def tuned(folder: Path) -> set[str]:
    """The float constants outside of tests and of the file of constants, each after its file."""
    files = [file for file in sorted(folder.rglob("*.rs")) if "tests" not in file.relative_to(folder).with_suffix("").parts]
    return {f"{file.relative_to(folder).as_posix()}: {name}" for file in files if file.name != CONSTANTS for name in FLOAT.findall(text(file))}


def planted() -> int:
    """Check an invented folder with a float constant elsewhere, and a name of Python that two files declare."""
    with tempfile.TemporaryDirectory() as folder:
        for name in ("estimate.rs", CONSTANTS):
            (Path(folder) / name).write_text("pub(crate) const FACTOR: [f64; 2] = [5.0, 1.5];\nconst COUNT: usize = 3;\n", encoding="utf-8")
        for name in ("a.py", "b.py"):
            (Path(folder) / name).write_text("Rows: TypeAlias = list[int]\ndef _own() -> None: ...\n", encoding="utf-8")
        found = tuned(Path(folder)), declared_in_python(Path(folder))
    good = found == ({"estimate.rs: FACTOR"}, {"Rows": ["a.py", "b.py"]})
    print("names: planted constants and names are found" if good else f"names: planted constants and names are not found: {found}")
    return not good


def main() -> int:
    """Print the names with two meanings, and the float constants that are not in their file."""
    if "--planted" in sys.argv[1:]:
        return planted()
    places = [
        (declared(ROOT / "crates/propagate/src"), ALLOWED, "ALLOWED"),
        (declared_in_python(ROOT / "crates/py/python/andoyer"), TWICE, "TWICE"),
    ]
    wrong = False
    for names, allowed, of in places:
        twice = {name: files for name, files in sorted(names.items()) if len(files) > 1}
        for name in sorted(twice.keys() - allowed.keys()):
            print(f"names: {name} is declared in {', '.join(twice[name])}")
        for name in sorted(allowed.keys() - twice.keys()):
            print(f"names: {name} is declared once; remove it from {of}")
        wrong |= twice.keys() != allowed.keys()
    constants = tuned(ROOT / "crates/propagate/src/gravity_gradient")
    scattered, gone = constants - EXACT.keys(), EXACT.keys() - constants
    for name in sorted(scattered):
        print(f"names: the constant gravity_gradient/{name} belongs into {CONSTANTS}")
    for name in sorted(gone):
        print(f"names: the constant {name} is gone; remove it from EXACT")
    if not wrong and not scattered:
        print("names: each type of propagate and each name of the Python package has one meaning, and the gravity gradient one file of tuned numbers")
    return bool(wrong or scattered or gone)


if __name__ == "__main__":
    sys.exit(main())
