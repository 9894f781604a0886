"""Results of rollouts: arrays by blocks of worlds, and whole episodes."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .work import Arrays, Report


class Trajectories:
    """Results of a call: a Report of all worlds, and arrays by blocks of worlds."""

    def __init__(self, report: Report, held: list[Any]) -> None:
        self.report = report
        self._held = held  # per shard: arrays of its blocks, or a reference to them

    @property
    def references(self) -> list[Any]:
        """References for Ray tasks, one per shard, each to a list with a dict of arrays by name per block.
        Without actors, the lists."""
        return list(self._held)

    @property
    def parts(self) -> Iterator[Arrays]:
        """Arrays by name of each block, in the order of worlds. Arrays on this node are not copied and
        read-only."""
        for one in self._held:
            if isinstance(one, list):
                yield from one
            else:
                import ray

                yield from ray.get(one)

    def gather(self) -> Arrays:
        """Arrays of all worlds, (steps or frames, worlds, ...), copied."""
        parts = list(self.parts)
        return {name: np.concatenate([p[name] for p in parts], axis=1) for name in parts[0]}


@dataclass(frozen=True)
class Evaluation:
    """Whole episodes under a policy, each in a separate world."""

    returns: NDArray[np.float64]  # (episodes,)
    lengths: NDArray[np.int64]  # (episodes,), steps
    lost: NDArray[np.bool_]  # (episodes,), the world was lost
