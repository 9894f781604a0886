"""Results of an Environment's task: values of expressions, and non-finite results."""

from __future__ import annotations

import math
import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import _core
from .terms import Value


@dataclass(frozen=True, slots=True)
class NonFinite:
    """An observation, a reward or an end of a task that was not finite."""

    expression: str  # "observation 3 'lean'", as issues of the task name it
    world: int
    step: int  # in the world's episode, from 1; 0: its start
    value: float  # infinite or NaN; NaN also for an end that compares NaN

    def __str__(self) -> str:
        value = "nan" if math.isnan(self.value) else f"{self.value}"
        when = f"at step {self.step} of its episode" if self.step else "at the start of its episode"
        return f"{self.expression} is {value} in world {self.world} {when}"


class WithResults:
    """Methods of Environment for values of expressions."""

    _worlds: int
    _held: _core.Environment
    _named_faults: int  # expressions that were warned of

    def _warn(self, stacklevel: int) -> None:
        """Warns of expressions without an earlier warning; `stacklevel` as in ``warnings.warn``."""
        faults = self.non_finite()
        new, self._named_faults = faults[self._named_faults :], len(faults)
        for fault in new:
            warnings.warn(
                f"{fault}: the world is lost and its episode truncated. Later faults of this expression "
                "are not reported; Environment(check=True) raises NonFiniteError",
                RuntimeWarning,
                stacklevel=stacklevel + 1,
            )

    def non_finite(self) -> list[NonFinite]:
        """The first fault of each expression since the environment was created, in order."""
        return [NonFinite(*fault) for fault in self._held.non_finite()]

    def evaluate(self, expression: Value) -> NDArray[np.float64]:
        """The value of an expression in every world, (worlds,) float64. Changes nothing.

        The expression is evaluated as an info after the last step or reset, but at the current
        state. Raises ValueError for items that the task's scene does not have. Also raises
        ValueError for values that the task does not observe or remember; add them with
        ``Task.tell``.
        """
        out = np.empty(self._worlds)
        self._held.evaluate(expression, out)
        return out
