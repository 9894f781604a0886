"""What callbacks of a trial see, and what comes of candidates."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import NamedTuple, Optional, Protocol, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..batch import Batch
from ..environment import Environment
from ..rollout import Trajectories
from .space import Doubles, Space


class Score(NamedTuple):
    """What an objective may return instead of values alone."""

    value: ArrayLike  # (worlds,)
    # (worlds,) or (worlds, constraints): by how much each is broken. What is <= 0 is kept.
    violation: ArrayLike


@dataclass(slots=True)
class Run:
    """Worlds that try candidates, as callbacks see them. ``run["mass"]`` is a parameter's (worlds,) values.

    What a callback does with a world must not depend on the others, nor on how many there are.
    """

    space: Space
    batch: Batch
    values: Doubles  # (worlds, parameters)
    seeds: NDArray[np.uint64]  # (worlds,)
    fields: Trajectories = field(
        default_factory=dict
    )  # (frames, worlds, items, components) of each
    environment: Optional[Environment] = None  # of a TaskTrial
    returns: Doubles = field(default_factory=lambda: np.zeros(0))  # (worlds,), of a TaskTrial
    step: int = 0  # of a TaskTrial: how many were taken
    recording: bool = False  # whether each step is a call of its own, to be sampled

    def __getitem__(self, name: str) -> Doubles:
        column: Doubles = self.values[:, self.space.index(name)]
        return column

    def info(self, name: str) -> Doubles:
        """(worlds,): one of the task's infos as it is now. ValueError."""
        names = [] if self.environment is None else self.environment.info_names
        if self.environment is None or name not in names:
            raise ValueError(
                f"there is no info {name!r}; expected one of {', '.join(names) or 'none'}"
            )
        return self.environment.infos[:, names.index(name)].copy()


Objective = Callable[[Run], Union[ArrayLike, Score]]


class Outcome(NamedTuple):
    """What came of candidates, in their order."""

    values: Doubles  # (candidates,), not a number where there is none
    violations: Doubles  # (candidates,), 0: constraints are kept
    lost: NDArray[np.bool_]  # (candidates,): Batch.lost
    hashes: NDArray[np.uint64]  # (candidates,): of each world's last state


class Evaluator(Protocol):
    """What a search needs of a trial; one's own may run elsewhere."""

    @property
    def space(self) -> Space:
        """The parameters."""
        ...

    def evaluate(self, values: Doubles, seeds: NDArray[np.uint64]) -> Outcome:
        """What comes of (candidates, parameters) values, each in a world of its seed (candidates,)."""
        ...
