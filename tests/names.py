"""Check that a type name has one meaning in crates/propagate, and that the tuned numbers of the gravity gradient stand in one file.

    python tests/names.py              exit status 1 for a type name that two files declare, a float constant elsewhere, or a line of ALLOWED or EXACT that is not needed
    python tests/names.py --planted    the same check of the constants on an invented file

Types are structs, enums, traits and type aliases outside of tests, private ones included. The field itself uses some words twice: they stand in ALLOWED with the reason.
"""

import re
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

from layers import ROOT, text

ALLOWED = {
    "Motion": "motion_code/kernel is the text of a printed program; its Motion is that program's",
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


def tuned(folder: Path) -> set[str]:
    """The float constants outside of tests and of the file of constants, each after its file."""
    files = [file for file in sorted(folder.rglob("*.rs")) if "tests" not in file.relative_to(folder).with_suffix("").parts]
    return {f"{file.relative_to(folder).as_posix()}: {name}" for file in files if file.name != CONSTANTS for name in FLOAT.findall(text(file))}


def planted() -> int:
    """Check an invented folder with a float constant elsewhere."""
    with tempfile.TemporaryDirectory() as folder:
        for name in ("estimate.rs", CONSTANTS):
            (Path(folder) / name).write_text("pub(crate) const FACTOR: [f64; 2] = [5.0, 1.5];\nconst COUNT: usize = 3;\n", encoding="utf-8")
        found = tuned(Path(folder))
    print("names: planted constants are found" if found == {"estimate.rs: FACTOR"} else f"names: planted constants are not found: {found}")
    return found != {"estimate.rs: FACTOR"}


def main() -> int:
    """Print the names with two meanings, and the float constants that are not in their file."""
    if "--planted" in sys.argv[1:]:
        return planted()
    twice = {name: files for name, files in sorted(declared(ROOT / "crates/propagate/src").items()) if len(files) > 1}
    unneeded = ALLOWED.keys() - twice.keys()
    left = {name: files for name, files in twice.items() if name not in ALLOWED}
    for name, files in left.items():
        print(f"names: {name} is declared in {', '.join(files)}")
    for name in sorted(unneeded):
        print(f"names: {name} is declared once; remove it from ALLOWED")
    constants = tuned(ROOT / "crates/propagate/src/gravity_gradient")
    scattered, gone = constants - EXACT.keys(), EXACT.keys() - constants
    for name in sorted(scattered):
        print(f"names: the constant gravity_gradient/{name} belongs into {CONSTANTS}")
    for name in sorted(gone):
        print(f"names: the constant {name} is gone; remove it from EXACT")
    if not left and not scattered:
        print("names: each type of propagate has a name of its own, and the gravity gradient one file of tuned numbers")
    return bool(left or unneeded or scattered or gone)


if __name__ == "__main__":
    sys.exit(main())
