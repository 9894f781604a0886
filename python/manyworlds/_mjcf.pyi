"""MJCF files. Private: use manyworlds.mjcf."""

from collections.abc import Mapping, Sequence
import os


class MjcfError(ValueError):
    """
    What is wrong in an MJCF file, or not simulated: one line for each thing.
    """

def load(file: str | os.PathLike, roots: Sequence[str | os.PathLike], limits: Mapping[str, int]) -> tuple[object, list[str]]:
    """The scene of a file, and what acts otherwise than in MuJoCo."""

def load_string(xml: object | None, roots: Sequence[str | os.PathLike], limits: Mapping[str, int]) -> tuple[object, list[str]]:
    """The same of a text."""

def limits() -> dict[str, int]:
    """The limits that hold unless others are given."""
