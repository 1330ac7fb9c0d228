"""The formulas on the front pages of the crates as MathML, which docs.rs and a browser without a network draw in the same way.

    python docs/_ext/rustdoc.py             writes crates/*/doc/formulas.html from the blocks of docs/theory.md
    python docs/_ext/rustdoc.py --check     exit status 1 if they are not what it would write

rustdoc reads Markdown, in which a block of HTML must have no empty line.
"""

import re
import sys
from pathlib import Path

from latex2mathml.converter import convert

ROOT = Path(__file__).resolve().parents[2]
CHOSEN = {
    "series": [("The normal form (theory §4), P_n the triaxiality polynomials:", "K &= ")],
    "propagate": [
        ("Variables and mean motion (theory §1, §7), with agm the arithmetic-geometric mean:", r"R &= R_z"),
        ("", r"\frac{d\ell'}{dt}"),
        ("The attitude without a singularity (theory §8), and its closed form (§10):", r"a = \sqrt"),
        ("", r"a\,e^{-iy'/2}"),
    ],
}


def formulas(crate: str) -> str:
    """The formulas on the front page of a crate."""
    text = (ROOT / "docs" / "theory.md").read_text(encoding="utf-8")
    blocks = re.findall(r"```math\n(.*?)```", text, re.DOTALL)
    parts = []
    for said, start in CHOSEN[crate]:
        (block,) = (block for block in blocks if block.replace("\\begin{aligned}\n", "").startswith(start))
        mathml = convert(block.replace("{aligned}", "{align*}"), display="block").replace("\n", " ")
        parts.append(f"{said}\n\n" * bool(said) + f'<div style="overflow-x: auto; overflow-y: hidden; padding: 0.3em 0">{mathml}</div>\n')
    return "\n".join(parts)


def main() -> int:
    """Write the files, or check them."""
    stale = []
    for crate in CHOSEN:
        path = ROOT / "crates" / crate / "doc" / "formulas.html"
        if "--check" in sys.argv[1:]:
            if not path.exists() or path.read_text(encoding="utf-8") != formulas(crate):
                stale.append(path)
            continue
        path.parent.mkdir(exist_ok=True)
        path.write_text(formulas(crate), encoding="utf-8")
    for path in stale:
        print(f"{path.relative_to(ROOT)} is not what docs/_ext/rustdoc.py makes of docs/theory.md", file=sys.stderr)
    return bool(stale)


if __name__ == "__main__":
    sys.exit(main())
