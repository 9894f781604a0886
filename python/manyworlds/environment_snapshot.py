"""Snapshots of an Environment: save, restore and copy worlds."""

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
    """Worlds of an Environment with the memories of its task. Can be pickled."""

    worlds: Snapshot
    task: int  # fingerprint of the task: equal for tasks with equal results
    memory: NDArray[np.float64]  # (worlds, numbers)
    # Values of the last step or reset, in the array that it filled.
    observations: Observations  # (worlds, observations)
    terminated: Flags  # (worlds,)
    truncated: Flags


class WithSnapshots:
    """Snapshot methods of Environment."""

    observations: Observations
    terminated: Flags
    truncated: Flags
    _worlds: int
    _held: _core.Environment
    _last: tuple[Observations, Flags, Flags]
    _unfilled: Optional[tuple[Any, ...]]

    def copy_world(self, source: int, target: int) -> None:
        """Copies world ``source``, with the memories of the task, to world ``target``."""
        self._held.copy_world(
            arrays.index(source, self._worlds, "source"),
            arrays.index(target, self._worlds, "target"),
        )

    def save(self) -> EnvironmentSnapshot:
        """A snapshot of all worlds, with the memories of the task and ``observations``."""
        worlds, task, memory = self._held.save()
        last = (array.copy() for array in self._last)
        return EnvironmentSnapshot(worlds, task, memory, *last)

    def restore(
        self,
        snapshot: EnvironmentSnapshot,
        source: Optional[Ids] = None,
        ids: Optional[Ids] = None,
    ) -> Observations:
        """Restores worlds, which continue bitwise equal to the saved ones. Returns
        ``observations``.

        ``source``, ``ids``: as in ``Batch.restore``. The snapshot may be of another Environment of
        the same task. A restore of all worlds also restores the draws of later episodes. Single
        worlds draw from the seeds of this environment.

        The returned observations, ``terminated`` and ``truncated`` have the rows of the snapshot.
        With another ``autoreset`` than "next_step", a world that was due for a reset steps on after
        its end. Raises SnapshotError, and changes nothing, for a snapshot of another task or
        precision.
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
