"""The parameters of a search: names, ranges, and the parameters of a scene that they set."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import arrays
from ..ids import BodyRef, ControlRef, JointRef, ShapeRef
from ..names import Parameter as SceneParameter

Doubles = NDArray[np.float64]
Scale = Literal["linear", "log"]

# Columns of every table of results.
RESERVED = ("generation", "candidate", "value", "violation", "cost", "status", "seed", "hash")
_MAX_INTEGER = 2**53  # doubles represent every integer up to this


@dataclass(frozen=True, slots=True)
class Number:
    """Sets a parameter of the scene to ``offset + factor * value`` of a search's parameter.

    ``parameter`` ("size", "mass", "friction", ...) and its owner are as in ``Variation``. Without body,
    shape, joint, control and attractor it is set for every owner. ``component`` selects one of the two or three
    values of sizes, gravity, gain and similar parameters.
    """

    parameter: SceneParameter
    body: BodyRef = -1
    shape: ShapeRef = -1  # an int: a shape of that body
    joint: JointRef = -1
    control: ControlRef = -1
    attractor: int = -1
    component: Optional[int] = None
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter of candidates, from ``low`` to ``high``, both included.

    scale    "linear", or "log": equal steps of the search are equal ratios; low > 0
    integer  whole numbers only
    sets     parameters of the scene that it sets, if any; a search declares them as variations and
             writes them to each world

    Raises ValueError and TypeError, which name the parameter.
    """

    name: str
    low: float
    high: float
    scale: Scale = "linear"
    integer: bool = False
    sets: Union[Number, Sequence[Number]] = ()

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not self.name:
            raise TypeError(f"the name of a parameter is {self.name!r}; expected a str")
        wrong = []
        if self.name in RESERVED:
            wrong.append(f"its name is reserved for a column of results ({', '.join(RESERVED)})")
        for end in ("low", "high"):
            value = getattr(self, end)
            if isinstance(value, (bool, np.bool_)) or not isinstance(
                value, (int, float, np.integer, np.floating)
            ):
                raise TypeError(
                    f"parameter {self.name!r}: {end} is of type {type(value).__name__}; expected a number"
                )
            if not np.isfinite(value):
                wrong.append(f"{end} is {value}, must be finite")
            elif self.integer and (float(value) != int(value) or abs(int(value)) > _MAX_INTEGER):
                wrong.append(
                    f"{end} is {value}, must be a whole number up to 2^53: it is an integer"
                )
        if not wrong and not self.low < self.high:
            wrong.append(f"low is {self.low}, must be < high, which is {self.high}")
        if self.scale not in ("linear", "log"):
            wrong.append(f"scale is {self.scale!r}; expected 'linear' or 'log'")
        if self.scale == "log" and not self.low > 0:
            wrong.append(f"low is {self.low}, must be > 0: its scale is 'log'")
        for number in self.numbers:
            if not isinstance(number, Number):
                found = type(number).__name__
                raise TypeError(f"parameter {self.name!r}: sets holds a {found}; expected Numbers")
        if wrong:
            raise ValueError(f"parameter {self.name!r}: " + "; ".join(wrong))

    @property
    def numbers(self) -> tuple[Number, ...]:
        """``sets`` as a tuple."""
        return (self.sets,) if isinstance(self.sets, Number) else tuple(self.sets)

    def from_unit(self, points: Doubles) -> Doubles:
        """Values of points from 0 to 1; each integer has an equal share of this range."""
        low, high = float(self.low), float(self.high)
        end = high + 1 if self.integer else high
        if self.scale == "log":
            found = np.exp(np.log(low) * (1 - points) + np.log(end) * points)
            found = np.where(points == 0, low, np.where(points == 1, end, found))  # to the last bit
        else:
            found = low * (1 - points) + end * points
        if self.integer:
            found = np.floor(found)
        clipped: Doubles = np.clip(found, low, high)
        return clipped

    def to_unit(self, values: Doubles) -> Doubles:
        """Points from 0 to 1 with these values; for an integer, the middle of its share."""
        low, high = float(self.low), float(self.high)
        if self.integer:
            values, high = values + 0.5, high + 1
        if self.scale == "log":
            low, high, values = np.log(low), np.log(high), np.log(values)
        found: Doubles = (values - low) / (high - low)
        return found


class Space:
    """The parameters of a search, in their order.

    Points of a strategy are rows of values from 0 to 1, (points, parameters). Values are rows in the units of
    the parameters. Raises ValueError if two parameters have the same name.
    """

    def __init__(self, *parameters: Parameter) -> None:
        for i, one in enumerate(parameters):
            if not isinstance(one, Parameter):
                found = type(one).__name__
                raise TypeError(f"parameter {i} is of type {found}; expected a search.Parameter")
        self.parameters = parameters
        self.names = tuple(p.name for p in parameters)
        if not parameters:
            raise ValueError("the space has no parameters; expected one or more")
        if twice := sorted({n for n in self.names if self.names.count(n) > 1}):
            raise ValueError(f"several parameters have the name {', '.join(map(repr, twice))}")

    def __len__(self) -> int:
        return len(self.parameters)

    def __repr__(self) -> str:
        return f"<manyworlds.search.Space: {', '.join(self.names)}>"

    def index(self, name: str) -> int:
        """The index of the parameter with this name. Raises ValueError."""
        if name not in self.names:
            known = ", ".join(map(repr, self.names))
            raise ValueError(f"there is no parameter {name!r}; expected one of {known}")
        return self.names.index(name)

    def values(self, points: ArrayLike) -> Doubles:
        """Values (n, parameters) of points from 0 to 1, (n, parameters). Raises ValueError."""
        unit = self._rows(points, "points")
        wrong = ~((unit >= 0) & (unit <= 1))
        if wrong.any():
            row, column = np.argwhere(wrong)[0]
            raise ValueError(
                f"point {row} has {unit[row, column]} for {self.names[column]!r}, must be 0 to 1"
            )
        columns = [p.from_unit(unit[:, i]) for i, p in enumerate(self.parameters)]
        return np.ascontiguousarray(np.stack(columns, axis=1))

    def points(self, values: ArrayLike) -> Doubles:
        """Points of values (n, parameters)."""
        rows = self.checked(values)
        columns = [p.to_unit(rows[:, i]) for i, p in enumerate(self.parameters)]
        return np.ascontiguousarray(np.stack(columns, axis=1))

    def row(self, values: Mapping[str, float]) -> Doubles:
        """The row (parameters,) of values by name, with all names. Raises ValueError."""
        missing = [n for n in self.names if n not in values]
        unknown = [n for n in values if n not in self.names]
        if missing or unknown:
            parts = [f"has no {n!r}" for n in missing] + [f"has {n!r}" for n in unknown]
            raise ValueError(
                f"values {', '.join(parts)}; expected {', '.join(map(repr, self.names))}"
            )
        row: Doubles = self.checked([[values[n] for n in self.names]])[0]
        return row

    def named(self, row: ArrayLike) -> dict[str, float]:
        """Values by name, from a row; integers are ints."""
        numbers = np.asarray(row, np.float64)
        return {p.name: int(x) if p.integer else float(x) for p, x in zip(self.parameters, numbers)}

    def checked(self, values: ArrayLike) -> Doubles:
        """Checks that values (n, parameters) are in their ranges. Raises ValueError, TypeError."""
        rows = self._rows(values, "values")
        for i, p in enumerate(self.parameters):
            column = rows[:, i]
            wrong = ~((column >= p.low) & (column <= p.high))
            expected = f"{p.low} to {p.high}"
            if p.integer:
                wrong |= column != np.floor(column)
                expected += ", whole"
            if wrong.any():
                at = int(np.argmax(wrong))
                raise ValueError(
                    f"parameter {p.name!r} is {column[at]} in row {at}, must be {expected}"
                )
        return rows

    def _rows(self, given: ArrayLike, name: str) -> Doubles:
        array: NDArray[Any] = arrays.reals(given, name)
        if array.ndim != 2 or array.shape[1] != len(self):
            raise ValueError(
                f"{name} have shape {array.shape}; expected (candidates, parameters={len(self)})"
            )
        return np.ascontiguousarray(array, np.float64)
