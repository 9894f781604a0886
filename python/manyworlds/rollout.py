"""Rollouts: controls in, trajectories out, in one call."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core, arrays
from .arrays import Writable
from .names import FieldName

if TYPE_CHECKING:
    from .batch import Batch

Initial = Union[_core.Snapshot, Mapping[str, ArrayLike], None]
Trajectories = dict[str, NDArray[Any]]

MAX_STEPS = 2**31 - 1


def rollout(
    batch: Batch,
    initial: Initial,
    controls: Optional[ArrayLike],
    steps: Optional[int],
    fields: Sequence[FieldName],
    every: int,
    out: Optional[Mapping[str, Writable]],
) -> Trajectories:
    """Batch.rollout: where it raises, no world has changed."""
    played, count = _controls(batch, controls, steps)
    every = arrays.integer(every, "every", 1, MAX_STEPS)
    names = _names(fields)
    known = [batch._field(name) for name in names]
    if out is not None and not isinstance(out, Mapping):
        found = type(out).__name__
        raise TypeError(f"out is of type {found}; expected a dict of arrays by field")
    given = dict(out or {})
    if unwanted := sorted(set(given) - set(names)):
        raise ValueError(f"out has {unwanted}, which is not in fields")
    frames = count // every
    filled = [
        arrays.output(
            given.get(f.name),
            (frames, *batch._shape(f, batch.worlds)),
            ("frames", *batch._axes(f)),
            f.dtype,
            f"out['{f.name}']",
        )
        for f in known
    ]
    _begin(batch, initial)
    batch._held.rollout(count, every, played, names, filled)
    return dict(zip(names, filled))


def _controls(
    batch: Batch, controls: Optional[ArrayLike], steps: Optional[int]
) -> tuple[Optional[NDArray[Any]], int]:
    if controls is None:
        if steps is None:
            raise ValueError("a rollout needs controls (steps, worlds, controls), or steps")
        return None, arrays.integer(steps, "steps", 0, MAX_STEPS)
    array = arrays.reals(controls, "controls")
    count = array.shape[0] if array.ndim == 3 else -1
    if steps is not None and steps != count:
        raise ValueError(f"steps is {steps}, but controls are {array.shape}; give one of them")
    shape = count, batch.worlds, batch._controls
    axes = "steps", "worlds", "controls"
    if count < 0:
        expected = arrays.shape_text(shape[1:], axes[1:])[1:]
        raise ValueError(f"controls has shape {array.shape}; expected (steps, {expected}")
    return arrays.broadcast(array, shape, axes, "controls"), count


def _names(fields: Sequence[FieldName]) -> list[FieldName]:
    if isinstance(fields, str):
        raise TypeError(f"fields is a str; expected a list of names, such as ['{fields}']")
    names = list(fields)
    if len({*names}) != len(names):
        raise ValueError(f"fields {names} contain a name more than once")
    return names


def _begin(batch: Batch, initial: Initial) -> None:
    if initial is None:
        return
    if isinstance(initial, _core.Snapshot):
        batch.restore(initial)
    elif isinstance(initial, Mapping):
        writes = [batch._to_write(name, values) for name, values in initial.items()]
        # Only numbers of the scene can still be refused, by their ranges.
        refusable = any(batch._field(name).group == "parameter" for name in initial)
        before = batch.save() if refusable else None
        try:
            for write in writes:
                batch._held.write(*write)
        except ValueError:
            if before is not None:
                batch.restore(before)
            raise
    else:
        found = type(initial).__name__
        raise TypeError(f"initial is of type {found}; expected a Snapshot or a dict of arrays")
