"""The spaces of a task, and task arguments."""

from __future__ import annotations

import dataclasses
from math import inf
from typing import Any, Optional, Union

import gymnasium
import numpy as np
from numpy.typing import DTypeLike

from .. import arrays, tasks
from ..tasks import Task
from .bounds import range_of

MAX_EPISODE_STEPS = 2**31 - 1


def task_of(task: Union[Task, str], max_episode_steps: Optional[int]) -> Task:
    """The task, or the task with this name; optionally with another episode length."""
    found = tasks.load(task) if isinstance(task, str) else task
    if max_episode_steps is None:
        return found
    steps = arrays.integer(max_episode_steps, "max_episode_steps", 0, MAX_EPISODE_STEPS)
    return dataclasses.replace(found, max_steps=steps)


def observation_space(task: Task, dtype: DTypeLike = np.float32) -> gymnasium.spaces.Box:
    """A Box, (observations,) of the dtype, with finite bounds.

    Bounds are those of the task, else those of its expressions, else the largest numbers.
    """
    ends = [range_of(o.value, task) for o in task.observations]
    low = [o.low if o.low > -inf else least for o, (least, _) in zip(task.observations, ends)]
    high = [o.high if o.high < inf else most for o, (_, most) in zip(task.observations, ends)]
    largest = np.finfo(np.float32).max
    return gymnasium.spaces.Box(
        np.clip(low, -largest, largest).astype(dtype),
        np.clip(high, -largest, largest).astype(dtype),
        dtype=np.dtype(dtype).type,
    )


def action_space(task: Task) -> gymnasium.spaces.Space[Any]:
    """Discrete(choices), or a Box, (actions,) float32, with the ranges of the actions."""
    if task.choices > 0:
        return gymnasium.spaces.Discrete(task.choices)
    low = np.array([a.low for a in task.actions], np.float32)
    high = np.array([a.high for a in task.actions], np.float32)
    return gymnasium.spaces.Box(low, high, dtype=np.float32)
