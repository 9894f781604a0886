"""The scene or task of all shards, and its division into blocks of worlds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

from .. import scenes, tasks
from ..batch import Batch
from ..environment import Environment
from ..kinds import AnyScene
from ..names import Isa, Precision
from ..tasks import Task

Arrays = dict[str, NDArray[Any]]
Policy = Callable[[Any], Any]

_LANES, _MOST, _BLOCKS = 16, 4096, 64


@dataclass(frozen=True)
class Work:
    """Worlds in blocks of equal size (the last may be smaller), each a separate Environment or Batch.

    Shards hold, save and exchange whole blocks. A policy therefore gets arrays of the same shape on every
    shard. This matters because rounding of matrix products depends on the number of rows.
    """

    what: Union[Task, AnyScene]
    worlds: int
    seed: int
    block: int
    threads: Optional[int]
    precision: Precision
    isa: Optional[Isa]
    fields: tuple[str, ...]  # scenes only

    @property
    def blocks(self) -> int:
        """Number of blocks."""
        return -(-self.worlds // self.block)

    def range(self, block: int) -> range:
        """The worlds of a block."""
        return range(block * self.block, min((block + 1) * self.block, self.worlds))

    def make(self, block: int) -> Union[Environment, Batch]:
        """The worlds of a block in their initial state."""
        worlds = self.range(block)
        return self.make_worlds(len(worlds), (self.seed + worlds.start) % 2**64)

    def make_worlds(self, count: int, seed: int) -> Union[Environment, Batch]:
        """``count`` worlds; the first one has this seed."""
        if isinstance(self.what, Task):
            return Environment(self.what, count, self.threads, seed, self.precision, self.isa)
        return Batch(self.what, count, self.threads, self.precision, seed, self.isa)


class ShardError(RuntimeError):
    """The actor of a shard died or hung more than ``max_restarts`` times in one call."""


def default_block(worlds: int) -> int:
    """The block size for 64 blocks: whole groups of lanes, at most 4096 worlds."""
    size = -(-worlds // _BLOCKS)
    return min(_MOST, -(-size // _LANES) * _LANES)


def task_of(what: Union[Task, AnyScene]) -> Union[Task, AnyScene]:
    """The Task with this name, or ``what`` unchanged. Raises ValueError for an unknown name."""
    if not isinstance(what, str):
        return what
    if what in tasks.names():
        return tasks.load(what)
    if what not in scenes.names():
        raise ValueError(
            f"there is no task and no scene {what!r}; tasks.names() and scenes.names() list them"
        )
    return what


def shares(blocks: int, shards: int) -> list[range]:
    """The blocks of each shard. Numbers of blocks differ by at most one."""
    ends = [blocks * (i + 1) // shards for i in range(shards)]
    return [range(first, end) for first, end in zip([0, *ends], ends)]


@dataclass(frozen=True)
class Report:
    """Results of a call in some worlds, in the order of worlds.

    21 bytes per world: 86 kB for a block of 4096. Ray returns results below 100 kB directly, larger ones
    through its object store.
    """

    hashes: NDArray[np.uint64]  # (worlds,), hash of each world's state
    lost: NDArray[np.bool_]  # (worlds,), as Batch.lost
    returns: NDArray[np.float64]  # (worlds,), sums of rewards over the call; 0 for a scene
    episodes: NDArray[np.int32]  # (worlds,), number of episodes that ended in the call; 0 for a scene

    @staticmethod
    def joined(parts: Sequence[Report]) -> Report:
        """The parts as one report."""
        return Report(
            np.concatenate([p.hashes for p in parts]),
            np.concatenate([p.lost for p in parts]),
            np.concatenate([p.returns for p in parts]),
            np.concatenate([p.episodes for p in parts]),
        )
