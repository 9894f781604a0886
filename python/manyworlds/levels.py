"""Levels of an Environment: values of worlds that persist over episodes."""

from __future__ import annotations

from typing import Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core, arrays
from .names import Ids
from .tasks import Task


class WithLevels:
    """Methods of Environment for ``Task.levels``."""

    task: Task
    _worlds: int
    _held: _core.Environment

    @property
    def level_names(self) -> list[str]:
        """Names of the columns of ``levels()``."""
        return [level.name for level in self.task.levels]

    def levels(self) -> NDArray[np.float64]:
        """Values of ``Task.levels`` in the current episodes, (worlds, levels)."""
        out = np.empty((self._worlds, len(self.task.levels)))
        self._held.read_levels(out)
        return out

    def set_levels(self, levels: ArrayLike, mask_or_ids: Optional[Ids] = None) -> None:
        """Sets finite levels of all worlds or of some: (selected worlds, levels), or broadcast to
        it.

        They apply from the next step until the end of an episode changes them. Unchanged values
        have no effect. Raises ValueError, TypeError, IndexError.
        """
        chosen = arrays.worlds(mask_or_ids, self._worlds)
        all_levels = self.levels()
        shape = len(chosen), all_levels.shape[1]
        all_levels[chosen] = arrays.broadcast(levels, shape, ("worlds", "levels"), "levels", np.float64)
        self._held.write_levels(arrays.mask(mask_or_ids, self._worlds), all_levels)
