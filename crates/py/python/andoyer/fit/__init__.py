"""States from data: `attitudes` fits measured attitudes, `light_curve` brightnesses of an ellipsoid. Both return a `Fit`.

Needs SciPy: the extra ``andoyer[fit]``; pictures need matplotlib.
"""

from andoyer.fit._attitudes import attitudes
from andoyer.fit._light_curve import light_curve
from andoyer.fit._result import Fit, Optimum
from andoyer.fit._scattering import brightness

__all__ = ["Fit", "Optimum", "attitudes", "brightness", "light_curve"]
