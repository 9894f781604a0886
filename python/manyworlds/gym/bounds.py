"""Ranges of a task's expressions for Gymnasium spaces, from the ranges of their operands.

Gymnasium warns about spaces without bounds. If a task declares none, they follow from the bounds of
a world: a step freezes worlds that exceed `_MOST`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from math import inf, pi
from typing import Any

from .. import _core
from ..tasks import Task, Value

Range = tuple[float, float]

_ALL: Range = (-inf, inf)
_TRUTH: Range = (0.0, 1.0)
_UNIT: Range = (-1.00001, 1.00001)  # with rounding
_ANGLE: Range = (-3.1416, 3.1416)
# Twice the limits of Status.out_of_range, to include the offset of a body's frame from its centre of
# mass: m, m/s, rad/s.
_MOST = {"position": 2e10, "velocity": 2e5, "angular_velocity": 2e6}


def range_of(value: Value, task: Task) -> Range:
    """Minimum and maximum of a task's expression; infinite if unknown."""
    if not isinstance(value, _core.Expression):
        return float(value), float(value)
    nodes, (root,) = _core.expression_graph([value])
    found: list[Range] = []
    for name, *rest in nodes:
        low, high = _range(str(name), rest, found, task)
        found.append(_ALL if math.isnan(low) or math.isnan(high) else (low, high))
    return found[root]


def _range(name: str, rest: Sequence[Any], found: Sequence[Range], task: Task) -> Range:
    if name == "number":
        return rest[0], rest[0]
    if name in _OPERATIONS:
        return _OPERATIONS[name](*(found[i] for i in rest))
    if name in _MOST:
        return -_MOST[name], _MOST[name]
    steps = float(task.max_steps or inf)
    if name == "uniform":
        return _TRUTH
    if name == "parameter":
        return _ALL
    if name in ("age", "held"):
        return 0.0, steps
    if name == "time_step":
        seconds = task.frame_skip * task.scene.options.dt
        return seconds, seconds
    if name == "ray_distance":
        return 0.0, task.rays[rest[0]].length
    if name == "action":
        if task.choices > 0:
            return 0.0, task.choices - 1.0
        action = task.actions[rest[0]]
        if not action.clamped:
            return _ALL
        return min(action.low, 0.0), max(action.high, 0.0)  # 0 at the start of an episode
    if name == "control":
        control = task.scene.controls[rest[0]]
        return control.low, control.high
    return {"angle": _ANGLE, "direction": _UNIT, "touching": _TRUTH, "lost": _TRUTH}.get(name, _ALL)


def _corners(f: Callable[[float, float], float], a: Range, b: Range) -> Range:
    at = [0.0 if math.isnan(x) else x for x in (f(i, j) for i in a for j in b)]  # 0 times infinite
    return min(at), max(at)


def _product(a: Range, b: Range) -> Range:
    return _corners(lambda x, y: x * y, a, b)


def _quotient(a: Range, b: Range) -> Range:
    if b[0] <= 0 <= b[1]:
        return _ALL
    return _product(a, (1 / b[1], 1 / b[0]))


def _absolute(a: Range) -> Range:
    least = 0.0 if a[0] <= 0 <= a[1] else min(abs(a[0]), abs(a[1]))
    return least, max(abs(a[0]), abs(a[1]))


def _floor(a: Range) -> Range:
    return tuple(x if math.isinf(x) else math.floor(x) for x in a)  # type: ignore[return-value]


def _exp(x: float) -> float:
    return math.exp(x) if x < 700 else inf


def _log(x: float) -> float:
    return math.log(x) if x > 0 else -inf


def _mod(a: Range, b: Range) -> Range:
    return min(b[0], 0.0), max(b[1], 0.0)


def _power(a: Range, b: Range) -> Range:
    if a[0] <= 0 or math.isinf(a[1]) or math.isinf(b[0]) or math.isinf(b[1]):
        return (0.0, inf) if a[0] >= 0 else _ALL
    logs = _product((math.log(a[0]), math.log(a[1])), b)
    return _exp(logs[0]), _exp(logs[1])


_OPERATIONS: dict[str, Callable[..., Range]] = {
    "add": lambda a, b: (a[0] + b[0], a[1] + b[1]),
    "subtract": lambda a, b: (a[0] - b[1], a[1] - b[0]),
    "multiply": _product,
    "divide": _quotient,
    "negate": lambda a: (-a[1], -a[0]),
    "abs": _absolute,
    "sqrt": lambda a: (math.sqrt(max(a[0], 0.0)), math.sqrt(max(a[1], 0.0))),
    "minimum": lambda a, b: (min(a[0], b[0]), min(a[1], b[1])),
    "maximum": lambda a, b: (max(a[0], b[0]), max(a[1], b[1])),
    "floor": _floor,
    "sin": lambda a: _UNIT,
    "cos": lambda a: _UNIT,
    "arctan2": lambda a, b: _ANGLE,
    "log": lambda a: (_log(a[0]), _log(a[1])),
    "tanh": lambda a: _UNIT,
    "arccos": lambda a: (0.0, _ANGLE[1]),
    "mod": _mod,
    "sign": lambda a: (-1.0, 1.0),
    "power": _power,
    "exp": lambda a: (_exp(a[0]), _exp(a[1])),
    **{name: lambda *_: _TRUTH for name in ("less", "less_equal", "equal", "both", "either")},
    "opposite": lambda a: _TRUTH,
    "where": lambda a, b, c: (min(b[0], c[0]), max(b[1], c[1])),
    "previous": lambda a: a,
    "largest": lambda a: a,
    "latched": lambda a: _TRUTH,
    "summed": lambda a: (-inf if a[0] < 0 else 0.0, inf if a[1] > 0 else 0.0),
    # Between the values, as long as the factor is a part.
    "smoothed": lambda a, b: a if 0 <= b[0] and b[1] <= 1 else _ALL,
    "phase": lambda a: _TRUTH,
}
