"""State in expressions, evaluation of expressions, and results that are not finite, from Python."""

import math
import pickle
import warnings

import numpy as np
import pytest

import manyworlds as mw
from manyworlds import tasks


def falling():
    """A ball that falls freely from 5 m, each world at its own speed, and an action."""
    scene = mw.Scene(space="planar")
    scene.options.gravity = (0, -10, 0)
    ball = mw.Body(name="ball", position=(1, 5, 0), shapes=[mw.Shape(geometry=mw.Circle(0.1))])
    ball.jitter.linear_velocity = (2, 2, 0)
    scene.add(ball)
    scene.add(mw.Control(name="push", kind="thrust", body=0, low=-50, high=50))
    task = mw.Task(name="falling", scene=scene, max_steps=9)
    task.act("a", -9, 9)
    task.controls = [0]
    return task


def remembering():
    task = falling()
    t, a = task.terms, task.terms.action()
    x = t.position("ball", 0)
    best = task.memory("best", x, lambda best: tasks.maximum(best, x))
    steps = task.memory("steps", 10)
    task.memories[-1].next = steps + 1
    task.controls = [steps + tasks.smoothed(a, time_constant=0.1) + 0.5 * t.age()]
    task.observe("x", x)
    task.observe("best", best)
    task.observe("steps", steps)
    task.observe("again", t.memory("steps"))
    task.observe("low", tasks.latched(t.position("ball", 1) < 4.99))
    task.observe("sum", tasks.summed(x))
    task.observe("smooth", tasks.smoothed(x, 0.5))
    task.observe("phase", tasks.phase(20))
    task.observe("push", t.control("push"))
    task.observe("time", t.age() * t.time_step())
    task.reward("progress", x - tasks.previous(x))
    return task


@pytest.mark.parametrize("autoreset", ["next_step", "same_step"])
def test_state_in_expressions(autoreset):
    task = pickle.loads(pickle.dumps(remembering()))
    assert task.validate() == []
    with mw.Environment(task, 7, threads=1, seed=3, autoreset=autoreset) as env:
        actions = np.linspace(-9, 9, 7)[:, None]
        episodes = 0
        for _ in range(30):
            x = env.observations[:, 0].copy()
            before = dict(zip(env.observation_names, env.observations.T.copy()))
            beginning = before["time"] == 0
            env.step(actions)
            after = env.observations
            ended = env.terminated | env.truncated
            if autoreset == "same_step":
                after = np.where(ended[:, None], env.final_observations, env.observations)
            o = dict(zip(env.observation_names, after.T))
            if (o["time"] == 0).any():  # an episode began with this step
                assert (o["steps"] == 10).all() and (o["best"] == o["x"]).all()
                assert (o["sum"] == 0).all() and (o["phase"] == 0).all() and (o["low"] == 0).all()
                episodes += 1
                continue
            episodes += int(autoreset == "same_step" and ended.any())
            age = np.rint(o["time"] * 60)
            assert o["steps"] == pytest.approx(10 + age) and (o["again"] == o["steps"]).all()
            assert (o["best"] == np.maximum(before["best"], o["x"])).all()
            assert o["sum"] == pytest.approx(before["sum"] + o["x"], rel=1e-5)
            assert o["smooth"] == pytest.approx((before["smooth"] + o["x"]) / 2, rel=1e-5)
            assert o["phase"] == pytest.approx(age * 20 / 60 % 1, abs=1e-5)
            filtered = (1 - np.exp(-10 / 60)) * (actions[:, 0] if beginning.all() else 0)
            if beginning.all():  # memories as the last step left them, functions with this one
                assert o["push"] == pytest.approx(10 + filtered + 0.5, rel=1e-5)
            assert x.shape == (7,)
        assert episodes >= 2


def test_evaluate_is_what_an_info_would_be():
    task = remembering()
    t = task.terms
    asked = {
        "progress": task.rewards[0].value * 100,
        "best": t.memory("best") + t.action(),
        "sum": tasks.summed(t.position("ball", 0)),
        "noise": t.uniform("noise"),
        "three": 3.0,
    }
    told = remembering()
    for name, value in asked.items():
        told.tell(name, value)
    arguments = dict(worlds=7, threads=1, seed=3, autoreset="same_step")
    with mw.Environment(task, **arguments) as env, mw.Environment(told, **arguments) as other:
        assert (env.evaluate(asked["best"]) == other.infos[:, 1]).all()
        random = np.random.default_rng(0)
        for _ in range(25):
            actions = random.uniform(-9, 9, (7, 1))
            env.step(actions), other.step(actions)
            hashes = env.batch.hash()
            for name, value in asked.items():
                found = env.evaluate(value)
                assert found.shape == (7,) and found.dtype == np.float64
                wanted = other.infos[:, other.info_names.index(name)]
                if name != "noise":  # of copies of a task that draws nothing
                    assert found == pytest.approx(wanted, rel=1e-5, abs=1e-5), name
            assert env.batch.hash() == hashes
            assert (env.observations == other.observations).all()
        again = mw.Environment(task, **arguments)
        again.restore(env.save())
        assert (again.evaluate(asked["progress"]) == env.evaluate(asked["progress"])).all()
        with pytest.raises(ValueError, match=r"previous\(position\(0, 'y'\)\) depends on earlier steps"):
            env.evaluate(tasks.previous(t.position("ball", 1)))
        with pytest.raises(ValueError, match="the observer 'touching'"):
            env.evaluate(t.touching("ball"))
        with pytest.raises(ValueError, match="position of body 7"):
            env.evaluate(t.position(7, 0))
        with pytest.raises(TypeError, match="expression"):
            env.evaluate("x")


def risky():
    task = falling()
    task.observe("x", task.terms.position("ball", 0))
    task.observe("depth", tasks.log(1 - task.terms.action()))
    task.reward("pace", tasks.sqrt(2 - task.terms.action()))
    task.terminated = ~(tasks.sqrt(2 - task.terms.action()) < 9)
    return task


@pytest.mark.parametrize("autoreset", ["next_step", "same_step", "disabled"])
def test_worlds_whose_results_are_not_finite_are_lost_and_named_once(autoreset):
    arguments = dict(threads=1, seed=3, autoreset=autoreset)
    with mw.Environment(risky(), 9, **arguments) as env, mw.Environment(risky(), 9, **arguments) as calm:
        actions = np.zeros((9, 1))
        env.step(actions), calm.step(actions)
        actions[4] = 3
        with pytest.warns(RuntimeWarning) as told:
            env.step(actions)
        calm.step(np.zeros((9, 1)))
        texts = [str(w.message) for w in told]
        assert len(texts) == 3 and told[0].filename == __file__
        for text, name in zip(sorted(texts), ("observation 1 'depth'", "reward 0 'pace'", "terminated")):
            assert text.startswith(f"{name} is nan in world 4 at step 2 of its episode: the world is lost")
        assert env.truncated.tolist() == env.lost_at_end.tolist() == [w == 4 for w in range(9)]
        assert not env.terminated.any()
        assert env.lost().any() == (autoreset != "same_step")
        others = np.arange(9) != 4
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            env.step(actions)
            actions[2] = 3
            env.step(actions)
        assert [f.world for f in env.non_finite()] == [4, 4, 4]
        assert str(env.non_finite()[0]) in texts[0] and math.isnan(env.non_finite()[0].value)
        calm.step(np.zeros((9, 1))), calm.step(np.zeros((9, 1)))
        others[2] = False
        assert (env.observations[others] == calm.observations[others]).all()
        env.reset()
        assert not env.lost().any() and not env.lost_at_end.any()


def test_check_raises_with_the_expression_the_world_and_the_step():
    with mw.Environment(risky(), 9, threads=1, check=True) as env:
        actions = np.zeros((9, 1))
        env.step(actions)
        actions[[7, 4]] = 3
        with pytest.raises(mw.NonFiniteError, match="observation 1 'depth' is nan in world 4 at step 2") as error:
            env.step(actions)
        found = error.value
        assert (found.expression, found.world, found.step) == ("observation 1 'depth'", 4, 2)
        assert math.isnan(found.value) and isinstance(found, FloatingPointError)
        assert env.batch.steps == 2 and np.flatnonzero(env.truncated).tolist() == [4, 7]
        env.step(np.zeros((9, 1)))  # worlds 4 and 7 begin anew
    task = falling()
    task.observe("start", tasks.log(task.terms.age() - 1))
    with pytest.raises(
        mw.NonFiniteError,
        match="observation 0 'start' is nan in world 0 at the start of its episode",
    ):
        mw.Environment(task, threads=1, check=True)
    with pytest.warns(RuntimeWarning, match="at the start of its episode"):
        mw.Environment(task, threads=1)


def test_numbers_that_are_not_finite_and_names_that_are_not_single_are_refused():
    task = falling()
    x = task.terms.position("ball", 0)
    task.observe("x", x)
    task.observe("x", tasks.clip(x, -math.inf, 3))
    task.reward("r", math.nan)
    task.terminated = (x > 1) & (x < math.inf)
    assert [str(issue) for issue in task.validate()] == [
        "observation 1 'x' has the name of observation 0 'x', must be unique",
        "observation 1 'x' holds the number -inf, must be finite",
        "reward 0 'r' holds the number nan, must be finite",
        "terminated holds the number inf, must be finite",
    ]


def test_gymnasium_tells_of_lost_worlds():
    gymnasium = pytest.importorskip("gymnasium")
    from manyworlds.gym import Env, VectorEnv

    actions = np.zeros((4, 1), np.float32)
    actions[2] = 3
    for mode in gymnasium.vector.AutoresetMode:
        env = VectorEnv(risky(), 4, autoreset_mode=mode)
        env.reset(seed=1)
        with pytest.warns(RuntimeWarning, match="depth"):
            *_, terminated, truncated, infos = env.step(actions)
        same = mode == gymnasium.vector.AutoresetMode.SAME_STEP
        told = infos["final_info"] if same else infos
        assert told["lost"].tolist() == truncated.tolist() == [False, False, True, False]
        assert not terminated.any()
    env = Env(risky())
    env.reset(seed=1)
    with pytest.warns(RuntimeWarning, match="depth"):
        *_, terminated, truncated, info = env.step(np.array([3.0], np.float32))
    assert truncated and not terminated and info["lost"]
    checked = Env(risky(), check=True)
    checked.reset(seed=1)
    with pytest.raises(mw.NonFiniteError):
        checked.step(np.array([3.0], np.float32))


def test_smoothed_wants_one_of_two():
    with pytest.raises(TypeError, match="either `factor` or `time_constant`"):
        tasks.smoothed(1)
    with pytest.raises(TypeError, match="either `factor` or `time_constant`"):
        tasks.smoothed(1, 0.5, time_constant=2)
