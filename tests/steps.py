"""Run a step of `make test` and keep its times, or print the table of all steps.

    python tests/steps.py NAME COMMAND …     runs the command; its status is that of the step
    python tests/steps.py                    prints the table: wall and processor time of each step [s], in the order of their ends

The times are in target/steps.csv until the next `make test`. No step fails by its time.
"""

import os
import resource
import subprocess
import sys
import time
from pathlib import Path

FILE = Path(__file__).resolve().parents[1] / "target" / "steps.csv"


def run(name: str, command: list[str]) -> int:
    """Run a command and add its times to the file."""
    start = time.monotonic()
    # The jobs of make are not for the compiler: cargo would look for make's pipe, which a child process does not have.
    environment = {key: value for key, value in os.environ.items() if key not in ("MAKEFLAGS", "MFLAGS")}
    status = subprocess.run(command, check=False, env=environment).returncode
    wall, used = time.monotonic() - start, resource.getrusage(resource.RUSAGE_CHILDREN)
    FILE.parent.mkdir(exist_ok=True)
    with FILE.open("a", encoding="utf-8") as file:
        file.write(f"{name},{wall:.1f},{used.ru_utime + used.ru_stime:.1f},{status}\n")
    return status


def main() -> int:
    """The table of the steps, or one step."""
    if sys.argv[1:]:
        return run(sys.argv[1], sys.argv[2:])
    rows = [line.split(",") for line in FILE.read_text(encoding="utf-8").splitlines()]
    print(f"{'step':<16}{'wall [s]':>10}{'processor [s]':>15}")
    for name, wall, used, status in rows:
        print(f"{name:<16}{float(wall):>10.0f}{float(used):>15.0f}{'' if status == '0' else '  failed'}")
    print(f"{'sum':<16}{sum(float(row[1]) for row in rows):>10.0f}{sum(float(row[2]) for row in rows):>15.0f}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
