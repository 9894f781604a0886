"""manyworlds.search: candidates in worlds, results, and what goes wrong."""

import importlib.util
import json
import pickle
import tempfile
from pathlib import Path

import numpy as np
import pytest

import manyworlds as mw
from manyworlds import search
from manyworlds.search import Number, Parameter, Space


def scene() -> mw.Scene:
    """A ball over a plane, with a box beside it that jitters."""
    made = mw.Scene(name="throw")
    made.add(mw.Body(motion="fixed", shapes=[mw.Shape(geometry=mw.Plane())]))
    made.add(mw.Body(name="ball", position=(0, 0, 1), shapes=[mw.Shape(geometry=mw.Sphere(0.1))]))
    box = mw.Body(
        name="box", position=(1.5, 0, 0.6), shapes=[mw.Shape(geometry=mw.Box((0.2, 0.3, 0.4)))]
    )
    box.jitter = mw.Jitter(position=(0.1, 0.1, 0.1))
    made.add(box)
    return made


SPACE = Space(
    Parameter("speed", 1, 12),
    Parameter("angle", 5, 85),
    Parameter("radius", 0.05, 0.3, "log", sets=Number("size", "ball", component=0)),
    Parameter("mass", 10, 300, "log", sets=Number("mass", "box")),
    Parameter("mu", 0.1, 0.9, sets=Number("friction")),
    Parameter("turn", 0, 3, integer=True),
)


def throw(run: search.Run) -> None:
    angle, turn = np.radians(run["angle"]), run["turn"] * 0.05
    v = np.zeros((run.batch.worlds, 3))
    v[:, 0] = run["speed"] * np.cos(angle) * np.cos(turn)
    v[:, 1] = run["speed"] * np.cos(angle) * np.sin(turn)
    v[:, 2] = run["speed"] * np.sin(angle)
    velocity = run.batch.get("linear_velocity")
    velocity[:, run.batch.row("ball")] = v
    run.batch.set("linear_velocity", velocity)


def distance(run: search.Run) -> np.ndarray:
    return run.batch.get("position")[:, run.batch.row("ball"), 0].astype(float)


def trial(**more) -> search.Trial:
    return search.Trial(scene(), SPACE, distance, 40, **{"begin": throw, "threads": 1, **more})


def same(a: search.Results, b: search.Results) -> None:
    first, second = a.columns(), b.columns()
    assert list(first) == list(second)
    for name, column in first.items():
        assert column.tobytes() == second[name].tobytes(), name


STRATEGIES = {
    "random": lambda: search.Random(32),
    "sobol": lambda: search.Sobol(32),
    "grid": lambda: search.Grid(2, 32),
    "cma": lambda: search.CmaEs(32),
}


def needs(name: str) -> None:
    if name in ("sobol", "cma"):
        pytest.importorskip({"sobol": "scipy", "cma": "cma"}[name])


# -- worlds


def test_worlds_have_their_numbers_and_do_what_a_batch_does():
    values = SPACE.values(np.random.default_rng(3).random((9, len(SPACE))))
    seeds = np.arange(20, 29, dtype=np.uint64)
    seen = {}

    def look(run):
        throw(run)
        seen.update({name: run.batch.get(name) for name in ("size", "mass", "friction")})

    with trial(begin=look) as tried:
        outcome = tried.evaluate(values, seeds)
        plan = tried._numbers.plan
    assert (seen["size"][:, 1, 0] == values[:, 2]).all() and (
        seen["mass"][:, 1, 0] == values[:, 3]
    ).all()
    assert (seen["friction"][..., 0] == values[:, 4:5]).all()
    with mw.Batch(plan, 9, seed=20, threads=1) as batch:
        for name, array in seen.items():
            batch.set(name, array)
        throw(search.Run(SPACE, batch, values, seeds))
        batch.step(40)
        assert (outcome.hashes == batch.hashes()).all()
        assert (outcome.values == batch.get("position")[:, 0, 0]).all()


def test_what_is_set_may_follow_from_it():
    made = scene()
    space = Space(
        Parameter("thickness", 0.1, 0.6, sets=Number("size", "box", component=2, factor=0.5)),
        Parameter("g", 1, 20, sets=Number("gravity", component=2, factor=-1)),
    )
    seen = []
    tried = search.Trial(
        made, space, distance, 1, begin=lambda r: seen.append([r.batch.get(n) for n in ("size", "mass", "gravity")])
    )  # fmt: skip
    tried.evaluate([[0.5, 9], [0.2, 3]], 0)
    size, mass, gravity = seen[-1]
    np.testing.assert_allclose(size[:, 2], [[0.2, 0.3, 0.25], [0.2, 0.3, 0.1]])
    np.testing.assert_allclose(gravity[:, 0], [[0, 0, -9], [0, 0, -3]])
    assert made.variations == []  # the scene stays as it was


@pytest.mark.parametrize("name", STRATEGIES)
def test_results_do_not_depend_on_worlds_threads_or_isa(name):
    needs(name)
    found, least = [], mw.available_isas()[0]
    for worlds, threads, isa in ((None, 1, None), (5, 2, None), (17, 3, least), (1, 1, None)):
        with trial(worlds=worlds, threads=threads, isa=isa) as tried:
            hunt = search.Search(tried, STRATEGIES[name](), "maximize", 4, "candidate")
            found.append(hunt.run(2))
    for other in found[1:]:
        same(found[0], other)
    assert len(np.unique(found[0].columns()["hash"])) == 64


@pytest.mark.parametrize(
    ("seeds", "expected"),
    [("search", [7] * 6), ("generation", [7] * 3 + [8] * 3), ("candidate", [7, 8, 9, 10, 11, 12])],
)
def test_which_worlds_begin_alike(seeds, expected):
    with trial() as tried:
        hunt = search.Search(tried, search.Random(3), seed=7, seeds=seeds)
        assert hunt.run(2).columns()["seed"].tolist() == expected


def test_fields_and_controls_are_rolled_out():
    lander = mw.scenes.load("lunar-lander")
    space = Space(Parameter("thrust", 0, 1))
    high = []

    def climb(run):
        high.append(run.fields["position"])
        return run.fields["position"][-1, :, run.batch.row("lander"), 1].astype(float)

    def controls(run):
        return np.broadcast_to(run["thrust"][None, :, None], (30, run.batch.worlds, 3))

    tried = search.Trial(
        lander, space, climb, 30, controls=controls, fields=["position"], every=10, threads=1
    )
    outcome = tried.evaluate([[0.0], [1.0]], 1)
    assert high[0].shape[:2] == (3, 2) and outcome.values[1] > outcome.values[0]
    batch = mw.Batch(lander, 1, seed=1, threads=1)
    batch.set_controls(1)
    batch.step(30)
    assert batch.hash(0) == outcome.hashes[1]
    with tempfile.TemporaryDirectory() as folder:
        pytest.importorskip("manyworlds.record")
        recording, again = tried.record({"thrust": 1}, 1, Path(folder) / "a.h5")
        assert again.hashes[0] == outcome.hashes[1] and len(recording.steps) == 31
        recording.close()
    with pytest.raises(ValueError, match=r"controls have shape \(30, 2, 3\); expected \(steps=20"):
        search.Trial(lander, space, climb, 20, controls=np.zeros((30, 2, 3))).evaluate(
            [[0], [1]], 1
        )


def test_tasks_are_searched_by_their_actions():
    task = mw.tasks.load("BirdSling")
    space = Space(*(Parameter(a.name, a.low, a.high) for a in task.actions))
    with search.TaskTrial(task, space, threads=1) as tried:
        found = search.Search(tried, search.Random(12), "maximize", seed=3).run(1)
    columns = found.columns()
    env = mw.Environment(task, 12, threads=1, autoreset="disabled")
    env.reset(seeds=[3] * 12)
    actions = np.stack([columns[a.name] for a in task.actions], axis=1).astype(np.float32)
    total, going = np.zeros(12), np.ones(12, bool)
    for _ in range(task.max_steps):
        _, rewards, terminated, truncated = env.step(actions)
        total += going * rewards
        going &= ~(terminated | truncated)
    assert (columns["value"] == total).all() and (columns["hash"] == env.batch.hashes()).all()
    with pytest.raises(ValueError, match="the task's actions 'steepness' are not parameters"):
        search.TaskTrial(task, Space(Parameter("strength", 0, 1)))
    with pytest.raises(ValueError, match="parameters 'idle' are not actions of the task"):
        search.TaskTrial(task, Space(*space.parameters, Parameter("idle", 0, 1)))


def test_policies_are_searched_by_their_weights():
    task = mw.tasks.load("CartPole")
    weights = [f"w{i}" for i in range(4)]
    space = Space(*(Parameter(w, -1, 1) for w in weights))

    def act(run):
        seen = run.environment.observations
        return ((seen * run.values).sum(axis=1) > 0).astype(np.int64)

    with search.TaskTrial(task, space, act=act, steps=120, threads=1) as tried:
        hunt = search.Search(tried, search.Random(64), "maximize", seed=1, seeds="candidate")
        best = hunt.run(1).best
        again = tried.evaluate(space.row(best.values)[None], best.seed)
    assert best.value > 60 and again.hashes[0] == best.hash and again.values[0] == best.value


# -- what goes wrong


@pytest.mark.parametrize(
    ("number", "says"),
    [
        (Number("size", "ball"), "'x' sets size, which has 3 components; component is none, expected 0 to 2"),
        (Number("mass", "bal"), "'x': .*bal"),
        (Number("mass", 0), "'x': .*fixed"),
        (Number("kp"), "newton"),
        (Number("attractor_strength", attractor=1), "'x': attractor is 1, must be one of 0"),
        (Number("size", "ball", 3, component=0), "'x': shape is 3, must be 0 to 0"),
        (Number("friction", "box"), "'mu' and 'x' both set friction of shape 2"),
    ],
)  # fmt: skip
def test_errors_say_what_cannot_be_set(number, says):
    space = Space(SPACE.parameters[4], Parameter("x", 0.1, 1, sets=number))
    with pytest.raises((ValueError, IndexError), match=says):
        search.Trial(scene(), space, distance, 1)


def test_lost_worlds_and_broken_constraints_cost_finite_numbers():
    pytest.importorskip("cma")
    space = Space(Parameter("x", 0, 1), Parameter("y", 0, 1))

    def begin(run):
        v = run.batch.get("linear_velocity")
        v[run["x"] > 0.8] = np.nan
        run.batch.set("linear_velocity", v)

    def objective(run):
        value = np.where(run["x"] > 0.6, np.nan, -run["x"])
        return search.Score(value, np.stack([0.3 - run["y"], run["y"] - 0.9], axis=1))

    told = []

    class Watched(search.CmaEs):
        def tell(self, points, costs):
            told.append(costs)
            super().tell(points, costs)

    for lost in (None, -5.0):
        with search.Trial(scene(), space, objective, 2, begin=begin, threads=1) as tried:
            hunt = search.Search(tried, Watched(64), "maximize", seed=1, lost=lost)
            hunt.run(2)
        for costs, g in zip(told[-2:], hunt.results.generations):
            ok, infeasible, rest = g.status == 0, g.status == 1, g.status > 1
            x, y = g.values.T
            assert (ok == ((x <= 0.6) & (y >= 0.3) & (y <= 0.9))).all()
            assert ((g.status == 2) == (x > 0.8)).all() and rest.any() and infeasible.any()
            assert np.isfinite(costs).all() and (costs[ok] == x[ok]).all()
            assert (costs[infeasible] >= costs[ok].max()).all()
            order = np.argsort(g.violation[infeasible])
            assert (np.diff(costs[infeasible][order]) >= 0).all()
            assert (costs[rest] == 5).all() if lost else costs[rest].min() > costs[~rest].max()
        columns = hunt.results.columns()
        assert np.isnan(columns["value"][np.isin(columns["status"], ["lost", "not_finite"])]).all()
    nowhere = search.Trial(
        scene(), space, lambda run: np.full(run.batch.worlds, np.nan), 1, threads=1
    )
    hunt = search.Search(nowhere, Watched(8))
    assert "8 not_finite" in str(hunt.run(1).generations[0]) and (told[-1] == 1).all()
    with pytest.raises(ValueError, match="no candidate of 8 is ok: 8 not_finite"):
        hunt.results.best


def test_what_callbacks_return_is_checked():
    with search.Trial(scene(), SPACE, lambda run: np.zeros(3), 1) as tried:
        with pytest.raises(
            ValueError, match=r"the value of the objective has shape \(3,\); expected"
        ):
            tried.evaluate(SPACE.values(np.full((2, 6), 0.5)), 0)
        middle = SPACE.values(np.full((2, 6), 0.5))
        for seeds, says in (
            (0.5, "seeds are of dtype float64; expected integers"),
            ([1, -1], "seeds hold -1, must be 0 to"),
            ([1, 2, 3], r"seeds have shape \(3,\); expected \(candidates=2,\)"),
        ):
            with pytest.raises((TypeError, ValueError), match=says):
                tried.evaluate(middle, seeds)
    with pytest.raises(ValueError, match="steps is 0"):
        search.Trial(scene(), SPACE, distance)
    with pytest.raises(ValueError, match="drive takes its own steps"):
        search.Trial(scene(), SPACE, distance, 5, drive=lambda run: {})
    with pytest.raises(ValueError, match="goal is 'max'; expected 'minimize' or 'maximize'"):
        search.Search(SPACE, search.Random(2), "max")
    with pytest.raises(ValueError, match="no generation is open; call ask"):
        search.Search(SPACE, search.Random(2)).tell([1, 2])
    with pytest.raises(ValueError, match="has a space but no trial"):
        search.Search(SPACE, search.Random(2)).run(1)


@pytest.mark.parametrize("name", ["random", "cma"])
def test_an_interrupt_leaves_what_there_is_and_goes_on(name, tmp_path):
    needs(name)
    rounds = []

    def interrupted(run):
        rounds.append(0)
        if len(rounds) == 6:  # in the middle of the third generation
            raise KeyboardInterrupt
        return distance(run)

    with trial(worlds=16) as tried:
        whole = search.Search(tried, STRATEGIES[name](), seed=2).run(4)
    with search.Trial(scene(), SPACE, interrupted, 40, begin=throw, worlds=16, threads=1) as tried:
        hunt = search.Search(tried, STRATEGIES[name](), seed=2)
        parquet = importlib.util.find_spec("pyarrow") and tmp_path / "so_far.parquet"
        with pytest.raises(KeyboardInterrupt):
            hunt.run(4, file=parquet)
        if parquet:
            from pyarrow.parquet import read_table

            assert read_table(parquet).to_pydict() == hunt.results.table().to_pydict()
        assert len(hunt.results) == 64
        same(hunt.run(2), whole)


def test_a_hash_that_differs_is_said():
    pytest.importorskip("manyworlds.record")

    def leaking(run):
        throw(run)
        if run.batch.worlds > 1:
            run.batch.set("linear_velocity", 1)

    with trial(begin=leaking) as tried, tempfile.TemporaryDirectory() as folder:
        hunt = search.Search(tried, search.Random(8))
        hunt.run(1)
        with pytest.raises(RuntimeError, match="worlds depend on each other"):
            hunt.record(Path(folder) / "best.h5")


# -- results


def test_the_best_is_recorded_and_shown(tmp_path):
    record = pytest.importorskip("manyworlds.record")
    with trial() as tried:
        hunt = search.Search(tried, search.Random(24), "maximize", seed=9, seeds="candidate")
        columns = hunt.run(2).columns()
        best = hunt.results.best
        assert best.value == columns["value"].max() and best.hash in columns["hash"]
        recording = hunt.record(tmp_path / "best.h5", every=4)
    assert isinstance(recording, record.Recording)
    assert int(recording.hashes[-1, 0]) == best.hash and len(recording.steps) == 11
    assert recording.replay().same
    try:
        page = mw.show(recording)
    except FileNotFoundError:
        return  # built without the page
    assert "iframe" in page._repr_html_()


def test_a_table(tmp_path):
    pa = pytest.importorskip("pyarrow")
    import pyarrow.feather as feather
    import pyarrow.parquet as parquet

    with trial() as tried:
        hunt = search.Search(tried, search.Grid(2, 20), seed=9)
        results = hunt.run(file=tmp_path / "found.parquet")
    assert len(results) == 64 and hunt.done
    table = results.table()
    assert table.column_names == [
        "generation", "candidate", *SPACE.names, "value", "violation", "cost", "status", "seed", "hash"
    ]  # fmt: skip
    assert (
        table.schema.field("turn").type == pa.int64()
        and table.schema.field("hash").type == pa.uint64()
    )
    for name, column in results.columns().items():
        assert table[name].to_pylist() == column.tolist(), name
    read = parquet.read_table(tmp_path / "found.parquet")
    assert read.to_pydict() == table.to_pydict()
    about = json.loads(read.schema.metadata[b"manyworlds.search"])
    assert about["goal"] == "minimize" and about["parameters"][2]["scale"] == "log"
    results.save(tmp_path / "found.arrow")
    assert feather.read_table(tmp_path / "found.arrow").to_pydict() == table.to_pydict()
    assert sorted(f.name for f in tmp_path.iterdir()) == ["found.arrow", "found.parquet"]
    with pytest.raises(ValueError, match="ends with .parquet, .arrow or .feather"):
        hunt.run(0, file="found.csv")
    empty = search.Search(SPACE, search.Random(2)).results
    assert len(empty.table()) == 0 and empty.table().schema.equals(table.schema)
    assert pickle.loads(pickle.dumps(results)).best == results.best
