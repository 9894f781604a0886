"""Any number of candidates, tried in rounds of equal size with one world for each candidate."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import arrays
from ..files import File
from ..in_memory import InMemory
from ..kinds import MAX_WORLDS
from .outcome import Objective, Outcome, Run, Score
from .space import Doubles, Space

if TYPE_CHECKING:
    from ..record import Recording

MAX_WORLDS_AT_ONCE = 16_384


class Rounds(InMemory):
    """Tries candidates in rounds. Trial and TaskTrial implement a round."""

    _instead = "pickle its arguments"

    def __init__(self, space: Space, objective: Optional[Objective], worlds: Optional[int]) -> None:
        if not isinstance(space, Space):
            raise TypeError(f"space is of type {type(space).__name__}; expected a search.Space")
        self._space = space
        self._objective = objective
        most = MAX_WORLDS_AT_ONCE if worlds is None else worlds
        self._most = arrays.integer(most, "worlds", 1, MAX_WORLDS)
        self._held: Any = None

    @property
    def space(self) -> Space:
        """The parameters."""
        return self._space

    def evaluate(self, values: ArrayLike, seeds: ArrayLike) -> Outcome:
        """Outcome of values (candidates, parameters), each in a separate world.

        ``seeds``: (candidates,), or one for all. More candidates than ``worlds`` run in rounds of equal size.
        An outcome depends only on its candidate's values and seed. Raises the errors of callbacks,
        ValueError and TypeError.
        """
        rows = self._space.checked(values)
        own = np.asarray(seeds)
        if own.dtype.kind not in "iu":
            raise TypeError(f"seeds are of dtype {own.dtype}; expected integers")
        if own.dtype.kind == "i" and (own < 0).any():
            raise ValueError(f"seeds hold {own.min()}, must be 0 to 2^64 - 1")
        if own.shape not in ((), (len(rows),)):
            raise ValueError(
                f"seeds have shape {own.shape}; expected (candidates={len(rows)},) or ()"
            )
        each = np.ascontiguousarray(np.broadcast_to(own.astype(np.uint64), len(rows)))
        parts = []
        rounds = -(-len(rows) // self._most)
        size = -(-len(rows) // rounds) if rounds else 0
        for first in range(0, len(rows), size or 1):
            count = min(size, len(rows) - first)
            # The last candidate fills the last round.
            chosen = np.minimum(np.arange(first, first + size), len(rows) - 1)
            found = self._round(rows[chosen], each[chosen])
            parts.append([array[:count] for array in found])
        if not parts:
            none = np.zeros(0)
            return Outcome(none, none, none.astype(bool), none.astype(np.uint64))
        return Outcome(*(np.concatenate(column) for column in zip(*parts)))

    def _round(self, values: Doubles, seeds: NDArray[np.uint64]) -> Outcome:
        if self._held is None or self._held.worlds != len(values):
            self.close()
            self._held = self._make(len(values))
        run = self._begin(self._held, values, seeds)
        self._play(run)
        return self._judge(run)

    def _judge(self, run: Run) -> Outcome:
        scored = self._score(run)
        value, violation = scored if isinstance(scored, Score) else (scored, 0.0)
        count = run.batch.worlds
        axes = ("worlds",)
        values = arrays.numbers(value, (count,), axes, "the value of the objective", float)
        broken = np.asarray(arrays.reals(violation, "the violation"), np.float64)
        broken = np.maximum(broken, 0)
        if broken.ndim == 2:
            broken = broken.sum(axis=1)
        broken = arrays.broadcast(broken, (count,), axes, "the violation", float)
        return Outcome(values.copy(), broken.copy(), run.batch.lost(), run.batch.hashes())

    def record(
        self, values: Mapping[str, float], seed: int, file: File, every: int = 1
    ) -> tuple[Recording, Outcome]:
        """Tries a candidate, ``values`` by name, in a single world, and records it to ``file``.

        Returns the Recording, which mw.show and mw.write_page accept, and the Outcome. The recording starts
        after ``begin``. ``every``: steps between samples.
        """
        from ..record import Recorder, Recording

        row = self._space.row(values)[None]
        seed = arrays.integer(seed, "seed", 0, 2**64 - 1)
        held = self._make(1)
        try:
            run = self._begin(held, row, np.array([seed], np.uint64))
            run.recording = True
            with Recorder(run.batch, file, every=every) as recorder:
                self._play(run)
                recorder.sample()
            outcome = self._judge(run)
        finally:
            held.close()
        return Recording(file), outcome

    def close(self) -> None:
        """Frees the worlds. They are created again when needed."""
        if self._held is not None:
            self._held.close()
        self._held = None

    def __enter__(self) -> Any:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _make(self, worlds: int) -> Any:
        raise NotImplementedError

    def _begin(self, held: Any, values: Doubles, seeds: NDArray[np.uint64]) -> Run:
        raise NotImplementedError

    def _play(self, run: Run) -> None:
        raise NotImplementedError

    def _score(self, run: Run) -> Union[ArrayLike, Score]:
        assert self._objective is not None
        return self._objective(run)
