"""Checks and conversions of what callers pass as arrays, the same in every call."""

from __future__ import annotations

import operator
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .names import Ids, Seeds

Shape = tuple[int, ...]
Indices = NDArray[np.int32]


def shape_text(shape: Shape, axes: tuple[str, ...]) -> str:
    """ "(worlds=4, bodies=2, 3)": a shape with the names of its axes."""
    parts = [f"{name}={n}" if name else str(n) for name, n in zip(axes, shape)]
    return "(" + ", ".join(parts) + ("," if len(parts) == 1 else "") + ")"


def integer(value: Any, name: str, low: int, high: int) -> int:
    """``value`` as an int from ``low`` to ``high``. TypeError, ValueError."""
    if isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name} is a bool; expected an integer")
    try:
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} is of type {type(value).__name__}; expected an integer") from None
    if not low <= number <= high:
        raise ValueError(f"{name} is {number}, must be {low} to {high}")
    return number


def index(value: Any, count: int, name: str) -> int:
    """``value`` as an index below ``count``. TypeError, IndexError."""
    try:
        return integer(value, name, 0, count - 1)
    except ValueError as error:
        raise IndexError(str(error)) from None


def indices(ids: Optional[Ids], count: int, name: str) -> Indices:
    """Indices below ``count`` as int32: None is all of them, a bool array a mask over all.

    Negative ones do not count from the end. IndexError, TypeError.
    """
    if ids is None:
        return np.arange(count, dtype=np.int32)
    array = np.asarray(ids)
    if array.dtype == np.bool_:
        if array.shape != (count,):
            raise IndexError(f"the mask of {name} has shape {array.shape}; expected ({count},)")
        return np.flatnonzero(array).astype(np.int32)
    if array.size == 0 and array.ndim == 1:
        return np.empty(0, dtype=np.int32)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name} are of dtype {array.dtype}; expected integers, or a mask of bools")
    if array.ndim > 1:
        raise IndexError(f"{name} have shape {array.shape}; expected one axis")
    array = np.atleast_1d(array)
    wrong = array[(array < 0) | (array >= count)]
    if wrong.size:
        raise IndexError(f"{name} hold {wrong[0]}, must be 0 to {count - 1}")
    return np.ascontiguousarray(array, dtype=np.int32)


def pairs(source: Optional[Ids], saved: int, ids: Optional[Ids], count: int) -> Indices:
    """(source, world) one after the other: which of ``saved`` worlds goes into which of ``count``; a
    single source goes into every one of ``ids``. IndexError, TypeError, ValueError."""
    worlds, sources = indices(ids, count, "ids"), indices(source, saved, "source")
    if len(sources) == 1:
        sources = np.repeat(sources, len(worlds))
    if len(sources) != len(worlds):
        raise ValueError(f"source has {len(sources)} worlds, ids {len(worlds)}; expected as many")
    return np.ascontiguousarray(np.stack([sources, worlds], axis=1).ravel(), dtype=np.int32)


def mask(ids: Optional[Ids], count: int) -> NDArray[np.uint8]:
    """1 for the worlds of ``indices``, else 0."""
    out = np.zeros(count, dtype=np.uint8)
    out[indices(ids, count, "ids")] = 1
    return out


def seeds(values: Optional[Seeds], ids: Optional[Ids], count: int) -> Optional[NDArray[np.uint64]]:
    """A seed for each of ``count`` worlds: s + i of a number s, else one given for each of ``ids``,
    in their order."""
    if values is None:
        return None
    if np.ndim(values) == 0:
        first = integer(values, "seeds", 0, 2**64 - 1)
        return np.arange(count, dtype=np.uint64) + np.uint64(first)  # wraps around
    each = [integer(s, "a seed", 0, 2**64 - 1) for s in values]  # type: ignore[union-attr]
    worlds = indices(ids, count, "ids")
    if len(each) != len(worlds):
        raise ValueError(f"seeds are {len(each)}, expected one for each of {len(worlds)} worlds")
    if len(np.unique(worlds)) != len(worlds):
        raise ValueError("ids name a world more than once, for which there are several seeds")
    full = np.zeros(count, np.uint64)
    full[worlds] = np.array(each, np.uint64)
    return full


def reals(values: ArrayLike, name: str) -> NDArray[Any]:
    """An array of real numbers of any dtype, order and strides. TypeError."""
    try:
        array = np.asarray(values)
    except ValueError as error:  # rows of different lengths
        raise ValueError(f"{name} is no array: {error}") from None
    if array.dtype.kind not in "fiub":
        raise TypeError(f"{name} is of dtype {array.dtype}; expected real numbers")
    return array


def numbers(
    values: ArrayLike,
    shape: Shape,
    axes: tuple[str, ...],
    name: str,
    dtype: Optional[type] = None,
) -> NDArray[Any]:
    """Real numbers of exactly this shape, in order; float32 stays, others become float64."""
    array = reals(values, name)
    if array.shape != shape:
        expected = shape_text(shape, axes)
        raise ValueError(f"{name} has shape {array.shape}; expected {expected}")
    if dtype is None:
        dtype = np.float32 if array.dtype.type is np.float32 else np.float64
    return np.ascontiguousarray(array, dtype=dtype)


def broadcast(
    values: ArrayLike, shape: Shape, axes: tuple[str, ...], name: str, dtype: type
) -> NDArray[Any]:
    """Numbers that broadcast to this shape, in order."""
    array = reals(values, name)
    if dtype is np.bool_ and array.dtype != np.bool_:
        raise TypeError(f"{name} is of dtype {array.dtype}; expected bools")
    try:
        full = np.broadcast_to(array, shape)
    except ValueError:
        expected = shape_text(shape, axes)
        raise ValueError(
            f"{name} has shape {array.shape}; expected {expected}, or what broadcasts to it"
        ) from None
    return np.ascontiguousarray(full, dtype=dtype)


def output(
    out: Optional[NDArray[Any]],
    shape: Shape,
    axes: tuple[str, ...],
    dtype: Union[type, np.dtype[Any]],
    name: str = "out",
) -> NDArray[Any]:
    """``out`` if it can be filled in place, a new array if it is None. TypeError, ValueError."""
    wanted = np.dtype(dtype)
    if out is None:
        return np.empty(shape, dtype=wanted)
    if not isinstance(out, np.ndarray):
        raise TypeError(f"{name} is of type {type(out).__name__}; expected a numpy.ndarray")
    if out.dtype != wanted or not out.dtype.isnative:
        raise TypeError(f"{name} is of dtype {out.dtype}; expected {wanted}")
    if out.shape != shape:
        expected = shape_text(shape, axes)
        raise ValueError(f"{name} has shape {out.shape}; expected {expected}")
    if not out.flags.c_contiguous:
        raise ValueError(f"{name} is not C-contiguous; it is filled in place, without a copy")
    if not out.flags.writeable:
        raise ValueError(f"{name} is read-only")
    return out
