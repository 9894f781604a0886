"""Worlds of an Environment saved, restored and copied."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from . import _core, arrays
from ._core import Snapshot
from .names import Ids

Flags = NDArray[np.bool_]
Observations = NDArray[Any]


@dataclass(frozen=True, slots=True, eq=False)
class EnvironmentSnapshot:
    """The worlds of an Environment with what its task remembers of them; can be pickled."""

    worlds: Snapshot
    task: int  # of which task: equal for tasks that compute the same
    memory: NDArray[np.float64]  # (worlds, numbers)
    # Of the last step or reset, as the array has them that it filled.
    observations: Observations  # (worlds, observations)
    terminated: Flags  # (worlds,)
    truncated: Flags


class WithSnapshots:
    """What an Environment has of snapshots."""

    observations: Observations
    terminated: Flags
    truncated: Flags
    _worlds: int
    _held: _core.Environment
    _last: tuple[Observations, Flags, Flags]
    _unfilled: Optional[tuple[Any, ...]]

    def copy_world(self, source: int, target: int) -> None:
        """World ``target`` becomes what ``source`` is, with what the task remembers of it."""
        self._held.copy_world(
            arrays.index(source, self._worlds, "source"),
            arrays.index(target, self._worlds, "target"),
        )

    def save(self) -> EnvironmentSnapshot:
        """All worlds, with what the task remembers of them and ``observations``."""
        worlds, task, memory = self._held.save()
        last = (array.copy() for array in self._last)
        return EnvironmentSnapshot(worlds, task, memory, *last)

    def restore(
        self,
        snapshot: EnvironmentSnapshot,
        source: Optional[Ids] = None,
        ids: Optional[Ids] = None,
    ) -> Observations:
        """Worlds go on bit by bit as the saved ones did, in this or another Environment of the task.

        ``source``, ``ids``: as in ``Batch.restore``. Restored as a whole, later episodes are
        drawn as they would have been; single worlds draw from the seeds that are here. A world that was to begin with its next step steps on beyond its end where
        ``autoreset`` is not "next_step". Returns ``observations``, with the rows of the snapshot, as
        ``terminated`` and ``truncated`` have. Raises SnapshotError, and changes nothing, for a snapshot
        of another task or precision.
        """
        if not isinstance(snapshot, EnvironmentSnapshot):
            found = type(snapshot).__name__
            raise TypeError(f"snapshot is of type {found}; expected an EnvironmentSnapshot")
        saved = snapshot.worlds.worlds
        own = self.observations, self.terminated, self.truncated
        last = snapshot.observations, snapshot.terminated, snapshot.truncated
        for array, name, mine in zip(last, ("observations", "terminated", "truncated"), own):
            wanted = saved, *mine.shape[1:]
            if np.shape(array) != wanted:
                raise _core.SnapshotError(
                    f"snapshot: {name} have shape {np.shape(array)}, expected {wanted}: it "
                    "belongs to another task, or was changed"
                )
        held = snapshot.worlds, snapshot.task, np.ascontiguousarray(snapshot.memory, np.float64)
        if source is None and ids is None:
            self._held.restore(*held, None)
            rows = worlds = np.arange(saved)
        else:
            pairs = arrays.pairs(source, saved, ids, self._worlds)
            self._held.restore(*held, pairs)
            rows, worlds = pairs[::2], pairs[1::2]
        for array, mine in zip(last, own):
            mine[worlds] = array[rows]
        self._unfilled = None
        self._last = own
        return self.observations
