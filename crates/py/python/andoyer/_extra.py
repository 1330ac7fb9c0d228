"""Import of optional packages where they are used, with an error that names a missing package."""

import importlib
from typing import Any


def extra(module: str, purpose: str, requirement: str | None = None) -> Any:
    """Import the module `module` of an optional package, which `requirement` installs: by default its name.

    Raises
    ------
    ImportError
        The package is not installed.
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = module.partition(".")[0]
        raise ImportError(f"{purpose} needs {package}, which is not installed: pip install {requirement or package}", name=package) from error
