"""
Your own normal form
====================

`normalize` finds the normal form of any Hamiltonian near an elliptic equilibrium. This example computes the frequency of a pendulum as a function of its amplitude, for several orders.
"""

import math

import matplotlib.pyplot as plt
import numpy as np

import andoyer

# %%
# H = p²/2 − cos q is written as a Taylor polynomial of degree 14 with exact rational coefficients.

terms = [f"{'+' if k % 2 else '-'} q^{2 * k}/{math.factorial(2 * k)}" for k in range(2, 8)]
pendulum = " ".join(["(p^2 + q^2)/2", *terms])
print(pendulum)
form = andoyer.normalize(pendulum, 12, variables=[("q", "p")])
print(form)

# %%
# The frequency is the derivative of K with respect to the action. The true frequency follows from the arithmetic-geometric mean. A state that the transformation there and back misses by
# more than 1 % is a `TheoryError`: the curve of each order ends there.


def true_frequency(amplitude: float) -> float:
    """The frequency of a pendulum with `amplitude` [rad]: the arithmetic-geometric mean of 1 and cos(amplitude/2)."""
    x, y = 1.0, math.cos(amplitude / 2)
    for _ in range(6):
        x, y = (x + y) / 2, math.sqrt(x * y)
    return x


amplitudes = np.linspace(0.05, 2.5, 50)
true = np.array([true_frequency(amplitude) for amplitude in amplitudes])
figure, axes = plt.subplots(figsize=(8, 5), layout="constrained")
for order, style in zip([2, 4, 8, 12], [":", "-.", "--", "-"]):
    form = andoyer.normalize(pendulum, order, variables=[("q", "p")])
    found = []
    for amplitude in amplitudes:
        try:
            found.append(form.frequency_map(form.actions([amplitude, 0.0]))[0])
        except andoyer.TheoryError:
            break
    error = np.maximum(np.abs(found / true[: len(found)] - 1), 1e-16)
    axes.semilogy(amplitudes[: len(found)], error, style, label=f"order {order}")
axes.set(xlabel="amplitude [rad]", ylabel="relative error of the frequency")
axes.set_title("The pendulum's normal form, by order")
axes.legend(frameon=False)
plt.show()

# %%
# `to_code` writes C for other programs: here the normal form of the rigid body. `docs/normalize.md` shows it for your own Hamiltonian.

print(andoyer.NormalForm(4).to_code("c", beta=0.5)[:600])
