"""Tasks as vector environments of Stable-Baselines3 (``pip install "manyworlds-sim[sb3]"``):

    from manyworlds.sb3 import VecEnv
    from stable_baselines3 import PPO
    PPO("MlpPolicy", VecEnv("LunarLander", num_envs=256)).learn(2_000_000)
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Optional, Union

import numpy as np
from ._distribution import needs
from .tasks import Task

with needs("gymnasium", extra="sb3", what="manyworlds.sb3"):
    from gymnasium.vector import AutoresetMode

    from .gym import VectorEnv
with needs("stable_baselines3", extra="sb3", what="manyworlds.sb3"):
    from stable_baselines3.common.vec_env import VecEnv as _VecEnv


class VecEnv(_VecEnv):  # type: ignore[misc]
    """A task in ``num_envs`` worlds. Other arguments are those of ``manyworlds.gym.VectorEnv``.

    As in Stable-Baselines3, the step that ends an episode also starts the next one.
    ``infos[i]["terminal_observation"]`` is the last observation of world i.
    ``"TimeLimit.truncated"`` is True if its episode was truncated. Wrap it in VecMonitor for
    statistics of episodes.
    """

    def __init__(self, task: Union[Task, str], num_envs: int = 1, **arguments: Any) -> None:
        arguments = {"autoreset_mode": AutoresetMode.SAME_STEP, "copy": True, **arguments}
        if AutoresetMode(arguments["autoreset_mode"]) != AutoresetMode.SAME_STEP:
            raise ValueError("Stable-Baselines3 requires AutoresetMode.SAME_STEP")
        self.env = VectorEnv(task, num_envs, **arguments)
        self.render_mode = self.env.render_mode
        self._actions: Optional[np.ndarray] = None
        spaces = self.env.single_observation_space, self.env.single_action_space
        super().__init__(num_envs, *spaces)

    def reset(self) -> np.ndarray:
        """Starts an episode in every world: the first one of the seeds from ``seed``, else the
        next.

        Returns observations (num_envs, observations) float32.
        """
        seeds = list(getattr(self, "_seeds", None) or [None] * self.num_envs)
        observations, _ = self.env.reset(seed=seeds)
        self._reset_seeds()
        self._reset_options()
        self.reset_infos: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        return observations

    def step_async(self, actions: np.ndarray) -> None:
        """Stores the actions, (num_envs,) or (num_envs, numbers), for ``step_wait``."""
        self._actions = np.asarray(actions)

    def step_wait(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, list[dict[str, Any]]]:
        """Steps. Returns (observations, rewards, ended, infos).

        These are float32, float32 and bool arrays, and a dict for each world. Raises RuntimeError
        without actions.
        """
        if self._actions is None:
            raise RuntimeError("step_wait without step_async")
        actions, self._actions = self._actions, None
        observations, rewards, terminated, truncated, infos = self.env.step(actions)
        ended = terminated | truncated
        out: list[dict[str, Any]] = [{} for _ in range(self.num_envs)]
        for i in np.flatnonzero(ended):
            out[i]["terminal_observation"] = infos["final_obs"][i]
            out[i]["TimeLimit.truncated"] = bool(truncated[i] and not terminated[i])
        return observations, rewards.astype(np.float32), ended, out

    def get_images(self) -> Sequence[Optional[np.ndarray]]:
        """An image of every world, (height, width, 3) uint8; empty without a render_mode."""
        return self.env.render() or ()

    def close(self) -> None:
        """Frees the worlds."""
        self.env.close()

    # Worlds are not separate objects: they share all attributes.

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        """An attribute of the VectorEnv, once for each of the worlds ``indices``."""
        owner = self if attr_name == "render_mode" else self.env
        return [getattr(owner, attr_name)] * len(self._chosen(indices))

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        """Raises NotImplementedError."""
        raise NotImplementedError("worlds have no individual attributes")

    def env_method(
        self, method_name: str, *method_args: Any, indices: Any = None, **method_kwargs: Any
    ) -> list[Any]:
        """Raises NotImplementedError."""
        raise NotImplementedError("worlds have no individual methods")

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:
        """False for each of the worlds ``indices``."""
        return [False] * len(self._chosen(indices))

    def _chosen(self, indices: Union[None, int, Sequence[int]]) -> list[int]:
        if indices is None:
            return list(range(self.num_envs))
        return [indices] if isinstance(indices, int) else list(indices)
