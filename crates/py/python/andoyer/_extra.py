"""Import of optional packages where they are used, with an error that names a missing package."""

import importlib
from typing import Any


def extra(module: str, purpose: str) -> Any:
    """Import the module `module` of an optional package.

    Raises
    ------
    ImportError
        The package is not installed.
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = module.partition(".")[0]
        raise ImportError(f"{purpose} needs {package}, which is not installed: pip install {package}", name=package) from error
