"""
Apophis and its light curve
===========================

Apophis tumbles: its short axis precesses in 27.38 hours, and the body turns about this axis in 263 hours (Pravec et al. 2014). This example finds the state with these periods. It then computes
the periods in three conventions, the strongest line of the light curve, and the error of the series at each order.
"""

import matplotlib.pyplot as plt
import numpy as np

import andoyer
from andoyer import plot

# %%
# The state has the two periods and the moments of the catalogue. The angular momentum points to ecliptic longitude 275°, latitude −85° (Lee et al. 2022). The phases are the default ones.
# Time is in seconds.

HOUR = 3600.0
apophis = andoyer.Body.named("apophis")
scene = andoyer.Scene.from_periods(apophis, 27.38 * HOUR, 263.0 * HOUR, momentum_direction=np.radians([275, -85]), name="Apophis, tumbling")
motion = scene.solve()
print(motion.plan)

# %%
# Light-curve papers use the extremal axis. Here it is the short axis, because the motion is in a short-axis mode. The long axis precesses more slowly, in 30.56 hours.

for convention, (precession, rotation) in motion.periods.items():
    print(f"{convention:13}  P_φ {precession / HOUR:.2f} h   P_ψ {rotation / HOUR:.1f} h")
precession, rotation = motion.periods["extremal-axis"]
long_axis = motion.periods["long-axis"].precession
assert [round(time / HOUR, 2) for time in (precession, rotation, long_axis)] == [27.38, 263.0, 30.56]

# %%
# The light curve is the cross-section of the homogeneous ellipsoid with these moments, for an observer perpendicular to the angular momentum. It repeats after half a turn of the long axis, so the
# strongest line of its spectrum is at half of 30.56 hours.

A, B, C = apophis.moments
semi_axes = np.sqrt([B + C - A, A + C - B, A + B - C])
momentum = motion.angular_momentum(0.0)
observer = np.cross(momentum, [1.0, 0.0, 0.0])
observer /= np.linalg.norm(observer)
times = np.arange(2**15) * 0.5 * HOUR
seen = motion.rotation(times).apply(observer, inverse=True)
section = np.pi * np.prod(semi_axes) * np.linalg.norm(seen / semi_axes, axis=1)
spectrum = np.abs(np.fft.rfft((section - section.mean()) * np.hanning(len(times))))
cycles = np.fft.rfftfreq(len(times), 0.5)
strongest = 1 / cycles[np.argmax(spectrum)]
print(f"strongest line of the light curve: {strongest:.2f} h")
assert abs(strongest - long_axis / HOUR / 2) < 0.01

figure, axes = plt.subplots(figsize=(9, 4), layout="constrained")
axes.plot(cycles * 24, spectrum / spectrum.max(), color="#0072B2")
axes.axvline(2 * 24 * HOUR / long_axis, color="#D55E00", linestyle="--", label="twice the precession of the long axis")
axes.set(xlabel="cycles a day", ylabel="amplitude", xlim=(0, 4))
axes.legend(frameon=False)
plt.show()

# %%
# E/E0 is the energy divided by the least energy for this angular momentum (rotation about the short axis), and k² is the parameter of the elliptic functions. Pravec et al. found E/E0 = 1.024 ± 0.013.

print(f"E/E0 = {motion.energy_ratio:.4f}, k² = {motion.elliptic_parameter:.3f}")
print(f"σ/σ_sep = {motion.plan.separatrix_ratio:.3f}")
assert round(motion.energy_ratio, 5) == 1.02364 and round(motion.elliptic_parameter, 3) == 0.638

# %%
# At σ/σ_sep = 0.57 each order of the series multiplies the error by 0.57, so order 43 reaches 1e-12 rad. The dashed line is the closed form.

axes = plot.error_by_order(scene, orders=range(0, 61, 4))
plt.show()

# %%
# Nutation, angles and rates during three turns of the polhode.

times = np.linspace(0, 3 * rotation, 2000)
figure, panels = plt.subplots(3, 1, figsize=(9, 8), layout="constrained", sharex=True)
plot.nutation(motion, times, panels[0], time_unit="s")
plot.angles(motion, times, panels[1], time_unit="s")
plot.rates(motion, times, panels[2], time_unit="s")
plt.show()
