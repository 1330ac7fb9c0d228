"""
Eros near its separatrix
========================

Eros is so elongated that its separatrix passes 3.9 degrees from its short axis. This example compares the series with the closed form for hypothetical states on both sides of the
separatrix: the order that the series need, the place where they stop, and the error bound of the closed form.
"""

import math
from typing import Literal

import matplotlib.pyplot as plt

import andoyer
from andoyer import plot

# %%
# The angular momentum is tilted from the short axis towards the long axis. In this direction the separatrix is nearest.

eros = andoyer.Body.named("eros")
moments = eros.moments


def tilted(degrees: float, method: Literal["auto", "series"] = "auto") -> andoyer.Motion:
    """Eros with its angular momentum tilted by this angle from axis 3 towards axis 1."""
    angle = math.radians(degrees)
    rates = [math.sin(angle) / moments[0], 0.0, math.cos(angle) / moments[2]]
    return andoyer.Scene(eros, [0, 0, 0, 1], rates, method=method, name=f"{degrees} degrees off").solve()


# %%
# The order of the series grows towards the separatrix. Close to the separatrix no order up to 60 is sufficient, and the error says so.

for degrees in [0.1, 1.0, 2.0, 3.0, 3.8]:
    closed = tilted(degrees)
    try:
        order = str(tilted(degrees, "series").plan.order)
    except andoyer.TheoryError as error:
        order = f"none, {error}"
    plan = closed.plan
    ratio, bound = plan.separatrix_ratio, plan.error_bound
    print(f"{degrees} degrees: {plan.mode}, σ/σ_sep {ratio:.3f}, bound {bound:.0e} rad")
    print(f"    order of the series: {order}")

# %%
# The two tilts are just inside and just outside the separatrix. The body is the same, but the motions are of different modes.

inside, outside = tilted(3.8), tilted(5.0)
print(inside.plan.mode, outside.plan.mode)
assert (inside.plan.mode, outside.plan.mode) == ("short-axis", "long-axis")
figure, panels = plt.subplots(1, 2, figsize=(11, 5), layout="constrained")
for motion, axes in zip((inside, outside), panels):
    plot.polhode(motion, axes)
    axes.set_title(motion.scene.name)
plt.show()

# %%
# The phase portrait shows that the region of the short-axis mode is thin.

plot.phase_portrait(inside)
plt.show()
