"""Named scenes: ``manyworlds.scenes.load("lunar-lander")``."""

from __future__ import annotations

from . import _core
from .scene import Scene


def names() -> list[str]:
    """The names that ``load`` accepts. Some take a size: "pyramid2d:100", "bin-boxes:1000"."""
    return [name for name, _ in _core.scene_names()]


def summaries() -> dict[str, str]:
    """A line about each scene, by name."""
    return dict(_core.scene_names())


def load(name: str) -> Scene:
    """A new copy of the scene with this name. Raises ValueError, with the nearest name, if unknown."""
    return _core.load_scene(name)
