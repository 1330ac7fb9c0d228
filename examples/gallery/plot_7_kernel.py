"""
Apophis as a kernel of SPICE
============================

Mission planners read attitudes with SPICE. This example writes the tumbling Apophis as a C-kernel, with its frame and its clock. SpiceyPy then
reads the attitude back, and the angle between the kernel and the motion stays below the requested error.
"""

import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import spiceypy

import andoyer
from andoyer.output import Kernel, write_ck

# %%
# The state is that of the scene file. Time is in seconds with time 0 at J2000, and the frame is the ecliptic. The kernel covers thirty days.

attitude = [0.9936142273587073, 0.039164900723114, -0.09451299087115574, 0.047583319538432894]
rates = [1.7762925277359764e-05, 0.0, 5.530125462483281e-05]
scene = andoyer.Scene(andoyer.Body.named("apophis"), attitude, rates, tolerance=1e-10, name="Apophis, tumbling")
motion = scene.solve()
DAY = 86400.0
interval = (0.0, 30 * DAY)

# %%
# You can choose the codes and names of the kernel. The inertial frame must be one of SPICE; ECLIPJ2000 is the ecliptic. A C-kernel of type 3 rotates uniformly
# from one record to the next. If the angular acceleration is α [rad/s²], the error in an interval of h seconds is h²α/8. The records are therefore denser
# where the angular velocity of Apophis changes faster.

ASKED = 1e-6
kernel = Kernel(instrument=-99942000, body_frame="APOPHIS_TUMBLING", frame="ECLIPJ2000", clock_id=-99942)
folder = Path(tempfile.mkdtemp())
written = write_ck(folder / "apophis.bc", motion, interval, kernel, interpolation_error=ASKED)
print(f"type {written.type}, {written.records} records, one in {interval[1] / written.records:.0f} s; {(folder / 'apophis.bc').stat().st_size / 1e6:.1f} MB")

# %%
# Load two files: the C-kernel and the text kernel with frame and clock. After that SPICE can use the frame like any other frame.

spiceypy.furnsh(str(folder / "apophis.bc"))
spiceypy.furnsh(str(folder / "apophis.tsc"))
times = np.random.default_rng(1).uniform(*interval, 2000)
times.sort()
matrices = np.array([spiceypy.pxform("APOPHIS_TUMBLING", "ECLIPJ2000", time) for time in times])

# %%
# The angle between two rotation matrices R and S follows from the Frobenius norm: ‖R − S‖ = 2√2 sin(angle/2).

expected = motion.rotation(times).as_matrix()
angle = 2 * np.arcsin(np.linalg.norm(matrices - expected, axis=(1, 2)) / np.sqrt(8))
print(f"largest angle {angle.max():.2e} rad, asked for {ASKED:.0e}")
assert ASKED / 4 < angle.max() < ASKED

figure, panels = plt.subplots(2, 1, figsize=(9, 6), layout="constrained", sharex=True)
panels[0].plot(times / DAY, np.degrees(np.arctan2(matrices[:, 1, 0], matrices[:, 0, 0])), ".", markersize=2, color="#0072B2")
panels[0].set(ylabel="longitude of the long axis [deg]", title="Read with SpiceyPy")
panels[1].semilogy(times / DAY, angle, ".", markersize=2, color="#D55E00")
panels[1].axhline(ASKED, color="black", linestyle="--", label="asked for")
panels[1].set(xlabel="time [d]", ylabel="angle from the motion [rad]")
panels[1].legend(loc="lower right")
plt.show()

# %%
# SPICE has one pool of kernels for the whole process. `kclear` unloads the kernels.

spiceypy.kclear()
