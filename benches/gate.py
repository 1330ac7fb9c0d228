"""Compare the instruction counts of ten kernels with the recorded counts. Exit status 1 if a count has grown by more than 5 %.

    python benches/gate.py PROGRAM             `make gate`; PROGRAM is the built `kernels` of benches
    python benches/gate.py PROGRAM --write     `make gate-write`: records new counts in benches/instructions.json

Valgrind's callgrind counts the instructions, so the counts do not depend on the clock or on the load of the machine. Valgrind emulates a processor without AVX-512, so the kernels run with
AVX2 and FMA if the machine has these. The counts are compared only with valgrind, on such a processor (see /proc/cpuinfo), and for the compiler of the recorded counts. Otherwise the last line says "skipped", or with CI set it is an error.
"""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

from figures import machine

# The conditions of the recorded counts.
INSTRUCTION_SETS = {"avx2", "fma"}
FILE = Path(__file__).with_name("instructions.json")
GROWTH = 1.05
# Repeats of each kernel: few, since valgrind is fifty times slower.
KERNELS = {
    "normalize": 2,
    "numeric": 2,
    "solve-closed": 2,
    "solve-series": 1,
    "evaluate": 4,
    "integrate": 2,
    "member": 1,
    "derivatives": 1,
    "libration": 1,
    "periodic": 1,
}


def lacking(processor):
    """Instruction sets of the recorded kernels that this processor lacks according to /proc/cpuinfo."""
    flags = re.search(r"^flags\s*:(.*)$", processor, re.MULTILINE)
    return sorted(INSTRUCTION_SETS - set(flags[1].split() if flags else ()))


def instructions(program, kernel, repeats):
    """Instruction count of callgrind for this number of repeats."""
    command = ["valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, kernel, str(repeats)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    found = re.search(r"Collected\s*:\s*(\d+)", done.stderr)
    if done.returncode or not found:
        sys.exit(f"{' '.join(map(str, command))}: status {done.returncode}\n{done.stderr[-2000:]}")
    return int(found.group(1))


def counted(program):
    """Instructions of one repeat of each kernel, without the first repeat, which fills the caches."""
    return {kernel: (instructions(program, kernel, 1 + n) - instructions(program, kernel, 1)) // n for kernel, n in KERNELS.items()}


def skip(reason, installable=False):
    """Say that nothing is compared. With CI set it is an error if what is missing can be installed."""
    message = f"instruction counts are not checked: {reason}"
    if installable and os.environ.get("CI"):
        sys.exit(message)
    print(f"skipped: {message}")


def main():
    parser = argparse.ArgumentParser(description="Instruction counts of ten kernels against those on file.")
    parser.add_argument("program", type=Path)
    parser.add_argument("--write", action="store_true")
    arguments = parser.parse_args()
    if not shutil.which("valgrind"):
        skip("no valgrind on this machine (apt-get install valgrind)", installable=True)
        return
    if missing := lacking(Path("/proc/cpuinfo").read_text(encoding="utf-8")):
        skip(f"no {' and no '.join(missing)} on this processor")
        return
    compiler = machine()["compiler"]
    counts = counted(arguments.program)
    if arguments.write:
        FILE.write_text(json.dumps({"compiler": compiler, "instructions": counts}, indent=2) + "\n", encoding="utf-8")
    kept = json.loads(FILE.read_text(encoding="utf-8"))
    grown = []
    for kernel, count in counts.items():
        before = kept["instructions"][kernel]
        print(f"{kernel:<14}{count:>14,} instructions, {100 * (count / before - 1):+.2f} % against {before:,}")
        if count > GROWTH * before:
            grown.append(kernel)
    if kept["compiler"] != compiler:
        skip(f"the counts on file are those of {kept['compiler']}, this is {compiler}")
        return
    if grown:
        sys.exit(f"grown by more than {100 * (GROWTH - 1):.0f} %: {', '.join(grown)}; if that is on purpose, `make gate-write`")


if __name__ == "__main__":
    main()
