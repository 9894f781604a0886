"""Which ids Gymnasium knows: "manyworlds/<task>-v0" for every task that has a name."""

from __future__ import annotations

import math

import gymnasium

from .. import tasks

NAMESPACE = "manyworlds"


def ids() -> list[str]:
    return [f"{NAMESPACE}/{name}-v0" for name in tasks.names()]


def register() -> None:
    """Makes the tasks known to Gymnasium; twice is once."""
    for name, id in zip(tasks.names(), ids()):
        if id in gymnasium.registry:
            continue
        task = tasks.load(name)
        gymnasium.register(
            id=id,
            entry_point="manyworlds.gym:Env",
            vector_entry_point="manyworlds.gym:VectorEnv",
            kwargs={"task": name},
            reward_threshold=task.solved_at if math.isfinite(task.solved_at) else None,
        )
