"""manyworlds.search: parameters, designs, CMA-ES, and strategies of one's own."""

import sys

import numpy as np
import pytest

from manyworlds import search
from manyworlds.search import Parameter, Space
from manyworlds.search.strategies import _folded, _unfolded
from test_search import SPACE, STRATEGIES, needs


def test_values_cover_their_ranges():
    unit = np.linspace(0, 1, 1001)
    for p in SPACE.parameters:
        values = p.from_unit(unit)
        assert values.min() == p.low and values.max() == p.high and (np.diff(values) >= 0).all()
        np.testing.assert_allclose(p.from_unit(p.to_unit(values)), values, rtol=1e-12)
    assert Parameter("a", 1, 100, "log").from_unit(np.array([0.5]))[0] == pytest.approx(10)
    counts = np.bincount(Parameter("n", 2, 5, integer=True).from_unit(unit).astype(int))
    assert counts[2:].min() >= 250 and len(counts) == 6
    values = SPACE.values(np.random.default_rng(1).random((50, len(SPACE))))
    assert (SPACE.values(SPACE.points(values))[:, -1] == values[:, -1]).all()
    named = SPACE.named(values[0])
    assert (SPACE.row(named) == values[0]).all() and type(named["turn"]) is int


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Parameter("a", 2, 1), "parameter 'a': low is 2, must be < high, which is 1"),
        (lambda: Parameter("a", 0, 1, "log"), "'a': low is 0, must be > 0: its scale is 'log'"),
        (lambda: Parameter("a", 0, np.inf), "'a': high is inf, must be finite"),
        (lambda: Parameter("a", 0, 1.5, integer=True), "'a': high is 1.5, must be a whole number"),
        (lambda: Parameter("a", 0, 1, "cubic"), "'a': scale is 'cubic'; expected 'linear' or 'log'"),
        (lambda: Parameter("seed", 0, 1), "'seed': its name is reserved for a column"),
        (lambda: Parameter("a", "0", 1), "'a': low is of type str; expected a number"),
        (lambda: Parameter("a", 0, 1, sets=["mass"]), "'a': sets holds a str; expected Numbers"),
        (lambda: Space(), "no parameters"),
        (lambda: Space(Parameter("a", 0, 1), Parameter("a", 0, 1)), "several parameters have the name 'a'"),
        (lambda: SPACE.row({"speed": 1}), "has no 'angle'"),
        (lambda: SPACE.index("sped"), "no parameter 'sped'; expected one of 'speed'"),
        (lambda: SPACE.values([[0, 0, 0, 0, 0, 1.5]]), "point 0 has 1.5 for 'turn', must be 0 to 1"),
        (lambda: SPACE.checked([[1, 5, 1, 10, 0.1, 0]]), "'radius' is 1.0 in row 0, must be 0.05 to 0.3"),
        (lambda: SPACE.checked([[1, 5, 0.1, 10, 0.1, 0.5]]), "'turn' is 0.5 in row 0, must be 0 to 3, whole"),
        (lambda: SPACE.values([0.5]), r"points have shape \(1,\); expected"),
    ],
)  # fmt: skip
def test_errors_name_the_parameter(make, says):
    with pytest.raises((ValueError, TypeError), match=says):
        make()


# -- strategies


@pytest.mark.parametrize("name", STRATEGIES)
def test_the_same_seed_asks_for_the_same_points(name):
    needs(name)
    asked = {}
    for key, seed in ((0, 5), (1, 5), (2, 6)):
        np.random.seed(key)  # nothing reads numpy's global draws, nor changes them
        before = np.random.get_state()[1].copy()
        strategy = STRATEGIES[name]()
        strategy.start(SPACE, seed)
        points = []
        for _ in range(2):
            points.append(strategy.ask())
            strategy.tell(points[-1], points[-1].sum(axis=1))
        assert (np.random.get_state()[1] == before).all()
        asked[key] = np.concatenate(points)
        assert asked[key].shape == (64, len(SPACE))
        assert asked[key].min() >= 0 and asked[key].max() <= 1
    assert asked[0].tobytes() == asked[1].tobytes()
    assert name == "grid" or asked[0].tobytes() != asked[2].tobytes()


def test_a_grid_has_every_combination_once():
    space = Space(
        Parameter("a", 0, 1), Parameter("n", 1, 3, integer=True), Parameter("c", 1, 4, "log")
    )
    grid = search.Grid({"a": 3, "n": 10, "c": 2}, 7)
    grid.start(space, 0)
    generations = []
    while not grid.done:
        generations.append(space.values(grid.ask()))
    assert [len(g) for g in generations] == [7, 7, 4]
    expected = [(a, n, c) for a in (0, 0.5, 1) for n in (1, 2, 3) for c in (1, 4)]
    np.testing.assert_allclose(np.concatenate(generations), expected)
    with pytest.raises(ValueError, match="all 18 points"):
        grid.ask()
    with pytest.raises(ValueError, match="levels are missing for 'n', 'c'"):
        search.Grid({"a": 3}).start(space, 0)
    with pytest.raises(ValueError, match="100000 x 3 x 100000 points"):
        search.Grid(100_000).start(space, 0)


def test_sobol_fills_evenly():
    pytest.importorskip("scipy")
    sobol = search.Sobol(64)
    sobol.start(Space(Parameter("a", 0, 1), Parameter("b", 0, 1)), 1)
    points = np.concatenate([sobol.ask(), sobol.ask()])
    cells = (points * [8, 16]).astype(int)
    assert len(np.unique(cells, axis=0)) == 128  # one in each


def test_cma_finds_a_minimum_and_is_done():
    pytest.importorskip("cma")
    space = Space(Parameter("a", -3, 3), Parameter("b", 0.01, 100, "log"))
    hunt = search.Search(space, search.CmaEs(24, start_at={"a": -2}), seed=2)
    while not hunt.done:
        a, b = hunt.ask().values.T
        hunt.tell((a - 1) ** 2 + np.log(b / 5) ** 2)
    assert hunt.mean == pytest.approx({"a": 1, "b": 5}, rel=1e-3)
    assert hunt.results.best.value < 1e-6 and hunt.strategy.why_done
    with pytest.raises(ValueError, match="start_at of 'a' is 7, must be -3 to 3"):
        search.Search(space, search.CmaEs(24, start_at={"a": 7}))


def test_what_leaves_its_range_is_folded_back():
    x = np.linspace(-3, 3, 60_001)
    y = _folded(x)
    assert y.min() == 0 and y.max() == 1 and np.abs(np.diff(y)).max() < 1.0001e-4  # no jumps
    assert (np.diff(y)[np.abs(x[1:] - 0.5) < 0.59] > 0).all()
    middle = np.abs(x - 0.5) < 0.4
    np.testing.assert_allclose(y[middle], x[middle], atol=1e-12)
    points = np.linspace(0, 1, 101)
    np.testing.assert_allclose(_folded(_unfolded(points)), points, atol=1e-12)


def test_other_strategies_and_evaluators_fit():
    class Halving:
        """Looks around the best so far, ever closer."""

        def start(self, space, seed):
            self.at, self.width, self.draw = (
                np.full(len(space), 0.5),
                0.5,
                np.random.default_rng(seed),
            )

        def ask(self):
            near = self.at + self.width * self.draw.uniform(-1, 1, (50, len(self.at)))
            return np.clip(near, 0, 1)

        def tell(self, points, costs):
            self.at, self.width = points[np.argmin(costs)], self.width / 2

    class Elsewhere:
        space = Space(Parameter("a", -3, 3))

        def evaluate(self, values, seeds):
            n = len(values)
            return search.Outcome(
                (values[:, 0] - 1) ** 2, np.zeros(n), np.zeros(n, bool), np.zeros(n, np.uint64)
            )

    hunt = search.Search(Elsewhere(), Halving(), seed=1)
    assert hunt.run(12).best.values["a"] == pytest.approx(1, abs=1e-2)
    with pytest.raises(ValueError, match="Halving never ends; expected a number"):
        hunt.run()
    with pytest.raises(ValueError, match="has no record\\("):
        hunt.record("x.h5")


MISSING = r"needs {}, which is not installed; install it with: pip install .manyworlds-sim\[search\]"


@pytest.mark.parametrize("package", ["cma", "scipy.stats.qmc", "pyarrow"])
def test_what_is_missing_is_named(package, monkeypatch, tmp_path):
    monkeypatch.setitem(sys.modules, package, None)
    calls = {
        "cma": lambda: search.Search(SPACE, search.CmaEs(8)),
        "scipy.stats.qmc": lambda: search.Search(SPACE, search.Sobol(8)),
        "pyarrow": lambda: search.Search(SPACE, search.Random(8)).results.save(
            tmp_path / "a.parquet"
        ),
    }
    with pytest.raises(ImportError, match=MISSING.format(package.split(".")[0])):
        calls[package]()
