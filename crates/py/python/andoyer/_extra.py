"""Optional packages: imported where they are used, and an error that names the extra which brings them."""

import importlib
from typing import Any


def extra(module: str, name: str, purpose: str) -> Any:
    """The module `module`, which the extra `name` of the package brings.

    Raises
    ------
    ImportError
        It is not installed.
    """
    try:
        return importlib.import_module(module)
    except ImportError as error:
        package = module.partition(".")[0]
        raise ImportError(f"{purpose} needs {package}, which is not installed: pip install 'andoyer[{name}]'", name=package) from error
