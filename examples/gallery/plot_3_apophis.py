"""
Apophis, and where the series end
=================================

Apophis tumbles: its long axis precesses in 27.38 hours and the body rolls about it in 263 (Pravec et al. 2014). From the state come the periods of both
conventions, the strongest line of the light curve, and a plan; from the series an error at each order, up to where they end.
"""

import andoyer
import matplotlib.pyplot as plt
import numpy as np
from andoyer import plot

# %%
# The state solves the two periods for the moments of the catalogue; frame: ecliptic, phases chosen. Time in seconds.

apophis = andoyer.Body.named("apophis")
attitude = [-0.9684470110523898, 0.18484619592060467, 0.12628171830822016, -0.10952259245697712]
rates = [2.1711456174137208e-05, 0.0, 6.126197961316196e-05]
scene = andoyer.Scene(apophis, attitude, rates, tolerance=1e-8, name="Apophis, tumbling")
motion = scene.solve()
print(motion.plan)

# %%
# Light curves are described by the long axis, the theory by the short one. The strongest line is at 1/P_φ − 1/P_ψ of the first, which is 1/P_φ of neither.

HOUR = 3600.0
for convention, (precession, rotation) in motion.periods.items():
    print(f"{convention:10}  P_φ {precession / HOUR:.2f} h   P_ψ {rotation / HOUR:.1f} h")
precession, rotation = motion.periods["long-axis"]
line = 1 / (1 / precession - 1 / rotation)
print(f"strongest line of the light curve: {line / HOUR:.2f} h")
assert [round(time / HOUR, 2) for time in (precession, rotation, line)] == [27.38, 263.0, 30.56]

# %%
# Energy over that of the slowest rotation with this momentum, and the parameter of the elliptic functions. Pravec et al. have E/E0 = 1.024 ± 0.013.

print(f"E/E0 = {motion.energy_ratio:.4f}, k² = {motion.elliptic_parameter:.3f}")
print(f"σ/σ_sep = {motion.plan.separatrix_ratio:.3f}")
assert round(motion.energy_ratio, 4) == 1.0285 and round(motion.elliptic_parameter, 3) == 0.777

# %%
# At σ/σ_sep = 0.71 each order of the series gains a factor 0.71, and order 60 leaves some 1e-10 rad: that is where they end. The closed form,
# the dashed line, does not know the difference.

axes = plot.error_by_order(scene, orders=range(0, 61, 4))
plt.show()

# %%
# Three turns of the polhode.

times = np.linspace(0, 3 * rotation, 2000)
figure, panels = plt.subplots(3, 1, figsize=(9, 8), layout="constrained", sharex=True)
plot.nutation(motion, times, panels[0])
plot.angles(motion, times, panels[1])
plot.rates(motion, times, panels[2])
plt.show()
