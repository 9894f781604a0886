"""Environment: the same bits however it is run; arrays, resets, copies; misuse."""

import dataclasses
import pickle
import threading

import numpy as np
import pytest

import manyworlds as mw
from manyworlds import tasks


def actions_of(env, random):
    if env.discrete:
        return random.integers(env.task.choices, size=env.worlds)
    low, high = (np.array([getattr(a, e) for a in env.task.actions]) for e in ("low", "high"))
    return random.uniform(low, high, (env.worlds, len(low))).astype(np.float32)


def hurried(name, max_steps=13):
    task = tasks.load(name)
    task.max_steps = max_steps
    return task


def play(env, steps, seed=0):
    """Everything that a user sees, [step][array], with these random actions."""
    random, seen = np.random.default_rng(seed), []
    for _ in range(steps):
        env.step(actions_of(env, random))
        arrays = env.observations, env.rewards, env.terminated, env.truncated, env.reward_terms
        seen.append([a.copy() for a in arrays])
    return seen


def make(task, worlds=19, **more):
    return mw.Environment(task, worlds, **{"threads": 1, "seed": 5, "reward_terms": True, **more})


@pytest.mark.parametrize("name", tasks.names())
@pytest.mark.parametrize("autoreset", ["next_step", "same_step"])
def test_the_same_bits_with_one_thread_and_with_two(name, autoreset):
    envs = [make(hurried(name), threads=n, autoreset=autoreset) for n in (1, 2)]
    for a, b in zip(*(play(env, 30) for env in envs)):
        for x, y in zip(a, b):
            assert x.tobytes() == y.tobytes()
    assert envs[0].batch.hash() == envs[1].batch.hash()


@pytest.mark.parametrize("name", ["LunarLander", "Hopper"])
def test_a_world_is_the_same_bits_as_alone(name):
    task = hurried(name)
    many = make(task)
    alone = [make(task, 1, seed=5 + w) for w in range(many.worlds)]
    random = np.random.default_rng(1)
    for _ in range(30):
        actions = actions_of(many, random)
        many.step(actions)
        for w, env in enumerate(alone):
            env.step(actions[w : w + 1])
            for array in ("observations", "rewards", "terminated", "truncated", "reward_terms"):
                assert getattr(many, array)[w].tobytes() == getattr(env, array)[0].tobytes()


def test_rewards_are_the_sums_of_their_parts():
    env = make("LunarLander")
    assert env.reward_names == ["potential", "main engine", "side engines", "landed", "crashed"]
    for _, rewards, _, _, parts in play(env, 50):
        np.testing.assert_allclose(rewards, parts.sum(1), rtol=1e-12, atol=1e-12)


def test_own_arrays_are_filled_in_place():
    env, other = make("CartPole"), make("CartPole")
    n = env.worlds
    out = [np.empty((n, 4), np.float32), np.empty(n), np.empty(n, bool), np.empty(n, bool)]
    terms = np.empty((n, 1))
    before = env.observations.copy()
    found = env.step(np.zeros(n, int), *out, reward_terms=terms)
    assert all(a is b for a, b in zip(found, out))
    assert (env.observations == before).all() and (terms == 1).all()
    assert other.step(np.zeros(n, int))[0].tobytes() == out[0].tobytes()


def test_resets_begin_next_episodes_or_those_of_seeds():
    env = make("LunarLander", 6, seed=3)
    first = env.observations.copy()
    second = env.reset().copy()
    assert (first != second).any(1).all()
    assert (env.reset(seeds=3) == first).all()
    assert (env.reset() == second).all()
    mask = np.array([1, 0, 0, 1, 0, 0], bool)
    mixed = env.reset(mask, seeds=[3, 6])
    assert (mixed[mask] == first[mask]).all() and (mixed[~mask] == second[~mask]).all()
    assert (env.reset([1], seeds=[4])[1] == first[1]).all()


def test_resets_repeat_or_draw_anew():
    env = make("LunarLander", 6, seed=3)
    first = env.observations.copy()
    second = env.reset().copy()
    assert (env.reset(redraw=False) == first).all()
    assert (env.reset(redraw=False) == first).all()
    assert (env.reset(redraw=True) == second).all()
    mixed = env.reset([0, 5], redraw=False)
    assert (mixed[[0, 5]] == first[[0, 5]]).all() and (mixed[1:5] == second[1:5]).all()
    assert (env.reset(seed=4)[:-1] == first[1:]).all()
    assert (env.reset(redraw=False)[:-1] == first[1:]).all()
    assert (env.reset(seed=3) == first).all()
    for wrong, error, match in (
        (dict(seed=1, seeds=2), ValueError, "both given"),
        (dict(seeds=1, redraw=False), ValueError, "redraw is False and a seed is given"),
        (dict(redraw="no"), TypeError, "redraw is of type str"),
    ):
        with pytest.raises(error, match=match):
            env.reset(**wrong)


def test_worlds_of_an_environment_are_ids_or_masks():
    env = make("LunarLander", 4, seed=3)
    for call in (env.reset, env.begin, lambda ids: env.restore(env.save(), source=0, ids=ids)):
        call([1, 3]), call(np.array([False, True, False, True])), call(2)
        with pytest.raises(ValueError, match="name world 0 more than once.*a mask is an array of bools"):
            call(np.array([0, 0, 1, 1]))
        with pytest.raises(TypeError, match="float64"):
            call(np.zeros(4))
        with pytest.raises(TypeError, match="mix bools and integers"):
            call([True, 2])


@pytest.mark.parametrize(
    "dtype, value",
    [
        (np.uint64, 2**63),
        (np.uint64, 2**64 - 1),
        (np.uint32, 2**32 - 1),
        (np.uint16, 2**16 - 1),
        (np.uint8, 255),
        (np.int64, -(2**63)),
        (np.int32, -(2**31)),
        (np.int8, -128),
        (object, 2**70),
        (object, -(2**70)),
    ],
)
def test_actions_of_every_dtype_are_reported_as_given(dtype, value):
    env = make("LunarLander", 3)
    before = env.batch.hashes()
    actions = np.array([3, value, 0], dtype)
    with pytest.raises(ValueError, match=f"the action of world 1 is {value}, must be 0 to 3"):
        env.step(actions)
    assert (env.batch.hashes() == before).all()
    if dtype is not object:
        env.step(actions[[0, 2, 0]])


def test_next_step_and_same_step_do_what_resets_by_hand_do():
    task, steps = hurried("LunarLander"), 40
    by_hand = make(task, autoreset="disabled")
    next_step, same_step = (make(task, autoreset=a) for a in ("next_step", "same_step"))
    # Same step: the slow way.
    random = [np.random.default_rng(0) for _ in range(2)]
    for _ in range(steps):
        actions = actions_of(by_hand, random[0])
        observations, rewards, terminated, truncated = (a.copy() for a in by_hand.step(actions))
        ended = terminated | truncated
        if ended.any():
            by_hand.reset(ended)
        same_step.step(actions)
        assert (same_step.observations == by_hand.observations).all()
        assert (same_step.final_observations[ended] == observations[ended]).all()
        assert (same_step.rewards == rewards).all()
        assert ((same_step.terminated | same_step.truncated) == ended).all()
    # Next step: a reset takes the place of a step.
    by_hand = make(task, autoreset="disabled")
    pending = np.zeros(by_hand.worlds, bool)
    for _ in range(steps):
        actions = actions_of(by_hand, random[1])
        _, rewards, terminated, truncated = (a.copy() for a in by_hand.step(actions))
        ended = (terminated | truncated) & ~pending
        if pending.any():
            by_hand.reset(pending)
        rewards[pending] = 0
        next_step.step(actions)
        assert (next_step.observations == by_hand.observations).all()
        assert (next_step.rewards == rewards).all()
        assert ((next_step.terminated | next_step.truncated) == ended).all()
        pending = ended


def test_a_copied_world_goes_on_as_the_other_does():
    env = make("LunarLander", 5, autoreset="disabled")
    play(env, 20)
    env.copy_world(1, 3)
    for step in range(30):
        env.step(np.full(5, step % 4))
        assert env.observations[1].tobytes() == env.observations[3].tobytes()
        assert env.rewards[1] == env.rewards[3]


def test_the_batch_is_the_environments_own():
    env = make("LunarLander", 4, autoreset="disabled")
    batch = env.batch
    assert batch is env.batch and batch.worlds == 4 and batch.steps == 0
    saved, start = batch.save(), env.observations.copy()
    play(env, 10)
    assert batch.steps == 10
    batch.restore(saved)
    assert (env.begin() == start).all()
    position = batch.get("position")
    env.close()
    with pytest.raises(ValueError, match="the batch is closed"):
        batch.step()
    assert np.isfinite(position).all()


def test_the_batch_outlives_its_environment():
    batch = make("Pendulum").batch
    batch.step(3)
    assert batch.worlds == 19


def test_an_action_that_is_no_number_loses_its_world_alone():
    env, twin = make("Pendulum", 9), make("Pendulum", 9)
    random = np.random.default_rng(0)
    for step in range(6):
        actions = actions_of(env, random)
        twin.step(actions)
        if step == 2:
            actions[4] = np.nan
        env.step(actions)
        others = np.arange(9) != 4
        assert env.observations[others].tobytes() == twin.observations[others].tobytes()
        assert env.truncated.tolist() == [step == 2 and w == 4 for w in range(9)]
        assert env.lost().tolist() == [step == 2 and w == 4 for w in range(9)]
    assert np.isfinite(env.observations).all() and not env.terminated.any()


def test_a_closed_view_of_the_worlds_does_not_close_the_environment():
    env = make("LunarLander", 5)
    with env.batch as batch:
        assert batch.get("position").shape == (5, 5, 2)
    assert batch.closed and not env.closed
    env.step(np.zeros(5, int))
    assert not env.lost().any() and env.batch.get("position").shape == (5, 5, 2)


WRONG = [
    (lambda e: e.step(np.zeros(4, int)), ValueError, r"shape \(4,\); expected \(worlds=5,\)"),
    (lambda e: e.step(np.zeros(5)), TypeError, "expected integers"),
    (lambda e: e.step(np.full(5, 4)), ValueError, "world 0 is 4, must be 0 to 3"),
    (lambda e: e.step([0, 0, 0, 0, -1]), ValueError, "world 4 is -1"),
    (lambda e: e.step("abcde"), ValueError, "shape"),
    (lambda e: e.step(list("abcde")), TypeError, "dtype"),
    (lambda e: e.step([0] * 5, np.zeros((5, 8))), TypeError, "float64; expected float32"),
    (lambda e: e.step([0] * 5, np.zeros((5, 7), "f4")), ValueError, r"\(worlds=5, observations=8"),
    (lambda e: e.step([0] * 5, rewards=np.zeros(10)[::2]), ValueError, "not C-contiguous"),
    (lambda e: e.step([0] * 5, terminated=np.zeros(5, "u1")), TypeError, "expected bool"),
    (lambda e: e.step([0] * 5, reward_terms=np.zeros(5)), ValueError, "rewards=5"),
    (lambda e: e.reset([5]), IndexError, "hold 5, must be 0 to 4"),
    (lambda e: e.reset([True] * 4), IndexError, "mask"),
    (lambda e: e.reset(seeds=-1), ValueError, "must be 0"),
    (lambda e: e.reset(seeds=[1, 2]), ValueError, "one for each of 5 worlds"),
    (lambda e: e.reset(seeds=1.5), TypeError, "integer"),
    (lambda e: e.copy_world(0, 5), IndexError, "target is 5"),
    (lambda e: e.copy_world(-1, 0), IndexError, "source is -1"),
    (lambda e: e.batch.get("kinetic_energy"), ValueError, "observe"),
]


@pytest.mark.parametrize("call, error, words", WRONG)
def test_wrong_calls_say_what_is_wrong_and_do_nothing(call, error, words):
    env = make("LunarLander", 5)
    before = env.batch.hash()
    with pytest.raises(error, match=words):
        call(env)
    assert env.batch.hash() == before


@pytest.mark.parametrize(
    "arguments, error",
    [
        (dict(task="CartPol"), ValueError),
        (dict(task=3), TypeError),
        (dict(worlds=0), ValueError),
        (dict(threads=0), ValueError),
        (dict(seed=-1), ValueError),
        (dict(precision="f16"), ValueError),
        (dict(isa="mmx"), ValueError),
        (dict(autoreset="never"), ValueError),
        (dict(autoreset=1), TypeError),
    ],
)
def test_wrong_constructions_are_errors(arguments, error):
    with pytest.raises(error):
        mw.Environment(**{"task": "CartPole", **arguments})


def test_closed_environments_are_errors():
    env = make("CartPole")
    env.close()
    env.close()
    assert env.closed and "closed" in repr(env)
    for call in (lambda: env.step(np.zeros(19, int)), env.reset, env.lost, lambda: env.batch):
        with pytest.raises(ValueError, match="the environment is closed"):
            call()


def test_two_threads_take_turns_or_are_told():
    env = mw.Environment("LunarLander", 2000, threads=1)
    batch, errors = env.batch, []

    def work(call):
        for _ in range(15):
            try:
                call()
            except RuntimeError as error:
                assert "in use by another thread" in str(error)
                errors.append(error)

    actions = np.zeros(2000, int)
    calls = [lambda: env.step(actions), lambda: batch.step(3), lambda: env.reset([1, 2])]
    threads = [threading.Thread(target=work, args=(call,)) for call in calls]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    env.step(actions)
    assert np.isfinite(env.observations).all()


@pytest.mark.parametrize("task", ["LunarLander", "Pendulum"])
def test_a_saved_environment_goes_on_as_it_did(task):
    def play(env, steps, seed):
        rng, seen = np.random.default_rng(seed), []
        for _ in range(steps):
            seen.append([a.copy() for a in env.step(actions_of(env, rng))])
        return seen

    first = mw.Environment(task, worlds=10, seed=4)
    play(first, 120, 0)
    saved = pickle.loads(pickle.dumps(first.save()))
    last = first.observations.copy()
    second = mw.Environment(task, worlds=10, seed=4, threads=1, isa="scalar")
    np.testing.assert_array_equal(second.restore(saved), last)
    for a, b in zip(play(first, 150, 1), play(second, 150, 1)):
        for x, y in zip(a, b):
            np.testing.assert_array_equal(x, y)

    # Where somebody else's arrays were filled.
    mine = np.zeros_like(first.observations)
    first.step(actions_of(first, np.random.default_rng(2)), observations=mine)
    np.testing.assert_array_equal(first.save().observations, mine)
    cut = dataclasses.replace(saved, observations=saved.observations[:, :1])
    before = second.batch.hash()
    with pytest.raises(mw.SnapshotError, match="observations have shape .10, 1.,"):
        second.restore(cut)
    assert second.batch.hash() == before

    # One world of it many times over.
    few = mw.Environment(task, worlds=4)
    few.terminated[3] = True
    observations = few.restore(saved, source=7, ids=[0, 3])
    np.testing.assert_array_equal(observations[[0, 3]], last[[7, 7]])
    assert not few.terminated[3]
    hashes = few.batch.hashes()
    assert hashes[0] == hashes[3] and hashes[0] != hashes[1]
    with pytest.raises(mw.SnapshotError, match="10 worlds"):
        few.restore(saved)
    with pytest.raises(mw.SnapshotError, match="another task"):
        mw.Environment("Acrobot", worlds=10).restore(saved)
    with pytest.raises(TypeError, match="EnvironmentSnapshot"):
        few.restore(saved.worlds)
