"""LunarLander against Gymnasium's: its own heuristic flies it, and an engine does what its does."""

from __future__ import annotations

import ast
import pathlib
from types import SimpleNamespace

import numpy as np
import pytest

import manyworlds as mw


def gymnasiums_heuristic():
    """`heuristic` as Gymnasium's package has it. Its module imports Box2D, the function wants NumPy."""
    gymnasium = pytest.importorskip("gymnasium")
    path = pathlib.Path(gymnasium.__file__).parent / "envs" / "box2d" / "lunar_lander.py"
    module = ast.parse(path.read_text(encoding="utf-8"))
    (function,) = [
        node
        for node in module.body
        if isinstance(node, ast.FunctionDef) and node.name == "heuristic"
    ]
    names: dict = {"np": np}
    exec(compile(ast.Module([function], []), str(path), "exec"), names)
    return names["heuristic"]


@pytest.mark.parametrize("name", ["LunarLander", "LunarLanderContinuous"])
def test_gymnasiums_heuristic_lands(name):
    heuristic, worlds = gymnasiums_heuristic(), 1024
    continuous = name == "LunarLanderContinuous"
    like = SimpleNamespace(unwrapped=SimpleNamespace(continuous=continuous))
    env = mw.Environment(name, worlds, seed=1, autoreset="disabled")
    actions = np.zeros(env.action_shape, np.float32 if continuous else np.int64)
    seen, returns, flying = env.reset(), np.zeros(worlds), np.ones(worlds, bool)
    landed = 0
    for _ in range(env.task.max_steps):
        for world in np.flatnonzero(flying):
            actions[world] = heuristic(like, seen[world])
        seen, rewards, terminated, truncated = env.step(actions)
        returns[flying] += rewards[flying]
        landed += (rewards[flying] == 100).sum()
        flying &= ~(terminated | truncated)
        if not flying.any():
            break
    assert returns.mean() >= 230  # Gymnasium's own: 249 and 284 (150 seeds, Box2D)
    assert landed >= 0.95 * worlds


# Box2D's lander, by Gymnasium 1.4.0's LunarLander with an np_random whose uniform() is 0: what five
# steps of an engine change in vx, vy and turn of an upright lander, against five without, in units
# of its observations.
ENGINES = {1: (-0.0494, -0.0003, 0.1979), 2: (0, 0.2330, 0), 3: (0.0494, -0.0003, -0.1979)}


@pytest.mark.parametrize("choice", [1, 2, 3])
def test_engines_are_gymnasiums(choice):
    env = mw.Environment("LunarLander", 2, autoreset="disabled")
    env.batch.set("linear_velocity", np.zeros_like(env.batch.get("linear_velocity")))
    env.begin()
    for _ in range(3):
        env.step(np.zeros(2, np.int64))
    for _ in range(5):
        seen = env.step(np.array([choice, 0]))[0]
    changed = (seen[0] - seen[1])[[2, 3, 5]]
    assert changed == pytest.approx(ENGINES[choice], rel=0.03, abs=0.0015)


@pytest.mark.parametrize("name", ["LunarLander", "LunarLanderContinuous"])
def test_starts_are_gymnasiums(name):
    env = mw.Environment(name, 4096, seed=5)
    assert env.observation_names[6:] == ["right leg", "left leg"]  # as its legs come
    x, y, vx, vy, angle, turn, first, second = env.reset().T
    assert (x == 0).all() and (angle == 0).all() and (turn == 0).all()
    assert not first.any() and not second.any()
    assert y == pytest.approx(1.41, abs=1e-3)
    most = 1000 * 0.02 / 4.8166666  # m/s: the force of a step on the cabin
    for speed, unit in ((vx, 5), (vy, 7.5)):
        assert np.abs(speed).max() == pytest.approx(most / unit, rel=0.01)
        assert np.abs(speed.mean()) < 0.02
        assert speed.std() == pytest.approx(most / unit / np.sqrt(3), rel=0.03)
