"""One world as a Gymnasium environment, for tests and inspection. VectorEnv is much faster."""

from __future__ import annotations

from typing import Any, Optional, Union

import gymnasium
import numpy as np
from numpy.typing import DTypeLike, NDArray

from ..environment import Environment
from ..in_memory import InMemory
from ..live import LiveView, view
from ..names import Isa, Precision
from ..tasks import Task
from . import infos as task_infos
from . import rendering, spaces


class Env(InMemory, gymnasium.Env[np.ndarray, Any]):
    """A task in one world. Arguments as in ``manyworlds.Environment``.

    ``reset(seed=s)`` starts the first episode of the seed s, ``reset()`` the next one. With the
    seed s + i, results are bitwise equal to those of world i of a VectorEnv with the seed s.
    """

    metadata: dict[str, Any] = {"render_modes": list(rendering.RENDER_MODES)}
    _instead = "pickle its spec, or the task and arguments that it was made with"

    def __init__(
        self,
        task: Union[Task, str],
        *,
        max_episode_steps: Optional[int] = None,
        precision: Precision = "f32",
        isa: Optional[Isa] = None,
        check: bool = False,
        reward_terms: bool = False,
        observation_dtype: DTypeLike = np.float32,
        render_mode: Optional[str] = None,
    ) -> None:
        self.task = spaces.task_of(task, max_episode_steps)
        self._frames = rendering.Frames(self.task, render_mode)
        self.render_mode = render_mode
        self.metadata = rendering.metadata(self.task)
        seed = int(np.random.SeedSequence().generate_state(1)[0])
        self.environment = Environment(
            self.task,
            threads=1,
            seed=seed,
            precision=precision,
            isa=isa,
            autoreset="disabled",
            check=check,
            reward_terms=reward_terms,
            observation_dtype=observation_dtype,
        )
        self._told_of = list(task_infos.told(self.task.infos))
        self.observation_space = spaces.observation_space(self.task, observation_dtype)
        self.action_space = spaces.action_space(self.task)

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Starts the first episode of the seed, 0 to 2**64 - 1; None: the next episode.

        Returns (observation, info): (observations,) float32, and the task's infos without those of
        steps.
        """
        super().reset(seed=seed)
        observation = self.environment.reset(seeds=seed)[0].copy()
        info = self._told(False)
        if self.environment.lost()[0]:
            info["lost"] = True
        return observation, info

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Takes one step of the task. ``action``: an integer below ``task.choices``, or (numbers,).

        Returns (observation, reward, terminated, truncated, info). The observation is a copy,
        (observations,) of the observation dtype, float32 by default. ``info`` has the task's infos,
        "lost" if the world is lost, and "reward_terms" by name if requested.

        Raises ValueError for a wrong shape and an invalid choice, TypeError for a wrong dtype.
        """
        e = self.environment
        observations, rewards, terminated, truncated = e.step(np.asarray(action)[None])
        info = self._told(True)
        if e.reward_terms is not None:
            parts = e.reward_terms[0]
            info["reward_terms"] = {n: float(p) for n, p in zip(e.reward_names, parts)}
        if truncated[0] and e.lost()[0]:
            info["lost"] = True
        ends = bool(terminated[0]), bool(truncated[0])
        return observations[0].copy(), float(rewards[0]), *ends, info

    def _told(self, stepped: bool) -> dict[str, Any]:
        values = self.environment.infos[0]
        return {
            name: values[columns] if isinstance(columns, list) else float(values[columns])
            for name, columns, of_steps_alone in self._told_of
            if stepped or not of_steps_alone
        }

    def render(self) -> Optional[NDArray[np.uint8]]:  # type: ignore[override]
        """An image of the current state, (height, width, 3) uint8; None without a render_mode."""
        frames = self._frames.of(self.environment)
        return None if frames is None else frames[0]

    def view(self, **options: Any) -> LiveView:
        """A page that shows the world while it steps: see ``manyworlds.view``."""
        return view(self.environment, **options)

    def close(self) -> None:
        """Frees the world. Later steps raise ValueError."""
        self.environment.close()


class RegisteredEnv(Env):
    """Entry point of ``gymnasium.make``, whose TimeLimit ends episodes at
    ``spec.max_episode_steps``.
    """

    def __init__(self, task: Union[Task, str], **arguments: Any) -> None:
        super().__init__(task, **{"max_episode_steps": 0, **arguments})
