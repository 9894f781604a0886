"""Batch: worlds of one scene that step together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core, arrays, shown
from .arrays import Writable
from .fields import Fields
from .ids import Chooser, KeyframeRef
from .in_memory import InMemory
from .inputs import Inputs
from .kinds import MAX_WORLDS, AnyScene, Kind, plans_of
from .names import ContactLayout, FieldName, Ids, Isa, Observer, Precision, Seeds
from .results import Results
from .rollout import MAX_STEPS, Initial, Trajectories, rollout
from .scene import Point, Ray

MAX_THREADS = 1024
# What there is one of for each kind of world.
_OF_A_KIND = frozenset({"plan", "_choose", "_bodies", "_controls", "_joints", "_fields"})

__all__ = ["MAX_THREADS", "MAX_WORLDS", "Batch", "checked_batch"]


class Batch(Fields, Inputs, Results, InMemory):
    """Worlds of one scene, stepped together on several threads, one SIMD lane for each.

    scene        a Scene, a Plan, or the name of a scene (``scenes.names()``); for several kinds of
                 world a list [(scene, worlds), ...] of them, all planar or all spatial, of one dt
    worlds       how many; None: 1, or as the list says
    threads      None: as many as the process may run on
    precision    "f32" or "f64": of the state
    seed         world i draws from seed + i; 0 to 2**64 - 1
    isa          "scalar", "avx2", "avx512"; None: the widest there is, or what the environment
                 variable MANYWORLDS_ISA says
    layout       of contacts: "automatic", "dense", "rows"; changes no bit
    sleep        bodies at rest fall asleep and cost little
    observe      what to watch beside the step: "motion", "contacts", ..., ``enumerations()`` has all;
                 ``batch.fields`` says which fields each gives
    rays         Rays that every world casts, which are observed then
    points       Points of bodies, whose places and velocities are observed then
    contacts_per_world  room for observed contacts; 0: as many as the plan has room for
    audit_every  each world's energy is audited in one of so many of its steps (Status.diverged);
                 0: never, at most 255

    What a world does depends on its scene, seed and inputs alone, not on the number of worlds or
    threads. Raises SceneError, ValueError, TypeError. A batch is used by one thread at a time; calls
    that take long let go of the GIL. It can be closed, also by ``with``.

    Worlds of several kinds lie one after the other. They step, are reset, saved, restored and looked at
    (status, hashes, energy, contacts) together, by their indices in the batch. Arrays, controls and
    forces are those of a kind, ``batch.kinds[k].get("position")``; the batch's own raise ValueError, and
    so do rollouts.
    """

    _views: tuple[Any, ...] = ()  # LiveViews that look on

    _instead = "pickle its scene or plan, the arguments that it was made with, and save()"

    def __init__(
        self,
        scene: Union[AnyScene, Sequence[tuple[AnyScene, int]]],
        worlds: Optional[int] = None,
        threads: Optional[int] = None,
        precision: Precision = "f32",
        seed: int = 0,
        isa: Optional[Isa] = None,
        layout: ContactLayout = "automatic",
        sleep: bool = False,
        observe: Sequence[Observer] = (),
        rays: Sequence[Ray] = (),
        contacts_per_world: int = 0,
        points: Sequence[Point] = (),
        audit_every: int = 16,
    ) -> None:
        plans = plans_of(scene, worlds)
        self._worlds = sum(count for _, count in plans)
        count = 0 if threads is None else arrays.integer(threads, "threads", 1, MAX_THREADS)
        seed = arrays.integer(seed, "seed", 0, 2**64 - 1)
        if not isinstance(sleep, (bool, np.bool_)):
            raise TypeError(f"sleep is of type {type(sleep).__name__}; expected a bool")
        self._held = _core.Batch(
            plans,
            count,
            seed,
            precision,
            isa,
            layout,
            bool(sleep),
            observe,
            rays,
            points,
            contacts_per_world,
            audit_every,
        )
        self._real = np.dtype(np.float32 if self._held.precision == "f32" else np.float64)
        self._watched = frozenset(name.replace("-", "_") for name in observe)
        given = {"rays": rays, "points": points}
        self._watched |= {name for name, some in given.items() if len(some) > 0}
        self._planar = plans[0][0].scene.space == "planar"
        self._plans = plans
        self._kinds: Optional[tuple[Kind, ...]] = None
        if len(plans) > 1:
            return
        self.plan = plans[0][0]
        self._bodies = self.plan.bodies
        self._controls = self._held.controls()
        self._joints = self.plan.joints
        self._choose = Chooser(self.plan)
        self._find_fields()

    if not TYPE_CHECKING:

        def __getattr__(self, name: str) -> Any:
            if name in _OF_A_KIND and "_plans" in self.__dict__:
                raise ValueError(
                    f"the batch has {len(self._plans)} kinds of worlds, each with its own plan, "
                    "arrays, controls and bodies: use batch.kinds[0] for the first"
                )
            raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}")

    # -- what it is

    @property
    def kinds(self) -> tuple[Kind, ...]:
        """The worlds of each kind, with their arrays; one kind, unless it was made of several."""
        if self._kinds is None:
            kinds, first = [], 0
            for i, (plan, worlds) in enumerate(self._plans):
                kinds.append(Kind(self._held, plan, i, first, worlds, self._watched))
                first += worlds
            self._kinds = tuple(kinds)
        return self._kinds

    @property
    def worlds(self) -> int:
        """How many there are."""
        return self._worlds

    @property
    def bodies(self) -> int:
        """Rows of a world's arrays: its dynamic and kinematic bodies, in the order of the scene."""
        return self._bodies

    @property
    def dtype(self) -> np.dtype[Any]:
        """Of the state: float32 or float64."""
        return self._real

    @property
    def precision(self) -> str:
        """Of the state: "f32" or "f64"."""
        return self._held.precision

    @property
    def threads(self) -> int:
        """On which it steps."""
        return self._held.threads

    @property
    def isa(self) -> str:
        """The instruction set of its kernels: "scalar", "avx2" or "avx512"."""
        return self._held.isa

    @property
    def lanes(self) -> int:
        """Worlds that share a register."""
        return self._held.lanes

    @property
    def kernel_table(self) -> str:
        """Which kernels step it: "avx2 f32 x8"."""
        return self._held.kernel_table

    @property
    def seed(self) -> int:
        """World i draws from seed + i, until a reset gives it another seed (``seeds``)."""
        return self._held.seed

    def seeds(self, out: Optional[Writable] = None) -> NDArray[np.uint64]:
        """The seed that each world draws from, (worlds,) uint64: seed + i, or what a reset gave it."""
        array = arrays.output(out, (self._worlds,), ("worlds",), np.uint64)
        self._held.seeds(array)
        return array

    @property
    def bytes_per_world(self) -> int:
        """Of persistent state."""
        return self._held.bytes_per_world

    @property
    def time(self) -> float:
        """Simulated since construction or reset of all worlds, s."""
        return self._held.time

    @property
    def steps(self) -> int:
        """Taken since construction or reset of all worlds."""
        return self._held.steps

    @property
    def closed(self) -> bool:
        """Whether ``close`` was called."""
        return self._held.closed

    def close(self) -> None:
        """Lets go of the worlds; every later use raises ValueError. Twice is once."""
        for view in self._views:
            view.close()
        self._held.close()

    def __enter__(self) -> Batch:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        if self.closed:
            return "<manyworlds.Batch: closed>"
        one = len(self._plans) == 1
        return shown.line(
            "Batch",
            self.plan.scene.name if one else "",
            f"{self._worlds} world" + ("" if self._worlds == 1 else "s"),
            f"{self._bodies} bodies" if one else f"{len(self._plans)} kinds",
            self.kernel_table,
            f"{self.threads} threads",
            f"{self.steps} steps",
        )

    def _repr_html_(self) -> Optional[str]:
        from .page import cell_of

        return cell_of(self)

    # -- stepping

    def step(
        self, n: int = 1, controls: Optional[ArrayLike] = None, ids: Optional[Ids] = None
    ) -> None:
        """Takes n steps of every world, or of some, without the GIL.

        ``controls``: set before, for the worlds that step; see set_controls.
        Forces that were added act in all n steps and are cleared. A world that goes wrong is frozen
        and flagged (``status``). ``ids``: indices or a bool array (worlds,); the others keep their
        state, their forces and what was observed of them. ``time`` and ``steps`` are of steps of
        all worlds and stay. Ctrl-C ends the call between two steps; ``steps`` says how many were
        taken, and the batch goes on from there. Lanes step together: a few worlds here and there cost as much as their
        whole groups of lanes.
        """
        n = arrays.integer(n, "n", 0, MAX_STEPS)
        mask = None if ids is None else arrays.mask(ids, self._worlds)
        if controls is not None:
            self.set_controls(controls, ids)
        self._before_step(n)
        self._held.step(n, mask)
        self._after_step()

    # What pages asked for, before a call of so many steps, and what they see after it.
    def _before_step(self, steps: int) -> None:
        for view in self._views:
            view._core.apply(steps)

    def _after_step(self) -> None:
        for view in self._views:
            view._core.show()

    def step_to(self, clock: float, max_steps: int = 8) -> int:
        """Takes whole steps until the simulated time reaches ``clock``, in s, and returns how many.

        For hosts that run by a clock: never past it (but for up to half a rounding step), at most
        ``max_steps``, beyond which time is dropped, so that a host that stalled is not behind for ever.
        Raises ValueError for a clock that is not finite, and for ``max_steps`` below 0.
        """
        if isinstance(clock, (bool, np.bool_)) or not isinstance(clock, (int, float, np.number)):
            raise TypeError(f"clock is of type {type(clock).__name__}; expected a number of s")
        if not np.isfinite(clock):
            raise ValueError(f"clock is {clock}, must be finite")
        max_steps = arrays.integer(max_steps, "max_steps", 0, MAX_STEPS)
        self._before_step(max(max_steps, 1))
        taken = self._held.step_to(float(clock), max_steps)
        self._after_step()
        return taken

    def reset(
        self,
        mask_or_ids: Optional[Ids] = None,
        seeds: Optional[Seeds] = None,
        keyframe: Optional[KeyframeRef] = None,
        *,
        seed: Optional[int] = None,
        redraw: Optional[bool] = None,
    ) -> None:
        """Starts all worlds again, or some.

        ``reset()`` repeats: every world starts with the same draws of jitter and variations as the
        first time, and the clock restarts. These calls draw new ones, and the clock goes on:

        ``reset(redraw=True)``   the draws that follow, of the next episode of each world
        ``reset(seed=s)``        from the seed s + i in world i, and later resets from there
        ``reset(ids)``           the next episode of some worlds; ``redraw=False`` repeats theirs

        ``mask_or_ids``: an array of bools (worlds,) is a mask, integers are ids of worlds without
        repeats; None: all. ``seeds``: as ``seed``, or one seed for every world that is reset, in the
        order of ids. ``keyframe``: a KeyframeId, name or index; worlds start with its values instead
        of drawn ones. With groups of several scenes it is the keyframe of that index in each, and a
        name is one of the first scene. Raises ValueError where a world has no such keyframe (and
        resets none), for two of seed, seeds, keyframe, and for ``redraw=False`` with a seed;
        IndexError and TypeError for wrong ids.
        """
        seeds = arrays.one_seed(seed, seeds, redraw)
        if redraw is None:
            redraw = mask_or_ids is not None
        if keyframe is not None:
            if seeds is not None:
                raise ValueError("seeds and keyframe are both given; expected one of them")
            if mask_or_ids is not None and not redraw:
                raise ValueError("redraw=False and a keyframe are given for some worlds only")
            index = int(self._plans[0][0].keyframe(keyframe))
            mask = arrays.mask(mask_or_ids, self._worlds) if redraw else None
            self._held.reset(mask, None, index)
        elif mask_or_ids is None and seeds is None and not redraw:
            self._held.reset(None, None, None)
        else:
            mask = arrays.mask(mask_or_ids, self._worlds)
            given = arrays.seeds(seeds, mask_or_ids, self._worlds)
            if given is None and not redraw:
                given = self.seeds()
            self._held.reset(mask, given, None)
        self._after_step()

    def rollout(
        self,
        initial: Initial = None,
        controls: Optional[ArrayLike] = None,
        steps: Optional[int] = None,
        fields: Sequence[FieldName] = ("position",),
        every: int = 1,
        out: Optional[Mapping[str, Writable]] = None,
    ) -> Trajectories:
        """Takes many steps in one call, without the GIL, and returns what happened.

        ``initial``: a Snapshot of all worlds, or a dict of fields as ``set`` takes them; None: from
        where the worlds are. ``controls``: (steps, worlds, controls), or with axes of length 1 that
        broadcast, as (steps, 1, controls) for the same in all worlds; or ``steps`` alone, with the
        controls as they are. Returns {field: (frames, worlds, items, components)}
        with frames = steps // every, taken after every ``every`` steps; the state before the first
        step is none of them. ``out``: a dict of arrays to fill. The worlds stay where the rollout
        ends; the bits are those of stepping and reading one by one. Ctrl-C ends it
        early, between two steps; frames beyond are not filled.
        """
        return rollout(self, initial, controls, steps, fields, every, out)


def checked_batch(batch: Any) -> Batch:
    """``batch``, if it is one. TypeError."""
    if not isinstance(batch, Batch):
        raise TypeError(f"batch is of type {type(batch).__name__}; expected a Batch")
    return batch
