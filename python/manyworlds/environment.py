"""Environment: a task in thousands of worlds, with arrays of actions and results."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from . import _core, arrays, shown, tasks
from .arrays import Writable
from .batch import MAX_THREADS, MAX_WORLDS, Batch
from .environment_snapshot import EnvironmentSnapshot as EnvironmentSnapshot
from .environment_snapshot import WithSnapshots
from .in_memory import InMemory
from .levels import WithLevels
from .names import Autoreset, Ids, Isa, Precision, Seeds
from .own_batch import _OwnBatch
from .plan import Plan
from .task_results import NonFinite as NonFinite
from .task_results import WithResults
from .tasks import Task, TaskError

Doubles = NDArray[np.float64]
Flags = NDArray[np.bool_]
Observations = NDArray[Any]  # float32, or float64 by observation_dtype


class Environment(WithLevels, WithResults, WithSnapshots, InMemory):
    """A task in many worlds, with one SIMD lane per world. The base of the Gymnasium classes.

    task         a Task or its name (``tasks.names()``)
    worlds       number of worlds
    threads      number of threads; None: all that the process may use
    seed         world i draws from seed + i; 0 to 2**64 - 1
    precision    precision of the worlds and of expressions: "f32" or "f64"
    isa          "scalar", "avx2", "avx512"; None: as in Batch
    autoreset    the treatment of a world after the end of its episode. "next_step": the next step
                 resets it instead of stepping it, with reward 0 and no end. "same_step": the step
                 that ends the episode also resets the world, and ``final_observations`` has the
                 last observations. "disabled": the world steps on until it is reset
    check        True: ``step``, ``reset`` and ``begin`` raise NonFiniteError, after all their work,
                 if an observation, a reward or an end is not finite
    reward_terms, final_observations  whether ``step`` fills these arrays
    observation_dtype  dtype of observations: "float32" or "float64"

    A world depends only on the task, its seed and its actions. The following arrays hold the
    results of the last step or reset. They are the same objects in every step:

    observations                      (worlds, observations), float32 by default
    rewards                           (worlds,) float64
    terminated, truncated             (worlds,) bool
    reward_terms                      (worlds, rewards) float64
    infos                             (worlds, infos) float64
    final_observations, final_infos   the last values of an episode, with "same_step"
    lost_at_end                       (worlds,) bool: worlds lost at the end of the last step, even
                                      if they were reset in it

    A world is lost (``lost()``) if an observation, a reward or an end is not finite. Its episode is
    then truncated, not terminated. The first fault of each expression is a RuntimeWarning and an
    entry of ``non_finite()``. Only one thread may use an environment at a time. Raises TaskError,
    ValueError, TypeError.
    """

    _instead = "pickle its task, the arguments that it was made with, and save()"

    def __init__(
        self,
        task: Union[Task, str],
        worlds: int = 1,
        threads: Optional[int] = None,
        seed: int = 0,
        precision: Precision = "f32",
        isa: Optional[Isa] = None,
        autoreset: Autoreset = "next_step",
        *,
        check: bool = False,
        reward_terms: bool = False,
        final_observations: Optional[bool] = None,
        observation_dtype: DTypeLike = np.float32,
    ) -> None:
        if isinstance(task, str):
            task = tasks.load(task)
        if not isinstance(task, Task):
            found = type(task).__name__
            raise TypeError(f"task is of type {found}; expected a Task or a name")
        issues = task.validate()
        if issues:
            raise TaskError(issues)
        self.task = task
        self._worlds = arrays.integer(worlds, "worlds", 1, MAX_WORLDS)
        count = 0 if threads is None else arrays.integer(threads, "threads", 1, MAX_THREADS)
        seed = arrays.integer(seed, "seed", 0, 2**64 - 1)
        self._plan = Plan(task.scene)  # of now: the task is its maker's
        self._named_faults = 0  # expressions that were warned of
        self._held = _core.Environment(
            task, self._worlds, count, seed, precision, isa, autoreset, bool(check)
        )
        self.autoreset: str = autoreset.replace("-", "_")
        self.discrete = task.choices > 0
        n, seen, parts = self._worlds, len(task.observations), len(task.rewards)
        kind = np.dtype(observation_dtype)
        if kind not in (np.float32, np.float64):
            raise ValueError(f"observation_dtype is {kind}; expected float32 or float64")
        self.observations: Observations = np.zeros((n, seen), kind)
        self.rewards: Doubles = np.zeros(n, np.float64)
        self.terminated: Flags = np.zeros(n, np.bool_)
        self.truncated: Flags = np.zeros(n, np.bool_)
        self.lost_at_end: Flags = np.zeros(n, np.bool_)
        self.reward_terms: Optional[Doubles] = np.zeros((n, parts)) if reward_terms else None
        if final_observations is None:
            final_observations = self.autoreset == "same_step"
        self.final_observations: Optional[Observations] = (
            np.zeros((n, seen), kind) if final_observations else None
        )
        self.infos: Doubles = np.zeros((n, len(task.infos)))
        same = self.autoreset == "same_step"
        self.final_infos: Optional[Doubles] = np.zeros_like(self.infos) if same else None
        self._action_shape = (n,) if self.discrete else (n, len(task.actions))
        self._action_type = np.dtype(np.int64 if self.discrete else np.float32)
        self._step = self._held.step_choices if self.discrete else self._held.step_numbers
        self._batch: Optional[Batch] = None
        # The arrays that were filled last, the caller's or the environment's.
        self._last = self.observations, self.terminated, self.truncated
        # The arrays of a step that was ended early, in the order of the extension.
        self._unfilled: Optional[tuple[Any, ...]] = None
        self.begin()

    # -- properties

    @property
    def worlds(self) -> int:
        """Number of worlds."""
        return self._worlds

    @property
    def observation_names(self) -> list[str]:
        """Names of the columns of ``observations``."""
        return [o.name for o in self.task.observations]

    @property
    def reward_names(self) -> list[str]:
        """Names of the columns of ``reward_terms``."""
        return [r.name for r in self.task.rewards]

    @property
    def info_names(self) -> list[str]:
        """Names of the columns of ``infos``."""
        return [i.name for i in self.task.infos]

    @property
    def action_shape(self) -> tuple[int, ...]:
        """(worlds,) for discrete tasks, with int64 actions; else (worlds, numbers), float32."""
        return self._action_shape

    @property
    def batch(self) -> Batch:
        """The Batch of the worlds, to inspect, save, restore or change them.

        Call ``begin`` after changes, so that memories and observations follow the new state.
        """
        if self._batch is None or self._batch.closed:
            self._batch = _OwnBatch(self)
        return self._batch

    @property
    def closed(self) -> bool:
        """Whether ``close`` was called."""
        return self._held.closed

    def close(self) -> None:
        """Frees the worlds. Every later use raises ValueError. A second call has no effect."""
        if self._batch is not None:
            self._batch.close()
        self._held.close()

    def __enter__(self) -> Environment:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        if self.closed:
            return "<manyworlds.Environment: closed>"
        return shown.line(
            "Environment",
            self.task.name,
            f"{self._worlds} world" + ("" if self._worlds == 1 else "s"),
            f"{self.task.choices} choices" if self.discrete else f"{self._action_shape[1]} actions",
            f"{self.observations.shape[1]} observations",
            f"autoreset {self.autoreset}",
        )

    def _repr_html_(self) -> Optional[str]:
        from .page import cell_of

        return cell_of(self)

    # -- stepping

    def step(
        self,
        actions: ArrayLike,
        observations: Optional[Writable] = None,
        rewards: Optional[Writable] = None,
        terminated: Optional[Writable] = None,
        truncated: Optional[Writable] = None,
        reward_terms: Optional[Writable] = None,
        final_observations: Optional[Writable] = None,
    ) -> tuple[Observations, Doubles, Flags, Flags]:
        """Takes one step of the task in all worlds, without the GIL.

        ``actions``: (worlds,) integers below ``task.choices`` or (worlds, numbers), of any dtype.
        int64 and float32 are not copied. An action is clamped to its range, unless its ``Action``
        has ``clamped=False``. NaN freezes its world, which is then lost and truncated. An invalid
        choice raises ValueError before the step.

        Optional arrays are filled instead of the environment's arrays, and returned. They have the
        same requirements as ``out`` of ``Batch.get``. Returns (observations, rewards, terminated,
        truncated).

        Ctrl-C, or an exception in a signal handler, ends a step that takes longer than about 0.2 s,
        between two physics steps. The arrays then keep their values, and ``steps_left`` is the
        number of remaining physics steps. Other calls that step, begin, copy or save worlds then
        raise ValueError, until ``finish_step``, or a reset, begin or restore of all worlds.
        """
        observations = self._out("observations", observations)
        rewards = self._out("rewards", rewards)
        terminated = self._out("terminated", terminated)
        truncated = self._out("truncated", truncated)
        if reward_terms is None:
            reward_terms = self.reward_terms
        else:
            shape = self._worlds, len(self.task.rewards)
            axes = "worlds", "rewards"
            reward_terms = arrays.output(reward_terms, shape, axes, np.float64, "reward_terms")
        if final_observations is None:
            final_observations = self.final_observations
        else:
            final_observations = arrays.output(
                final_observations,
                self.observations.shape,
                ("worlds", "observations"),
                self.observations.dtype,
                "final_observations",
            )
        given = self._actions(actions)
        told = (self.infos, self.final_infos) if self.task.infos else (None, None)
        out = observations, rewards, terminated, truncated, reward_terms, final_observations
        out += *told, self.lost_at_end
        if self._batch is not None:
            self._batch._before_step(self.task.frame_skip)
        try:
            faults = self._step(given, *out)
        except BaseException as error:  # also exceptions of signal handlers
            if self._unfilled is None and self.steps_left > 0:
                self._unfilled = out
            if isinstance(error, _core.NonFiniteError):  # the step was taken
                self._named_faults = len(self.non_finite())
                self._stepped(observations, terminated, truncated)
            raise
        self._stepped(observations, terminated, truncated)
        if faults > self._named_faults:
            self._warn(2)
        return observations, rewards, terminated, truncated

    def _stepped(self, observations: Observations, terminated: Flags, truncated: Flags) -> None:
        self._last = observations, terminated, truncated
        if self._batch is not None:
            self._batch._after_step()

    def finish_step(self) -> tuple[Observations, Doubles, Flags, Flags]:
        """Completes a step that Ctrl-C ended early, with the same actions and arrays.

        The results are bitwise equal to those of an uninterrupted step, with one exception: forces
        added to ``batch`` act only until the interruption. Returns the results of ``step``. Ctrl-C
        can end it early, too. Raises ValueError if no step was ended early.
        """
        if self._unfilled is None:
            raise ValueError("no step was interrupted")
        observations, rewards, terminated, truncated = self._unfilled[:4]
        try:
            faults = self._held.finish_step(*self._unfilled)
        finally:
            if self.steps_left == 0:
                self._unfilled = None
                self._last = observations, terminated, truncated
        if faults > self._named_faults:
            self._warn(2)
        return observations, rewards, terminated, truncated

    @property
    def steps_left(self) -> int:
        """Remaining physics steps of a step that was ended early; 0 if there is none."""
        return self._held.steps_left

    def _out(self, name: str, given: Optional[Writable]) -> NDArray[Any]:
        own: NDArray[Any] = getattr(self, name)
        if given is None or given is own:
            return own
        axes = ("worlds", "observations")[: own.ndim]
        return arrays.output(given, own.shape, axes, own.dtype, name)

    def _actions(self, actions: ArrayLike) -> NDArray[Any]:
        choices = self.task.choices if self.discrete else None
        return arrays.actions(actions, self._action_shape, choices)

    # -- starts of episodes

    def reset(
        self,
        mask_or_ids: Optional[Ids] = None,
        seeds: Optional[Seeds] = None,
        observations: Optional[Writable] = None,
        *,
        seed: Optional[int] = None,
        redraw: Optional[bool] = None,
    ) -> Observations:
        """Starts new episodes in all worlds or in some.

        ``reset()`` draws new values, as Gymnasium does: the draws of the next episode.
        ``reset(seed=s)`` draws from the seed s + i in world i. ``reset(redraw=False)`` repeats the
        first episode of the current seeds. With a seed, and with ``redraw=False``, levels restart,
        too.

        ``mask_or_ids``: an array of bools (worlds,) is a mask, integers are world ids without
        repeats; None: all. ``seeds``: as ``seed``, or one seed per world of the reset, in the order
        of ids. Returns observations; those of other worlds do not change.

        Raises ValueError for seed with seeds, and for ``redraw=False`` with one of them. Raises
        IndexError and TypeError for wrong ids.
        """
        seeds = arrays.one_seed(seed, seeds, redraw)
        mask = arrays.mask(mask_or_ids, self._worlds)
        observations = self._out("observations", observations)
        own = arrays.seeds(seeds, mask_or_ids, self._worlds)
        if redraw is not None and not redraw:  # as from those that they have
            own = np.empty(self._worlds, np.uint64)
            self._held.batch().seeds(own)
        self._begin(mask, observations, self._held.reset, mask, own)
        return observations

    def begin(
        self, mask_or_ids: Optional[Ids] = None, observations: Optional[Writable] = None
    ) -> Observations:
        """Starts an episode in worlds at their current state; arguments as in ``reset``."""
        mask = arrays.mask(mask_or_ids, self._worlds)
        observations = self._out("observations", observations)
        self._begin(mask, observations, self._held.begin, mask)
        return observations

    def _begin(
        self,
        mask: NDArray[np.uint8],
        observations: Observations,
        call: Callable[..., int],
        *arguments: Any,
    ) -> None:
        try:
            faults = call(*arguments, observations, self.infos if self.task.infos else None)
        except _core.NonFiniteError:  # the worlds have begun
            self._named_faults = len(self.non_finite())
            self._began(mask, observations)
            raise
        self._began(mask, observations)
        if faults > self._named_faults:
            self._warn(3)

    def _began(self, mask: NDArray[np.uint8], observations: Observations) -> None:
        chosen = mask.view(np.bool_)
        self.terminated[chosen] = False
        self.truncated[chosen] = False
        self.lost_at_end[chosen] = False
        self._unfilled = None
        self._last = observations, self.terminated, self.truncated
        if self._batch is not None:
            self._batch._after_step()

    def lost(self) -> Flags:
        """Which worlds are lost, (worlds,) bool: frozen, or out of their bounds."""
        return self.batch.lost()
