"""Where to look next: designs (random, grid, Sobol) and CMA-ES, by ask and tell.

A strategy works on points with numbers from 0 to 1, one for each parameter. Anything with the three methods
of ``Strategy`` is one, so other libraries' optimisers fit in a few lines.
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
    """What a search asks for points and tells what came of them.

    ``done`` may be there, too: True once there is nothing more to ask; and ``mean``, (parameters,): the middle
    of where it looks.
    """

    def start(self, space: Space, seed: int) -> None:
        """Begins anew; the same seed gives the same points."""

    def ask(self) -> Doubles:
        """The next generation, (points, parameters) from 0 to 1."""
        ...

    def tell(self, points: Doubles, costs: Doubles) -> None:
        """What those of the last ``ask`` cost, (points,), finite; less is better."""


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
        """Begins anew."""
        self._dimensions = len(space)
        self._draw = np.random.default_rng(seed)

    def ask(self) -> Doubles:
        """The next ones, (candidates, parameters)."""
        return self._draw.random((self.candidates, self._dimensions))

    def tell(self, points: Doubles, costs: Doubles) -> None:
        """Nothing: draws do not depend on it."""


@dataclass
class Sobol:
    """A scrambled Sobol sequence (SciPy), which fills the space more evenly than draws do.

    Generations go on where the one before ended. It is balanced where the points so far are a power of two.
    """

    candidates: int = 8192  # of a generation

    def __post_init__(self) -> None:
        self.candidates = _candidates(self.candidates)

    def start(self, space: Space, seed: int) -> None:
        """Begins anew. ImportError without SciPy."""
        qmc = needed("scipy.stats.qmc", "search.Sobol")
        if len(space) > qmc.Sobol.MAXDIM:
            raise ValueError(
                f"the space has {len(space)} parameters; a Sobol sequence has {qmc.Sobol.MAXDIM} at most"
            )
        self._sequence = qmc.Sobol(len(space), rng=np.random.default_rng(seed), bits=52)

    def ask(self) -> Doubles:
        """The next ones, (candidates, parameters)."""
        with warnings.catch_warnings():  # of numbers that are no power of two
            warnings.simplefilter("ignore", UserWarning)
            return np.asarray(self._sequence.random(self.candidates), np.float64)

    def tell(self, points: Doubles, costs: Doubles) -> None:
        """Nothing: the sequence does not depend on it."""


@dataclass
class Grid:
    """Every combination of equally spaced values, the last parameter's changing fastest.

    levels      of every parameter, or of each by name; both ends are among them. An integer has no more
                than it has values
    candidates  of a generation at most; the last one has the rest
    """

    levels: Union[int, Mapping[str, int]] = 10
    candidates: int = 10_000

    def __post_init__(self) -> None:
        self.candidates = _candidates(self.candidates)

    def start(self, space: Space, seed: int) -> None:
        """Begins anew; a grid has no draws. ValueError for levels that do not fit."""
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
        """Whether all points were asked for."""
        return self._next >= self.points

    def ask(self) -> Doubles:
        """The next ones, (at most candidates, parameters). ValueError once it is done."""
        if self.done:
            raise ValueError(f"all {self.points} points of the grid were returned already")
        end = min(self._next + self.candidates, self.points)
        index = np.unravel_index(np.arange(self._next, end), self._shape)
        self._next = end
        return np.stack([axis[i] for axis, i in zip(self._axes, index)], axis=1)

    def tell(self, points: Doubles, costs: Doubles) -> None:
        """Nothing: the grid does not depend on it."""


@dataclass
class CmaEs:
    """CMA-ES, the package ``cma`` (Hansen, The CMA evolution strategy: a tutorial, 2016).

    candidates  of a generation
    sigma       first standard deviation, of ranges that are 1 wide
    start_at    values by name to begin around; what is not named begins in the middle of its range
    parents     how many of the best count; None: a tenth of the candidates from 100 on, else half. Large
                generations get lost in noise when half of them count
    options     further ones of ``cma.CMAOptions``, such as {"CMA_diagonal": True} for many parameters

    Points beyond a range are folded back into it (``_folded``): cma itself searches without bounds. Only the
    order of costs counts. ``done`` is True once
    cma finds one of its stopping criteria met; ``why_done`` says which.
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
        """Begins anew. ImportError without cma, ValueError for what ``start_at`` names."""
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
            # Draws of its own: numpy's global ones are not touched.
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
        """cma's criteria that are met, with their values."""
        return dict(self._held.stop())

    @property
    def mean(self) -> Doubles:
        """(parameters,) from 0 to 1: the middle of the distribution, cma's ``xfavorite``."""
        return _folded(np.asarray(self._held.result.xfavorite, np.float64))

    def ask(self) -> Doubles:
        """The next ones, (candidates, parameters)."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self._asked = self._held.ask()
        return _folded(np.array(self._asked, np.float64))

    def tell(self, points: Doubles, costs: Doubles) -> None:
        """What they cost, (candidates,)."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            self._held.tell(self._asked, costs)


_MARGIN = 0.1  # of the range at each end, in which the folding is bent


def _folded(points: Doubles) -> Doubles:
    """Any numbers as ones from 0 to 1: as they are but for a margin m at each end, which a parabola bends over to
    twice its width, y = (x + m)^2 / 4 m for -m < x < m; mirrored beyond that.

    So points gather at an end that is good, and none is beyond it. cma's own bounds are of this kind, too, but
    work solution by solution, which takes 0.2 s for 10,000; all at once it is a millisecond.
    """
    m = _MARGIN
    turn = 1 + 2 * m  # where it is mirrored again
    x = turn - np.abs(np.mod(points + m, 2 * turn) - turn) - m  # -m to 1 + m
    low, high = (x + m) ** 2 / (4 * m), 1 - (1 + m - x) ** 2 / (4 * m)
    within: Doubles = np.clip(np.where(x < m, low, np.where(x > 1 - m, high, x)), 0, 1)
    return within


def _unfolded(points: Doubles) -> Doubles:
    """What is folded to these numbers from 0 to 1; of several the one between the mirrors."""
    m = _MARGIN
    low, high = 2 * np.sqrt(m * points) - m, 1 + m - 2 * np.sqrt(m * (1 - points))
    found: Doubles = np.where(points < m, low, np.where(points > 1 - m, high, points))
    return found
