"""
Relaxation of a tumbler and its age
===================================

Toutatis tumbles in its long-axis mode, and inner friction takes longer than the age of the solar system to end this.
"""

import matplotlib.pyplot as plt
import numpy as np

import andoyer

# %%
# The state comes from the two periods of the radar observations. The body is a homogeneous ellipsoid with the published ratios of moments, of a rock with a product of
# rigidity and quality factor of 5e11 Pa. Units are kg, m and s.

GYR = 3.15576e16
body = andoyer.Body.named("toutatis")
scene = andoyer.Scene.from_periods(body, 7.40 * 86400, 5.38 * 86400, mode="long-axis")
rock = andoyer.Material(density=2100.0, rigidity=5e9, quality=100.0)
dissipation = andoyer.Dissipation(body, 1225.0, rock)
relaxation = dissipation.relax(scene)
print(relaxation, f"{dissipation.age(scene, 0.1) / GYR:.0f} Gyr since an angle of 0.1 rad from the long axis")
print(f"{relaxation.time_to(np.pi / 2) / GYR:.0f} Gyr to the separatrix, {relaxation.time_to(0.05) / GYR:.0f} Gyr to an angle of 0.05 rad from the short axis")

# %%
# The energy falls at constant angular momentum, from C/A to 1 in units of that of rotation about the short axis. The angle is the largest one on the polhode, from the long
# axis before the separatrix and from the short axis after it. The power is smallest at the ends, and 0 on the separatrix.

times = np.linspace(-40, 200, 2400) * GYR
states = relaxation.at(times)
figure, (angles, energies, powers) = plt.subplots(3, 1, sharex=True, figsize=(7, 7), layout="constrained")
for mode in ("long-axis", "short-axis"):
    part = states.mode == mode
    angles.plot(times[part] / GYR, np.degrees(states.angle[part]), label=f"from the {mode[:-5]} axis")
    energies.plot(times[part] / GYR, states.energy_ratio[part])
    powers.semilogy(times[part] / GYR, states.power[part])
for axes in (angles, energies, powers):
    axes.axvline(0, color="0.6", linewidth=0.8)
angles.set_ylabel("largest angle [deg]")
angles.legend(fontsize="small")
energies.set_ylabel("energy / least energy")
powers.set_ylabel("power [W]")
powers.set_xlabel("time from now [Gyr]")

# %%
# The reverse: which product of rigidity and quality factor, or which viscosity, lets the state be as old as the solar system. An age is proportional to either. The weaker the
# wobble at the start, the longer the way to the present state, and the softer the material must be.

starts = np.radians(np.linspace(0.5, 45, 60))
products = [5e9 * dissipation.quality_from_age(scene, 4.5 * GYR, start) for start in starts]
viscosities = [dissipation.viscosity_from_age(scene, 4.5 * GYR, start) for start in starts]
figure, axes = plt.subplots(figsize=(7, 3.5), layout="constrained")
axes.semilogy(np.degrees(starts), products, label="rigidity × quality factor [Pa]")
axes.semilogy(np.degrees(starts), viscosities, label="viscosity [Pa s]")
axes.set_xlabel("angle from the long axis 4.5 Gyr ago [deg]")
axes.legend(fontsize="small")
print(f"rigidity × quality factor from {min(products):.1e} to {max(products):.1e} Pa")
plt.show()
