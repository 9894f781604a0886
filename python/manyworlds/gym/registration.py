"""Ids in Gymnasium's registry.

"manyworlds/<task>-v0" for every named task, and "manyworlds/<task>-v5" for Gymnasium's MuJoCo
tasks.
"""

from __future__ import annotations

import math
from typing import Optional

import gymnasium

from .. import tasks

NAMESPACE = "manyworlds"

# Gymnasium's, with the length of their episodes and the reward at which they count as solved. A model
# is read where an environment is made.
_MUJOCO: dict[str, tuple[int, Optional[float]]] = {
    "InvertedPendulum-v5": (1000, 950.0),
    "InvertedDoublePendulum-v5": (1000, 9100.0),
    "Reacher-v5": (50, -3.75),
    "Pusher-v5": (100, 0.0),
    "Swimmer-v5": (1000, 360.0),
    "Hopper-v5": (1000, 3800.0),
    "HalfCheetah-v5": (1000, 4800.0),
    "Walker2d-v5": (1000, None),
    "Ant-v5": (1000, 6000.0),
    "Humanoid-v5": (1000, None),
    "HumanoidStandup-v5": (1000, None),
}


def ids() -> list[str]:
    """The ids of all tasks, for ``gymnasium.make`` and ``make_vec``."""
    return [f"{NAMESPACE}/{name}-v0" for name in tasks.names()]


def register() -> None:
    """Registers the tasks with Gymnasium. A second call has no effect."""
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
    for name, (steps, threshold) in _MUJOCO.items():
        if f"{NAMESPACE}/{name}" in gymnasium.registry:
            continue
        gymnasium.register(
            id=f"{NAMESPACE}/{name}",
            entry_point="manyworlds.gym.mujoco:make_env",
            vector_entry_point="manyworlds.gym.mujoco:make_vector_env",
            max_episode_steps=steps,
            kwargs={"mujoco_task": name},
            reward_threshold=threshold,
        )
