"""Fields: the arrays of a batch, for ``Batch.get``, ``set`` and ``view``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core, arrays, draws, rotations
from .arrays import Writable
from .names import FieldName, Ids, SettableField
from .names import Field as StateField
from .plan import Plan
from .state_view import View


@dataclass(frozen=True, slots=True)
class Field:
    """Description of a field, whose array is (worlds, items, components)."""

    name: FieldName
    group: str  # "state", "parameter" (of the scene) or "observed"
    observer: str  # required for an observed field; else ""
    # Owner: "body", "shape", "joint", "control", "attractor", "world", "coordinate", "dof", "ray".
    item: str
    items: int
    components: int
    unit: str
    meaning: str
    dtype: np.dtype[Any]


class Fields:
    """Array access of Batch."""

    _held: _core.Batch
    _worlds: int
    _real: np.dtype[Any]
    _watched: frozenset[str]
    _fields: Mapping[FieldName, Field]
    _quaternion_starts: Optional[list[int]] = None
    plan: Plan

    def _find_fields(self) -> None:
        double = np.dtype(np.float64)
        found = {}
        for name, group, *rest in self._held.quantities():
            dtype = double if group == "parameter" else self._real
            found[name] = Field(name, group, *rest, dtype)
        self._fields = MappingProxyType(found)

    @property
    def fields(self) -> Mapping[FieldName, Field]:
        """All fields by name: state, scene parameters, and observed values."""
        return self._fields

    def _field(self, name: FieldName) -> Field:
        if not isinstance(name, str):
            raise TypeError(f"the field is of type {type(name).__name__}; expected a str")
        if name not in self._fields:
            raise ValueError("the field " + _core.unknown_name(name, list(self._fields)))
        field = self._fields[name]
        if field.observer and field.observer not in self._watched:
            given = field.item in ("ray", "point")  # of a list that chooses its observer
            wanted = f"{field.observer}=[...]" if given else f"observe=['{field.observer}']"
            raise ValueError(f"{name} is not observed; make the Batch with {wanted}")
        return field

    def _shape(self, field: Field, worlds: int) -> tuple[int, int, int]:
        return worlds, field.items, field.components

    @staticmethod
    def _axes(field: Field) -> tuple[str, str, str]:
        return "worlds", {"body": "bodies"}.get(field.item, field.item + "s"), "components"

    def get(
        self, name: FieldName, out: Optional[Writable] = None, ids: Optional[Ids] = None
    ) -> NDArray[Any]:
        """A field of all worlds, (worlds, items, components), or of the worlds ``ids`` in this
        order.

        State and observed fields have the precision of the batch (float32 or float64). Scene
        parameters are float64. Position is the position of the body's origin; velocity is the
        velocity of its centre of mass. ``fields[name].unit`` is the unit.

        ``ids``: a mask of bools (worlds,), or ids without repeats. ``out``: filled in place and
        returned. It must have this shape and dtype, and must be C-contiguous, writable and on the
        CPU. It may also support DLPack (a torch.Tensor) or the buffer protocol (a bytearray,
        array.array, memoryview of exactly this size). The call then returns an array over the same
        memory.

        Raises ValueError for an unknown or unobserved field and for an ``out`` with a wrong shape,
        TypeError for its dtype, IndexError for wrong ids.
        """
        field = self._field(name)
        worlds = None if ids is None else arrays.worlds(ids, self._worlds)
        shape = self._shape(field, self._worlds if worlds is None else len(worlds))
        axes = self._axes(field) if worlds is None else ("ids", *self._axes(field)[1:])
        array = arrays.output(out, shape, axes, field.dtype)
        self._held.read(name, array, worlds)
        return array

    def set(self, name: SettableField, values: ArrayLike, ids: Optional[Ids] = None) -> None:
        """Sets a state field or a scene parameter, in all worlds or in the worlds ``ids``.

        ``values``: (worlds, items, components), or (len(ids), items, components), or an array that
        broadcasts to this shape: a number, a row (components,), rows (items, components). Any
        dtype, order and strides are valid. ``ids``: a mask of bools (worlds,), or ids without
        repeats.

        Setting positions or orientations clears the stored impulses of these worlds and wakes all
        their bodies. A state that is not finite freezes its world at the next step (``status``).

        Raises ValueError, and changes nothing, for a wrong shape. Orientations must be finite and
        of length 1 (to 0.001); quaternions of ``generalized_position`` must be finite and not of
        length 0. A scene parameter must vary (Scene.variations), and its values must be in its
        range. Raises IndexError for wrong ids.
        """
        self._held.write(*self._to_write(name, values, ids))

    def randomize(
        self,
        name: SettableField,
        low: ArrayLike,
        high: ArrayLike,
        ids: Optional[Ids] = None,
        items: Optional[Ids] = None,
        seed: Optional[int] = None,
    ) -> None:
        """Draws a state field or a scene parameter uniformly from ``low`` to ``high``, and sets it.

        ``low``, ``high``: numbers, or arrays that broadcast to (items, components). ``ids`` selects
        worlds, ``items`` selects bodies, shapes, joints or controls (``fields[name].item``); None:
        all. World i draws from ``seed`` + i (None: the batch's seed) and the name of the field.
        Equal seeds give equal values in a batch of any size and in every call. Raises the errors of
        ``set``.
        """
        field = self._field(name)
        worlds = arrays.worlds(ids, self._worlds)
        chosen = arrays.indices(items, field.items, "items")
        first = self._held.seed if seed is None else arrays.integer(seed, "seed", 0, 2**64 - 1)
        shape = len(chosen), field.components
        axes = self._axes(field)[1:]
        lowest, highest = (
            arrays.broadcast(end, shape, axes, which, np.float64)
            for end, which in ((low, "low"), (high, "high"))
        )
        width = highest / 2 - lowest / 2  # halves avoid overflow
        if not (width >= 0).all() or not np.isfinite(width).all():
            raise ValueError("low and high must be finite numbers with low <= high")
        seeds = np.uint64(first) + worlds.astype(np.uint64)  # wraps around
        share = draws.uniform(seeds, name, shape[0] * shape[1]).reshape(len(worlds), *shape)
        values = self.get(name, ids=worlds).astype(np.float64)
        values[:, chosen] = lowest * (1 - share) + highest * share
        self.set(name, values, worlds)

    def _to_write(
        self, name: FieldName, values: ArrayLike, ids: Optional[Ids] = None
    ) -> tuple[FieldName, NDArray[Any], Optional[NDArray[np.int32]]]:
        """Checked values and indices for a write; ranges of parameters are not checked."""
        field = self._field(name)
        if field.group == "observed":
            raise ValueError(f"{name} is observed and cannot be set")
        if ids is None:
            dtype = np.float64 if field.group == "parameter" else None
            shape = self._shape(field, self._worlds)
            numbers = arrays.broadcast(values, shape, self._axes(field), name, dtype)
            rotations.check(name, numbers, None, self._rotations_in(name))
            return name, numbers, None
        worlds = arrays.worlds(ids, self._worlds)
        shape, axes = self._shape(field, len(worlds)), ("ids", *self._axes(field)[1:])
        numbers = arrays.broadcast(values, shape, axes, name, np.float64)
        rotations.check(name, numbers, worlds, self._rotations_in(name))
        return name, numbers, worlds

    def _rotations_in(self, name: FieldName) -> list[int]:
        """First indices of quaternions in a field of coordinates."""
        if name != "generalized_position" or not self._fields[name].items:
            return []
        if self._quaternion_starts is None:
            self._quaternion_starts = rotations.among_coordinates(self.plan, self._fields[name].items)
        return self._quaternion_starts

    def view(self, name: StateField) -> View:
        """Direct access to the memory of a state field: see View. Raises ValueError."""
        field = self._field(name)
        if field.group != "state":
            raise ValueError(f"{name} is not a state field; only those can be viewed in place")
        blocks = self._held.blocks(name)
        if blocks is None:
            raise ValueError(
                f"the plan has no {name}: no {field.item} has any (see Plan.text())"
            )
        return View(self._held, name, blocks)

    def lane_indices(self, out: Optional[Writable] = None) -> NDArray[np.int32]:
        """Indices of worlds in views, (worlds,) int32: index i is lane i % lanes of group i //
        lanes.

        With ``sleep`` steps may change them.
        """
        array = arrays.output(out, (self._worlds,), ("worlds",), np.int32)
        self._held.lane_indices(array)
        return array
