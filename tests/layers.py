"""Check the imports between the files of each crate. No crate may have an import circle. A module of crates/propagate may import only from earlier layers; lib.rs lists its modules in the order of the layers.

    python tests/layers.py               exit status 1 for a circle or an import from a later layer
    python tests/layers.py --planted     the same check on invented crates that have one of each

The script reads `use` declarations and paths that begin with `crate`, `self` or `super`, and follows names that lib.rs re-exports to their files. It ignores comments and tests.
An import between a module and a file in its own folder does not count as a circle.
"""

import re
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LAYERED = ("propagate",)

Imports = dict[str, set[str]]


def expanded(path: str) -> Iterator[str]:
    """The paths of a `use` tree, one by one."""
    head, brace, rest = path.partition("{")
    if not brace:
        yield re.sub(r"\s+as\s+\w+", "", path).strip()
        return
    depth, part = 0, ""
    for letter in rest.rstrip().removesuffix("}") + ",":
        depth += (letter == "{") - (letter == "}")
        if letter == "," and depth == 0:
            if part.strip():
                yield from expanded(head.strip() + part.strip())
            part = ""
        else:
            part += letter


def code(file: Path) -> str:
    """The text of a file without comments and without its test module."""
    text = re.sub(r"//[^\n]*", "", file.read_text(encoding="utf-8"))
    return re.split(r"#\[cfg\(test\)\]\s*mod \w+ \{", text)[0]


def module(source: Path, file: Path) -> str:
    """`a::b` for a/b.rs and a/b/mod.rs; empty for lib.rs."""
    parts = file.relative_to(source).with_suffix("").parts
    return "::".join(parts[:-1] if parts[-1] in ("mod", "lib") else parts)


def paths(text: str, here: str) -> Iterator[list[str]]:
    """The imports of a file, as paths from the root of its crate."""
    found = [path for tree in re.findall(r"\buse\s+((?:crate|self|super)\b[^;]+);", text) for path in expanded(tree)]
    text = re.sub(r"\buse\s[^;]+;", "", text)
    found += re.findall(r"\b(?:crate|self|super)(?:::\w+)+", text)
    for path in found:
        parts = [part.strip() for part in path.split("::")]
        base = here.split("::") if here and parts[0] != "crate" else []
        while parts and parts[0] in ("crate", "self", "super"):
            base = base[:-1] if parts[0] == "super" else base
            parts = parts[1:]
        yield base + parts


def imports(source: Path) -> Imports:
    """The modules that each module imports."""
    files = {module(source, file): file for file in sorted(source.rglob("*.rs")) if file.stem not in ("tests", "main")}
    root = code(files[""]) if "" in files else ""
    exported = {}
    for tree in re.findall(r"\bpub use\s+([^;]+);", root):
        for path in expanded(tree):
            exported[path.split("::")[-1]] = path.removeprefix("crate::").split("::")

    def home(parts: list[str]) -> str:
        if len(parts) == 1 and parts[0] not in files:
            parts = exported.get(parts[0], parts)
        while parts and "::".join(parts) not in files:
            parts = parts[:-1]
        return "::".join(parts)

    return {name: {home(path) for path in paths(code(file), name)} - {"", name} for name, file in files.items() if name}


def circles(edges: Imports) -> Iterator[list[str]]:
    """Sets of modules that import each other, by Tarjan's algorithm; an import between a module and its own folder is left out."""

    def nested(one: str, other: str) -> bool:
        return one.startswith(other + "::") or other.startswith(one + "::")

    edges = {name: sorted(other for other in others if not nested(name, other)) for name, others in edges.items()}
    index, lowest, stack = {}, {}, []

    def visit(name: str) -> Iterator[list[str]]:
        index[name] = lowest[name] = len(index)
        stack.append(name)
        for other in edges.get(name, ()):
            if other not in index:
                yield from visit(other)
            if other in stack:
                lowest[name] = min(lowest[name], lowest[other])
        if lowest[name] == index[name]:
            together = [stack.pop()]
            while together[-1] != name:
                together.append(stack.pop())
            if len(together) > 1:
                yield sorted(together)

    for name in edges:
        if name not in index:
            yield from visit(name)


def upwards(source: Path, edges: Imports) -> Iterator[str]:
    """Imports of a module from a later layer."""
    layers = re.findall(r"^(?:pub(?:\(crate\))? )?mod (\w+);", code(source / "lib.rs"), re.MULTILINE)
    place = {layer: number for number, layer in enumerate(layers)}
    for name, others in edges.items():
        for other in sorted(others):
            above, below = name.split("::")[0], other.split("::")[0]
            if place[below] > place[above]:
                yield f"{name} imports {other}, which is in a later layer"


def problems(source: Path, layered: bool) -> list[str]:
    """The problems in the imports of a crate."""
    edges = imports(source)
    found = [f"{len(circle)} modules in a circle: {', '.join(circle)}" for circle in circles(edges)]
    return found + (list(upwards(source, edges)) if layered else [])


PLANTED = {
    "a circle": ({"lib.rs": "mod a;\nmod b;\n", "a.rs": "use crate::b::B;\n", "b.rs": "use super::a::A;\n"}, False, ["circle: a, b"]),
    "a circle by a re-exported name": (
        {"lib.rs": "mod a;\nmod b;\npub use b::B;\n", "a.rs": "use crate::{\n    B,\n};\n", "b/mod.rs": "fn f() -> crate::a::A {}\n"},
        False,
        ["circle: a, b"],
    ),
    "an import upwards": (
        {"lib.rs": "mod a;\n\nmod b;\n", "a.rs": "use crate::b::{c::C, B};\n", "b/mod.rs": "", "b/c.rs": ""},
        True,
        ["a imports b", "a imports b::c"],
    ),
    "none": (
        {"lib.rs": "mod a;\nmod b;\n", "a.rs": "// use crate::b::B;\n", "b.rs": "use crate::a::A;\n#[cfg(test)]\nmod tests {\n    use crate::b::B;\n}\n"},
        True,
        [],
    ),
}


def planted() -> list[str]:
    """The cases in which the check misses a planted problem or finds a wrong one."""
    wrong = []
    for name, (files, layered, expected) in PLANTED.items():
        with tempfile.TemporaryDirectory() as folder:
            for path, text in files.items():
                file = Path(folder) / path
                file.parent.mkdir(exist_ok=True)
                file.write_text(text, encoding="utf-8")
            found = problems(Path(folder), layered)
        if len(found) != len(expected) or not all(part in problem for part, problem in zip(expected, found)):
            wrong.append(f"{name}: found {found}, expected {expected}")
    return wrong


def main() -> int:
    """Check the crates or, with --planted, the check itself."""
    if "--planted" in sys.argv[1:]:
        found, good = planted(), "imports: planted circles and imports upwards are found"
    else:
        crates = sorted(path.parent for path in ROOT.glob("crates/*/src"))
        found = [f"crates/{crate.name}: {problem}" for crate in crates for problem in problems(crate / "src", crate.name in LAYERED)]
        good = "imports: no circle, none upwards"
    print("\n".join(found) or good)
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
