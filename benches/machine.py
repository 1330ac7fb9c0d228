"""Description of the machine of a measurement: processor, cores, compiler, commit, date. It contains no host names."""

import datetime
import os
import platform
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def described():
    """The columns that describe the machine in every row of docs/data/bench.csv and work-precision.csv."""
    return {
        "processor": _processor(),
        "cores": os.cpu_count(),
        "compiler": _told("rustc", "--version"),
        "commit": _told("git", "describe", "--always", "--dirty", "--exclude", "*"),
        "date": datetime.datetime.now(datetime.UTC).date().isoformat(),
    }


def _processor():
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or platform.machine()
    names = [line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")]
    flags = next((line for line in lines if line.startswith("flags")), "")
    wide = "AVX-512" if "avx512f" in flags else "AVX2" if "avx2" in flags else "no AVX2"
    return f"{names[0] if names else platform.machine()} ({wide})"


def _told(*command):
    try:
        return subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"
