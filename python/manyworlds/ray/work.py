"""What is to be done, and by which blocks of worlds: what every shard knows."""

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
    """Worlds in blocks of equal size (the last may be smaller), each an Environment or a Batch of its own.

    A block is what a shard holds, saves and hands over, so a policy sees the same arrays whoever steps them:
    products of matrices round by the number of their rows.
    """

    what: Union[Task, AnyScene]
    worlds: int
    seed: int
    block: int
    threads: Optional[int]
    precision: Precision
    isa: Optional[Isa]
    fields: tuple[str, ...]  # of a scene

    @property
    def blocks(self) -> int:
        """How many."""
        return -(-self.worlds // self.block)

    def range(self, block: int) -> range:
        """Its worlds."""
        return range(block * self.block, min((block + 1) * self.block, self.worlds))

    def make(self, block: int) -> Union[Environment, Batch]:
        """Its worlds at their beginning."""
        worlds = self.range(block)
        return self.make_worlds(len(worlds), (self.seed + worlds.start) % 2**64)

    def make_worlds(self, count: int, seed: int) -> Union[Environment, Batch]:
        """So many, the first of them of this seed."""
        if isinstance(self.what, Task):
            return Environment(self.what, count, self.threads, seed, self.precision, self.isa)
        return Batch(self.what, count, self.threads, self.precision, seed, self.isa)


class ShardError(RuntimeError):
    """A shard whose actor died or hung more often in one call than ``max_restarts``."""


def default_block(worlds: int) -> int:
    """64 blocks, of whole groups of lanes and at most 4096 worlds."""
    size = -(-worlds // _BLOCKS)
    return min(_MOST, -(-size // _LANES) * _LANES)


def task_of(what: Union[Task, AnyScene]) -> Union[Task, AnyScene]:
    """A Task where it is the name of one, else as it is. ValueError of a name of neither."""
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
    """Which blocks each shard has: as many as the others, or one more."""
    ends = [blocks * (i + 1) // shards for i in range(shards)]
    return [range(first, end) for first, end in zip([0, *ends], ends)]


@dataclass(frozen=True)
class Report:
    """What came of a call in some worlds, in the order of worlds.

    21 bytes a world: of a block of 4096 it stays below the 100 kB up to which Ray sends what a call returns
    with its answer; what is larger goes through the object store.
    """

    hashes: NDArray[np.uint64]  # (worlds,), of each world's state
    lost: NDArray[np.bool_]  # (worlds,), as Batch.lost
    returns: NDArray[np.float64]  # (worlds,), sums of rewards over the call; 0 of a scene
    episodes: NDArray[np.int32]  # (worlds,), how many ended in the call; 0 of a scene

    @staticmethod
    def joined(parts: Sequence[Report]) -> Report:
        """One of them all."""
        return Report(
            np.concatenate([p.hashes for p in parts]),
            np.concatenate([p.lost for p in parts]),
            np.concatenate([p.returns for p in parts]),
            np.concatenate([p.episodes for p in parts]),
        )
