"""Values of other packages: times and quantities of astropy, arrays and frames of pandas and xarray, expressions of SymPy, integrations by SciPy; orbit messages of the CCSDS.

`read_oem` reads an orbit ephemeris message.
"""

from typing import TYPE_CHECKING as _TYPE_CHECKING

__all__ = ["read_oem"]

if _TYPE_CHECKING:
    from andoyer.interop._oem import read_oem
else:

    def __getattr__(name: str) -> object:
        """`read_oem` is imported when it is first used: it needs the parsers of `andoyer.output`, which `import andoyer` does not load."""
        if name != "read_oem":
            raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
        from andoyer.interop._oem import read_oem

        return read_oem
