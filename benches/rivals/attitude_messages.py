"""Check that Orekit reads the attitude ephemeris messages (CCSDS AEM) of andoyer with the same times, quaternions and angular velocities.

    python benches/rivals/attitude_messages.py --orekit FOLDER [--examples FOLDER]

The script writes and reads messages of every type, both versions and every time system. With `--examples` both programs read every file of that folder instead. A file
is read by both with equal attitudes, or refused by andoyer for the printed reason. Orekit has no ephemeris of the bodies here, so the lines CENTER_NAME
are removed from its copies. Exit status 1 for a difference.
"""

import argparse
import re
import subprocess
import sys
import tempfile
from datetime import datetime
from pathlib import Path

import erfa
import numpy as np

import andoyer
from andoyer._quaternions import angle_between
from andoyer.output import TIME_SYSTEMS, Heading, Segment, read_aem_segments, write_aem

TRIAXIAL = andoyer.Scene(andoyer.Body([1.0, 1.5, 2.0]), [0.1, -0.2, 0.3, 0.9273618495495703], [0.1, 0.2, 1.0]).solve()
SYMMETRIC = andoyer.Scene(andoyer.Body([1.0, 1.0, 1.5]), [0.1, -0.2, 0.3, 0.9273618495495703], [0.3, 0.2, 1.0]).solve()
STEADY = andoyer.Scene(andoyer.Body([1.0, 1.0, 1.5]), [0.1, -0.2, 0.3, 0.9273618495495703], [0.0, 0.0, -0.7]).solve()
TYPES = {
    "QUATERNION": TRIAXIAL,
    "QUATERNION/DERIVATIVE": TRIAXIAL,
    "QUATERNION/ANGVEL": TRIAXIAL,
    "SPIN": STEADY,
    "SPIN/NUTATION": SYMMETRIC,
    "SPIN/NUTATION_MOM": SYMMETRIC,
}
OF_VERSION_1 = ["QUATERNION", "QUATERNION/DERIVATIVE", "SPIN", "SPIN/NUTATION"]

LARGEST_ANGLE = 2e-14
"""[rad]: sixteen digits of angles in degrees, of some 360."""
LARGEST_RATE = 1e-6
"""Of the rate: as well as quaternions of six digits give it, where Orekit does not normalize them before their derivative."""
TDB_LESS_TT = 0.002
"""[s], the most that TDB departs from TT."""


def written(folder: Path) -> list[Path]:
    """Write messages of every type, version and time system."""
    headings = [Heading(attitude_type=name, frame="EME2000") for name in TYPES]
    headings += [Heading(attitude_type=name, frame="EME2000", version=1) for name in OF_VERSION_1]
    headings += [Heading(time_system=system, frame="EME2000", date=datetime(2016, 12, 31, 23, 59, 55), interpolation=("LINEAR", 1)) for system in TIME_SYSTEMS]
    paths = []
    for place, heading in enumerate(headings):
        motion = TYPES[heading.type]
        paths.append(folder / f"{place:02d}-{heading.type.replace('/', '-')}-{heading.time_system}-{heading.version}.aem")
        write_aem(paths[-1], motion.at(np.linspace(0, 20, 41)), heading, body=motion.scene.body)
    return paths


def without_centers(paths: list[Path], folder: Path) -> list[Path]:
    """Copies of the files without the lines CENTER_NAME."""
    copies = [folder / path.name for path in paths]
    for path, copy in zip(paths, copies):
        copy.write_text(re.sub(r"^.*CENTER_NAME.*\n", "", path.read_text(encoding="utf-8"), flags=re.MULTILINE), encoding="utf-8")
    return copies


def by_orekit(paths: list[Path], jars: Path) -> dict[int, dict[int, np.ndarray]]:
    """The rows that Orekit reads, by file and segment; files that Orekit refuses are missing."""
    leaps = "\n".join(f"{row['year']} {row['month']} {round(row['tai_utc'])}" for row in erfa.leap_seconds.get() if row["year"] > 1971)
    program = Path(__file__).parent / "orekit" / "AemRival.java"
    done = subprocess.run(["java", "-cp", str(jars / "*"), str(program), *map(str, paths)], input=leaps, capture_output=True, text=True, check=True)
    found: dict[int, dict[int, list[list[float]]]] = {}
    for line in done.stdout.splitlines():
        place, number, *values = line.split()
        if number != "refused":
            found.setdefault(int(place), {}).setdefault(int(number), []).append([float(value) for value in values])
    return {place: {number: np.array(rows) for number, rows in segments.items()} for place, segments in found.items()}


def compared(segment: Segment, rows: np.ndarray) -> str | None:
    """A description of the differences in a segment, or None."""
    samples = segment.samples
    if len(rows) != len(samples):
        return f"{len(rows)} records by Orekit, {len(samples)} here"
    late = np.abs(rows[:, 0] - samples.times).max()
    angle = angle_between(rows[:, 1:5], samples.attitude).max()
    rate = np.abs(rows[:, 5:] - samples.angular_velocity).max() / max(np.abs(rows[:, 5:]).max(), 1e-300)
    print(f"  {segment.heading.attitude_type:22} {len(rows):4} records, {late:.1e} s, {angle:.1e} rad, rates {rate:.1e}")
    if late > TDB_LESS_TT or angle > LARGEST_ANGLE or rate > LARGEST_RATE:  # rates that a message does not have are NaN here
        return f"{late:.3g} s, {angle:.3g} rad, rates {rate:.3g}"
    return None


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--orekit", type=Path, required=True, help="folder with Orekit's jars")
    parser.add_argument("--examples", type=Path, help="folder of messages")
    options = parser.parse_args()
    wrong = []
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "copies").mkdir()
        paths = sorted(options.examples.iterdir()) if options.examples else written(folder)
        rival = by_orekit(without_centers(paths, folder / "copies"), options.orekit)
        for place, path in enumerate(paths):
            print(path.name)
            try:
                segments = read_aem_segments(path)
            except ValueError as error:
                print(f"  refused: {str(error).removeprefix(str(path))}")
                if options.examples:
                    continue
                segments = []
            if len(segments) != len(rival.get(place, {})):
                wrong.append(f"{path.name}: {len(rival.get(place, {}))} segments by Orekit, {len(segments)} here")
                continue
            said = [compared(segment, rival[place][number]) for number, segment in enumerate(segments)]
            wrong += [f"{path.name}: {what}" for what in said if what]
    print("\n".join(wrong) if wrong else f"{len(paths)} messages: what is read here is the same by Orekit")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
