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


def ours(name, policy, signs=1):
    env = mw.Environment(name, 256, seed=1, autoreset="disabled")
    total, going = np.zeros(256), np.ones(256, bool)
    seen = env.reset()
    for _ in range(env.task.max_steps):
        seen, rewards, ended, truncated = env.step(policy(seen * signs))
        total[going] += rewards[going]
        going &= ~(ended | truncated)
    return total


def test_cart_pole_carries_over_with_the_signs_of_lean_and_turn():
    there, here = theirs("CartPole-v1", balance), ours("CartPole", balance, [1, 1, -1, -1])
    assert there.mean() > 450 and here.mean() > 450
    assert ours("CartPole", balance).mean() < 50  # without


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
