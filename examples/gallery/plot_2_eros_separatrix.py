"""
Eros near its separatrix
========================

Eros is so long that the separatrix begins 3.9 degrees from its short axis. Hypothetical states on both sides of it: what the series need, where they
stop, and what the closed form does there.
"""

import math
from typing import Literal

import andoyer
import matplotlib.pyplot as plt
from andoyer import plot

# %%
# States with the momentum tilted from the short axis towards the long one: the shortest way to the separatrix.

eros = andoyer.Body.named("eros")
moments = eros.moments


def tilted(degrees: float, method: Literal["auto", "series"] = "auto") -> andoyer.Motion:
    """Eros with its angular momentum so far from axis 3 towards axis 1."""
    angle = math.radians(degrees)
    rates = [math.sin(angle) / moments[0], 0.0, math.cos(angle) / moments[2]]
    return andoyer.Scene(eros, [0, 0, 0, 1], rates, method=method, name=f"{degrees} degrees off").solve()


# %%
# The order of the series grows towards the separatrix; then there is none, and the error says so.

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
# Just inside and just outside: the same body, two kinds of motion.

inside, outside = tilted(3.8), tilted(5.0)
print(inside.plan.mode, outside.plan.mode)
assert (inside.plan.mode, outside.plan.mode) == ("short-axis", "long-axis")
figure, panels = plt.subplots(1, 2, figsize=(11, 5), layout="constrained")
for motion, axes in zip((inside, outside), panels):
    plot.polhode(motion, axes)
    axes.set_title(motion.scene.name)
plt.show()

# %%
# The phase portrait shows how thin the region of the short-axis mode is.

plot.phase_portrait(inside)
plt.show()
