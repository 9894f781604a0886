"""Parameters of a search as parameters of a scene: its variations, and the values of each world."""

from __future__ import annotations

import copy
from dataclasses import dataclass
from typing import Any, Optional, get_args

import numpy as np
from numpy.typing import NDArray

from ..batch import Batch
from ..ids import ShapeId
from ..kinds import AnyScene, plan_of
from ..names import Draw
from ..names import Parameter as SceneParameter
from ..plan import Plan
from ..scene import Scene, Variation
from .space import Doubles, Number, Parameter, Space


@dataclass(frozen=True)
class _Write:
    """Writes a column of values to some items of a field."""

    column: int  # index of the parameter
    items: NDArray[np.intp]
    component: int
    factor: float
    offset: float


class Numbers:
    """The parameters that a space sets in a scene. ``scene`` is a copy with their variations.

    Raises ValueError and SceneError, which name the parameter or the variation.
    """

    def __init__(self, scene: AnyScene, space: Space) -> None:
        source = plan_of(scene)
        self.scene: Scene = copy.deepcopy(source.scene)
        self._writes: dict[str, list[_Write]] = {}
        wanted = [(i, p, n) for i, p in enumerate(space.parameters) for n in p.numbers]
        self.plan = source
        if not wanted:
            return
        taken: dict[tuple[str, int, int], str] = {}
        ranges: dict[tuple[str, int], tuple[Doubles, Doubles]] = {}
        with Batch(source, 1, threads=1) as one:
            fields = {str(n.parameter): one._field(n.parameter) for _, _, n in wanted}
            own = {name: one.get(name)[0].astype(np.float64) for name in fields}
        for column, parameter, number in wanted:
            field = fields[number.parameter]
            component = self._component(parameter, number, field.components)
            items = self._items(source, parameter, number, field.item)
            write = _Write(column, items, component, number.factor, number.offset)
            self._writes.setdefault(number.parameter, []).append(write)
            ends = sorted(
                number.offset + number.factor * x for x in (parameter.low, parameter.high)
            )
            for item in map(int, items):
                key = number.parameter, item, component
                if key in taken:
                    raise ValueError(
                        f"parameters {taken[key]!r} and {parameter.name!r} both set {number.parameter} "
                        f"of {field.item} {item}"
                    )
                taken[key] = parameter.name
                base = own[number.parameter][item]
                low, high = ranges.setdefault((number.parameter, item), (base.copy(), base.copy()))
                low[component], high[component] = ends
        for (name, item), (low, high) in ranges.items():
            where = self._named(source, fields[name].item, item)
            base = own[name][item]
            # Draw "none" costs no time at resets, but the range must contain the scene's value.
            keeps = bool(((low <= base) & (base <= high)).all())
            draw: Draw = "none" if keeps else "uniform"
            self.scene.add(_variation(name, low, high, {**where, "draw": draw}))
        self.plan = Plan(self.scene)
        # In the order in which the library applies them: a mass is set after sizes.
        order = get_args(SceneParameter)
        self._writes = {name: self._writes[name] for name in order if name in self._writes}

    def write(self, batch: Batch, values: Doubles) -> None:
        """Writes the values (worlds, parameters) to every world."""
        for name, writes in self._writes.items():
            array = batch.get(name)
            for w in writes:
                column = w.offset + w.factor * values[:, w.column]
                array[:, w.items, w.component] = column[:, None]
            batch.set(name, array)

    @staticmethod
    def _component(parameter: Parameter, number: Number, count: int) -> int:
        if number.component is None and count == 1:
            return 0
        if number.component is None or not 0 <= number.component < count:
            found = "none" if number.component is None else str(number.component)
            raise ValueError(
                f"parameter {parameter.name!r} sets {number.parameter}, which has {count} components; component "
                f"is {found}, expected 0 to {count - 1}"
            )
        return number.component

    # Rows of a field's array that a Number sets.
    def _items(
        self, plan: Plan, parameter: Parameter, number: Number, owner: str
    ) -> NDArray[np.intp]:
        try:
            if owner == "world":
                return np.zeros(1, np.intp)
            if owner == "body" and number.body != -1:
                return np.array([plan.row(number.body)], np.intp)
            if owner == "joint" and number.joint != -1:
                return np.array([int(plan.joint(number.joint))], np.intp)
            if owner == "control" and number.control != -1:
                return np.array([int(plan.control(number.control))], np.intp)
            if owner == "attractor" and number.attractor != -1:
                count = len(plan.scene.attractors)
                if not 0 <= number.attractor < count:
                    raise IndexError(f"attractor is {number.attractor}, must be one of {count}")
                return np.array([number.attractor], np.intp)
            if owner == "shape" and (number.body != -1 or number.shape != -1):
                return np.array([plan.row(s) for s in _shapes(plan, number)], np.intp)
        except (ValueError, IndexError, TypeError) as error:
            raise type(error)(f"parameter {parameter.name!r}: {error}") from None
        return self._all(plan, parameter, number)

    # All items with the parameter: those whose draws differ in two worlds.
    def _all(self, plan: Plan, parameter: Parameter, number: Number) -> NDArray[np.intp]:
        scene = copy.deepcopy(plan.scene)
        ends = np.array([parameter.low, parameter.high]) * number.factor + number.offset
        low, high = np.full(3, ends.min()), np.full(3, ends.max())
        scene.add(_variation(number.parameter, low, high, {}))
        with Batch(scene, 2, threads=1) as two:
            drawn = two.get(number.parameter)
        found = np.flatnonzero((drawn[0] != drawn[1]).any(axis=1))
        if not found.size:
            raise ValueError(
                f"parameter {parameter.name!r} sets {number.parameter}, which nothing in the scene has"
            )
        return found

    # Members of a Variation that select one item.
    @staticmethod
    def _named(plan: Plan, owner: str, item: int) -> dict[str, Any]:
        if owner == "body":
            return {"body": int(plan.body_in_row(item))}
        if owner == "shape":
            for b, body in enumerate(plan.scene.bodies):
                if item < len(body.shapes):
                    return {"body": b, "shape": item}
                item -= len(body.shapes)
        return {} if owner == "world" else {owner: item}


def _shapes(plan: Plan, number: Number) -> list[ShapeId]:
    scene = plan.scene
    if isinstance(number.shape, ShapeId):
        return [number.shape]
    if isinstance(number.shape, str):
        return [plan.shape(number.shape, None if number.body == -1 else number.body)]
    body = plan.body(number.body)
    count = len(scene.bodies[int(body)].shapes)
    if number.shape == -1:
        return [ShapeId(body, i) for i in range(count)]
    if not 0 <= number.shape < count:
        raise IndexError(f"shape is {number.shape}, must be 0 to {count - 1} of body {int(body)}")
    return [ShapeId(body, number.shape)]


def _variation(
    name: Any, low: Doubles, high: Doubles, where: Optional[dict[str, Any]]
) -> Variation:
    full = np.zeros((2, 3))
    full[0, : len(low)], full[1, : len(high)] = low[:3], high[:3]
    return Variation(parameter=name, low=tuple(full[0]), high=tuple(full[1]), **(where or {}))
