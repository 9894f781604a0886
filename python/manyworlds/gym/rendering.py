"""Images of an environment's worlds, by ``manyworlds.plot``."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np
from gymnasium.error import DependencyNotInstalled
from numpy.typing import NDArray

from ..environment import Environment
from ..tasks import Task

RENDER_MODES = ["rgb_array"]


def metadata(task: Task) -> dict[str, Any]:
    """Gymnasium's metadata of rendering: the modes, and frames per simulated second."""
    per_second = 1 / (task.scene.options.dt * task.frame_skip)
    return {"render_modes": list(RENDER_MODES), "render_fps": max(1, round(per_second))}


class Frames:
    """Draws images of one task's worlds; ``mode`` None: none. Raises DependencyNotInstalled."""

    def __init__(self, task: Task, mode: Optional[str]) -> None:
        if mode is not None and mode not in RENDER_MODES:
            raise ValueError(f"render_mode is {mode!r}, must be None or one of {RENDER_MODES}")
        self._picture = None
        if mode is None:
            return
        try:
            from ..plot import Picture
        except ImportError as error:
            raise DependencyNotInstalled(str(error)) from error
        self._picture = Picture(task.scene)

    def of(self, environment: Environment) -> Optional[tuple[NDArray[np.uint8], ...]]:
        """An image of every world, (height, width, 3); None without a mode."""
        if self._picture is None:
            return None
        batch = environment.batch
        return tuple(self._picture.frame(batch, world) for world in range(batch.worlds))
