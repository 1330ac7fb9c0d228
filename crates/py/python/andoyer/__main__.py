"""`python -m andoyer`: the same as the console script `andoyer`."""

import sys

from andoyer.cli import main

sys.exit(main())
