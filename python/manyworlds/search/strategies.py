"""Strategies: designs (random, grid, Sobol) and CMA-ES, with the methods ask and tell.

Points of a strategy have values from 0 to 1, one per parameter. Any object with the three methods
of ``Strategy`` is a strategy, so optimisers of other libraries fit in a few lines.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, field
from importlib import import_module
from typing import Any, Optional, Protocol, Union

import numpy as np

from .. import arrays
from .._distribution import needs
from .space import Doubles, Space

MAX_CANDIDATES = 100_000_000


class Strategy(Protocol):
    """Interface of strategies.

    Optional members: ``done``, True if there are no more points; ``mean``, (parameters,), the mean
    of the distribution.
    """

    def start(self, space: Space, seed: int) -> None:
        """Restarts the strategy. Equal seeds give equal points."""

    def ask(self) -> Doubles:
        """The next generation, (points, parameters) from 0 to 1."""
        ...

    def tell(self, points: Doubles, costs: Doubles) -> None:
        """Sets the finite costs (points,) of the last generation. Lower is better."""


def needed(module: str, what: str) -> Any:
    """Imports a module of the extra ``search``. ImportError, with the command to install it."""
    with needs(module.partition(".")[0], extra="search", what=what):
        return import_module(module)


def _candidates(value: Any) -> int:
    return arrays.integer(value, "candidates", 1, MAX_CANDIDATES)


@dataclass
class Random:
    """Points drawn uniformly and independently."""

    candidates: int = 10_000  # of a generation

    def __post_init__(self) -> None:
        self.candidates = _candidates(self.candidates)

    def start(self, space: Space, seed: int) -> None:
        """Restarts with this seed."""
        self._dimensions = len(space)
        self._draw = np.random.default_rng(seed)

    def ask(self) -> Doubles:
        """The next generation, (candidates, parameters)."""
        return self._draw.random((self.candidates, self._dimensions))

    def tell(self, points: Doubles, costs: Doubles) -> None:
        """No effect: draws do not depend on costs."""


@dataclass
class Sobol:
    """A scrambled Sobol sequence (SciPy), which covers the space more evenly than random points.

    Each generation continues the sequence. It is balanced if the total number of points is a power
    of two.
    """

    candidates: int = 8192  # of a generation

    def __post_init__(self) -> None:
        self.candidates = _candidates(self.candidates)

    def start(self, space: Space, seed: int) -> None:
        """Restarts with this seed. ImportError without SciPy."""
        qmc = needed("scipy.stats.qmc", "search.Sobol")
        if len(space) > qmc.Sobol.MAXDIM:
            raise ValueError(
                f"the space has {len(space)} parameters; a Sobol sequence has {qmc.Sobol.MAXDIM} at most"
            )
        self._sequence = qmc.Sobol(len(space), rng=np.random.default_rng(seed), bits=52)

    def ask(self) -> Doubles:
        """The next generation, (candidates, parameters)."""
        with warnings.catch_warnings():  # of numbers that are no power of two
            warnings.simplefilter("ignore", UserWarning)
            return np.asarray(self._sequence.random(self.candidates), np.float64)

    def tell(self, points: Doubles, costs: Doubles) -> None:
        """No effect: the sequence does not depend on costs."""


@dataclass
class Grid:
    """All combinations of equally spaced values. The last parameter changes fastest.

    levels      number of values of every parameter, or by name; both ends are included. For an
                integer at most its number of values
    candidates  maximum size of a generation; the last one has the remainder
    """

    levels: Union[int, Mapping[str, int]] = 10
    candidates: int = 10_000

    def __post_init__(self) -> None:
        self.candidates = _candidates(self.candidates)

    def start(self, space: Space, seed: int) -> None:
        """Restarts; a grid does not use the seed. ValueError for wrong levels."""
        if isinstance(self.levels, Mapping):
            for name in self.levels:
                space.index(name)
            if missing := [n for n in space.names if n not in self.levels]:
                raise ValueError(f"levels are missing for {', '.join(map(repr, missing))}")
            counts = [self.levels[name] for name in space.names]
        else:
            counts = [self.levels] * len(space)
        self._axes: list[Doubles] = []
        for p, count in zip(space.parameters, counts):
            most = int(p.high - p.low) + 1 if p.integer else MAX_CANDIDATES
            n = arrays.integer(count, f"levels of {p.name!r}", 1, MAX_CANDIDATES)
            unit = np.linspace(0, 1, n) if n > 1 else np.full(1, 0.5)
            if p.integer:  # the middles of what gives the values nearest to equal steps
                values = np.unique(np.round(p.low + (p.high - p.low) * unit))
                if n >= most:
                    values = np.arange(p.low, p.high + 1, dtype=np.float64)
                unit = p.to_unit(values)
            self._axes.append(unit)
        self._shape = tuple(len(axis) for axis in self._axes)
        self.points = 1
        for n in self._shape:
            self.points *= n
        if self.points > MAX_CANDIDATES:
            text = " x ".join(map(str, self._shape))
            raise ValueError(f"the grid has {text} points, must be {MAX_CANDIDATES} at most")
        self._next = 0

    @property
    def done(self) -> bool:
        """Whether ``ask`` has returned all points."""
        return self._next >= self.points

    def ask(self) -> Doubles:
        """The next generation, (at most candidates, parameters). ValueError after the last one."""
        if self.done:
            raise ValueError(f"all {self.points} points of the grid were returned already")
        end = min(self._next + self.candidates, self.points)
        index = np.unravel_index(np.arange(self._next, end), self._shape)
        self._next = end
        return np.stack([axis[i] for axis, i in zip(self._axes, index)], axis=1)

    def tell(self, points: Doubles, costs: Doubles) -> None:
        """No effect: the grid does not depend on costs."""


@dataclass
class CmaEs:
    """CMA-ES, the package ``cma`` (Hansen, The CMA evolution strategy: a tutorial, 2016).

    candidates  size of a generation
    sigma       initial standard deviation, relative to the range
    start_at    initial mean, values by name; other parameters start in the middle of their range
    parents     number of best candidates that update the mean; None: half of the candidates,
                or a tenth from 100 candidates on, because half of them would add noise
    options     other entries of ``cma.CMAOptions``, such as {"CMA_diagonal": True} for many
                parameters

    Points outside a range are reflected into it (``_folded``); cma searches without bounds. Only
    the order of costs matters. ``done`` is True once a stopping criterion of cma is met;
    ``why_done`` lists them.
    """

    candidates: int = 10_000
    sigma: float = 0.25
    start_at: Mapping[str, float] = field(default_factory=dict)
    parents: Optional[int] = None
    options: Mapping[str, Any] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.candidates = arrays.integer(self.candidates, "candidates", 4, MAX_CANDIDATES)
        if not 0 < self.sigma < np.inf:
            raise ValueError(f"sigma is {self.sigma}, must be finite and > 0")
        if self.parents is not None:
            self.parents = arrays.integer(self.parents, "parents", 1, self.candidates)

    def start(self, space: Space, seed: int) -> None:
        """Restarts with this seed. ImportError without cma, ValueError for unknown names in
        ``start_at``.
        """
        cma = needed("cma", "search.CmaEs")
        middle = np.full(len(space), 0.5)
        for name, value in self.start_at.items():
            i = space.index(name)
            p = space.parameters[i]
            if not p.low <= value <= p.high:
                raise ValueError(f"start_at of {name!r} is {value}, must be {p.low} to {p.high}")
            middle[i] = p.to_unit(np.array([value], np.float64))[0]
        draw = np.random.default_rng(seed)
        n = self.candidates
        parents = self.parents or (n // 10 if n >= 100 else n // 2)
        options = {
            "popsize": n,
            "CMA_mu": parents,
            # A separate generator: NumPy's global one does not change.
            "randn": lambda *shape: draw.standard_normal(shape),
            "seed": np.nan,
            "verbose": -9,
            **self.options,
        }
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self._held = cma.CMAEvolutionStrategy(_unfolded(middle), self.sigma, options)

    @property
    def done(self) -> bool:
        """Whether a stopping criterion of cma is met."""
        return bool(self._held.stop())

    @property
    def why_done(self) -> dict[str, Any]:
        """The stopping criteria that are met, with their values."""
        return dict(self._held.stop())

    @property
    def mean(self) -> Doubles:
        """Mean of the distribution, (parameters,) from 0 to 1: cma's ``xfavorite``."""
        return _folded(np.asarray(self._held.result.xfavorite, np.float64))

    def ask(self) -> Doubles:
        """The next generation, (candidates, parameters)."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self._asked = self._held.ask()
        return _folded(np.array(self._asked, np.float64))

    def tell(self, points: Doubles, costs: Doubles) -> None:
        """Sets the costs of the last generation, (candidates,)."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self._held.tell(self._asked, costs)


_MARGIN = 0.1  # of the range at each end, in which the folding is bent


def _folded(points: Doubles) -> Doubles:
    """Folds values into 0 to 1, without changes except in a margin m at each end.

    Within -m < x < m the value is y = (x + m)^2 / 4 m; values beyond that are mirrored. Points can
    therefore gather at an end, and none exceeds it. cma's own bounds are similar, but take 0.2 s
    for 10,000 points; this function takes a millisecond.
    """
    m = _MARGIN
    turn = 1 + 2 * m  # where it is mirrored again
    x = turn - np.abs(np.mod(points + m, 2 * turn) - turn) - m  # -m to 1 + m
    low, high = (x + m) ** 2 / (4 * m), 1 - (1 + m - x) ** 2 / (4 * m)
    within: Doubles = np.clip(np.where(x < m, low, np.where(x > 1 - m, high, x)), 0, 1)
    return within


def _unfolded(points: Doubles) -> Doubles:
    """Inverse of ``_folded``; of several values, the one between the mirrors."""
    m = _MARGIN
    low, high = 2 * np.sqrt(m * points) - m, 1 + m - 2 * np.sqrt(m * (1 - points))
    found: Doubles = np.where(points < m, low, np.where(points > 1 - m, high, points))
    return found
