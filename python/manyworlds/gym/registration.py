"""The ids registered with Gymnasium: "manyworlds/<task>-v0" for every task that has a name."""

from __future__ import annotations

import math

import gymnasium

from .. import tasks

NAMESPACE = "manyworlds"


def ids() -> list[str]:
    """The ids of all tasks, as ``gymnasium.make`` and ``make_vec`` take them."""
    return [f"{NAMESPACE}/{name}-v0" for name in tasks.names()]


def register() -> None:
    """Makes the tasks known to Gymnasium; twice is once."""
    for name, id in zip(tasks.names(), ids()):
        if id in gymnasium.registry:
            continue
        task = tasks.load(name)
        gymnasium.register(
            id=id,
            entry_point="manyworlds.gym.single_env:RegisteredEnv",
            vector_entry_point="manyworlds.gym:VectorEnv",
            max_episode_steps=task.max_steps or None,
            kwargs={"task": name},
            reward_threshold=task.solved_at if math.isfinite(task.solved_at) else None,
        )
