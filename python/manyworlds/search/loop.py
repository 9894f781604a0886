"""The loop of a search: get candidates from a strategy, try them in worlds, return the outcome."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Literal, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import __version__, arrays
from ..files import File
from .outcome import Evaluator, Outcome
from .results import Candidate, Generation, Results, checked_file
from .space import Doubles, Space
from .strategies import Strategy

if TYPE_CHECKING:
    from ..record import Recording

Goal = Literal["minimize", "maximize"]
SeedsBy = Literal["search", "generation", "candidate"]
_MAX_GENERATIONS = 2**31 - 1


@dataclass(frozen=True, slots=True)
class Asked:
    """A generation of candidates."""

    generation: int
    points: Doubles  # (candidates, parameters), in the strategy's units from 0 to 1
    values: Doubles  # (candidates, parameters)
    seeds: NDArray[np.uint64]  # (candidates,)


class Search:
    """Candidates of a strategy, tried by a trial.

    trial     a Trial, a TaskTrial or any Evaluator; a Space if the caller uses ``ask`` and ``tell``
    strategy  CmaEs, Random, Sobol, Grid, or any Strategy
    goal      "minimize" or "maximize" the objective
    seed      seed of the strategy and of worlds; results are bitwise equal for equal seeds, with any number
              of concurrent worlds and threads
    seeds     seeds of worlds: "search": ``seed`` for all; "generation": seed + g in generation g;
              "candidate": seed + n for the n-th candidate of the search
    lost      value of a candidate whose world is lost, or whose value is not finite; None: its cost is
              above all others of its generation

    The strategy gets finite costs. A valid candidate costs its value, negated if it is maximised. A candidate
    that violates constraints costs the largest cost of valid ones plus its violation (Deb, An efficient
    constraint handling method, 2000). Lost candidates cost more than those.
    """

    def __init__(
        self,
        trial: Union[Evaluator, Space],
        strategy: Strategy,
        goal: Goal = "minimize",
        seed: int = 0,
        seeds: SeedsBy = "search",
        lost: Optional[float] = None,
    ) -> None:
        self.trial: Optional[Evaluator] = None if isinstance(trial, Space) else trial
        self.space: Space = trial if isinstance(trial, Space) else trial.space
        if goal not in ("minimize", "maximize"):
            raise ValueError(f"goal is {goal!r}; expected 'minimize' or 'maximize'")
        if seeds not in ("search", "generation", "candidate"):
            raise ValueError(f"seeds is {seeds!r}; expected 'search', 'generation' or 'candidate'")
        if lost is not None and not np.isfinite(lost):
            raise ValueError(f"lost is {lost}, must be finite, or None")
        self.strategy = strategy
        self.goal = goal
        self.seed = arrays.integer(seed, "seed", 0, 2**64 - 1)
        self.seeds = seeds
        self.lost = lost
        self.seconds = {"searching": 0.0, "trying": 0.0}  # wall time so far
        self._sign = 1.0 if goal == "minimize" else -1.0
        self._asked: Optional[Asked] = None
        strategy.start(self.space, self.seed)
        parameters = [
            {"name": p.name, "low": p.low, "high": p.high, "scale": p.scale, "integer": p.integer}
            for p in self.space.parameters
        ]
        about = {
            "version": __version__,
            "goal": goal,
            "strategy": type(strategy).__name__,
            "seed": self.seed,
            "seeds": seeds,
            "parameters": parameters,
        }
        self.results = Results(self.space, goal, about)

    @property
    def done(self) -> bool:
        """Whether the strategy is finished."""
        return self._asked is None and bool(getattr(self.strategy, "done", False))

    @property
    def mean(self) -> Optional[dict[str, float]]:
        """The mean of the strategy's distribution, values by name; None if it has none (designs).

        With noisy objectives it is often better than the best candidate.
        """
        point = getattr(self.strategy, "mean", None)
        return None if point is None else self.space.named(self.space.values([point])[0])

    def ask(self) -> Asked:
        """The next generation. Returns the same one until ``tell``."""
        if self._asked is None:
            began = time.perf_counter()
            points = np.asarray(self.strategy.ask(), np.float64)
            values = self.space.values(points)
            index, count = len(self.results.generations), len(points)
            if not count:
                raise ValueError("the strategy returned no points; expected one or more")
            first = {"search": 0, "generation": index, "candidate": len(self.results)}[self.seeds]
            start = np.uint64((self.seed + first) % 2**64)
            step = np.arange(count, dtype=np.uint64) if self.seeds == "candidate" else np.uint64(0)
            with np.errstate(over="ignore"):  # overflow as in Batch's seeds
                seeds = np.full(count, start) + step
            self._asked = Asked(index, points, values, seeds)
            self.seconds["searching"] += time.perf_counter() - began
        return self._asked

    def tell(self, outcome: Union[Outcome, ArrayLike], seconds: float = 0.0) -> Generation:
        """Sets the outcome of the last generation from ``ask``: an Outcome, or values (candidates,).

        ``seconds`` is the time that it took, for the results. Raises ValueError without a call of ``ask``.
        """
        asked = self._asked
        if asked is None:
            raise ValueError("no generation is open; call ask() first")
        began = time.perf_counter()
        count = len(asked.points)
        if not isinstance(outcome, Outcome):
            zeros = np.zeros(count)
            numbers = arrays.numbers(outcome, (count,), ("candidates",), "values", float)
            outcome = Outcome(numbers, zeros, zeros.astype(bool), zeros.astype(np.uint64))
        for name, array in zip(Outcome._fields, outcome):
            if np.shape(array) != (count,):
                raise ValueError(
                    f"{name} have shape {np.shape(array)}; expected (candidates={count},)"
                )
        status, costs = self._costs(outcome)
        self.strategy.tell(asked.points, costs)
        told = Generation(
            asked.generation,
            self.space,
            asked.values,
            outcome.values,
            outcome.violations,
            costs,
            status,
            asked.seeds,
            outcome.hashes,
            seconds,
        )
        self.results.generations.append(told)
        self._asked = None
        self.seconds["searching"] += time.perf_counter() - began
        return told

    def _costs(self, outcome: Outcome) -> tuple[NDArray[np.uint8], Doubles]:
        values, violations = np.asarray(outcome.values), np.asarray(outcome.violations)
        status = np.zeros(len(values), np.uint8)
        status[violations > 0] = 1
        status[~(np.isfinite(values) & np.isfinite(violations))] = 3
        status[np.asarray(outcome.lost)] = 2
        costs = self._sign * values
        ok, infeasible, rest = status == 0, status == 1, status > 1
        worst = float(costs[ok].max()) if ok.any() else 0.0
        costs[infeasible] = worst + violations[infeasible]
        if self.lost is not None:
            costs[rest] = self._sign * self.lost
        elif rest.any():
            worst = float(costs[~rest].max()) if not rest.all() else 0.0
            costs[rest] = worst + max(1.0, abs(worst))
        most = np.finfo(np.float64).max
        return status, np.clip(costs, -most, most)

    def run(
        self,
        generations: Optional[int] = None,
        file: Optional[File] = None,
        on_generation: Optional[Callable[[Generation], Any]] = None,
    ) -> Results:
        """Tries further generations until the strategy is done. Returns the results.

        generations    maximum number; None: no maximum, for strategies that end (Grid, CmaEs)
        file           file of the results' table, written at the end and after an interruption
        on_generation  called after each generation; ``print`` prints a line

        After Ctrl-C or an error in a callback, ``results`` has all complete generations. A later run
        repeats the interrupted generation and gives the same bits as a run without interruption.
        """
        if self.trial is None:
            raise ValueError("the search has a space but no trial; pass a trial, or use ask() and tell()")
        if generations is None and not hasattr(self.strategy, "done"):
            name = type(self.strategy).__name__
            raise ValueError(f"generations is None, but a {name} never ends; expected a number")
        most = _MAX_GENERATIONS if generations is None else generations
        most = arrays.integer(most, "generations", 0, _MAX_GENERATIONS)
        path = None if file is None else checked_file(file)
        try:
            for _ in range(most):
                if self.done:
                    break
                asked = self.ask()
                began = time.perf_counter()
                outcome = self.trial.evaluate(asked.values, asked.seeds)
                seconds = time.perf_counter() - began
                self.seconds["trying"] += seconds
                told = self.tell(outcome, seconds)
                if on_generation is not None:
                    on_generation(told)
        finally:
            if path is not None:
                self.results.save(path)
        return self.results

    def record(
        self, file: File, candidate: Optional[Candidate] = None, every: int = 1
    ) -> Recording:
        """Repeats a candidate in a single world and records it; None: the best so far.

        ``every``: steps between samples. mw.show and mw.write_page accept the Recording. Raises RuntimeError
        if the final state differs from the search: then worlds depend on each other in a callback.
        """
        if candidate is None:
            candidate = self.results.best
        recorder = getattr(self.trial, "record", None)
        if recorder is None:
            raise ValueError("the search's trial has no record(); expected a Trial or a TaskTrial")
        recording, outcome = recorder(candidate.values, candidate.seed, file, every)
        found = int(outcome.hashes[0])
        if candidate.hash and found != candidate.hash:
            recording.close()
            raise RuntimeError(
                f"alone, the world ends with hash {found:016x}; in the search it was {candidate.hash:016x}: "
                "in a callback, worlds depend on each other or on their number"
            )
        result: Recording = recording
        return result
