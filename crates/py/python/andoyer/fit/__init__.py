"""Fits of states to data: `attitudes` fits measured attitudes, and `light_curve` fits brightnesses of an ellipsoid. Both return a `Fit`. `clones` draws states from published values.

The module needs SciPy, which ``pip install scipy`` installs; facets need threadpoolctl too, and pictures matplotlib. ``pip install andoyer[fit]`` installs the first two.
"""

from andoyer.fit._attitudes import attitudes
from andoyer.fit._clones import clones
from andoyer.fit._facets import FacetAreas
from andoyer.fit._light_curve import light_curve
from andoyer.fit._magnitudes import ZeroPoints
from andoyer.fit._optimum import Alias, Optimum
from andoyer.fit._result import Draws, Fit
from andoyer.fit._scattering import brightness
from andoyer.fit._verdict import SimpleRotation, Verdict

__all__ = ["Alias", "Draws", "FacetAreas", "Fit", "Optimum", "SimpleRotation", "Verdict", "ZeroPoints", "attitudes", "brightness", "clones", "light_curve"]
