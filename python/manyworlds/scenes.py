"""Scenes that have a name: ``manyworlds.scenes.load("lunar-lander")``."""

from __future__ import annotations

from . import _core
from .scene import Scene


def names() -> list[str]:
    """The scenes that ``load`` accepts. Some have sizes, too: "pyramid2d:100", "bin-boxes:1000"."""
    return [name for name, _ in _core.scene_names()]


def summaries() -> dict[str, str]:
    """One line about each scene, by its name."""
    return dict(_core.scene_names())


def load(name: str) -> Scene:
    """The scene of that name, to take or to change. Raises ValueError with the nearest name."""
    return _core.load_scene(name)
