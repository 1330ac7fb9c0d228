"""
A satellite over a month
========================

A box satellite of 1 × 1.2 × 0.6 m tumbles slowly after its release, in an orbit with the height and inclination of the space station. The oblate Earth turns the node of the orbit by five degrees a day,
and the gravity gradient follows the node. After a month the axis differs from that in a fixed orbit. The motion is integrated and written as an attitude ephemeris message. The same satellite with a faster spin
is solved by the averaged theory.
"""

import math
import tempfile
import time
from pathlib import Path
from typing import Literal

import matplotlib.pyplot as plt
import numpy as np

import andoyer
from andoyer import output

# %%
# The Earth's GM, J2 and radius are those of EGM2008. The orbit has the secular rates of first order in J2.

DAY = 86400.0
earth = {"j2": 1.08262668e-3, "radius": 6378136.3}
semi_major_axis, inclination = 6378136.3 + 420e3, math.radians(51.6)
orbit = andoyer.Orbit.around_oblate(3.986004415e14, semi_major_axis, 0.001, inclination, **earth)
print(f"node {math.degrees(orbit.node_rate) * DAY:.3f} °/day, pericentre {math.degrees(orbit.pericentre_rate) * DAY:.3f} °/day")
assert abs(math.degrees(orbit.node_rate) * DAY + 4.95) < 0.01

# %%
# The satellite rotates by half a degree a second about its shortest side. The torque is then too strong for the averaged theory to meet the tolerance, so the motion is integrated. The plan states the reason.

box = andoyer.Body.box(1.0, 1.2, 0.6, mass=100.0)
spin = math.radians(0.5)
state = ([0, 0, 0, 1], [0.02 * spin, 0.0, spin])
month = (0.0, 30 * DAY)
motion = andoyer.Scene(box, *state, orbit=orbit, span=month, tolerance=1e-6, name="box satellite").solve()
print(motion.plan)
assert motion.plan.method == "integrated" and motion.plan.meets_tolerance

# %%
# The same satellite in a fixed orbit. The angle between the two angular momenta is 6° after a day and exceeds 90° within the month.

still = andoyer.Orbit(orbit.mean_motion, orbit.eccentricity, inclination=inclination, attraction=orbit.attraction)
fixed = andoyer.Scene(box, *state, orbit=still, span=month, tolerance=1e-6, method="integrated").solve()
times = np.linspace(*month, 3000)
poles = [momentum / np.linalg.norm(momentum, axis=1, keepdims=True) for momentum in (motion.angular_momentum(times), fixed.angular_momentum(times))]
apart = np.degrees(np.arctan2(np.linalg.norm(np.cross(*poles), axis=1), np.sum(poles[0] * poles[1], axis=1)))
print(f"after a day {apart[100]:.2f}°, after a week {apart[700]:.1f}°, the most in the month {apart.max():.0f}°")
assert 5 < apart[100] < 7 and apart.max() > 90

figure, axes = plt.subplots(figsize=(9, 4), layout="constrained")
axes.plot(times / DAY, apart, color="#0072B2")
axes.set(xlabel="days", ylabel="between the two angular momenta [°]")
plt.show()

# %%
# An integration at a smaller tolerance has other steps and another order. It agrees within the error bounds of both.

tighter = andoyer.Scene(box, *state, orbit=orbit, span=month, tolerance=1e-8, method="integrated").solve()
difference = (motion.rotation(times[-1]).inv() * tighter.rotation(times[-1])).magnitude()
print(f"orders {motion.plan.order} and {tighter.plan.order}, {difference:.1e} rad apart after the month")
assert difference < motion.plan.error_bound + tighter.plan.error_bound

# %%
# A satellite at 500 km that rotates by six degrees a second: the averaged theory of first order against the integration, in a day and in a week. The fixed orbit has no rate of the node.

semi_major_axis = 6378136.3 + 500e3
orbit = andoyer.Orbit.around_oblate(3.986004415e14, semi_major_axis, 0.001, inclination, **earth)
still = andoyer.Orbit(orbit.mean_motion, orbit.eccentricity, inclination=inclination, attraction=orbit.attraction)
print(f"node {math.degrees(orbit.node_rate) * DAY:.3f} °/day")
fast = ([0, 0, 0, 1], [0.02 * 12 * spin, 0.0, 12 * spin])
runs: list[tuple[Literal["closed", "integrated"], andoyer.Orbit]] = [("closed", orbit), ("integrated", orbit), ("closed", still)]
print("days  attitude error  error bound  pole error  pole in a fixed orbit  theory [s]  integration [s]")
for days in (1, 7):
    times = np.linspace(0, days * DAY, 1000)
    attitudes, poles, seconds, bounds = [], [], [], []
    for name, disturbing in runs:
        clock = time.perf_counter()
        solved = andoyer.Scene(box, *fast, orbit=disturbing, span=(0, days * DAY), tolerance=1e-2 if name == "closed" else 1e-7, method=name).solve()
        solved.attitude(times)
        seconds.append(time.perf_counter() - clock)
        attitudes.append(solved.rotation(times))
        momentum = solved.angular_momentum(times)
        poles.append(momentum / np.linalg.norm(momentum, axis=1, keepdims=True))
        bounds.append(solved.plan.error_bound)
    error = (attitudes[0].inv() * attitudes[1]).magnitude().max()
    of_pole, of_fixed = (np.linalg.norm(poles[k] - poles[1], axis=1).max() for k in (0, 2))
    fixed_angle = math.degrees(2 * math.asin(of_fixed / 2))
    print(f"{days:4d}  {error:14.1e}  {bounds[0]:11.1e}  {of_pole:10.1e}  {fixed_angle:20.2f}°  {seconds[0]:10.3f}  {seconds[1]:15.2f}")
    assert error < bounds[0]
month_by_theory = andoyer.Scene(box, *fast, orbit=orbit, span=month, tolerance=1e-2).solve()
print(f"a month: {month_by_theory.plan.method}, error bound {month_by_theory.plan.error_bound:.1e} rad")

# %%
# The last hour of the slow satellite is written as a message of the CCSDS, which mission software can read.

with tempfile.TemporaryDirectory() as folder:
    path = Path(folder) / "box.aem"
    samples = motion.at(np.arange(month[1] - 3600, month[1] + 1, 60.0))
    output.write_aem(path, samples, output.Heading(name="BOX", frame="EME2000", center="EARTH"))
    print("\n".join(path.read_text().splitlines()[:24]))
