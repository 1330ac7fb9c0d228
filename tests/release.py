"""Check that version, address, licences and changelog of a release agree in all files.

    python tests/release.py              exit status 1 and one line for each disagreement
    python tests/release.py --write      copies version and address from `workspace.package` in Cargo.toml to the other places, and the date from the changelog
    python tests/release.py --release    puts the notes of changes/ together as the section of the version, with the date of today, and does --write
    python tests/release.py --planted    the same on invented notes
    python tests/release.py --semver     compares the public Rust names with the last tag by cargo-semver-checks, which must be installed if CI is set

`workspace.package` in Cargo.toml defines the version and the address (`repository`). The date of the version is that of its section in CHANGELOG.md. The README of the wheel is that of the repository with absolute links, since
registries show it without the other files.
"""

import datetime
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = tomllib.loads((ROOT / "Cargo.toml").read_text(encoding="utf-8"))["workspace"]["package"]
VERSION, ADDRESS = PACKAGE["version"], PACKAGE["repository"]
PUBLISHED = ("double", "kernels", "series", "propagate")
PLACEHOLDER = "https://example.org/"
PICTURES = (".png", ".svg")
KINDS = ("Added", "Changed", "Deprecated", "Removed", "Fixed", "Security")
UNRELEASED = "## [Unreleased]\n\nThe rows of the next version are in `changes/`, one file for each change.\n\n"
NOTE = re.compile(rf"[a-z0-9]+(?:-[a-z0-9]+)*\.({'|'.join(KINDS).lower()})\.md")
LINK = re.compile(r"\]\((?!https?:|#)([^)\s]+)\)")


def absolute(text: str, folder: str = "") -> str:
    """A README with absolute links to files and pictures of the repository."""

    def linked(match: re.Match[str]) -> str:
        kind = "raw" if match[1].endswith(PICTURES) else "blob"
        return f"]({ADDRESS}/{kind}/main/{folder}{match[1]})"

    return LINK.sub(linked, text)


def readdressed(text: str) -> str:
    """Replace any former address in the links to files of the repository by the current one."""
    return re.sub(r"https://[^\s\")]+?(?=/(?:blob|raw)/main/)", ADDRESS, text)


def expected() -> Iterator[tuple[Path, str]]:
    """The files that are made from Cargo.toml and the README, with their expected contents."""

    def text(name: str) -> str:
        return (ROOT / name).read_text(encoding="utf-8")

    yield ROOT / "crates/py/README.md", absolute(text("README.md"))
    for crate in PUBLISHED:
        yield ROOT / f"crates/{crate}/README.md", readdressed(text(f"crates/{crate}/README.md"))
    yield ROOT / "Cargo.toml", re.sub(r'(?m)^(andoyer-\w+ = .*version = )"[^"]*"', rf'\g<1>"{VERSION}"', text("Cargo.toml"))
    released = re.search(rf"(?m)^## \[{re.escape(VERSION)}\] - (\S+)$", text("CHANGELOG.md"))
    date = f"\ndate-released: {released[1]}" if released else ""
    cited = re.sub(r"(?m)^version: .*$(\ndate-released: .*$)?", f"version: {VERSION}{date}", text("CITATION.cff"))
    recipe = re.sub(r'(?m)^  version: ".*"$', f'  version: "{VERSION}"', text("recipe/recipe.yaml"))
    yield ROOT / "recipe/recipe.yaml", re.sub(r"(?m)^  repository: .*$", f"  repository: {ADDRESS}", recipe)
    yield ROOT / "CITATION.cff", re.sub(r"(?m)^repository-code: .*$", f"repository-code: {ADDRESS}", cited)
    date = f'\n  "datePublished": "{released[1]}",' if released else ""
    meta = re.sub(r'"version": "[^"]*",(\n  "datePublished": "[^"]*",)?', f'"version": "{VERSION}",{date}', text("codemeta.json"))
    yield ROOT / "codemeta.json", re.sub(r'"codeRepository": "[^"]*"', f'"codeRepository": "{ADDRESS}"', meta)
    project = re.sub(r'(?m)^Repository = ".*"$', f'Repository = "{ADDRESS}"', text("crates/py/pyproject.toml"))
    yield ROOT / "crates/py/pyproject.toml", readdressed(project)


def problems() -> Iterator[str]:
    """One line for each disagreement."""
    for path, text in expected():
        if not path.exists() or path.read_text(encoding="utf-8") != text:
            yield f"{path.relative_to(ROOT)}: not what Cargo.toml and README.md say: python tests/release.py --write"
    for crate in (*PUBLISHED, "py"):
        for licence in ("LICENSE-MIT", "LICENSE-APACHE"):
            path = ROOT / "crates" / crate / licence
            if not path.exists() or path.read_bytes() != (ROOT / licence).read_bytes():
                yield f"{path.relative_to(ROOT)}: not the text of {licence}"
        readme = ROOT / "crates" / crate / "README.md"
        links = LINK.findall(readme.read_text(encoding="utf-8")) if readme.exists() else []
        yield from (f"crates/{crate}/README.md: a registry has no file {link}" for link in links)
    json.loads((ROOT / "codemeta.json").read_text(encoding="utf-8"))
    yield from wrong_notes(ROOT / "changes")
    yield from changelog((ROOT / "CHANGELOG.md").read_text(encoding="utf-8"))


def changelog(text: str) -> Iterator[str]:
    """Problems of the changelog: Unreleased must come first with no rows, then the versions in descending order, each once and with a date."""
    headings = re.findall(r"(?m)^## (.*)$", text)
    if not headings or headings[0] != "[Unreleased]":
        yield f"CHANGELOG.md: the first section must be [Unreleased]: got {headings[:1]}"
    elif f"{UNRELEASED}## " not in text:
        yield "CHANGELOG.md: under [Unreleased] stands one sentence that names changes/; a row belongs into a file there"
    versions = []
    for heading in headings[1:]:
        match = re.fullmatch(r"\[(\d+)\.(\d+)\.(\d+)\] - \d{4}-\d{2}-\d{2}", heading)
        if match is None:
            yield f"CHANGELOG.md: a section must be [version] - date: got {heading}"
        else:
            versions.append(tuple(int(part) for part in match.groups()))
    if versions != sorted(set(versions), reverse=True):
        yield f"CHANGELOG.md: versions must fall: got {versions}"
    for section in re.split(r"(?m)^## ", text)[1:]:
        names = re.findall(r"(?m)^### (.*)$", section)
        yield from (f"CHANGELOG.md: {name} stands twice in {section.splitlines()[0]}" for name in sorted(set(names)) if names.count(name) > 1)


def notes(folder: Path) -> list[Path]:
    """The notes of a folder by name; its README is none."""
    return sorted(path for path in folder.iterdir() if path.name != "README.md")


def wrong_notes(folder: Path) -> Iterator[str]:
    """One line for each note whose name or form is wrong."""
    for path in notes(folder):
        if not NOTE.fullmatch(path.name):
            yield f"changes/{path.name}: a note must be NAME.KIND.md, with small letters, digits and hyphens in NAME and one of {', '.join(KINDS).lower()} as KIND"
        elif not re.fullmatch(r"(?:- \S.*\n(?:  \S.*\n)*)+", path.read_text(encoding="utf-8")):
            yield f"changes/{path.name}: a note must be rows that begin with '- '; a further line of a row begins with two spaces"


def released(text: str, folder: Path, version: str, date: str) -> str:
    """The changelog with the section of a version: the notes of a folder by kind and name."""
    sections = dict.fromkeys(KINDS, "")
    for path in notes(folder):
        sections[path.name.split(".")[1].capitalize()] += path.read_text(encoding="utf-8")
    body = "".join(f"### {name}\n\n{rows}\n" for name, rows in sections.items() if rows)
    return text.replace(UNRELEASED, f"{UNRELEASED}## [{version}] - {date}\n\n{body}")


def release() -> int:
    """Write the section of the version and remove its notes."""
    path, folder = ROOT / "CHANGELOG.md", ROOT / "changes"
    text = path.read_text(encoding="utf-8")
    found = [*wrong_notes(folder), *changelog(text)]
    if f"## [{VERSION}]" in text:
        found.append(f"CHANGELOG.md: has a section of {VERSION}; set another version in Cargo.toml")
    if found:
        print("\n".join(found), file=sys.stderr)
        return 1
    path.write_text(released(text, folder, VERSION, datetime.date.today().isoformat()), encoding="utf-8")
    for note in notes(folder):
        note.unlink()
    return main(["--write"])


def planted() -> int:
    """Put invented notes together; refuse notes with a wrong name or form, and a row under [Unreleased]."""
    first = "## [0.1.0] - 2026-01-01\n\n### Added\n\n- First.\n"
    text = f"# Changelog\n\n{UNRELEASED}{first}"
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, row in {"b.added.md": "- B.\n", "a-1.added.md": "- A,\n  in two lines.\n", "c.fixed.md": "- C.\n", "README.md": "Notes.\n"}.items():
            (folder / file).write_text(row, encoding="utf-8")
        good = list(wrong_notes(folder))
        done = released(text, folder, "0.2.0", "2026-02-02")
        for file, row in {"d.new.md": "- D.\n", "E.fixed.md": "- E.\n", "f.fixed.md": "F.\n"}.items():
            (folder / file).write_text(row, encoding="utf-8")
        refused = [line.split(":")[0] for line in wrong_notes(folder)]
    expected = f"# Changelog\n\n{UNRELEASED}## [0.2.0] - 2026-02-02\n\n### Added\n\n- A,\n  in two lines.\n- B.\n\n### Fixed\n\n- C.\n\n{first}"
    rows = [list(changelog(text.replace(first, f"{planted}\n\n{first}"))) for planted in ("### Added\n\n- Row.", "Text.")]
    holds = (
        done == expected
        and not good
        and refused == ["changes/E.fixed.md", "changes/d.new.md", "changes/f.fixed.md"]
        and not list(changelog(done))
        and [len(found) for found in rows] == [1, 1]
    )
    print("release: planted notes are put together, wrong ones refused" if holds else f"release: planted notes are not put together:\n{done}\n{refused}")
    return not holds


def semver() -> int:
    """Compare the public names of the crates with those of the last tag."""
    done = subprocess.run(["git", "describe", "--tags", "--abbrev=0", "--match", "v*"], cwd=ROOT, capture_output=True, text=True)
    if done.returncode:
        print("semver: no tag v* yet, and so nothing to compare with")
        return 0
    if shutil.which("cargo-semver-checks") is None:
        print("semver: skipped, since there is no cargo-semver-checks (cargo install --locked cargo-semver-checks)")
        return 1 if os.environ.get("CI") else 0
    packages = [argument for crate in PUBLISHED for argument in ("--package", f"andoyer-{crate}")]
    return subprocess.run(["cargo", "semver-checks", "--baseline-rev", done.stdout.strip(), *packages], cwd=ROOT).returncode


def main(arguments: list[str]) -> int:
    if arguments == ["--semver"]:
        return semver()
    if arguments == ["--release"]:
        return release()
    if arguments == ["--planted"]:
        return planted()
    if arguments == ["--write"]:
        for path, text in expected():
            path.write_text(text, encoding="utf-8")
    elif arguments:
        raise SystemExit(__doc__)
    found = list(problems())
    for line in found:
        print(line, file=sys.stderr)
    if ADDRESS.startswith(PLACEHOLDER):
        print(f"note: workspace.package.repository is a placeholder, {ADDRESS}")
    return 1 if found else 0


if __name__ == "__main__":
    raise SystemExit(main(sys.argv[1:]))
