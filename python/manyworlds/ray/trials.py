"""A trial of a search that runs on shards."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

from .. import search
from ..kinds import AnyScene
from ..search.outcome import Objective
from ..tasks import Task

if TYPE_CHECKING:
    from .rollouts import Rollouts


class Maker:
    """Makes a trial in an actor. A trial owns worlds, which cannot be sent."""

    def __init__(
        self,
        what: Union[Task, AnyScene],
        space: search.Space,
        objective: Optional[Objective],
        arguments: Mapping[str, Any],
    ) -> None:
        self._made_of = what, space, objective, dict(arguments)

    def __call__(self) -> Union[search.Trial, search.TaskTrial]:
        what, space, objective, arguments = self._made_of
        if isinstance(what, Task):
            return search.TaskTrial(what, space, objective, **arguments)
        if objective is None:
            raise ValueError("a search over a scene has no objective; expected a function of a Run")
        return search.Trial(what, space, objective, **arguments)


class Trials:
    """An Evaluator of a Search that splits candidates over shards, in pieces of a block."""

    def __init__(
        self,
        rollouts: Rollouts,
        number: int,
        space: search.Space,
        objective: Optional[Objective],
        arguments: Mapping[str, Any],
    ) -> None:
        work = rollouts._work
        given = {"threads": work.threads, "precision": work.precision, "isa": work.isa}
        self._maker = Maker(work.what, space, objective, {**given, **arguments})
        self._maker().close()  # raises errors early
        self._rollouts = rollouts
        self._number = number
        self._space = space

    @property
    def space(self) -> search.Space:
        """The parameters."""
        return self._space

    def evaluate(
        self, values: NDArray[np.float64], seeds: NDArray[np.uint64]
    ) -> search.Outcome:
        """Outcome of values (candidates, parameters), each in a world with its seed (candidates,)."""
        rollouts = self._rollouts
        rollouts._check()
        ranges = replace(rollouts._work, worlds=len(values))
        pieces = [slice(r.start, r.stop) for r in map(ranges.range, range(ranges.blocks))]
        trial = self._number, self._maker
        if rollouts._crew is None:
            assert rollouts._shard is not None
            found = [rollouts._shard.try_out(trial, values[p], seeds[p]) for p in pieces]
        else:
            found = rollouts._spread(
                "try_out",
                lambda r: (trial, [values[pieces[i]] for i in r], [seeds[pieces[i]] for i in r]),
                len(pieces),
            )
        return search.Outcome(*(np.concatenate(column) for column in zip(*found)))
