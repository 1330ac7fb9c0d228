"""The pages held against the package: the example of docs/scene.md is solved, keys, columns, names and symbols are those there are, and no text has a price of its own."""

import ast
import builtins
import inspect
import re

import numpy as np
import pytest
from conftest import REPOSITORY

import andoyer
from andoyer import plot
from andoyer.cli import COLUMNS, main

TEXT = (REPOSITORY / "docs/scene.md").read_text(encoding="utf-8")
EXAMPLE = re.search(r"```toml\n(.*?)```", TEXT, re.DOTALL)[1]
UNCOMMENTED = re.sub(r"^# (?=[a-z_]+ +=|\[)", "", EXAMPLE, flags=re.MULTILINE).replace("named =", "# named =").replace("inertia =", "# inertia =")
# A scene has a state or periods.
OF_PERIODS, UNCOMMENTED = (re.sub(rf"\[{table}\].*\n(?:.+\n)*", "", UNCOMMENTED) for table in ("state", "periods"))


@pytest.fixture
def example(tmp_path):
    path = tmp_path / "example.toml"
    path.write_text(EXAMPLE, encoding="utf-8")
    return path


def test_example_is_a_scene_that_is_solved(example):
    scene = andoyer.Scene.from_toml(example)
    assert scene.body == andoyer.Body.named("ceres")
    plan = scene.solve().plan
    assert plan.mode == "short-axis" and plan.error_bound < scene.tolerance


@pytest.mark.filterwarnings("ignore::andoyer.ToleranceWarning")
def test_lines_that_the_example_comments_out_are_keys_too(example):
    example.write_text(UNCOMMENTED, encoding="utf-8")
    scene = andoyer.Scene.from_toml(example)
    assert scene.order == 8 and scene.body == andoyer.Body.named("ceres")
    assert scene.orbit == andoyer.Orbit(4.329e-8, 0.0797, argument_of_pericentre=1.0)
    assert scene.solve().plan.averaging == "spin"


def known(path, line):
    """The keys that the error for an unknown one lists, in the table of `line`."""
    text = OF_PERIODS if line == "[periods]" else UNCOMMENTED
    path.write_text(text.replace(line, f"{line}\ncolour = 1") if line else f"colour = 1\n{EXAMPLE}", encoding="utf-8")
    with pytest.raises(andoyer.FileError, match="colour") as caught:
        andoyer.Scene.from_toml(path)
    return re.findall("`([a-z_]+)`", str(caught.value).partition("expected ")[2])


def test_table_has_every_key_and_no_other(example):
    expected = [key for key in known(example, "") if key not in {"body", "state", "orbit", "periods"}]
    expected += [f"{table}.{key}" for table in ["body", "state", "orbit", "periods"] for key in known(example, f"[{table}]")]
    assert set(re.findall(r"^\| `([a-z_.]+)` \|(?: .*)? \|.*\|.*\|$", TEXT.partition("## ")[0], re.MULTILINE)) == set(expected)


def test_catalogue_is_listed():
    assert ", ".join(andoyer.Body.catalogue()) in " ".join(TEXT.split())


def test_columns_and_keys_of_what_is_written_are_listed(example):
    csv, npz = (re.findall(r"^\| (`.*?`) \|", part, re.MULTILINE) for part in TEXT.partition("## ")[2].partition("Parquet (")[0].split("NPZ:"))
    assert ",".join(re.findall(r"\w+", " ".join(csv))) == COLUMNS
    output = example.with_suffix(".npz")
    assert main(["propagate", str(example), "-o", str(output), "--stop", "3600", "--step", "60"]) == 0
    with np.load(output) as file:
        assert [f"`{key}`" for key in file] == npz
        assert len(file["times"]) == 61


def test_no_symbol_stands_twice_in_the_table_of_symbols():
    rows = re.findall(r"^\| (.+?) \|", (REPOSITORY / "docs/symbols.md").read_text(encoding="utf-8"), re.MULTILINE)[2:]
    symbols = [symbol for row in rows for symbol in re.split(r", | ≤ ", row)]
    assert len(symbols) > 60 and sorted(symbols) == sorted(set(symbols))


def symbols():
    """The rows of the table of symbols, by symbol."""
    rows = {}
    for line in (REPOSITORY / "docs/symbols.md").read_text(encoding="utf-8").splitlines()[4:]:
        if line.startswith("| "):
            for symbol in re.split(r", | ≤ ", re.split(r"(?<!\\)\|", line)[1].strip()):
                rows[symbol] = line
    return rows


def defined(comment):
    """The letters that a comment defines, each with its formula: `With q = 3φn²/2` does, and a sum, an expansion or a value as in J = 0 does not."""
    letter = r"(?<![\w′_⟨∂^(/·+−|])((?:[A-Za-zΑ-ωϖ]|k_[rN]|r̂|n̂)[₀-₉]?(?:_[a-z]+)?) = (.+)"
    for piece in re.split(r"(?<= {4})|, | and | with |With ", comment):
        found = re.search(letter, piece)
        if found:
            formula = re.split(r" (?=[a-z`\[]{2})|[,;:]|\.(?: |$)", found[2])[0]
            if formula and not re.match(r"[−±]?[\d.π/]+(?: \(|$)|[ABC]$|`|Σ|Re |Q\b|g_j e\^|g e\^", formula):
                yield found[1], formula


def contradictions(text, rows):
    """Letters of the table that the comments of a source file define otherwise."""
    plain = lambda part: re.sub(r"[\s|\\*()]", "", part)  # noqa: E731
    comments = [line.strip() for line in text.splitlines() if re.match(r"\s*//[/!]", line)]
    pairs = [pair for line in comments for pair in defined(line)]
    return [f"{letter} = {formula}" for letter, formula in pairs if letter in rows and plain(formula) not in plain(rows[letter])]


def test_letters_of_the_gravity_gradient_have_the_meaning_of_the_table_of_symbols():
    rows = symbols()
    crate = REPOSITORY / "crates/propagate/src"
    files = [
        *sorted((crate / "gravity_gradient").rglob("*.rs")),
        *(crate / "orbit" / f"{name}.rs" for name in ("tensor", "derivatives", "hansen", "span")),
        crate / "torque.rs",
    ]
    found = {str(path.relative_to(crate)): contradictions(path.read_text(encoding="utf-8"), rows) for path in files}
    assert len(files) > 30 and {name: letters for name, letters in found.items() if letters} == {}
    # Planted: a second meaning of a letter.
    assert contradictions("//! With q = 3φn²/2 and the span T,\n/// μ = G m/a³ of a body\n", rows) == ["q = 3φn²/2", "μ = G m/a³"]


def test_errors_that_the_pages_name_exist_and_are_raised_for_what_they_say():
    pages = [REPOSITORY / "README.md", REPOSITORY / "CHANGELOG.md", *(REPOSITORY / "changes").glob("*.md"), *(REPOSITORY / "docs").glob("*.md")]
    named = {(page.name, name) for page in pages for name in re.findall(r"`(?:andoyer\.)?(\w+Error)`", page.read_text(encoding="utf-8"))}
    assert ("gravity-gradient.md", "TheoryError") in named
    # OnError is a variant of the Rust errors.
    assert not [(page, name) for page, name in named if not (hasattr(andoyer, name) or name in (*dir(builtins), "OnError"))]
    # A synchronous moon, which gravity-gradient.md gives as an example.
    moon = andoyer.Scene(andoyer.Body.named("moon"), [0, 0, 0, 1], [0, 0, 1], orbit=andoyer.Orbit(1.0, 0.0554))
    with pytest.raises(andoyer.TheoryError):
        moon.solve()


def test_cards_of_the_front_page_are_of_equal_length():
    text = (REPOSITORY / "docs/index.md").read_text(encoding="utf-8")
    cards = [re.sub(r"\]\([^)]*\)|[\[*]", "", card) for card in re.findall(r"\{container\} card\n!\[.*\n\n(.*)\n::::\n", text)]
    assert len(cards) == 4 and max(map(len, cards)) <= 1.1 * min(map(len, cards)), [len(card) for card in cards]


def missing(text):
    """Names and keyword arguments of a card of calls that the package does not have."""
    for name, arguments in re.findall(
        r"(?<![\w.=])([A-Z]\w+(?:\.\w+)*|(?:fit|interop|output|plot)\.[\w.]+|[a-z]\w+(?=\())(?:\(([^`]*))?", "\n".join(re.findall(r"`[^`]+`", text))
    ):
        holder = andoyer
        for part in name.split("."):
            holder = plot if part == "plot" else getattr(holder, part, None)
        if holder is None:
            yield name
        elif arguments:
            known = inspect.signature(holder).parameters
            yield from (f"{name}({key}=)" for key in re.findall(r"(\w+)=…", re.sub(r"[A-Z]\w+\(.*?\)", "", arguments)) if key not in known)
            given = [part.strip() for part in re.sub(r"\[.*?\]|\{.*?\}|\([^()]*\)", "X", arguments.rstrip(")")).split(",") if part.strip()]
            named = {part.split("=")[0]: 1 for part in given if "=" in part}
            if given and set(named) <= set(known):
                own = [1] * (next(iter(known)) == "self") + [1 for part in given if "=" not in part]
                try:
                    inspect.signature(holder).bind(*own, **named)
                except TypeError as problem:
                    yield f"{name}: {problem}"


def test_card_of_calls_has_no_name_that_the_package_does_not_have():
    text = (REPOSITORY / "docs/calls.md").read_text(encoding="utf-8")
    table = "\n".join(line for line in text.splitlines() if line.startswith("| `"))
    assert table.count("`") > 150 and list(missing(table)) == []
    assert list(missing("`Torque.sphere(table)`")) == ["Torque.sphere: missing a required argument: 'source'"]
    assert list(missing("`Scene.solv()`, `Scene(body, tolerances=…)`, `plot.sumary(motion)`, `Motion.at`, `normalise(h)`")) == [
        "Scene.solv",
        "Scene(tolerances=)",
        "plot.sumary",
        "normalise",
    ]


def test_troubleshooting_names_every_error_of_the_crates():
    page = (REPOSITORY / "docs/troubleshooting.md").read_text(encoding="utf-8")
    sources = [(REPOSITORY / f"crates/{crate}/src/error.rs").read_text(encoding="utf-8") for crate in ("propagate", "series")]
    variants = [name for source in sources for name in re.findall(r"^ *#\[error\((?:.|\n)*?\)\]\n *([A-Z]\w+)", source, re.MULTILINE)]
    assert len(variants) > 90
    assert [name for name in variants if f"`{name}`" not in page] == []


NUMBER = r"(?<![\w.^⁻])(?:\d[\d.,]*(?:e[-−]?\d+)?|two|three|four|five|six|eight|ten|fifteen|twenty|thirty) "
SHORT = re.compile(rf"{NUMBER}(?:ms|[µμ]s|ns|(?:milli|micro|nano)seconds?)\b")
LONG = re.compile(rf"{NUMBER}(?:s|seconds?|minutes?|hours?)\b")
COST = re.compile(r"\b(?:takes?|taken|took|costs?|cores?|threads?|processor)\b")
# What a command writes from docs/data.
OWNED = re.compile(r"<!-- (?:report|stress|measured)\b.*?<!-- end -->|```measured\n.*?```", re.DOTALL)


def prices(text):
    """Sentences that say what a computation takes: with a number of ms, µs or ns, or of s, minutes or hours beside a word of COST. A duration of nature is written in s or longer units."""
    sentences = (" ".join(sentence.split()) for sentence in re.split(r"(?<=[.;:])\s|\n\s*\n", text))
    return [sentence for sentence in sentences if SHORT.search(sentence) or (COST.search(sentence) and LONG.search(sentence))]


def said(path):
    """What a file says in words: a page without what a command writes, or the comments and docstrings of a source, with an empty line between those that are apart."""
    text = path.read_text(encoding="utf-8")
    if path.suffix == ".md":
        return OWNED.sub("", text)
    nodes = ast.walk(ast.parse(text)) if path.suffix != ".rs" else ()
    docstrings = [
        node.value.value for node in nodes if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str)
    ]
    comments = (re.search(r"(?:^|\s)(?://[/!]?|# )(.*)", line) for line in text.splitlines())
    return "\n\n".join([*docstrings, "\n".join(comment[1] if comment else "" for comment in comments)])


def test_prices_are_those_that_were_measured(tmp_path):
    python = REPOSITORY / "crates/py/python"
    pages = [*REPOSITORY.glob("*.md"), *(REPOSITORY / "docs").glob("*.md"), *REPOSITORY.glob("crates/*/README.md"), REPOSITORY / "benches/README.md"]
    files = [*pages, REPOSITORY / ".github/CONTRIBUTING.md", *REPOSITORY.glob("crates/*/src/**/*.rs"), *python.rglob("*.py"), *python.rglob("*.pyi")]
    # The changelog has the figures of its day.
    found = {str(file.relative_to(REPOSITORY)): prices(said(file)) for file in files if file.name != "CHANGELOG.md"}
    assert len(found) > 400 and {name: sentences for name, sentences in found.items() if sentences} == {}
    planted = {
        "a.rs": ("/// One step takes\n/// 4 µs. A clock ticks every 4 s.\nfn f() {} // as long as 2 ms\n", ["One step takes 4 µs.", "as long as 2 ms"]),
        "a.py": ('def f():\n    """Rows, which take 0.1 s."""\n    # The light time changes by 17 minutes.\n', ["Rows, which take 0.1 s."]),
        "a.md": ("```measured\nensemble\n```\nA form takes two\nseconds.\n\n<!-- report: x -->\n3 ns\n<!-- end -->\n", ["A form takes two seconds."]),
    }
    for name, (text, expected) in planted.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
        assert prices(said(tmp_path / name)) == expected
