"""One world as an ordinary environment of Gymnasium: to look at, to test with, not for speed."""

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
    """A task in one world. ``reset(seed=s)`` begins the first episode of the seed s, ``reset()`` the
    next one; with the seed s + i it is, bit by bit, world i of a VectorEnv with the seed s. ``check``:
    see ``manyworlds.Environment``."""

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
        """The first episode of the seed, 0 to 2**64 - 1; None: the next episode. Returns (observation,
        info): (observations,) float32 and the task's infos, but for those of steps alone."""
        super().reset(seed=seed)
        observation = self.environment.reset(seeds=seed)[0].copy()
        info = self._told(False)
        if self.environment.lost()[0]:
            info["lost"] = True
        return observation, info

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """One step of the task. ``action``: an integer below ``task.choices``, or (numbers,).

        Returns (observation, reward, terminated, truncated, info); the observation is (observations,)
        float32 or what was asked for, a copy. ``info`` has the task's infos, "lost" where the world is,
        "reward_terms" by name if asked for.
        ValueError for a wrong shape and for a choice that there is not, TypeError for a wrong dtype.
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
        """The world as it is, (height, width, 3) uint8; None without a render_mode."""
        frames = self._frames.of(self.environment)
        return None if frames is None else frames[0]

    def view(self, **options: Any) -> LiveView:
        """A page that shows the world while it steps: ``manyworlds.view`` of the environment."""
        return view(self.environment, **options)

    def close(self) -> None:
        """Lets go of the world; later steps raise ValueError."""
        self.environment.close()


class RegisteredEnv(Env):
    """What ``gymnasium.make`` makes: its TimeLimit ends the episodes, after ``spec.max_episode_steps``."""

    def __init__(self, task: Union[Task, str], **arguments: Any) -> None:
        super().__init__(task, **{"max_episode_steps": 0, **arguments})
