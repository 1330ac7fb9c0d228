"""Check that a type name has one meaning in crates/propagate: two files do not declare a type of the same name, private ones included.

    python tests/names.py    exit status 1 for such a name, or for a line of ALLOWED that is not needed

Types are structs, enums, traits and type aliases outside of tests. The field itself uses some words twice: they stand in ALLOWED with the reason.
"""

import re
import sys
from collections import defaultdict
from pathlib import Path

from layers import ROOT, text

ALLOWED = {
    "Motion": "motion_code/kernel is the text of a printed program; its Motion is that program's",
}

DECLARATION = re.compile(r"^(?:[ ]*(?:pub(?:\([^)]*\))? )?(?:struct|enum|trait)|(?:pub(?:\([^)]*\))? )?type) (\w+)", re.MULTILINE)


def declared(source: Path) -> dict[str, list[str]]:
    """The files that declare each type name."""
    files = defaultdict(list)
    for file in sorted(source.rglob("*.rs")):
        if "tests" not in file.relative_to(source).with_suffix("").parts:
            for name in sorted(set(DECLARATION.findall(text(file)))):
                files[name].append(str(file.relative_to(source)))
    return files


def main() -> int:
    """Print the names with two meanings."""
    twice = {name: files for name, files in sorted(declared(ROOT / "crates/propagate/src").items()) if len(files) > 1}
    unneeded = ALLOWED.keys() - twice.keys()
    left = {name: files for name, files in twice.items() if name not in ALLOWED}
    for name, files in left.items():
        print(f"names: {name} is declared in {', '.join(files)}")
    for name in sorted(unneeded):
        print(f"names: {name} is declared once; remove it from ALLOWED")
    if not left:
        print("names: each type of propagate has a name of its own")
    return bool(left or unneeded)


if __name__ == "__main__":
    sys.exit(main())
