"""Samples and motions as files, and back: CSV, NPZ, Parquet, the attitude ephemeris message of the CCSDS, the C-kernel of SPICE.

The first argument of every writer is the path. A file is written whole or not at all; an existing file is replaced unless ``force=False``.
`write_csv`, `write_npz`, `write_parquet` and `write_aem` take `Samples`. `write_ck` takes `Samples` or a `Motion`, and `write_pck` a `Motion`, whose times they choose themselves.
`read_table`, `read_aem` and `read_pck` return samples.
"""

from andoyer.output.aem import Heading, write_aem
from andoyer.output.aem_reader import Segment, read_aem, read_aem_segments
from andoyer.output.calendar import TIME_SYSTEMS
from andoyer.output.kernels import Kernel, Written, write_ck, write_pck
from andoyer.output.orientations import read_pck
from andoyer.output.rows import COLUMNS, CONVENTION
from andoyer.output.table import Progress, Table, read_table, silent, write_csv, write_npz, write_parquet, write_table

__all__ = [
    "COLUMNS",
    "CONVENTION",
    "TIME_SYSTEMS",
    "Heading",
    "Kernel",
    "Progress",
    "Segment",
    "Table",
    "Written",
    "read_aem",
    "read_aem_segments",
    "read_pck",
    "read_table",
    "silent",
    "write_aem",
    "write_ck",
    "write_csv",
    "write_npz",
    "write_parquet",
    "write_pck",
    "write_table",
]
