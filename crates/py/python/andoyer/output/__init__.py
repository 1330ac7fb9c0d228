"""Samples and motions as files, and back: CSV, NPZ, Parquet, the attitude ephemeris message of the CCSDS, the C-kernel of SPICE.

Every writer takes the path first and writes the file whole or not at all; a file that is there already is replaced unless ``force=False``.
`write_csv`, `write_npz`, `write_parquet` and `write_aem` take `Samples`, `write_ck` a `Motion`, since it chooses its times itself.
`read_table` and `read_aem` give samples back.
"""

from andoyer.output.aem import Heading, write_aem
from andoyer.output.aem_reader import Segment, read_aem, read_aem_segments
from andoyer.output.calendar import TIME_SYSTEMS
from andoyer.output.ck import Kernel, Written, write_ck
from andoyer.output.rows import COLUMNS, CONVENTION
from andoyer.output.table import Progress, Table, read_table, silent, write_csv, write_npz, write_parquet, write_table

__all__ = [
    "COLUMNS",
    "CONVENTION",
    "Heading",
    "Kernel",
    "Progress",
    "Segment",
    "TIME_SYSTEMS",
    "Table",
    "Written",
    "read_aem",
    "read_aem_segments",
    "read_table",
    "silent",
    "write_aem",
    "write_ck",
    "write_csv",
    "write_npz",
    "write_parquet",
    "write_table",
]
