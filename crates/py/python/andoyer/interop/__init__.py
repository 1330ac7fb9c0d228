"""Values of other packages: times and quantities of astropy, arrays and frames of pandas and xarray, expressions of SymPy, integrations by SciPy; and their files.

`read_oem` reads an orbit ephemeris message of the CCSDS. `read_alcdef` and `read_damit` read photometry. `read_shape` and `write_shape` read and write the spin state of a SHAPE model.
"""

from importlib import import_module as _import_module
from typing import TYPE_CHECKING as _TYPE_CHECKING

if _TYPE_CHECKING:
    from andoyer.interop._oem import read_oem
    from andoyer.interop._photometry import LightCurves, read_alcdef, read_damit
    from andoyer.interop._shape import read_shape, write_shape

_HOMES = {
    "LightCurves": "_photometry",
    "read_alcdef": "_photometry",
    "read_damit": "_photometry",
    "read_oem": "_oem",
    "read_shape": "_shape",
    "write_shape": "_shape",
}

__all__ = ["LightCurves", "read_alcdef", "read_damit", "read_oem", "read_shape", "write_shape"]

if not _TYPE_CHECKING:

    def __getattr__(name: str) -> object:
        """A public name is imported when it is first used: plain numbers need none of them."""
        if name in __all__:
            return getattr(_import_module(f"andoyer.interop.{_HOMES[name]}"), name)
        raise AttributeError(f"module 'andoyer.interop' has no attribute {name!r}")
