"""Check the imports between the files of each crate and of the Python package. None may have an import circle, and no Rust module may import a name that lib.rs re-exports: it imports from
the file. A module of crates/propagate may import only from earlier layers; lib.rs lists its modules in the order of the layers. A room, the files of one folder, has at most MOST_FLOORS floors.

    python tests/layers.py               exit status 1 for a circle, an import from a later layer or a list of imports
    python tests/layers.py --planted     the same check on invented crates and a package that have one of each

An edge goes from the file that uses a name to the file that declares the name and, if the path names another file that re-exports it, to that file too. These are uses:

- a private `use`, and each path in the code that begins with `crate`, `self`, `super`, a module of the file (`mod child;`) or an imported module;
- a `pub use` of a name from outside the module's own folder.

`mod child;` and `pub use child::Name` declare and are no edges. But if the code of the same file then uses `Name`, that is an edge to the file that declares it.
The check follows any number of re-exports in any file. Edges between a parent and its children count as any other: a child that uses a function of its parent, whose code calls the
child, is a circle. What lib.rs declares and uses is in the file `lib`.
A list of imports in the comment at the head of a module is refused: nothing keeps it true.
The floors of a room are the files of its longest chain of imports. A room inside it counts alone, and so does the root of a crate, whose modules are rooms.
The check does not see methods that are called on a value, and it leaves out comments and tests (files `tests`, and code below `#[cfg(test)]`).

In Python each import is an edge, in functions and for types alone (`if TYPE_CHECKING`) too. `from package import module` is an edge to that module, not to the package.
"""

import ast
import re
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
LAYERED = ("propagate",)
MOST_FLOORS = 9

Imports = dict[str, set[str]]
LISTED = re.compile(r"^//!.*\b[Ii]mports (?:only )?[\[`]|^//!.*\bImports\b", re.MULTILINE)
USE = re.compile(r"\b(pub(?:\([^)]*\))?\s+)?use\s+([^;]+);")
KEYWORDS = ("crate", "self", "super")


@dataclass
class Module:
    """A module: its file, its code without `use` and inner modules, and the names that it imports."""

    file: str
    code: str = ""
    private: list[tuple[str, list[str]]] = field(default_factory=list)
    public: list[tuple[str, list[str]]] = field(default_factory=list)

    def named(self) -> dict[str, list[str]]:
        """The path of each imported name."""
        return dict(self.private + self.public)


def expanded(path: str) -> Iterator[tuple[str, list[str]]]:
    """The names of a `use` tree, each with its path."""
    head, brace, rest = path.partition("{")
    if not brace:
        whole, _, name = re.sub(r"\s+", " ", path.strip()).partition(" as ")
        parts = [part.strip() for part in whole.split("::") if part.strip()]
        parts = parts[:-1] if parts[-1] == "self" and len(parts) > 1 else parts
        yield name or parts[-1], parts
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


def text(file: Path) -> str:
    """The text of a file without comments and without its tests."""
    code = re.sub(r"//[^\n]*", "", file.read_text(encoding="utf-8"))
    code = re.split(r"#\[cfg\(test\)\]\s*mod \w+ \{", code)[0]
    return re.sub(r"#\[cfg\(test\)\]\s*(?:pub(?:\([^)]*\))? )?(?:use|mod) [^;]+;", "", code)


def parsed(modules: dict[str, Module], name: str, file: str, code: str) -> None:
    """Adds a module and the modules that stand in its text."""
    while inner := re.search(r"^\s*(?:pub(?:\([^)]*\))? )?mod (\w+) \{", code, re.MULTILINE):
        end, depth = inner.end(), 1
        while depth:
            depth += (code[end] == "{") - (code[end] == "}")
            end += 1
        parsed(modules, "::".join(filter(None, (name, inner[1]))), file, code[inner.end() : end - 1])
        code = code[: inner.start()] + code[end:]
    module = modules[name] = Module(file, USE.sub("", code))
    for public, tree in USE.findall(code):
        (module.public if public else module.private).extend(expanded(tree))


class Crate:
    """The modules of a crate, and where their names are declared."""

    def __init__(self, source: Path) -> None:
        self.modules: dict[str, Module] = {}
        for file in sorted(source.rglob("*.rs")):
            parts = file.relative_to(source).with_suffix("").parts
            if "tests" in parts or "main" in parts:
                continue
            name = "::".join(parts[:-1] if parts[-1] in ("mod", "lib") else parts)
            parsed(self.modules, name, name or "lib", text(file))

    def absolute(self, here: str, parts: list[str]) -> list[str] | None:
        """A path from the root of the crate; None for another crate's."""
        base = here.split("::") if here else []
        if parts[0] not in KEYWORDS:
            if "::".join([*base, parts[0]]) in self.modules:
                return base + parts
            alias = self.modules[here].named().get(parts[0], parts)
            return None if alias[0] == parts[0] else self.absolute(here, alias + parts[1:])
        while parts and parts[0] in KEYWORDS:
            base = [] if parts[0] == "crate" else base[:-1] if parts[0] == "super" else base
            parts = parts[1:]
        return base + parts

    def declared(self, module: str) -> set[str]:
        """The names that a module declares, without those that it re-exports."""
        return set(re.findall(r"\b(?:fn|struct|enum|trait|type|const(?! fn)|static(?: mut)?|macro_rules!) (\w+)", self.modules[module].code))

    def home(self, path: list[str], seen: tuple[str, ...] = ()) -> str | None:
        """The module that declares what a path names; None for another crate's name."""
        here = ""
        for place, part in enumerate(path):
            inner = f"{here}::{part}".removeprefix("::")
            if inner in self.modules:
                here = inner
                continue
            for name, target in self.modules[here].private + self.modules[here].public:
                whole = self.absolute(here, target[:-1] if name == "*" else target)
                if name == part and whole is None:
                    return None
                if whole is None or inner in seen or name not in (part, "*") or name == part == "*":
                    continue
                if name == part or ((home := self.home(whole, (*seen, inner))) is not None and part in self.declared(home)):
                    return self.home(whole + path[place + (name != "*") :], (*seen, inner))
            break
        return here

    def through(self, path: list[str]) -> str:
        """The module that a path names before its first other name."""
        ends = (end for end in range(len(path), -1, -1) if "::".join(path[:end]) in self.modules)
        return "::".join(path[: next(ends)])

    def uses(self, here: str) -> Iterator[list[str]]:
        """The paths that the code of a module uses."""
        module = self.modules[here]
        folder = [] if module.file == "lib" else module.file.split("::")
        yield from (path for _, path in module.private)
        for name, path in module.public:
            whole = self.absolute(here, path)
            own = whole is not None and whole[: len(folder)] == folder
            names = self.declared(self.home(whole) or "") if own and name == "*" else {name}
            if not own or names & set(re.findall(r"\w+", module.code)):
                yield path
        yield from (path.split("::") for path in re.findall(r"(?<![\w:$])\w+(?:::\w+)+", module.code))

    def imports(self) -> Imports:
        """The files that each file imports."""
        edges: Imports = {module.file: set() for module in self.modules.values()}
        for here, module in self.modules.items():
            for path in self.uses(here):
                whole = self.absolute(here, path)
                home = None if whole is None else self.home(whole)
                if home is not None:
                    edges[module.file] |= {self.modules[name].file for name in (home, self.through(whole))} - {module.file}
        return edges


def python_imports(source: Path) -> Imports:
    """The modules of a Python package that each of its modules imports."""
    modules = {".".join(file.relative_to(source.parent).with_suffix("").parts).removesuffix(".__init__"): file for file in sorted(source.rglob("*.py"))}
    edges: Imports = {}
    for name, file in modules.items():
        names = set()
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ImportFrom) and node.module:
                inner = {f"{node.module}.{alias.name}" for alias in node.names}
                names |= {module if module in modules else node.module for module in inner}
            elif isinstance(node, ast.Import):
                names |= {alias.name for alias in node.names}
        edges[name] = names & modules.keys() - {name}
    return edges


def circles(edges: Imports) -> Iterator[list[str]]:
    """Sets of files that import each other, by Tarjan's algorithm."""
    index, lowest, stack = {}, {}, []

    def visit(name: str) -> Iterator[list[str]]:
        index[name] = lowest[name] = len(index)
        stack.append(name)
        for other in sorted(edges.get(name, ())):
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
    """Imports of a file from a later layer."""
    layers = re.findall(r"^(?:pub(?:\(crate\))? )?mod (\w+);", text(source / "lib.rs"), re.MULTILINE)
    place = {layer: number for number, layer in enumerate(layers)}
    for name, others in edges.items():
        for other in sorted(others - {"lib"}):
            above, below = name.split("::")[0], other.split("::")[0]
            if name != "lib" and place[below] > place[above]:
                yield f"{name} imports {other}, which is in a later layer"


def chains(edges: Imports) -> dict[str, list[str]]:
    """The longest chain of imports inside each room, of files without a circle."""
    longest: dict[str, list[str]] = {}

    def chain(name: str) -> list[str]:
        if name not in longest:
            room, longest[name] = name.rpartition("::")[0], [name]
            longest[name] = [*max((chain(other) for other in sorted(edges[name]) if other.rpartition("::")[0] == room), key=len, default=[]), name]
        return longest[name]

    found: dict[str, list[str]] = {}
    for name in sorted(edges):
        room, here = name.rpartition("::")[0], chain(name)
        if room and len(here) > len(found.get(room, [])):
            found[room] = here
    return found


def high(edges: Imports) -> Iterator[str]:
    """Rooms with more than MOST_FLOORS floors."""
    for room, chain in chains(edges).items():
        if len(chain) > MOST_FLOORS:
            yield f"{room} has {len(chain)} floors, and at most {MOST_FLOORS} are allowed: {' <- '.join(name.rpartition('::')[2] for name in chain)}"


def from_root(crate: Crate) -> Iterator[str]:
    """Imports of names that lib.rs re-exports."""
    names = {name for name, _ in crate.modules[""].public} - crate.modules.keys()
    for here, module in crate.modules.items():
        if module.file != "lib":
            paths = (crate.absolute(here, path) for path in crate.uses(here))
            for name in sorted({whole[0] for whole in paths if whole and whole[0] in names}):
                yield f"{module.file} imports {name} from the crate's root"


def problems(source: Path, layered: bool) -> list[str]:
    """The problems in the imports of a crate."""
    crate = Crate(source)
    edges = crate.imports()
    found = [
        f"{file.relative_to(source)} lists imports in its head" for file in sorted(source.rglob("*.rs")) if LISTED.search(file.read_text(encoding="utf-8"))
    ]
    return found + list(from_root(crate)) + list(arrows(edges)) + list(high(edges)) + (list(upwards(source, edges)) if layered else [])


def arrows(edges: Imports) -> Iterator[str]:
    """Each circle as a sentence."""
    for circle in circles(edges):
        inside = ", ".join(f"{name} -> {' '.join(sorted(edges[name] & set(circle)))}" for name in circle)
        yield f"{len(circle)} files in a circle: {inside}"


PLANTED = {
    "a circle": (
        {"lib.rs": "mod a;\nmod b;\n", "a.rs": "use crate::b::B;\n", "b.rs": "use super::a::A;\n"},
        False,
        ["circle: a -> b, b -> a"],
    ),
    "a circle by a name that lib.rs re-exports": (
        {"lib.rs": "mod a;\nmod b;\npub use b::B;\n", "a.rs": "use crate::{\n    B,\n};\n", "b/mod.rs": "fn f() -> crate::a::A {}\n"},
        False,
        ["a imports B from the crate's root", "circle: a -> b, b -> a"],
    ),
    "a circle by two re-exports and a renamed one": (
        {
            "lib.rs": "mod a;\nmod b;\n",
            "a.rs": "use crate::b;\nfn f() -> b::Name {}\n",
            "b/mod.rs": "mod c;\npub use c::D as Name;\n",
            "b/c/mod.rs": "mod d;\npub use d::*;\n",
            "b/c/d.rs": "pub struct D(crate::a::A);\n",
        },
        False,
        ["circle: a -> b::c::d, b::c::d -> a"],
    ),
    "a circle of a parent and its child": (
        {"lib.rs": "mod a;\n", "a.rs": "mod b;\npub struct A;\nfn f() { b::g() }\n", "a/b.rs": "use super::A;\nfn g() {}\n"},
        False,
        ["circle: a -> a::b, a::b -> a"],
    ),
    "a circle of a parent and its child, whose name it re-exports and uses": (
        {"lib.rs": "mod a;\n", "a.rs": "mod b;\npub use b::B;\nfn f() -> B {}\n", "a/b.rs": "pub struct B;\nuse super::f;\n"},
        False,
        ["circle: a -> a::b, a::b -> a"],
    ),
    "a circle of lib.rs and a module": (
        {"lib.rs": "mod a;\npub struct A;\nfn f() { a::g() }\n", "a.rs": "use crate::A;\n"},
        False,
        ["circle: a -> lib, lib -> a"],
    ),
    "a circle of an earlier gravity gradient": (
        {
            "lib.rs": "mod gravity_gradient;\n",
            "gravity_gradient/mod.rs": "mod envelope;\nmod generator;\nmod orbit_series;\n",
            "gravity_gradient/envelope.rs": "use crate::gravity_gradient::generator::{ORDERS, Orbital};\npub struct Reach;\n",
            "gravity_gradient/generator.rs": "mod exact;\nmod orbital;\nuse exact::ExactTerms;\npub(crate) use orbital::{ORDERS, Orbital};\nfn f(_: ExactTerms) {}\n",
            "gravity_gradient/generator/exact.rs": "use crate::gravity_gradient::orbit_series::OrbitSeries;\npub(super) struct ExactTerms;\n",
            "gravity_gradient/generator/orbital.rs": "pub const ORDERS: usize = 4;\npub struct Orbital;\n",
            "gravity_gradient/orbit_series.rs": "use super::envelope::Reach;\npub struct OrbitSeries;\n",
        },
        True,
        [
            "4 files in a circle: gravity_gradient::envelope -> gravity_gradient::generator, gravity_gradient::generator -> gravity_gradient::generator::exact, "
            "gravity_gradient::generator::exact -> gravity_gradient::orbit_series, gravity_gradient::orbit_series -> gravity_gradient::envelope"
        ],
    ),
    "a list of imports in a head": (
        {"lib.rs": "mod a;\nmod b;\n", "a.rs": "//! A.\n//!\n//! Ends. Imports errors and orbit.\n", "b.rs": "//! It does not import SymPy.\n"},
        False,
        ["a.rs lists imports in its head"],
    ),
    "a room of ten floors, and one of nine with another inside it": (
        {
            "lib.rs": "mod a;\nmod b;\n",
            **{f"a/f{k}.rs": f"use super::f{k + 1}::F;\n" for k in range(9)},
            "a/f9.rs": "use crate::b::f0::F;\n",
            **{f"b/f{k}.rs": f"use super::f{k + 1}::F;\n" for k in range(8)},
            "b/f8.rs": "use super::c::d::F;\n",
            "b/c/d.rs": "pub struct F;\n",
        },
        False,
        ["a has 10 floors, and at most 9 are allowed: f9 <- f8"],
    ),
    "an import upwards": (
        {"lib.rs": "mod a;\n\nmod b;\n", "a.rs": "use crate::b::{c::C, B};\n", "b/mod.rs": "", "b/c.rs": ""},
        True,
        ["a imports b", "a imports b::c"],
    ),
    "a circle in Python by an import for types and one in a function": (
        {
            "p/__init__.py": "from p.a import A\nfrom p import c\n",
            "p/a.py": "def f():\n    from p.b import g\n",
            "p/b.py": "if TYPE_CHECKING:\n    from p.a import A\n",
            "p/c.py": "import p.a\n",
        },
        False,
        ["circle: p.a -> p.b, p.b -> p.a"],
    ),
    "none": (
        {
            "lib.rs": "mod a;\nmod b;\nmod d;\npub use a::A;\n",
            "a.rs": "// use crate::b::B;\npub struct A;\n",
            "b.rs": "use crate::a::A;\nmod inner {\n    use super::B;\n}\n#[cfg(test)]\nmod tests {\n    use crate::d::D;\n}\n",
            "d/mod.rs": "mod e;\npub use e::E;\npub struct D;\n",
            "d/e.rs": "use super::D;\npub struct E;\n",
        },
        True,
        [],
    ),
}


def planted() -> list[str]:
    """The cases in which the check misses a planted problem or finds a wrong one."""
    wrong = []
    for name, (files, layered, expected) in PLANTED.items():
        with tempfile.TemporaryDirectory() as folder:
            for path, content in files.items():
                file = Path(folder) / path
                file.parent.mkdir(parents=True, exist_ok=True)
                file.write_text(content, encoding="utf-8")
            found = problems(Path(folder), layered) if "lib.rs" in files else list(arrows(python_imports(Path(folder) / "p")))
        if len(found) != len(expected) or not all(part in problem for part, problem in zip(expected, found)):
            wrong.append(f"{name}: found {found}, expected {expected}")
    return wrong


def main() -> int:
    """Check the crates or, with --planted, the check itself."""
    if "--planted" in sys.argv[1:]:
        found, good = planted(), "imports: planted circles, lists, high rooms, imports upwards and from the root are found"
    else:
        crates = sorted(path.parent for path in ROOT.glob("crates/*/src"))
        found = [f"crates/{crate.name}: {problem}" for crate in crates for problem in problems(crate / "src", crate.name in LAYERED)]
        found += [f"crates/py/python: {problem}" for problem in arrows(python_imports(ROOT / "crates/py/python/andoyer"))]
        good = f"imports: no circle, none upwards, none from the root of a crate, no list in a head, no room of more than {MOST_FLOORS} floors"
    print("\n".join(found) or good)
    return bool(found)


if __name__ == "__main__":
    sys.exit(main())
