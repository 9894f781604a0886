"""MJCF files. Private: use manyworlds.mjcf."""

import os


class MjcfError(ValueError):
    pass

def load(file: str | os.PathLike) -> tuple[object, list[str]]:
    """The scene of a file, and what acts otherwise than in MuJoCo."""

def load_string(xml: object | None) -> tuple[object, list[str]]:
    """The same of a text."""
