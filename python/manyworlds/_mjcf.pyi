"""MJCF files. Private: use manyworlds.mjcf."""

from collections.abc import Mapping, Sequence
import os


class MjcfError(ValueError):
    """Errors and unsupported elements of an MJCF file, one per line."""

def load(file: str | os.PathLike, roots: Sequence[str | os.PathLike], limits: Mapping[str, int]) -> tuple[object, list[str]]:
    """The scene of a file, and its differences from MuJoCo."""

def load_string(xml: object | None, roots: Sequence[str | os.PathLike], limits: Mapping[str, int]) -> tuple[object, list[str]]:
    """As load, for a text."""

def limits() -> dict[str, int]:
    """The default limits."""
