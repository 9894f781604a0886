"""Trials of candidates in worlds of a task."""

from __future__ import annotations

import copy
from collections.abc import Callable
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import arrays, tasks
from ..environment import Environment
from ..names import Isa, Precision
from ..rollout import MAX_STEPS
from ..tasks import Task
from .numbers import Numbers
from .outcome import Objective, Run, Score
from .rounds import Rounds
from .space import Doubles, Space


class TaskTrial(Rounds):
    """Tries candidates in worlds of a Task. The default value is the return of an episode.

    task       a Task or its name
    space      the parameters; a parameter with the name of an action is this action in every step
    objective  function of a Run after the last step; None: ``run.returns``, the sum of rewards
               until the end of the episode
    steps      number of steps; None: the task's max_steps
    begin      function of a Run after the reset, when its worlds have their parameters
    act        function of a Run before each step that returns actions (worlds, actions), for
               policies with parameters as weights; ``run.environment.observations`` are their input

    Other arguments are those of Environment. Worlds continue to step after the end of their
    episode.
    """

    def __init__(
        self,
        task: Union[Task, str],
        space: Space,
        objective: Optional[Objective] = None,
        *,
        steps: Optional[int] = None,
        begin: Optional[Callable[[Run], None]] = None,
        act: Optional[Callable[[Run], ArrayLike]] = None,
        worlds: Optional[int] = None,
        threads: Optional[int] = None,
        precision: Precision = "f32",
        isa: Optional[Isa] = None,
    ) -> None:
        super().__init__(space, objective, worlds)
        self._task = tasks.load(task) if isinstance(task, str) else copy.deepcopy(task)
        if not isinstance(self._task, Task):
            raise TypeError(f"task is of type {type(task).__name__}; expected a Task or a name")
        self._numbers = Numbers(self._task.scene, space)
        self._task.scene = self._numbers.scene
        count = self._task.max_steps if steps is None else steps
        self._steps = arrays.integer(count, "steps (None: the task's max_steps)", 1, MAX_STEPS)
        self._on_begin, self._act = begin, act
        self._batch = {"threads": threads, "precision": precision, "isa": isa}
        names = [a.name for a in self._task.actions]
        self._columns: list[int] = []
        if act is None:
            missing = [n for n in names if n not in space.names]
            if missing or self._task.choices:
                what = (
                    "choices" if self._task.choices else f"actions {', '.join(map(repr, missing))}"
                )
                raise ValueError(
                    f"the task's {what} are not parameters; expected act to compute them"
                )
            self._columns = [space.index(n) for n in names]
        used = set() if act is not None else set(names)
        idle = [p.name for p in space.parameters if p.name not in used and not p.numbers]
        if idle and begin is None and act is None:
            raise ValueError(
                f"parameters {', '.join(map(repr, idle))} are not actions of the task "
                f"({', '.join(names)}) and set nothing; expected begin or act to use them"
            )
        self._make(1).close()

    def _make(self, worlds: int) -> Environment:
        return Environment(self._task, worlds, autoreset="disabled", **self._batch)  # type: ignore[arg-type]

    def _begin(self, held: Environment, values: Doubles, seeds: NDArray[np.uint64]) -> Run:
        held.batch.reset()
        held.reset(seeds=seeds)
        self._numbers.write(held.batch, values)
        run = Run(self._space, held.batch, values, seeds, environment=held)
        if self._on_begin is not None:
            self._on_begin(run)
        held.begin()
        run.returns = np.zeros(held.worlds)
        return run

    def _play(self, run: Run) -> None:
        env = run.environment
        assert env is not None
        going = np.ones(env.worlds, np.bool_)
        actions: Any = np.ascontiguousarray(run.values[:, self._columns], np.float32)
        for run.step in range(self._steps):
            if self._act is not None:
                actions = self._act(run)
            _, rewards, terminated, truncated = env.step(actions)
            run.returns += np.where(going, rewards, 0)
            going &= ~(terminated | truncated)

    def _score(self, run: Run) -> Union[ArrayLike, Score]:
        return run.returns if self._objective is None else self._objective(run)
