"""Checks and conversions of array arguments."""

from __future__ import annotations

import operator
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .names import Ids, Seeds

Shape = tuple[int, ...]
# Types of ``out``: a NumPy array, or another writable one on the CPU with DLPack (a torch.Tensor)
# or is a buffer (bytearray, array.array, memoryview).
Writable = Any
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


def at_least(value: Any, name: str, low: float) -> float:
    """``value`` as a float from ``low`` to infinity, included. TypeError, ValueError."""
    if isinstance(value, (bool, np.bool_)) or not isinstance(
        value, (int, float, np.integer, np.floating)
    ):
        raise TypeError(f"{name} is of type {type(value).__name__}; expected a number")
    if not value >= low:
        raise ValueError(f"{name} is {value}, must be >= {low:g}")
    try:
        return float(value)
    except OverflowError:  # an int with hundreds of digits
        return float("inf")


def index(value: Any, count: int, name: str) -> int:
    """``value`` as an index below ``count``. TypeError, IndexError."""
    try:
        return integer(value, name, 0, count - 1)
    except ValueError as error:
        raise IndexError(str(error)) from None


def indices(ids: Optional[Ids], count: int, name: str) -> Indices:
    """Indices below ``count`` as int32. None selects all; an array of bools is a mask over all.

    Negative indices are invalid. IndexError, TypeError.
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


def worlds(ids: Optional[Ids], count: int, name: str = "ids") -> Indices:
    """Indices of worlds from a caller's argument.

    None is all of them, in order. An array of bools is a mask over all, (count,). Integers are ids
    below ``count``, without repeats, in the caller's order. IndexError, TypeError, ValueError.
    """
    if isinstance(ids, (list, tuple)):
        bools = sum(isinstance(i, (bool, np.bool_)) for i in ids)
        if 0 < bools < len(ids):
            raise TypeError(f"{name} mix bools and integers; expected a mask of bools, or integers")
    chosen = indices(ids, count, name)
    if len(np.unique(chosen)) < len(chosen):
        first = next(i for k, i in enumerate(chosen) if i in chosen[:k])
        raise ValueError(
            f"{name} name world {first} more than once; expected each once. Integers are ids of "
            f"worlds; a mask is an array of bools, one for each of {count} worlds"
        )
    return chosen


def pairs(source: Optional[Ids], saved: int, ids: Optional[Ids], count: int) -> Indices:
    """(source, world) one after the other: copies of ``saved`` worlds into ``count`` worlds. A
    single source goes into every one of ``ids``. A source may be repeated. IndexError,
    TypeError, ValueError.
    """
    targets, sources = worlds(ids, count), indices(source, saved, "source")
    if len(sources) == 1:
        sources = np.repeat(sources, len(targets))
    if len(sources) != len(targets):
        raise ValueError(
            f"source has {len(sources)} worlds, ids {len(targets)}; expected equal numbers"
        )
    return np.ascontiguousarray(np.stack([sources, targets], axis=1).ravel(), dtype=np.int32)


def mask(ids: Optional[Ids], count: int) -> NDArray[np.uint8]:
    """1 for the selected worlds, else 0."""
    out = np.zeros(count, dtype=np.uint8)
    out[worlds(ids, count)] = 1
    return out


def seeds(values: Optional[Seeds], ids: Optional[Ids], count: int) -> Optional[NDArray[np.uint64]]:
    """A seed for each of ``count`` worlds: s + i for a number s, or one per entry of ``ids``, in
    order.
    """
    if values is None:
        return None
    if np.ndim(values) == 0:
        first = integer(values, "seeds", 0, 2**64 - 1)
        return np.arange(count, dtype=np.uint64) + np.uint64(first)  # wraps around
    each = [integer(s, "a seed", 0, 2**64 - 1) for s in values]  # type: ignore[union-attr]
    chosen = worlds(ids, count)
    if len(each) != len(chosen):
        raise ValueError(f"seeds are {len(each)}, expected one for each of {len(chosen)} worlds")
    full = np.zeros(count, np.uint64)
    full[chosen] = np.array(each, np.uint64)
    return full


def one_seed(
    seed: Optional[int], seeds: Optional[Seeds], redraw: Optional[bool]
) -> Optional[Seeds]:
    """The seeds of a reset: ``seed``, a number, or ``seeds``; else None. TypeError, ValueError."""
    if redraw is not None and not isinstance(redraw, (bool, np.bool_)):
        raise TypeError(f"redraw is of type {type(redraw).__name__}; expected a bool")
    if seed is not None:
        if seeds is not None:
            raise ValueError("seed and seeds are both given; expected one of them")
        seeds = integer(seed, "seed", 0, 2**64 - 1)
    if seeds is not None and redraw is not None and not redraw:
        raise ValueError("redraw is False and a seed is given; a seed redraws, pass only one")
    return seeds


def actions(values: ArrayLike, shape: Shape, choices: Optional[int]) -> NDArray[Any]:
    """Actions of a task: integers as int64 where there are ``choices``, else numbers as float32.

    Raises TypeError, ValueError. Messages show integers of any size unchanged.
    """
    array = np.asarray(values)
    if array.shape != shape:
        expected = shape_text(shape, ("worlds", "numbers"))
        raise ValueError(f"actions have shape {array.shape}; expected {expected}")
    if choices is None:
        if array.dtype.kind not in "fiu":
            raise TypeError(f"actions are of dtype {array.dtype}; expected numbers")
        return np.ascontiguousarray(array, dtype=np.float32)
    if array.dtype.kind == "O" and all(isinstance(a, int) for a in array):  # of any size
        wrong = np.flatnonzero([not 0 <= a < choices for a in array])
    elif array.dtype.kind == "u":
        wrong = np.flatnonzero(array >= choices)
    elif array.dtype.kind == "i":
        wrong = np.empty(0)  # the library reports them
    else:
        wanted = "integers: the task's actions are choices"
        raise TypeError(f"actions are of dtype {array.dtype}; expected {wanted}")
    if wrong.size:
        found = array[wrong[0]]
        raise ValueError(f"the action of world {wrong[0]} is {found}, must be 0 to {choices - 1}")
    return np.ascontiguousarray(array, dtype=np.int64)


def reals(values: ArrayLike, name: str) -> NDArray[Any]:
    """An array of real numbers of any dtype, order and strides. TypeError."""
    try:
        array = np.asarray(values)
    except ValueError as error:  # rows of different lengths
        raise ValueError(f"{name} is not an array: {error}") from None
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
    """Real numbers of exactly this shape, C-contiguous. float32 is kept; others become float64."""
    array = reals(values, name)
    if array.shape != shape:
        expected = shape_text(shape, axes)
        raise ValueError(f"{name} has shape {array.shape}; expected {expected}")
    if dtype is None:
        dtype = np.float32 if array.dtype.type is np.float32 else np.float64
    return np.ascontiguousarray(array, dtype=dtype)


def broadcast(
    values: ArrayLike,
    shape: Shape,
    axes: tuple[str, ...],
    name: str,
    dtype: Optional[type] = None,
) -> NDArray[Any]:
    """Numbers that broadcast to this shape, C-contiguous; without a dtype as ``numbers``."""
    array = reals(values, name)
    if dtype is None:
        dtype = np.float32 if array.dtype.type is np.float32 else np.float64
    if dtype is np.bool_ and array.dtype != np.bool_:
        raise TypeError(f"{name} is of dtype {array.dtype}; expected bools")
    try:
        full = np.broadcast_to(array, shape)
    except ValueError:
        expected = shape_text(shape, axes)
        raise ValueError(
            f"{name} has shape {array.shape}; expected {expected}, or a shape that broadcasts to it"
        ) from None
    return np.ascontiguousarray(full, dtype=dtype)


def output(
    out: Optional[Writable],
    shape: Shape,
    axes: tuple[str, ...],
    dtype: Union[type, np.dtype[Any]],
    name: str = "out",
) -> NDArray[Any]:
    """``out`` as an array that can be filled in place; a new array if it is None.

    Other objects give an array over the same memory, through DLPack or the buffer protocol. A
    buffer must have exactly this size, in numbers of the type or in bytes. TypeError, ValueError.
    """
    wanted = np.dtype(dtype)
    if out is None:
        return np.empty(shape, dtype=wanted)
    if isinstance(out, np.ndarray):
        array = out
    elif hasattr(out, "__dlpack__"):
        array = _from_dlpack(out, name)
    else:
        array = _from_buffer(out, shape, axes, wanted, name)
    if array.dtype != wanted or not array.dtype.isnative:
        raise TypeError(f"{name} is of dtype {array.dtype}; expected {wanted}")
    if array.shape != shape:
        expected = shape_text(shape, axes)
        raise ValueError(f"{name} has shape {array.shape}; expected {expected}")
    if not array.flags.c_contiguous:
        raise ValueError(f"{name} is not C-contiguous; it is filled in place, without a copy")
    if not array.flags.writeable:
        raise ValueError(f"{name} is read-only")
    return array


_CPU = 1  # DLPack's kDLCPU


def _from_dlpack(out: Any, name: str) -> NDArray[Any]:
    try:
        device = out.__dlpack_device__()
        if device[0] != _CPU:
            raise ValueError(f"its memory is on the device {tuple(device)}, must be on the CPU")
        array = np.from_dlpack(out)
    except (AttributeError, BufferError, RuntimeError, TypeError, ValueError) as error:
        kind = type(out).__name__
        raise TypeError(f"{name}, a {kind}, cannot be imported through DLPack: {error}") from None
    if array.flags.writeable or not hasattr(out, "__array__"):
        return array
    # DLPack before its version 1 cannot say that memory may be written to; the type itself can.
    own = np.asarray(out)
    same = own.__array_interface__["data"][0] == array.__array_interface__["data"][0]
    return own if same and (own.shape, own.strides) == (array.shape, array.strides) else array


def _from_buffer(
    out: Any, shape: Shape, axes: tuple[str, ...], dtype: np.dtype[Any], name: str
) -> NDArray[Any]:
    try:
        view = memoryview(out)
    except TypeError:
        raise TypeError(
            f"{name} is of type {type(out).__name__}; expected a numpy.ndarray, or "
            "an object with DLPack or the buffer protocol"
        ) from None
    if not view.c_contiguous:
        raise ValueError(f"{name} is not C-contiguous; it is filled in place, without a copy")
    array: NDArray[Any] = np.asarray(view)
    if array.ndim != 1:
        return array
    # One after the other, as buffers without a shape have them.
    raw = view.format in ("B", "b", "c") and dtype.itemsize > 1
    numbers = int(np.prod(shape, dtype=np.int64))
    expected = f"{numbers * dtype.itemsize} bytes" if raw else f"{numbers} values"
    if (view.nbytes if raw else array.size) != numbers * (dtype.itemsize if raw else 1):
        raise ValueError(
            f"{name} has {view.nbytes if raw else array.size} {expected.split()[1]}; expected "
            f"{expected} for {shape_text(shape, axes)}"
        )
    if raw:
        array = array.view(np.uint8).view(dtype)
        if not array.flags.aligned:
            raise ValueError(
                f"{name} starts at an address that is not a multiple of {dtype.itemsize}"
            )
    return array.reshape(shape)
