"""Builds the playground of the site: the crate of this folder as WebAssembly, and the pages of docs/playground beside it.

    python crates/playground/build.py            writes target/playground/playground and prints its sizes
    python crates/playground/build.py --pages    the pages alone, beside WebAssembly that is built

It needs rustup. The command wasm-bindgen, of the version of the lock file, is installed into target/tools from crates.io if it is not there.
`docs/conf.py` copies target/playground into the site.
"""

import gzip
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

CRATE = Path(__file__).resolve().parent
ROOT = CRATE.parents[1]
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
TOOLS = Path(os.environ.get("PLAYGROUND_TOOLS", ROOT / "target" / "tools"))
OUT = ROOT / "target" / "playground" / "playground"
PAGES = ROOT / "docs" / "playground"
VIEW = ROOT / "crates" / "py" / "python" / "andoyer" / "output"
WASM = "wasm32-unknown-unknown"

EVALUATOR = """const evaluate = time => parent.playground.evaluate(time);
document.getElementById("data").textContent = JSON.stringify(parent.playground.data());"""
"""The view is a page of `plot.page` whose motion is that of the playground around it."""


def run(*command: str | Path, **options: str) -> None:
    """Run a command, and end with its message if it fails."""
    subprocess.run([str(part) for part in command], check=True, **options)


def binding_version() -> str:
    """The version of wasm-bindgen in the lock file, which the command must have too."""
    return re.search(r'name = "wasm-bindgen"\nversion = "([^"]+)"', (CRATE / "Cargo.lock").read_text(encoding="utf-8")).group(1)


def command() -> Path:
    """The command wasm-bindgen in the version of the lock file."""
    path, version = TOOLS / "bin" / "wasm-bindgen", binding_version()
    if not path.exists() or version not in subprocess.run([path, "--version"], capture_output=True, text=True, check=True).stdout:
        # Without optimisation it is there sooner, and it runs for a second.
        # Not by its lock file, which names versions that a mirror of the registry may not have.
        run("cargo", "install", "--debug", "--quiet", "wasm-bindgen-cli", "--version", version, "--root", TOOLS)
    return path


def library() -> None:
    """The crate as WebAssembly with its module in JavaScript."""
    run("rustup", "target", "add", WASM)
    run("cargo", "build", "--release", "--locked", "--quiet", "--target", WASM, "--target-dir", TARGET, cwd=str(CRATE))
    run(command(), "--target", "web", "--no-typescript", "--out-dir", OUT, TARGET / WASM / "release" / "andoyer_playground.wasm")


def pages() -> None:
    """The pages: those of docs/playground, and the view in its frame from the parts of `plot.page`."""
    for page in sorted(PAGES.iterdir()):
        shutil.copy(page, OUT)
    text = (VIEW / "_page.html").read_text(encoding="utf-8")
    drawing = (VIEW / "_page_drawing.js").read_text(encoding="utf-8")
    for mark, part in {"@TITLE@": "", "@DATA@": "", "@EVALUATOR@": EVALUATOR, "@DRAWING@": drawing}.items():
        text = text.replace(mark, part)
    (OUT / "view.js").write_text(f"export const VIEW = {json.dumps(text)};\n", encoding="utf-8")


def main() -> None:
    """Write the folder and print what a reader loads."""
    OUT.mkdir(parents=True, exist_ok=True)
    if sys.argv[1:] != ["--pages"]:
        library()
    pages()
    for path in sorted(OUT.iterdir()):
        print(f"{path.name:28} {path.stat().st_size:9,} bytes, gzipped {len(gzip.compress(path.read_bytes(), 9)):9,}")


if __name__ == "__main__":
    main()
