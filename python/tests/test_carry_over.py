"""What docs/gymnasium.md says carries over from Gymnasium: one policy, flown in its environment and here."""

from __future__ import annotations

import numpy as np
import pytest

import manyworlds as mw

gymnasium = pytest.importorskip("gymnasium")

SEEDS = 24


def balance(seen):
    """Of CartPole, with Gymnasium's signs: lean and turn to the right are positive."""
    x, speed, lean, turn = seen.T
    return (0.1 * x + 0.2 * speed + 3 * lean + 0.6 * turn > 0).astype(np.int64)


def swing(seen):
    """Of Pendulum: to the energy of standing upright, then held."""
    up, side, speed = seen.T
    short = 0.5 * speed**2 / 3 + 5 * (up - 1) < 0
    pump = np.where(short, 2, -2) * np.where(speed > 0, 1, -1)
    hold = -(16 * side + 3 * speed)
    upright = (up > 0.92) & (np.abs(speed) < 1.5)
    return np.clip(np.where(upright, hold, pump), -2, 2).astype(np.float32)[:, None]


def pump(seen):
    """Of Acrobot: along with the elbow."""
    return np.where(seen[:, 5] > 0, 2, 0)


def theirs(name, policy):
    """Returns of an episode for each seed."""
    env = gymnasium.make(name)
    out = []
    for seed in range(SEEDS):
        seen, total, over = env.reset(seed=seed)[0], 0.0, False
        while not over:
            seen, reward, ended, truncated, _ = env.step(policy(seen[None])[0])
            total, over = total + float(reward), ended or truncated
        out.append(total)
    return np.array(out)


def ours(name, policy, signs=(1,)):
    env = mw.Environment(name, 256, seed=1, autoreset="disabled")
    total, going = np.zeros(256), np.ones(256, bool)
    seen = env.reset()
    for _ in range(env.task.max_steps):
        seen, rewards, ended, truncated = env.step(policy(seen * np.array(signs)))
        total[going] += rewards[going]
        going &= ~(ended | truncated)
    return total


def push_after(seen):
    """Of CartPole: towards the side that the pole falls to."""
    return (seen[:, 2] + 0.5 * seen[:, 3] > 0).astype(np.int64)


@pytest.mark.parametrize("policy, least", [(balance, 450), (push_after, 150)])
def test_cart_pole_carries_over(policy, least):
    there, here = theirs("CartPole-v1", policy), ours("CartPole", policy)
    assert there.mean() > least and here.mean() > least
    assert ours("CartPole", policy, [1, 1, -1, -1]).mean() < 50  # with the wrong signs


def test_cart_pole_has_gymnasiums_ends():
    there, task = gymnasium.make("CartPole-v1").unwrapped, mw.tasks.load("CartPole")
    lean = there.theta_threshold_radians
    assert [o.high for o in task.observations][::2] == pytest.approx([2 * 2.4, 2 * lean])
    assert there.x_threshold == 2.4 and there.observation_space.high[2] == np.float32(2 * lean)
    env = mw.Environment(task, 4, autoreset="disabled")
    for x, angle, ends in ((2.38, 0, False), (2.42, 0, True), (0, 0.2, False), (0, -0.22, True)):
        put(env, (x, 0, angle, 0))
        env.step([1, 0, 1, 0])
        there.state, there.steps_beyond_terminated = np.array([x, 0, angle, 0.0]), None
        assert there.step(1)[2] is ends and (env.terminated == ends).all()


def put(env, state):
    """Worlds in a state (x, x', lean, lean') of Gymnasium's CartPole."""
    x, speed, lean, turn = state
    sin, cos = np.sin(lean), np.cos(lean)
    env.batch.set("position", [[x, 0], [x, 0]])
    env.batch.set("orientation", [[1, 0], [cos, -sin]])
    pole = [speed + 0.5 * turn * cos, -0.5 * turn * sin]  # of its centre of mass
    env.batch.set("linear_velocity", [[speed, 0], pole])
    env.batch.set("angular_velocity", [[0], [-turn]])
    env.begin()


@pytest.mark.parametrize("state", [(0, 0, 0.05, 0), (0.3, -0.4, -0.03, 0.2), (-1, 0.5, 0, -0.4)])
def test_cart_pole_steps_as_gymnasiums(state):
    """From one state by the same pushes, to what the schemes of integration differ by."""
    there = gymnasium.make("CartPole-v1").unwrapped
    there.reset()
    env = mw.Environment("CartPole", autoreset="disabled")
    put(env, state)
    np.testing.assert_allclose(env.observations[0], state, atol=1e-6)
    there.state = np.array(state, float)
    before = np.array(state)
    for action in (1, 1, 0, 1, 0, 0, 1, 0, 1, 1):
        theirs, mine = there.step(action)[0], env.step([action])[0][0]
        # A push of 10 N changes velocities by about 0.2 m/s and 0.3 rad/s in a step.
        assert (np.abs(mine - theirs) < [0.02, 0.02, 0.02, 0.04]).all()
        push = 1 if action else -1
        assert np.sign(mine - before)[[1, 3]].tolist() == [push, -push]
        before = mine.copy()


def test_pendulum_carries_over():
    there, here = theirs("Pendulum-v1", swing), ours("Pendulum", swing)
    assert there.mean() > -250 and here.mean() > -250
    assert here.mean() == pytest.approx(there.mean(), abs=3 * there.std() / SEEDS**0.5 + 10)


def test_acrobot_carries_over():
    there, here = theirs("Acrobot-v1", pump), ours("Acrobot", pump)
    # Worlds that begin near rest wait long for the pump to take hold, here more of them.
    assert np.median(here) == pytest.approx(np.median(there), abs=10)
    assert np.median(here) > -100


def test_what_bears_other_names_or_numbers_is_not_taken_for_gymnasiums():
    """Hopper and Pusher share a name alone; docs/gymnasium.md says so by these numbers."""
    hopper = mw.tasks.load("Hopper")
    assert max(c.high for c in hopper.scene.controls) == 100  # N m; 200 there
    assert len(mw.tasks.load("Pusher").actions) == 2  # 7 there
