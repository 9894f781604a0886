"""The name that pip knows this package by, and messages about extras that are not installed.

PyPI's "manyworlds" is another project with the same import name, so nothing here may recommend it.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

DISTRIBUTION = "manyworlds-sim"


def install_command(extra: str) -> str:
    """The command that installs an extra: pip install 'manyworlds-sim[gym]' for "gym"."""
    return f"pip install '{DISTRIBUTION}[{extra}]'"


@contextmanager
def needs(package: str, *, extra: str, what: str) -> Iterator[None]:
    """Guards imports of a package that an extra installs.

    Raises ModuleNotFoundError, an ImportError, that names ``what``, the package and the command to run if
    the package ("gymnasium") is missing. Other import errors pass unchanged.
    """
    try:
        yield
    except ModuleNotFoundError as error:
        if (error.name or "").partition(".")[0] != package:
            raise
        raise ModuleNotFoundError(
            f"{what} needs {package}, which is not installed; install it with: "
            f"{install_command(extra)}",
            name=error.name,
        ) from error
