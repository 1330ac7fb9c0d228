"""Colours and style of the pictures. The colours are those of Okabe and Ito, which colour-blind readers can distinguish."""

import math

BLUE, VERMILION, GREEN, BLACK, GREY = "#0072B2", "#D55E00", "#009E73", "#222222", "#9A9A9A"
ARCSECOND = math.pi / 648000
STYLE = {"font.size": 10, "axes.titlesize": 10.5, "axes.spines.top": False, "axes.spines.right": False, "legend.frameon": False}
DEGREES = 0.02
"""Size [deg] above which small angles are in degrees, otherwise in arcseconds."""


def angular_unit(largest: float, degrees: float = DEGREES) -> tuple[float, str]:
    """The unit of angles of a size, in rad, and its name: degrees above `degrees`."""
    return (math.pi / 180, "deg") if math.degrees(largest) > degrees else (ARCSECOND, "arcsec")
