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
# Attributes that each group of worlds has separately.
_OF_A_KIND = frozenset({"plan", "_choose", "_bodies", "_controls", "_joints", "_fields"})

__all__ = ["MAX_THREADS", "MAX_WORLDS", "Batch", "checked_batch"]


class Batch(Fields, Inputs, Results, InMemory):
    """Worlds of one scene that step together on several threads, with one SIMD lane per world.

    scene        a Scene, a Plan, or the name of a scene (``scenes.names()``). For worlds with
                 different plans a list [(scene, worlds), ...], all planar or all spatial, with the
                 same dt
    worlds       number of worlds; None: 1, or the sum of the list
    threads      number of threads; None: all that the process may use
    precision    precision of the state: "f32" or "f64"
    seed         world i draws from seed + i; 0 to 2**64 - 1
    isa          "scalar", "avx2", "avx512"; None: the environment variable MANYWORLDS_ISA, or the
                 widest that is available
    layout       layout of contacts: "automatic", "dense", "rows". Results are bitwise equal
    sleep        True: bodies at rest fall asleep, which saves most of their cost
    observe      observers: "motion", "contacts", ...; ``enumerations()`` lists all, and
                 ``batch.fields`` lists the fields of each
    rays         Rays that every world casts and observes
    points       Points of bodies whose positions and velocities are observed
    contacts_per_world  maximum number of observed contacts; 0: the maximum of the plan
    audit_every  interval in steps of the energy audit of a world (Status.diverged), at most 255;
                 0: no audit

    A world depends only on its scene, seed and inputs, not on the number of worlds or threads. Only
    one thread may use a batch at a time. Long calls release the GIL. A batch is a context manager,
    which closes it. Raises SceneError, ValueError, TypeError.

    Groups of worlds with different plans are stored one after the other. The batch steps, resets,
    saves and restores them together, and returns their status, hashes, energy and contacts by index
    in the batch. Arrays, controls and forces belong to a group: ``batch.kinds[k].get("position")``.
    In such a batch these methods of the batch, and rollouts, raise ValueError.
    """

    _views: tuple[Any, ...] = ()  # LiveViews that show the batch

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

    # -- properties

    @property
    def kinds(self) -> tuple[Kind, ...]:
        """The groups of worlds with the same plan, with their arrays. Usually one."""
        if self._kinds is None:
            kinds, first = [], 0
            for i, (plan, worlds) in enumerate(self._plans):
                kinds.append(Kind(self._held, plan, i, first, worlds, self._watched))
                first += worlds
            self._kinds = tuple(kinds)
        return self._kinds

    @property
    def worlds(self) -> int:
        """Number of worlds."""
        return self._worlds

    @property
    def bodies(self) -> int:
        """Rows of a world's arrays: its dynamic and kinematic bodies, in the order of the scene."""
        return self._bodies

    @property
    def dtype(self) -> np.dtype[Any]:
        """The dtype of the state: float32 or float64."""
        return self._real

    @property
    def precision(self) -> str:
        """The precision of the state: "f32" or "f64"."""
        return self._held.precision

    @property
    def threads(self) -> int:
        """Number of threads of a step."""
        return self._held.threads

    @property
    def isa(self) -> str:
        """The instruction set of the kernels: "scalar", "avx2" or "avx512"."""
        return self._held.isa

    @property
    def lanes(self) -> int:
        """Number of worlds in a SIMD register."""
        return self._held.lanes

    @property
    def kernel_table(self) -> str:
        """The name of the kernels, such as "avx2 f32 x8"."""
        return self._held.kernel_table

    @property
    def seed(self) -> int:
        """World i draws from seed + i, until a reset sets another seed (``seeds``)."""
        return self._held.seed

    def seeds(self, out: Optional[Writable] = None) -> NDArray[np.uint64]:
        """The seed of each world, (worlds,) uint64: seed + i, or the seed of its last reset."""
        array = arrays.output(out, (self._worlds,), ("worlds",), np.uint64)
        self._held.seeds(array)
        return array

    @property
    def bytes_per_world(self) -> int:
        """Size of the persistent state of a world, in bytes."""
        return self._held.bytes_per_world

    @property
    def time(self) -> float:
        """Simulated time since construction or reset of all worlds, in s."""
        return self._held.time

    @property
    def steps(self) -> int:
        """Number of steps since construction or reset of all worlds."""
        return self._held.steps

    @property
    def closed(self) -> bool:
        """Whether ``close`` was called."""
        return self._held.closed

    def close(self) -> None:
        """Frees the worlds. Every later use raises ValueError. A second call has no effect."""
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
        """Takes n steps of all worlds, or of some, without the GIL.

        ``controls``: sets the controls of the worlds that step; see set_controls. ``ids``: indices,
        or an array of bools (worlds,). Other worlds keep their state, forces and observations.
        ``time`` and ``steps`` count only steps of all worlds.

        Added forces act in all n steps and are then cleared. A world with an invalid state is
        frozen and flagged (``status``). A group of lanes steps as a whole, so a few scattered
        worlds cost as much as all worlds of their groups.

        Ctrl-C ends the call between two steps. ``steps`` is then the number of completed steps, and
        the batch can continue.
        """
        n = arrays.integer(n, "n", 0, MAX_STEPS)
        mask = None if ids is None else arrays.mask(ids, self._worlds)
        if controls is not None:
            self.set_controls(controls, ids)
        self._before_step(n)
        self._held.step(n, mask)
        self._after_step()

    # Before a step call, applies requests of live pages; after it, sends them the state.
    def _before_step(self, steps: int) -> None:
        for view in self._views:
            view._core.apply(steps)

    def _after_step(self) -> None:
        for view in self._views:
            view._core.show()

    def step_to(self, clock: float, max_steps: int = 8) -> int:
        """Takes whole steps until the simulated time reaches ``clock``, in s. Returns the number of
        steps.

        For hosts with a real-time clock. The simulated time does not exceed ``clock``, up to
        rounding. The call takes at most ``max_steps`` steps and drops the remaining time, so that a
        stalled host can catch up. Raises ValueError if ``clock`` is not finite or ``max_steps`` is
        negative.
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
        """Resets all worlds, or some, to a start state.

        ``reset()`` repeats: every world starts with the jitter and variations of its first episode,
        and the clock restarts at 0. The following calls draw new values, and the clock continues:

        ``reset(redraw=True)``   the draws of the next episode of each world
        ``reset(seed=s)``        draws from the seed s + i in world i, also in later resets
        ``reset(ids)``           the next episode of some worlds; with ``redraw=False`` their first

        ``mask_or_ids``: an array of bools (worlds,) is a mask, integers are world ids without
        repeats; None: all. ``seeds``: as ``seed``, or one seed per world of the reset, in the order
        of ids.

        ``keyframe``: a KeyframeId, name or index; worlds start with its values instead of drawn
        ones. With several scenes it selects the keyframe with this index in each scene. A name is
        looked up in the first scene.

        Raises ValueError if a world has no such keyframe (no world is reset), for two of seed,
        seeds and keyframe, and for ``redraw=False`` with a seed. Raises IndexError and TypeError
        for wrong ids.
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
        """Takes many steps in one call, without the GIL, and returns fields of the trajectory.

        ``initial``: a Snapshot of all worlds, or a dict of fields as in ``set``; None: the current
        state. ``controls``: (steps, worlds, controls), or an array that broadcasts along axes of
        length 1, such as (steps, 1, controls) for equal controls in all worlds. With ``steps``
        alone the controls stay as they are. ``out``: a dict of arrays to fill.

        Returns {field: (frames, worlds, items, components)} with frames = steps // every. A frame
        is taken after every ``every`` steps; the state before the first step is not included. The
        worlds keep the final state. Results are bitwise equal to those of single steps. Ctrl-C ends
        the call between two steps; later frames are not filled.
        """
        return rollout(self, initial, controls, steps, fields, every, out)


def checked_batch(batch: Any) -> Batch:
    """Returns ``batch``. Raises TypeError if it is not a Batch."""
    if not isinstance(batch, Batch):
        raise TypeError(f"batch is of type {type(batch).__name__}; expected a Batch")
    return batch
