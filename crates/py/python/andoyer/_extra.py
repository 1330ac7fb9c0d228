"""Optional packages: imported where they are used, and an error that names the one which is missing."""

import importlib
from typing import Any


def extra(module: str, purpose: str) -> Any:
    """The module `module` of a package that is not among the requirements.

    Raises
    ------
    ImportError
        It is not installed.
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = module.partition(".")[0]
        raise ImportError(f"{purpose} needs {package}, which is not installed: pip install {package}", name=package) from error
