"""Functions of what an expression was in earlier steps of the episode; they are in ``manyworlds.tasks``."""

from __future__ import annotations

from typing import Optional

from . import arrays
from ._core import Expression
from ._core import expressions as _x
from .terms import Value

_MAX_DELAY = 256  # steps, as in the library


def previous(value: Value) -> Expression:
    """What ``value`` was at the end of the step before; in the first step where the world began."""
    return _x.previous(value)


def delayed(value: Value, steps: Value, max_steps: Optional[int] = None) -> Expression:
    """What ``value`` was so many steps before, 0 to 256; in the first steps where the world began.

    In ``Task.controls`` 0 is the step to take, so ``delayed(t.action(), 2)`` is what was asked for two steps
    ago, 0 where there was none. ``steps`` may be an expression, such as a random number of the episode:
    rounded down, kept within 0 and ``max_steps``, which says how much is remembered; what is not a number counts as
    ``max_steps``. Each step is a number that a world remembers. Raises ValueError for other numbers of steps,
    TypeError for an expression without ``max_steps``.
    """
    if max_steps is not None:
        return _x.delayed_by(value, steps, arrays.integer(max_steps, "max_steps", 0, _MAX_DELAY))
    if isinstance(steps, Expression):
        raise TypeError(
            "steps is an expression; expected `max_steps` too, the number of steps to store"
        )
    return _x.delayed(value, arrays.integer(steps, "steps", 0, _MAX_DELAY))


def held(condition: Value) -> Expression:
    """Steps in a row, up to this one, at whose end the condition was true."""
    return _x.held(condition)


def largest(value: Value) -> Expression:
    """The largest that ``value`` has been since the episode began."""
    return _x.largest(value)


def latched(condition: Value) -> Expression:
    """1 once the condition was true in this episode, the beginning included; 0 before.

    This and the functions below are of all steps of the episode so far, up to this one. In
    ``Task.controls`` the step to take counts, so their arguments must be known before it there:
    ``previous(latched(...))`` is what the last step left.
    """
    return _x.latched(condition)


def summed(value: Value) -> Expression:
    """The sum of the values at the ends of the episode's steps; 0 where it begins."""
    return _x.summed(value)


def smoothed(
    value: Value, factor: Optional[Value] = None, *, time_constant: Optional[Value] = None
) -> Expression:
    """Exponential moving average: starts at ``value``, then moves a part of the way to it in each step.

    factor         that part: 1 follows at once, 0 never
    time_constant  s, instead: factor = 1 - exp(-time_step / time_constant)

    Raises TypeError unless one of the two is given.
    """
    if (factor is None) == (time_constant is None):
        raise TypeError("smoothed: expected either `factor` or `time_constant`")
    if time_constant is not None:
        return _x.smoothed_over(value, time_constant)
    assert factor is not None
    return _x.smoothed(value, factor)


def phase(frequency: Value) -> Expression:
    """Cycles since the episode began, without whole ones: from 0 up to 1, 1 not included.

    It grows by ``frequency`` (Hz, may change from step to step) times the duration of a step in each step;
    a negative frequency runs backwards. ``sin(2 * pi * phase(f))`` is a wave.
    """
    return _x.phase(frequency)
