"""File arguments."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any, Union

File = Union[str, os.PathLike[str]]


def path(file: Any, name: str) -> Path:
    """``file`` as a Path. TypeError, ValueError."""
    if not isinstance(file, (str, os.PathLike)):
        raise TypeError(f"{name} is of type {type(file).__name__}; expected a str or a Path")
    text = os.fsdecode(file)
    if "\0" in text:
        raise ValueError(f"{name} is {text!r}, which contains a NUL character")
    return Path(text)
