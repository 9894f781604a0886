"""Arguments of a trial's callbacks, and outcomes of candidates."""

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
    """Values with constraint violations, as the result of an objective."""

    value: ArrayLike  # (worlds,)
    # (worlds,) or (worlds, constraints): amount of the violation; <= 0: the constraint holds
    violation: ArrayLike


@dataclass(slots=True)
class Run:
    """Worlds that try candidates; the argument of callbacks. ``run["mass"]``: a parameter's values (worlds,).

    The effect of a callback on a world must not depend on other worlds or on their number.
    """

    space: Space
    batch: Batch
    values: Doubles  # (worlds, parameters)
    seeds: NDArray[np.uint64]  # (worlds,)
    fields: Trajectories = field(
        default_factory=dict
    )  # (frames, worlds, items, components) of each
    environment: Optional[Environment] = None  # TaskTrial only
    returns: Doubles = field(default_factory=lambda: np.zeros(0))  # (worlds,), TaskTrial only
    step: int = 0  # TaskTrial only: number of completed steps
    recording: bool = False  # whether each step is a separate call, for samples

    def __getitem__(self, name: str) -> Doubles:
        column: Doubles = self.values[:, self.space.index(name)]
        return column

    def info(self, name: str) -> Doubles:
        """The current values (worlds,) of one of the task's infos. Raises ValueError."""
        names = [] if self.environment is None else self.environment.info_names
        if self.environment is None or name not in names:
            raise ValueError(
                f"there is no info {name!r}; expected one of {', '.join(names) or 'none'}"
            )
        return self.environment.infos[:, names.index(name)].copy()


Objective = Callable[[Run], Union[ArrayLike, Score]]


class Outcome(NamedTuple):
    """Outcomes of candidates, in their order."""

    values: Doubles  # (candidates,), NaN if there is none
    violations: Doubles  # (candidates,), 0: all constraints hold
    lost: NDArray[np.bool_]  # (candidates,): Batch.lost
    hashes: NDArray[np.uint64]  # (candidates,): of each world's last state


class Evaluator(Protocol):
    """The interface of a trial. Custom ones can run elsewhere."""

    @property
    def space(self) -> Space:
        """The parameters."""
        ...

    def evaluate(self, values: Doubles, seeds: NDArray[np.uint64]) -> Outcome:
        """Outcome of values (candidates, parameters), each in a world with its seed (candidates,)."""
        ...
