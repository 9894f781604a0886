"""Environment: a task in thousands of worlds; actions in, arrays out."""

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
Observations = NDArray[Any]  # float32, or the float64 that was asked for


class Environment(WithLevels, WithResults, WithSnapshots, InMemory):
    """A task in many worlds, one SIMD lane for each; what Gymnasium's classes are built on.

    task         a Task, or the name of one (``tasks.names()``)
    worlds       how many
    threads      None: as many as the process may run on
    seed         world i draws from seed + i; 0 to 2**64 - 1
    precision    "f32" or "f64": of the worlds and of expressions
    isa          "scalar", "avx2", "avx512"; None: the widest there is
    autoreset    what happens to a world whose episode has ended: with "next_step" the next step
                 begins its next episode instead of stepping it (reward 0, no end), with "same_step"
                 the step that ends it begins the next and ``final_observations`` has where it ended,
                 with "disabled" it steps on until it is reset
    check        True: ``step``, ``reset`` and ``begin`` raise NonFiniteError where an observation, a
                 reward or an end is not a finite number, after they have done all that they do
    reward_terms, final_observations  whether these arrays are filled by ``step``
    observation_dtype  "float32" or "float64": of observations

    What a world does depends on the task, its seed and its actions alone. The arrays of the last
    step or reset are ``observations`` (worlds, observations) float32, ``rewards`` (worlds,) float64,
    ``terminated`` and ``truncated`` (worlds,) bool, ``reward_terms`` (worlds, rewards) float64,
    ``infos`` (worlds, infos) float64, and ``final_observations`` and ``final_infos`` of "same_step":
    the same arrays in every step. ``lost_at_end`` (worlds,) bool says which worlds were lost at the end
    of the last step, also those that then began anew.

    A world with an observation, a reward or an end that is not a finite number is lost (``lost()``), and its
    episode is truncated, not terminated. The first such fault of each expression is a RuntimeWarning and
    in ``non_finite()``. Raises TaskError, ValueError, TypeError.
    An environment is used by one thread at a time.
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
        # Those that were filled last: the caller's or the environment's own.
        self._last = self.observations, self.terminated, self.truncated
        # Those of a step that was ended early, in the order of the extension.
        self._unfilled: Optional[tuple[Any, ...]] = None
        self.begin()

    # -- what it is

    @property
    def worlds(self) -> int:
        """How many there are."""
        return self._worlds

    @property
    def observation_names(self) -> list[str]:
        """Of the columns of ``observations``."""
        return [o.name for o in self.task.observations]

    @property
    def reward_names(self) -> list[str]:
        """Of the columns of ``reward_terms``."""
        return [r.name for r in self.task.rewards]

    @property
    def info_names(self) -> list[str]:
        """Of the columns of ``infos``."""
        return [i.name for i in self.task.infos]

    @property
    def action_shape(self) -> tuple[int, ...]:
        """(worlds,) of discrete tasks, whose actions are int64; else (worlds, numbers), float32."""
        return self._action_shape

    @property
    def batch(self) -> Batch:
        """The worlds: to look at, to save and restore, to change. Whoever changes them says so by
        ``begin``, for what the task remembers of them."""
        if self._batch is None or self._batch.closed:
            self._batch = _OwnBatch(self)
        return self._batch

    @property
    def closed(self) -> bool:
        """Whether ``close`` was called."""
        return self._held.closed

    def close(self) -> None:
        """Lets go of the worlds; every later use raises ValueError. Twice is once."""
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
        """One step of the task in every world, without the GIL.

        ``actions``: (worlds,) integers below ``task.choices`` or (worlds, numbers), of any dtype;
        int64 and float32 are taken without a copy. An action beyond its range counts as the end of
        the range, or as given where it is not clamped (``Action``); one that is not a number freezes its
        world, which is then lost and truncated. A choice that there is not raises ValueError before
        anything is done.

        Arrays that are given are filled in place of the environment's own, and returned; they may be
        whatever ``Batch.get`` takes as ``out``. Returns (observations, rewards, terminated, truncated).

        Ctrl-C, and what a signal's handler raises, ends a step that takes longer than some 0.2 s between
        two of its physics steps. The arrays are then as they were, ``steps_left`` says how many physics
        steps are still to take, and until ``finish_step``, or a reset, begin or restore of all worlds,
        other calls that step, begin, copy or save worlds raise ValueError.
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
        except BaseException as error:  # whatever a signal's handler raised
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
        """Takes a step that Ctrl-C ended early to its end, with its actions and into its arrays.

        What comes of it has the bits of a step that was not ended, but for forces that were added to
        ``batch`` before: they act up to where it was. Returns what ``step`` would have; Ctrl-C ends it
        early as it does ``step``. Raises ValueError when no step was ended early.
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
        """Physics steps that a step which was ended early has still to take; 0: none was."""
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

    # -- beginnings

    def reset(
        self,
        mask_or_ids: Optional[Ids] = None,
        seeds: Optional[Seeds] = None,
        observations: Optional[Writable] = None,
        *,
        seed: Optional[int] = None,
        redraw: Optional[bool] = None,
    ) -> Observations:
        """Starts the next episodes of all worlds or of some.

        ``reset()`` draws anew, as Gymnasium's does: the draws that follow those of the episode before.
        ``reset(seed=s)`` draws from the seed s + i in world i; ``reset(redraw=False)`` repeats the first
        episode of the seeds that the worlds have. With a seed, and with ``redraw=False``, levels start
        again, too. ``mask_or_ids``: an array of bools (worlds,) is a mask, integers are ids of worlds
        without repeats; None: all. ``seeds``: as ``seed``, or one for every world that is reset, in the
        order of ids. Returns observations; those of the other worlds stay. Raises ValueError for seed
        and seeds, and for ``redraw=False`` with one of them; IndexError and TypeError for wrong ids.
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
        """Worlds begin an episode in the state that they have; see ``reset``."""
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
