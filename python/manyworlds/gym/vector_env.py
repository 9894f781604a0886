"""VectorEnv: a task in thousands of worlds as a Gymnasium vector environment."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Optional, Union

import gymnasium
import numpy as np
from gymnasium.vector import AutoresetMode
from gymnasium.vector.utils import batch_space
from numpy.typing import DTypeLike, NDArray

from .. import arrays
from ..environment import Environment
from ..in_memory import InMemory
from ..live import LiveView, view
from ..names import Isa, Precision
from ..tasks import Task
from . import infos as task_infos
from . import rendering, spaces

Seed = Union[int, Sequence[Optional[int]], None]
_MAX_SEED = 2**64 - 1
MODES = {
    AutoresetMode.NEXT_STEP: "next_step",
    AutoresetMode.SAME_STEP: "same_step",
    AutoresetMode.DISABLED: "disabled",
}


class VectorEnv(InMemory, gymnasium.vector.VectorEnv[NDArray[Any], NDArray[Any], NDArray[Any]]):
    """A task in ``num_envs`` worlds.

    task                a Task or its name
    max_episode_steps   replaces the task's value; 0: episodes have no maximum
    autoreset_mode      AutoresetMode or its value; see ``manyworlds.Environment``
    copy                False: ``reset`` and ``step`` return the same arrays every time
    seed                seed of the worlds until ``reset`` sets one; None: a random one
    reward_terms        True: ``infos["reward_terms"]`` has the terms of the reward by name
    threads, precision, isa, check, observation_dtype  as in ``manyworlds.Environment``
    render_mode         "rgb_array": ``render()`` draws every world (``manyworlds.plot``)

    ``reset(seed=s)`` starts the first episode of the seed s + i in world i, ``reset()`` the next
    episodes. ``infos["lost"]`` separates worlds with a fault, such as a NaN action, from worlds at
    their time limit. With SAME_STEP it is in ``infos["final_info"]``. ``environment`` is the
    Environment.
    """

    metadata: dict[str, Any] = {
        "render_modes": list(rendering.RENDER_MODES),
        "autoreset_mode": AutoresetMode.NEXT_STEP,
    }
    _instead = (
        "pickle its spec, or the task and arguments that it was made with, and environment.save()"
    )

    def __init__(
        self,
        task: Union[Task, str],
        num_envs: int = 1,
        *,
        max_episode_steps: Optional[int] = None,
        autoreset_mode: Union[AutoresetMode, str] = AutoresetMode.NEXT_STEP,
        copy: bool = True,
        seed: Optional[int] = None,
        reward_terms: bool = False,
        threads: Optional[int] = None,
        precision: Precision = "f32",
        isa: Optional[Isa] = None,
        check: bool = False,
        observation_dtype: DTypeLike = np.float32,
        render_mode: Optional[str] = None,
    ) -> None:
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.copy = copy
        self.task = spaces.task_of(task, max_episode_steps)
        self._frames = rendering.Frames(self.task, render_mode)
        self.render_mode = render_mode
        self.metadata = rendering.metadata(self.task) | {"autoreset_mode": self.autoreset_mode}
        if seed is None:
            seed = int(np.random.SeedSequence().generate_state(1)[0])
        self.environment = Environment(
            self.task,
            num_envs,
            threads,
            seed,
            precision,
            isa,
            MODES[self.autoreset_mode],  # type: ignore[arg-type]
            check=check,
            reward_terms=reward_terms,
            observation_dtype=observation_dtype,
        )
        self._told_of = list(task_infos.told(self.task.infos))
        self.num_envs = self.environment.worlds
        self.single_observation_space = spaces.observation_space(self.task, observation_dtype)
        self.single_action_space = spaces.action_space(self.task)
        self.observation_space = batch_space(self.single_observation_space, self.num_envs)
        self.action_space = batch_space(self.single_action_space, self.num_envs)
        self._resets_now = np.zeros(self.num_envs, np.bool_)  # with NEXT_STEP, the worlds that do

    # -- the contract

    def reset(
        self,
        *,
        seed: Seed = None,  # type: ignore[override]
        options: Optional[dict[str, Any]] = None,
    ) -> tuple[NDArray[Any], dict[str, Any]]:
        """Starts episodes in all worlds, or in those of ``options["reset_mask"]``.

        ``seed``: one seed, or one per world; None for a world: its next episode.
        """
        mask = self._reset_mask(options)
        seeds = self._seeds(seed)
        if seeds is None or isinstance(seeds, int):
            super().reset(seed=seeds)
            self.environment.reset(mask, seeds)
        else:
            given = mask & np.array([s is not None for s in seeds])
            chosen = np.flatnonzero(given)
            self.environment.reset(given, [seeds[i] for i in chosen])  # type: ignore[misc]
            self.environment.reset(mask & ~given)
        self._resets_now[mask] = False
        observations = self.environment.observations
        infos = self._told(self.environment.infos, mask, np.zeros_like(mask))
        return observations.copy() if self.copy else observations, infos

    def step(
        self, actions: NDArray[Any]
    ) -> tuple[NDArray[Any], NDArray[Any], NDArray[Any], NDArray[Any], dict[str, Any]]:
        """Takes one step of the task in all worlds.

        ``actions``: (num_envs,) integers or (num_envs, numbers). Returns (observations, rewards,
        terminated, truncated, infos). Arrays are (num_envs, observations) float32, (num_envs,)
        float64, and two of (num_envs,) bool, as copies unless ``copy`` is False.

        Raises ValueError for a wrong shape and an invalid choice, before the step, and TypeError
        for a dtype.
        """
        results = self.environment.step(actions)
        infos = self._infos()
        if self.copy:
            observations, rewards, terminated, truncated = results
            results = observations.copy(), rewards.copy(), terminated.copy(), truncated.copy()
        return *results, infos

    def render(self) -> Optional[tuple[NDArray[np.uint8], ...]]:  # type: ignore[override]
        """An image of the current state of every world, (height, width, 3) uint8; None without a
        mode.
        """
        return self._frames.of(self.environment)

    def view(self, **options: Any) -> LiveView:
        """A page that shows the worlds while they step: see ``manyworlds.view``."""
        return view(self.environment, **options)

    def close_extras(self, **kwargs: Any) -> None:
        """Frees the worlds. ``close`` calls it once."""
        self.environment.close()

    # -- parts of it

    def _reset_mask(self, options: Optional[dict[str, Any]]) -> NDArray[np.bool_]:
        if options is None or "reset_mask" not in options:
            return np.ones(self.num_envs, np.bool_)
        mask = options["reset_mask"]
        if not isinstance(mask, np.ndarray) or mask.dtype != np.bool_:
            found = f"dtype {mask.dtype}" if isinstance(mask, np.ndarray) else type(mask).__name__
            raise TypeError(f"options['reset_mask'] is of {found}; expected a NumPy array of bool")
        if mask.shape != (self.num_envs,):
            expected = f"({self.num_envs},)"
            raise ValueError(f"options['reset_mask'] has shape {mask.shape}; expected {expected}")
        if not mask.any():
            raise ValueError("options['reset_mask'] has no world to reset")
        return mask

    def _seeds(self, seed: Seed) -> Union[int, list[Optional[int]], None]:
        if seed is None:
            return None
        if np.ndim(seed) == 0:
            return arrays.integer(seed, "seed", 0, _MAX_SEED)
        seeds = list(seed)  # type: ignore[arg-type]
        if len(seeds) != self.num_envs:
            raise ValueError(f"seed has {len(seeds)} numbers, expected {self.num_envs}")
        return [None if s is None else arrays.integer(s, "a seed", 0, _MAX_SEED) for s in seeds]

    def _infos(self) -> dict[str, Any]:
        e, infos = self.environment, {}
        told = bool(self.task.infos)
        if e.reward_terms is None and not told and not (e.truncated.any() or e.terminated.any()):
            return infos
        ended = e.terminated | e.truncated
        every = np.ones_like(ended)
        if self.autoreset_mode == AutoresetMode.SAME_STEP:
            if ended.any():
                infos |= self._final(ended)
            infos |= self._told(e.infos, every, ~ended)
            if e.reward_terms is not None and not ended.all():
                infos |= self._reward_terms(~ended)
            return infos
        if e.reward_terms is not None or told:
            stepped = every
            if self.autoreset_mode != AutoresetMode.DISABLED:
                stepped = ~self._resets_now
                self._resets_now = ended
            infos |= self._told(e.infos, every, stepped)
            if e.reward_terms is not None and stepped.any():
                infos |= self._reward_terms(stepped)
        return infos | self._lost()

    def _lost(self) -> dict[str, Any]:
        lost = self.environment.lost_at_end
        return {"lost": lost.copy(), "_lost": lost.copy()} if lost.any() else {}

    def _told(
        self, values: NDArray[Any], mask: NDArray[np.bool_], stepped: NDArray[np.bool_]
    ) -> dict[str, Any]:
        """The task's infos for the worlds of a mask; infos of steps only for stepped worlds."""
        out: dict[str, Any] = {}
        for name, columns, of_steps_alone in self._told_of:
            of = mask & stepped if of_steps_alone else mask
            if of.any():
                own = values[:, columns]
                out[name] = np.where(of if own.ndim == 1 else of[:, None], own, 0)
                out["_" + name] = of.copy()
        return out

    def _final(self, ended: NDArray[np.bool_]) -> dict[str, Any]:
        e = self.environment
        assert e.final_observations is not None
        rows = np.flatnonzero(ended)
        last = np.full(self.num_envs, None, dtype=object)
        for row, observation in zip(rows, e.final_observations[rows]):
            last[row] = observation
        info = {} if e.reward_terms is None else self._reward_terms(ended)
        if e.final_infos is not None:
            info |= self._told(e.final_infos, ended, ended)
        info |= self._lost()
        return {
            "final_obs": last,
            "_final_obs": ended,
            "final_info": info,
            "_final_info": ended.copy(),
        }

    def _reward_terms(self, mask: NDArray[np.bool_]) -> dict[str, Any]:
        e = self.environment
        assert e.reward_terms is not None
        parts: dict[str, Any] = {}
        for name, column in zip(e.reward_names, e.reward_terms.T):
            parts[name] = np.where(mask, column, 0)
            parts["_" + name] = mask.copy()
        return {"reward_terms": parts, "_reward_terms": mask.copy()}
