"""Delays, levels that outlive episodes, and numbers of the scene that a task sets."""

import pickle

import numpy as np
import pytest

import manyworlds as mw
from manyworlds import tasks


def stairs() -> mw.Task:
    """Episodes of as many steps as the world's level, which is one more after each; the cart begins there."""
    task = tasks.load("CartPole")
    t = task.terms
    level = task.level("step", begin=1)
    task.levels[-1].next = level + 1
    task.scene.variations = [mw.vary("friction", 0.0, 1.0, "none")]
    task.initial_parameter(t.parameter("friction", shape=0, body=0), 0.1 * level)
    task.observe("step", level)
    task.observe("friction", t.parameter("friction", shape=0, body=0))
    task.tell("step", level)
    task.terminated = t.age() >= level
    return task


@pytest.mark.parametrize("autoreset", ["next_step", "same_step"])
def test_levels_go_on_where_episodes_end(autoreset):
    task = stairs()
    assert not task.validate()
    with mw.Environment(task, 3, autoreset=autoreset) as e:
        assert e.level_names == ["step"]
        np.testing.assert_array_equal(e.levels(), [[1], [1], [1]])
        np.testing.assert_allclose(e.observations[:, -1], 0.1, rtol=1e-6)
        for _ in range(3 if autoreset == "same_step" else 5):  # episodes of one step and two
            e.step(np.zeros(3, np.int64))
        np.testing.assert_array_equal(e.levels(), [[3], [3], [3]])
        np.testing.assert_allclose(e.batch.get("friction").ravel()[:1], 0.3, rtol=1e-6)
        e.set_levels([[8], [7]], [2, 0])
        np.testing.assert_array_equal(e.levels().ravel(), [7, 3, 8])
        saved = pickle.loads(pickle.dumps(e.save()))
        e.set_levels(2)
        np.testing.assert_array_equal(e.levels().ravel(), [2, 2, 2])
        e.restore(saved)
        np.testing.assert_array_equal(e.levels().ravel(), [7, 3, 8])
        e.reset()
        np.testing.assert_array_equal(e.levels().ravel(), [7, 3, 8])
        np.testing.assert_allclose(e.observations[:, -1], [0.7, 0.3, 0.8], rtol=1e-6)
        e.reset(seeds=5)
        np.testing.assert_array_equal(e.levels().ravel(), [1, 1, 1])
        with pytest.raises(ValueError, match="'step' of world 1 is nan, must be a finite"):
            e.set_levels([[1], [np.nan], [1]])
        with pytest.raises(ValueError, match="levels"):
            e.set_levels([[1], [2]])
        with pytest.raises(TypeError, match="levels"):
            e.set_levels("hard")
        with pytest.raises(ValueError, match="name world . more than once"):
            e.set_levels(1, [0, 0])
        for world in (3, -1):
            with pytest.raises(IndexError):
                e.set_levels(1, [world])
        e.set_levels(4, np.array([True, False, False]))
        e.set_levels(9, [])
        e.set_levels(6, 2)
        np.testing.assert_array_equal(e.levels().ravel(), [4, 1, 6])


def test_tasks_with_levels_and_delays_are_plain_values():
    task = stairs()
    task.observe("late", tasks.delayed(task.terms.position("cart", "x"), 2))
    again = pickle.loads(pickle.dumps(task))
    assert repr(again.levels[0].next) == repr(task.levels[0].next)
    actions = np.zeros(4, np.int64)
    with mw.Environment(task, 4) as one, mw.Environment(again, 4) as other:
        for _ in range(12):
            np.testing.assert_array_equal(one.step(actions)[0], other.step(actions)[0])


def test_what_is_delayed_was_seen_before():
    task = tasks.load("CartPole")
    t = task.terms
    x = t.position("cart", "x")
    lag = t.uniform("lag", 0, 4, every="episode")
    task.observe("x", x)
    task.observe("lag", lag)
    task.observe("late", tasks.delayed(x, lag, 3))
    task.observe("two ago", tasks.delayed(x, 2))
    task.controls = [tasks.where(tasks.delayed(t.action(), 1), 10, -10)]
    task.observe("push", t.control(0))
    task.terminated = 0
    rng = np.random.default_rng(3)
    with mw.Environment(task, 50) as e:
        seen, asked = [e.observations[:, -5].copy()], [np.zeros(50, np.int64)]
        for step in range(1, 12):
            asked.append(rng.integers(0, 2, 50))
            e.step(asked[-1])
            _, lags, late, two_ago, push = e.observations[:, -5:].T
            seen.append(e.observations[:, -5].copy())
            back = np.maximum(step - np.minimum(lags.astype(int), 3), 0)
            np.testing.assert_array_equal(late, np.array(seen)[back, np.arange(50)])
            np.testing.assert_array_equal(two_ago, seen[max(step - 2, 0)])
            np.testing.assert_array_equal(push, np.where(asked[-2], 10, -10))


def test_what_cannot_be_delayed_is_said():
    t = tasks.load("CartPole").terms
    with pytest.raises(ValueError, match="steps"):
        tasks.delayed(1.0, 257)
    with pytest.raises(TypeError, match="expected `max_steps`"):
        tasks.delayed(1.0, t.age())
    with pytest.raises(ValueError, match="max_steps"):
        tasks.delayed(1.0, t.age(), -1)
    task = tasks.load("CartPole")
    task.level("hard", next=t.level("soft"))
    with pytest.raises(mw.TaskError, match="level 0 'hard', next uses the level 'soft'"):
        mw.Environment(task)
