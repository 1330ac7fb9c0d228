"""
Apophis passes the Earth
========================

On 13 April 2029 Apophis passes the Earth at 38,011 km, and the gravity of the Earth changes its tumbling. By how much depends on how the body happens to lie, which is not known so many years ahead.
So 300 bodies pass here, which differ in their two phases alone.
"""

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

import andoyer

# %%
# The orbit is a hyperbola about the Earth, in the ecliptic of J2000, with the elements at the pericentre, JD 2462240.40709 TDB. Time is in hours from the pericentre. The torque is even in the direction, so the
# Earth's place and its opposite are the same.

GM = 398600.4418 * 3600.0**2  # km³ / h²
q, e = 38011.48649, 4.253901873
n = np.sqrt(GM / (q / (e - 1)) ** 3)
earth = andoyer.Orbit(
    n, e, inclination=np.radians(162.8562), node=np.radians(152.0019), argument_of_pericentre=np.radians(32.5676), semi_major_axis=q / (e - 1)
)
hours = np.array([-24.0, -2.0, 0.0])
print("distance at −24, −2 and 0 h:", np.linalg.norm(earth.position(hours), axis=1).round(), "km")


# %%
# Is the frame right? Far away the velocity of the hyperbola must be that of Apophis less that of the Earth, from their orbits about the Sun where Apophis crosses the ecliptic at its ascending node. Its
# elements are those of JPL's solution 218 (Horizons, epoch 2021-01-01); those of the Earth are rounded.


def velocity(a: float, e: float, inclination: float, node: float, argument: float, longitude: float) -> NDArray[np.float64]:
    """The velocity [km/s] on an orbit about the Sun, ecliptic components; a in au, angles in degrees, the longitude is that in the orbit."""
    i, node, argument, longitude = (float(np.radians(angle)) for angle in (inclination, node, argument, longitude))
    along, across = np.sqrt(1.32712440018e11 / (149597870.7 * a * (1 - e**2))) * np.array(
        [-np.sin(longitude) - e * np.sin(argument), np.cos(longitude) + e * np.cos(argument)]
    )
    return np.array([along * np.cos(node) - across * np.cos(i) * np.sin(node), along * np.sin(node) + across * np.cos(i) * np.cos(node), across * np.sin(i)])


def described(name: str, vector: NDArray[np.float64]) -> None:
    """Print size and direction."""
    longitude, latitude = np.degrees([np.arctan2(vector[1], vector[0]), np.arcsin(vector[2] / np.linalg.norm(vector))])
    print(f"{name}: {np.linalg.norm(vector):.2f} km/s along longitude {longitude:.1f}°, latitude {latitude:.1f}°")


NODE = 204.0389
heliocentric = velocity(0.9225072, 0.1915217, 3.336751, NODE, 126.6521, 0) - velocity(1.0, 0.0167, 0, 0, 102.94, NODE)
described("from the orbits about the Sun", heliocentric)
before, now = earth.position([-10000.0, -9999.0])
described("from the hyperbola", (now - before) / 3600)
assert np.linalg.norm((now - before) / 3600 - heliocentric) < 0.03

# %%
# Periods and pole are those of Pravec et al. (2014) and Lee et al. (2022). The integration goes from two days before the pericentre to two days after it; the torque falls with the cube of the distance.

apophis = andoyer.Body.named("apophis")
span = (-48.0, 48.0)
phases = np.random.default_rng(2029).uniform(0, 1, (300, 2))
pole = np.radians([275, -85])
starts = [andoyer.Scene.from_periods(apophis, 27.38, 263.0, momentum_direction=pole, phases=tuple(phase), epoch=span[0]) for phase in phases]
ensemble = andoyer.Ensemble(
    apophis.moments, [start.attitude for start in starts], [start.angular_velocity for start in starts], epochs=span[0], orbits=earth, tolerance=1e-8, span=span
)
print("largest error bound:", f"{max(plan.error_bound for plan in ensemble.plans):.0e} rad")
after = ensemble.at(span[1])

# %%
# After the passage each body tumbles freely again, with other periods. Some change to the other mode: the long axis then precesses, and the body makes full turns about it.

free = [andoyer.Scene(apophis, *state, epoch=span[1]).solve() for state in zip(after.attitude, after.angular_velocity, strict=True)]
periods = np.array([list(motion.periods["long-axis"]) for motion in free])
ratios = np.array([motion.energy_ratio for motion in free])
modes = np.array([motion.plan.mode for motion in free])
print(f"P_φ of the long axis: {np.quantile(periods[:, 0], [0.05, 0.5, 0.95]).round(2)} h, before 30.56 h")
print(f"E/E0: {np.quantile(ratios, [0.05, 0.5, 0.95]).round(4)}, before {starts[0].solve().energy_ratio:.4f}")
print({str(mode): int((modes == mode).sum()) for mode in np.unique(modes)})

figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
left.hist(periods[:, 0], bins=30, color="#0072B2")
left.axvline(30.56, color="#D55E00", linestyle="--", label="before")
left.set(xlabel="period of the long axis' precession [h]", ylabel="bodies")
left.legend(frameon=False)
turns = [np.degrees(np.arccos(np.clip(np.dot(a, b) / np.linalg.norm(a) / np.linalg.norm(b), -1, 1))) for a, b in
         ((start.solve().angular_momentum(span[0]), motion.angular_momentum(span[1])) for start, motion in zip(starts, free, strict=True))]  # fmt: skip
right.scatter(turns, ratios, s=8, color="#0072B2")
right.axhline(starts[0].solve().energy_ratio, color="#D55E00", linestyle="--")
right.set(xlabel="turn of the angular momentum [°]", ylabel="E/E0 after the passage")
plt.show()

# %%
# The angular momentum of the first body: nearly all of the change falls into three hours, a ninth of a turn.

one = ensemble[0]
times = np.linspace(-12, 12, 600)
figure, axes = plt.subplots(figsize=(9, 3.4), layout="constrained")
axes.plot(times, np.linalg.norm(one.angular_momentum(times), axis=1) / np.linalg.norm(one.angular_momentum(span[0])), color="#0072B2")
axes.set(xlabel="hours from the pericentre", ylabel="angular momentum, before = 1")
plt.show()
