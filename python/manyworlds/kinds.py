"""Kind: the worlds with the same plan in a batch of several scenes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Optional, Union, cast

import numpy as np
from numpy.typing import NDArray

from . import _core, arrays, scenes, shown
from .fields import Fields
from .ids import Chooser
from .in_memory import InMemory
from .inputs import Inputs
from .plan import Plan
from .scene import Scene

MAX_WORLDS = 100_000_000

AnyScene = Union[Scene, Plan, str]


def plan_of(scene: Any, name: str = "scene") -> Plan:
    """The Plan of a Scene, a Plan or a scene's name. Raises TypeError, SceneError, ValueError."""
    if isinstance(scene, str):
        scene = scenes.load(scene)
    if not isinstance(scene, (Scene, Plan)):
        found = type(scene).__name__
        raise TypeError(f"{name} is of type {found}; expected a Scene, a Plan or a name")
    return scene if isinstance(scene, Plan) else Plan(scene)


def plans_of(
    scene: Union[AnyScene, Sequence[tuple[AnyScene, int]]], worlds: Optional[int]
) -> list[tuple[Plan, int]]:
    """(plan, worlds) of each group of worlds, from the arguments of a Batch."""
    if not isinstance(scene, (list, tuple)):
        count = 1 if worlds is None else worlds
        return [(plan_of(scene), arrays.integer(count, "worlds", 1, MAX_WORLDS))]
    if worlds is not None:
        raise ValueError("worlds is set for each kind, [(scene, worlds), ...]; do not pass the argument worlds")
    if not scene:
        raise ValueError("scene is empty; expected [(scene, worlds), ...]")
    plans = []
    for i, pair in enumerate(scene):
        if not isinstance(pair, (list, tuple)) or len(pair) != 2:
            raise TypeError(f"kind {i} is {shown.short(pair)}; expected (scene, worlds)")
        plan = plan_of(pair[0], f"the scene of kind {i}")
        plans.append((plan, arrays.integer(pair[1], f"worlds of kind {i}", 1, MAX_WORLDS)))
    return plans


class _Core:
    """The core of a batch, with world indices that start at the first world of a kind."""

    def __init__(self, core: _core.Batch, kind: int, first: int) -> None:
        self._core, self._kind, self._first = core, kind, first

    def __getattr__(self, name: str) -> Any:  # closed, precision, ...
        return getattr(self._core, name)

    def _world(self, worlds: NDArray[np.int32]) -> NDArray[np.int32]:
        return worlds + np.int32(self._first)

    @property
    def seed(self) -> int:
        return (self._core.seed + self._first) % 2**64

    def quantities(self) -> Any:
        return self._core.quantities(self._kind)

    def read(self, name: str, out: Any, worlds: Any) -> None:
        self._core.read(name, out, worlds, self._kind)

    def write(self, name: str, numbers: Any, worlds: Any) -> None:
        # Written world by world, as doubles.
        self._core.write(name, np.ascontiguousarray(numbers, np.float64), worlds, self._kind)

    def blocks(self, name: str) -> Any:
        return self._core.blocks(name, self._kind)

    def lane_indices(self, out: Any) -> None:
        self._core.lane_indices(out, self._kind)

    def read_controls(self, out: Any) -> None:
        self._core.read_controls(out, self._kind)

    def write_controls(self, numbers: Any, worlds: Any) -> None:
        self._core.write_controls(numbers, worlds, self._kind)

    def apply_external(self, what: str, worlds: Any, *rest: Any) -> None:
        self._core.apply_external(what, self._world(worlds), *rest)

    def spawn(self, worlds: Any, *rest: Any) -> None:
        self._core.spawn(self._world(worlds), *rest)

    def set_enabled(self, worlds: Any, *rest: Any) -> None:
        self._core.set_enabled(self._world(worlds), *rest)

    def set_joints_enabled(self, worlds: Any, *rest: Any) -> None:
        self._core.set_joints_enabled(self._world(worlds), *rest)

    def enabled(self, out: Any) -> None:
        self._core.enabled(out, self._kind)

    def joints_enabled(self, out: Any) -> None:
        self._core.joints_enabled(out, self._kind)

    def asleep(self, out: Any) -> None:
        self._core.asleep(out, self._kind)

    def wake(self, worlds: Any) -> None:
        self._core.wake(self._world(worlds))

    def set_rays(self, rays: Any, world: Optional[int]) -> None:
        if world is None:
            raise ValueError("all kinds have the same rays; pass a world, or use Batch.set_rays")
        self._core.set_rays(rays, self._first + world)


class Kind(Fields, Inputs, InMemory):
    """The worlds with the same plan in a batch, ``batch.kinds[k]``: arrays, controls, forces.

    Methods work as those of a Batch with only these worlds, indexed from 0: fields are (worlds,
    items, components), and ``ids`` are indices in this group. Only the batch steps, resets, and has
    results and snapshots. World i of the group has index ``first + i`` in the batch. ``slice``
    selects these worlds from arrays of the batch: ``batch.status()[kind.slice]``.
    """

    _instead = "pickle its plan"

    def __init__(
        self, core: _core.Batch, plan: Plan, kind: int, first: int, worlds: int, watched: frozenset[str]
    ) -> None:
        self.plan = plan
        self.first = first
        self._held = cast(_core.Batch, _Core(core, kind, first))
        self._worlds = worlds
        self._real = np.dtype(np.float32 if core.precision == "f32" else np.float64)
        self._watched = watched
        self._bodies = plan.bodies
        self._controls = core.controls(kind)
        self._joints = plan.joints
        self._choose = Chooser(plan)
        self._planar = plan.scene.space == "planar"
        self._find_fields()

    @property
    def worlds(self) -> int:
        """Number of worlds of this group."""
        return self._worlds

    @property
    def bodies(self) -> int:
        """Rows of a world's arrays: its dynamic and kinematic bodies, in the order of the scene."""
        return self._bodies

    @property
    def slice(self) -> slice:
        """The indices of these worlds in arrays over all worlds of the batch."""
        return slice(self.first, self.first + self._worlds)

    def __repr__(self) -> str:
        worlds = f"{self._worlds} world" + ("" if self._worlds == 1 else "s")
        return shown.line("Kind", self.plan.scene.name, worlds, f"{self._bodies} bodies")
