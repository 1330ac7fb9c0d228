"""
Apophis passes the Earth
========================

On 13 April 2029 Apophis passes the Earth at 38,011 km, and the gravity of the Earth changes its tumbling. By how much depends on how the body happens to lie, which is not known so many years ahead.
So 2,000 clones pass here, drawn from the published periods and pole with their errors, and with all phases.
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
# Moments, periods and pole with their errors are those of the model of Brozović et al. (2018) in NASA's Planetary Data System (DOI 10.26033/ydyq-5756). The integration goes from ten days before the pericentre to ten
# days after it; the torque falls with the cube of the distance. Draws that no body can have are NaN and counted.

random, clones = np.random.default_rng(2029), 2000
apophis = andoyer.Body([0.729, 0.947, 1.0])
span = (-240.0, 240.0)
pole = np.radians([246.8, -59.3] + [14, 7] * random.normal(size=(clones, 2)))
ensemble = andoyer.Ensemble.from_periods(
    apophis,
    27.45 + 0.07 * random.normal(size=clones),
    265.7 + 6 * random.normal(size=clones),
    "short-axis",
    pole,
    phases=random.uniform(size=(clones, 2)),
    epoch=span[0],
    orbit=earth,
    span=span,
    tolerance=1e-8,
    errors="nan",
)
before, after = (ensemble.after(time) for time in span)
print("draws that no body can have:", len(before.errors))

# %%
# After the passage each body tumbles freely again, with other periods. Most keep the short-axis mode, as Ďurech et al. (2026, arXiv:2604.24566) expect; in the others the long axis makes full turns. The spin changes by up to a factor of
# one and a half to either side, and the direction of the angular momentum by ten degrees or more for half of the clones.

known = np.isfinite(after.energy_ratio)
momenta = [state.angular_momentum[known] for state in (before, after)]
sizes = [np.linalg.norm(vectors, axis=1) for vectors in momenta]
turns = np.degrees(np.arccos(np.clip(np.sum(momenta[0] * momenta[1], axis=1) / sizes[0] / sizes[1], -1, 1)))
periods = [state.periods["long-axis"].precession[known] for state in (before, after)]
print({mode: f"{share:.1%}" for mode, share in after.share().items()})
print(f"P_φ of the long axis, after over before: {np.quantile(periods[1] / periods[0], [0, 0.05, 0.5, 0.95, 1]).round(2)}")
print(f"turn of the angular momentum [°]: {np.quantile(turns, [0.05, 0.5, 0.95]).round(1)}; ten or more: {(turns >= 10).mean():.0%}")

figure, (left, right) = plt.subplots(1, 2, figsize=(9, 4), layout="constrained")
left.hist(periods[1], bins=40, color="#0072B2", label="after")
left.axvspan(*np.quantile(periods[0], [0.05, 0.95]), color="#D55E00", label="before, 5 to 95 %")
left.set(xlabel="period of the long axis' precession [h]", ylabel="clones")
left.legend(frameon=False)
for mode, colour in [("short-axis", "#0072B2"), ("long-axis", "#D55E00")]:
    here = after.mode[known] == mode
    right.scatter(turns[here], after.energy_ratio[known][here], s=5, color=colour, label=f"{mode} mode")
right.set(xlabel="turn of the angular momentum [°]", ylabel="E/E0 after the passage")
right.legend(frameon=False)
plt.show()

# %%
# The angular momentum of the first clones: nearly all of the change falls into some hours.

times = np.linspace(-12, 12, 600)
figure, axes = plt.subplots(figsize=(9, 3.4), layout="constrained")
size = np.linalg.norm(ensemble[:20].angular_momentum(times), axis=2)
axes.plot(times, (size / np.linalg.norm(before.angular_momentum[:20], axis=1)[:, None]).T, color="#0072B2", alpha=0.6)
axes.set(xlabel="hours from the pericentre", ylabel="angular momentum, before = 1")
plt.show()
