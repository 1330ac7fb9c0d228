"""Run the lines of heyoka in docs/coming-from.md, and hold their last state against andoyer's motion of the same body.

    python benches/rivals/coming_from.py

Exit status 1 if attitude or rates differ by 1e-13 or more.
"""

import re
import sys
from pathlib import Path

import numpy as np

import andoyer

PAGE = Path(__file__).resolve().parents[2] / "docs" / "coming-from.md"


def lines():
    """The lines of heyoka on the page. No test of the pages runs them, so they stand in a block of text."""
    (found,) = re.findall(r"```text\n(import heyoka\n.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    return found


def main():
    theirs = {}
    exec(compile(lines(), str(PAGE), "exec"), theirs)
    motion = andoyer.Scene(andoyer.Body([1.0, 1.5, 2.0]), [0, 0, 0, 1], [0.1, 0.2, 1.0]).solve()
    difference = abs(theirs["integrator"].state - np.concatenate([motion.attitude(100.0), motion.angular_velocity(100.0)])).max()
    print(f"docs/coming-from.md, heyoka: attitude and rates differ by {difference:.1e}")
    return int(difference >= 1e-13)


if __name__ == "__main__":
    sys.exit(main())
