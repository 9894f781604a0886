"""The numbers of an Environment's worlds that outlive their episodes."""

from __future__ import annotations

from typing import Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core, arrays
from .names import Ids
from .tasks import Task


class WithLevels:
    """What an Environment has of ``Task.levels``."""

    task: Task
    _worlds: int
    _held: _core.Environment

    @property
    def level_names(self) -> list[str]:
        """Of the columns of ``levels()``."""
        return [level.name for level in self.task.levels]

    def levels(self) -> NDArray[np.float64]:
        """The numbers of ``Task.levels``, (worlds, levels), in the episodes that worlds are in."""
        out = np.empty((self._worlds, len(self.task.levels)))
        self._held.read_levels(out)
        return out

    def set_levels(self, levels: ArrayLike, mask_or_ids: Optional[Ids] = None) -> None:
        """Other numbers, finite, of all worlds or of some: (worlds that are meant, levels), or what fits that
        by broadcasting.

        They count from the next step on, until an episode that ends says otherwise. Raises ValueError.
        """
        chosen = arrays.indices(mask_or_ids, self._worlds, "ids")
        all_levels = self.levels()
        try:
            all_levels[chosen] = np.asarray(levels, np.float64)
        except ValueError:
            expected = len(chosen), all_levels.shape[1]
            raise ValueError(
                f"levels have shape {np.shape(levels)}; expected "
                f"{arrays.shape_text(expected, ('worlds', 'levels'))}"
            ) from None
        self._held.write_levels(arrays.mask(mask_or_ids, self._worlds), all_levels)
