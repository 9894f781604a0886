"""Random calls, with arguments that fit or do not: they work or raise, and nothing breaks.

10,000 in all, which tools of the kind of AddressSanitizer can look at from below.
"""

import os
import random

import numpy as np
import pytest

import manyworlds as mw
from conftest import crates, lander


def junk(rng: random.Random):
    """A value of a kind that some call wants, or none does."""
    shape = [rng.choice([0, 1, 2, 3, 5]) for _ in range(rng.randrange(4))]
    numbers = np.random.default_rng(rng.randrange(99)).normal(size=shape) * 10 ** rng.randrange(5)
    return rng.choice(
        [None, -1, 0, 1, 2, 5, 2**40, 1.5, np.nan, "position", "friction", "x", b"y", True, {}, []]
        + [[0, 2], [True] * 5, [9], numbers, numbers.astype("f4"), numbers > 0, numbers.T]
        + [numbers.astype(int), np.full((5, 5, 2), np.nan), mw.Ray(), mw.Body(), object(), len]
    )


def fitting_a_batch(rng: random.Random, batch: mw.Batch) -> dict:
    """Arguments that fit, by method."""
    width = 2 if batch.plan.scene.space == "planar" else 3
    some = rng.choice([None, 2, [0, 3], [True, False, False, False, True]])
    shape = (5, batch.bodies, width)
    return {
        "step": (rng.randrange(4), None, some),
        "get": (rng.choice(["position", "orientation", "friction", "mass"]),),
        "set": ("linear_velocity", np.random.default_rng(0).normal(size=shape)),
        "view": ("position",),
        "set_controls": (np.zeros((5, batch._controls)),),
        "add_force": (np.ones(width), 1, some),
        "add_impulse": (np.ones(width), None, some, np.zeros(width)),
        "add_torque": ([1.0],) if width == 2 else ((1, 2, 3),),
        "set_enabled": (rng.random() < 0.8, 0, some),
        "spawn": (1, np.full(width, 7.0), None, None, None, some),
        "wake": (some,),
        "hash": (3,),
        "contacts": (1,),
        "save": (some,),
        "copy_world": (0, 4),
        "reset": (some, rng.choice([None, 3])),
        "randomize": ("linear_velocity", -1, 1, some),
        "rollout": (None, None, 3, ["position", "mass"]),
    }


def fitting_an_environment(rng: random.Random, env: mw.Environment) -> dict:
    some = rng.choice([None, 2, [0, 3], [True, False, False, False, True]])
    actions = np.zeros(env.action_shape, int if env.discrete else float)
    return {
        "step": (actions + rng.choice([0, 1]),),
        "reset": (some, rng.choice([None, 3])),
        "begin": (some,),
        "copy_world": (0, 4),
        "save": (),
        "lost": (),
    }


def call_at_random(make, methods, fitting, seed, calls, now_and_then):
    """How many calls worked, and how many raised."""
    rng = random.Random(seed)
    subject, worked, raised = make(), 0, 0
    for call in range(calls):
        name = rng.choice(methods)
        good = fitting(rng, subject)
        if name in good and rng.random() < 0.5:
            arguments = good[name]
        else:
            arguments = tuple(junk(rng) for _ in range(rng.randrange(4)))
        try:
            result = getattr(subject, name)(*arguments)
            worked += 1
            if name == "save" and result.worlds:
                subject.restore(result, source=0, ids=[rng.randrange(5)])
        except (ValueError, TypeError, IndexError):
            raised += 1
        if call % 50 == 49:
            now_and_then(subject)
            if rng.random() < 0.3:
                subject.close()
                subject = make()
    return worked, raised


WIDEST = os.environ.get("MW_PRECISIONS", "f64")  # sanitizer builds have float32 alone
BATCHES = [
    lambda: lander(sleep=True, observe=["motion", "contacts"], rays=[mw.Ray()]),
    lambda: mw.Batch(crates(), worlds=5, threads=2, precision=WIDEST),
]
METHODS = (
    "step get set view lane_indices get_controls set_controls add_force add_torque add_impulse "
    "add_angular_impulse get_enabled set_enabled spawn get_joints_enabled set_joints_enabled asleep "
    "wake set_rays status status_names lost hash hashes energy contacts step_contacts "
    "measure_contacts look save restore copy_world reset randomize rollout"
).split()


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("seed", range(4))
def test_batches(seed):
    def check(batch):
        batch.step(2)
        assert batch.hashes().shape == (5,) and batch.status().shape == (5,)

    worked, raised = call_at_random(BATCHES[seed % 2], METHODS, fitting_a_batch, seed, 1500, check)
    assert worked > 375 and raised > 375


ENVIRONMENTS = [
    lambda: mw.Environment("LunarLander", 5, autoreset="same_step", reward_terms=True),
    lambda: mw.Environment("BallBalance", 5, threads=2, precision=WIDEST),
]


@pytest.mark.filterwarnings("ignore::RuntimeWarning")
@pytest.mark.parametrize("seed", range(4))
def test_environments(seed):
    def check(env):
        env.step(np.zeros(env.action_shape, int))
        assert env.batch.hashes().shape == (5,) and np.isfinite(env.rewards).all()

    methods = ["step", "reset", "begin", "copy_world", "save", "restore", "lost"]
    worked, raised = call_at_random(
        ENVIRONMENTS[seed % 2], methods, fitting_an_environment, seed, 1000, check
    )
    assert worked > 250 and raised > 250
