"""Functions of earlier values of an expression in the episode, exported by ``manyworlds.tasks``."""

from __future__ import annotations

from typing import Optional

from . import arrays
from ._core import Expression
from ._core import expressions as _x
from .terms import Value

_MAX_DELAY = 256  # steps, as in the library


def previous(value: Value) -> Expression:
    """``value`` at the end of the previous step; in the first step, its value at the start."""
    return _x.previous(value)


def delayed(value: Value, steps: Value, max_steps: Optional[int] = None) -> Expression:
    """``value`` from ``steps`` steps ago, 0 to 256; in the first steps, its value at the start.

    In ``Task.controls`` 0 is the next step. ``delayed(t.action(), 2)`` is the action from two steps
    ago, or 0 if there was none. ``steps`` may be an expression, such as a random number of the
    episode. It is rounded down and clamped to 0 and ``max_steps``; NaN counts as ``max_steps``.

    Each world stores ``steps`` values, or ``max_steps`` for an expression. Raises ValueError for
    other numbers of steps, TypeError for an expression without ``max_steps``.
    """
    if max_steps is not None:
        return _x.delayed_by(value, steps, arrays.integer(max_steps, "max_steps", 0, _MAX_DELAY))
    if isinstance(steps, Expression):
        raise TypeError(
            "steps is an expression; expected `max_steps` too, the number of steps to store"
        )
    return _x.delayed(value, arrays.integer(steps, "steps", 0, _MAX_DELAY))


def held(condition: Value) -> Expression:
    """Number of consecutive steps, up to this one, with the condition true at their ends."""
    return _x.held(condition)


def largest(value: Value) -> Expression:
    """Maximum of ``value`` since the start of the episode."""
    return _x.largest(value)


def latched(condition: Value) -> Expression:
    """1 if the condition was true at any time in this episode, including its start; else 0.

    This and the functions below cover all steps of the episode up to this one. In ``Task.controls``
    they include the next step, so their arguments must be known before it. There,
    ``previous(latched(...))`` is the value after the last step.
    """
    return _x.latched(condition)


def summed(value: Value) -> Expression:
    """Sum of the values at the ends of the episode's steps; 0 at its start."""
    return _x.summed(value)


def smoothed(
    value: Value, factor: Optional[Value] = None, *, time_constant: Optional[Value] = None
) -> Expression:
    """Exponential moving average: starts at ``value``, and moves towards it in each step.

    factor         fraction of the difference per step: 1 follows at once, 0 never
    time_constant  alternative, in s: factor = 1 - exp(-time_step / time_constant)

    Raises TypeError unless exactly one of the two is set.
    """
    if (factor is None) == (time_constant is None):
        raise TypeError("smoothed: expected either `factor` or `time_constant`")
    if time_constant is not None:
        return _x.smoothed_over(value, time_constant)
    assert factor is not None
    return _x.smoothed(value, factor)


def phase(frequency: Value) -> Expression:
    """Cycles since the start of the episode, modulo 1: from 0 up to 1, excluding 1.

    It increases by ``frequency`` (Hz, may change from step to step) times the duration of a step in
    each step. A negative frequency decreases it. ``sin(2 * pi * phase(f))`` is a wave.
    """
    return _x.phase(frequency)
