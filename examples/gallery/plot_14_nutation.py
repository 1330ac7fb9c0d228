"""
The Earth under Sun and Moon: precession and nutation
=====================================================

This example computes the rotation of a rigid Earth for 37.2 years, two revolutions of the lunar node, by the averaged theory and by an integration of the full equations. The Sun and the Moon are on ellipses with
secular rates. The motion of the figure axis is then decomposed into terms with the arguments of REN-2000, the nutation of the rigid Earth by Souchay, Loysel, Kinoshita and Folgueira (1999).
"""

import csv
import sys
import time
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
from numpy.typing import NDArray

import andoyer

DAY, CENTURY = 86400.0, 36525 * 86400.0
ARCSECOND = np.pi / 648000
DATA = Path(sys.argv[0]).resolve().parents[2] / "tests/data/ren2000_main_terms.csv"

# %%
# The fundamental arguments of the IERS Conventions (2010), section 5.7.2: values at J2000 [°] and rates ["/century]. Ω is the longitude of the lunar node, and F − D + Ω is the longitude of the
# Sun, both from the moving equinox. In an inertial frame both rates are smaller by the general precession of 5028.77 "/century.

ARGUMENTS = {
    "l": (134.96340251, 1717915923.2178),
    "l'": (357.52910918, 129596581.0481),
    "F": (93.27209062, 1739527262.8478),
    "D": (297.85019547, 1602961601.2090),
    "Ω": (125.04455501, -6962890.5431),
}
values = np.array([[np.radians(value), rate * ARCSECOND / CENTURY] for value, rate in ARGUMENTS.values()])
anomaly, sun_anomaly, latitude, elongation, node = values
precession = np.array([0.0, 5028.77 * ARCSECOND / CENTURY])


Angle = NDArray[np.float64]  # value at J2000 and rate


def orbit(gm: float, axis: float, eccentricity: float, inclination: float, anomaly: Angle, node: Angle, pericentre: Angle) -> andoyer.Orbit:
    """An orbit from its angles at J2000 and their rates. Node and pericentre are converted to the time of pericentre."""
    start = -anomaly[0] / anomaly[1]
    node_at, pericentre_at = ((angle + rate * start) % (2 * np.pi) for angle, rate in (node, pericentre))
    return andoyer.Orbit(
        anomaly[1],
        eccentricity,
        time_of_pericentre=start,
        inclination=np.radians(inclination),
        node=node_at,
        argument_of_pericentre=pericentre_at,
        node_rate=node[1],
        pericentre_rate=pericentre[1],
        attraction=gm / axis**3,
    )


moon = orbit(4902.800066, 384399.0, 0.0549006, 5.1453964, anomaly, node - precession, latitude - anomaly)
sun_longitude = latitude - elongation + node - precession
sun = orbit(1.32712440018e11, 149598023.0, 0.0167086, 0.0, sun_anomaly, np.zeros(2), sun_longitude - sun_anomaly)

# %%
# The Earth has the dynamical ellipticity of REN-2000, (C − A)/C = 0.0032737548, and A = B. At J2000 its figure axis has the obliquity 84381.448", and the Earth rotates about this axis.

earth = andoyer.Body([1 - 0.0032737548, 1 - 0.0032737548, 1.0])
half = 84381.448 * ARCSECOND / 2
span = 37.2 * 365.25 * DAY
state = ([-np.sin(half), 0.0, 0.0, np.cos(half)], [0.0, 0.0, 7.2921151467e-5])
times = np.arange(0, span, DAY / 4)


def solved(**options: Any) -> tuple[andoyer.Motion, NDArray[np.float64]]:
    """The motion, and the figure axis at the times."""
    clock = time.perf_counter()
    motion = andoyer.Scene(earth, *state, orbit=[moon, sun], span=(0, span), **options).solve()
    motion.attitude(times)
    print(f"{motion.plan}\n{time.perf_counter() - clock:.2f} s with {len(times)} attitudes\n")
    assert motion.plan.meets_tolerance
    return motion, motion.rotation(times).as_matrix()[:, :, 2]


# %%
# At a tolerance of 1e-7 rad the averaged theory of first order is enough. The integration has a tolerance of 1e-10 rad.

averaged, axis = solved(tolerance=1e-7)
integrated, integrated_axis = solved(tolerance=1e-10, method="integrated")
assert averaged.plan.method == "closed"
between = np.linalg.norm(axis - integrated_axis, axis=1).max()
print(f"largest angle between the two figure axes: {between:.1e} rad")
assert between < averaged.plan.error_bound + integrated.plan.error_bound

# %%
# The figure axis in the frame of the ecliptic of J2000: ψ is the angle of its retrograde motion along the ecliptic, and ε its angle from the pole of the ecliptic.


def angles_of(axis: NDArray[np.float64]) -> NDArray[np.float64]:
    """ψ and ε in arcseconds."""
    psi = np.unwrap(np.arctan2(axis[:, 0], axis[:, 1]))
    return np.array([psi, np.arctan2(np.hypot(axis[:, 0], axis[:, 1]), axis[:, 2])]) / ARCSECOND


psi, epsilon = angles_of(axis)

# %%
# The fit by least squares has a cubic polynomial, the free wobble of the initial state, and the terms of the table whose frequencies differ by at least one cycle in the span.

with DATA.open(encoding="utf-8", newline="") as file:
    table = list(csv.DictReader(line for line in file if not line.startswith("#")))
multiples = np.array([[int(row[name]) for name in ("l", "lp", "F", "D", "Om")] for row in table])
published = np.array([[float(row["dpsi_sin_uas"]), float(row["deps_cos_uas"])] for row in table]) * 1e-6
phases, rates = multiples @ values[:, 0], multiples @ values[:, 1]
periods = np.array([float(row["period_days"]) for row in table])
short = periods < 1e4  # longer periods are small differences of rates
assert np.allclose(2 * np.pi / abs(rates[short]) / DAY, periods[short], rtol=2e-5)  # the arguments are those of the table
kept: list[int] = []
for index in np.argsort(-abs(published[:, 0])):
    apart = [min(abs(rates[index] - rates[other]), abs(rates[index] + rates[other])) for other in kept]
    if abs(rates[index]) * span > 2 * np.pi and min(apart, default=np.inf) * span > 0.9 * 2 * np.pi:
        kept.append(index)
angles = phases[kept, None] + rates[kept, None] * times
wobble = 7.2921151467e-5 / earth.moments[0] * times
x = times / span - 0.5
columns = np.array([np.ones_like(x), x, x**2, x**3, np.sin(wobble), np.cos(wobble), *np.sin(angles), *np.cos(angles)]).T
both = np.linalg.lstsq(columns, np.vstack([psi, epsilon, angles_of(integrated_axis)]).T, rcond=None)[0].T
of_psi, of_epsilon, *of_integrated = both
found, by_integration = (np.array([one[6 : 6 + len(kept)], other[6 + len(kept) :]]).T for one, other in (both[:2], of_integrated))

# %%
# Amplitudes in longitude (sine) and obliquity (cosine) for the terms that two precessing ellipses produce. The ellipse of the Moon does not include evection and variation, which are perturbations by the Sun. They change
# the terms with l by half a per cent, the term −l + 2F + 2Ω by two per cent, and the solar terms by 0.2 %. They also produce the terms of the table that are not shown here.

NAMED = {
    "Ω": (0, 0, 0, 0, -1), "2Ω": (0, 0, 0, 0, -2), "2F+2Ω": (0, 0, 2, 0, 2), "2F+Ω": (0, 0, 2, 0, 1), "l": (1, 0, 0, 0, 0),
    "l+Ω": (1, 0, 0, 0, 1), "l−Ω": (1, 0, 0, 0, -1), "l+2F+2Ω": (1, 0, 2, 0, 2), "−l+2F+2Ω": (-1, 0, 2, 0, 2),
}  # fmt: skip
print('term          period [d]   ψ sine ["]  table ["]   ratio    ε cosine ["]  table ["]   ratio')
ratios = {}
for name, wanted in NAMED.items():
    place = next(place for place, index in enumerate(kept) if tuple(multiples[index]) == wanted)
    (sine, cosine), (by_sine, by_cosine) = found[place], published[kept[place]]
    ratios[name] = sine / by_sine
    period = float(table[kept[place]]["period_days"])
    print(f"{name:12s} {period:10.3f} {sine:12.6f} {by_sine:12.6f} {sine / by_sine:8.4f} {cosine:12.6f} {by_cosine:12.6f} {cosine / by_cosine:8.4f}")
for name, bound in {"Ω": 5e-4, "2Ω": 1e-3, "2F+2Ω": 6e-4, "2F+Ω": 8e-4, "l": 6e-3, "l+2F+2Ω": 6e-3}.items():
    assert abs(ratios[name] - 1) < bound, (name, ratios[name])

# %%
# The amplitudes and the precession of the theory are those of the integration.

largest = np.abs(by_integration[:, 0]) > 1e-3
difference = np.abs(found[largest] / by_integration[largest] - 1).max()
slower = abs(of_psi[1] / of_integrated[0][1] - 1)
print(f'theory against integration: amplitudes above 0.001" in longitude agree within {difference:.1e} of each, the precession within {slower:.1e}')
assert difference < 1e-3 and slower < 1e-4

# %%
# The luni-solar precession is the rate of ψ. The first-order theory, averaged over both orbits, gives (3/2) H cos ε/ω times the sum of the attractions, each divided by η³; the attraction of the Moon is also multiplied by
# 1 − (3/2) sin² i (theory, section 9).

slope = of_psi[1] / span * CENTURY
eta = [np.sqrt(1 - body.eccentricity**2) ** -3 * body.attraction for body in (moon, sun)]
by_formula = 1.5 * 0.0032737548 * np.cos(2 * half) / 7.2921151467e-5 * (eta[0] * (1 - 1.5 * np.sin(moon.inclination) ** 2) + eta[1]) * CENTURY / ARCSECOND
print(f'luni-solar precession {slope:.3f}"/century, by the averaged formula {by_formula:.3f}", ratio {slope / by_formula:.5f}')

figure, axes = plt.subplots(figsize=(7, 6), layout="constrained")
smooth = columns[:, :4]
axes.plot((psi - smooth @ of_psi[:4]) * np.sin(2 * half), epsilon - smooth @ of_epsilon[:4], linewidth=0.5, color="#0072B2")
axes.set(xlabel='sin ε Δψ ["]', ylabel='Δε ["]', aspect="equal", title="The figure axis about its mean place, 37.2 years")
plt.show()
