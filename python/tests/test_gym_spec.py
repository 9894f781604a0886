"""What Gymnasium is told: specs with the length of episodes, spaces with bounds, metadata; pickles."""

import copy
import functools
import pickle
import warnings

import numpy as np
import pytest

gymnasium = pytest.importorskip("gymnasium")

from gymnasium.utils.env_checker import check_env  # noqa: E402
from gymnasium.vector import AutoresetMode  # noqa: E402

import manyworlds as mw  # noqa: E402
from manyworlds import tasks  # noqa: E402
from manyworlds.gym import Env, VectorEnv, ids  # noqa: E402
from manyworlds.gym.bounds import range_of  # noqa: E402
from manyworlds.gym.spaces import observation_space  # noqa: E402


def steps_until_truncated(env):
    env.reset(seed=1)
    for step in range(1, 2000):
        *_, terminated, truncated, _ = env.step(env.action_space.sample() * 0)
        if np.any(terminated) or np.any(truncated):
            return step, bool(np.all(truncated))
    return None


def test_specs_know_how_long_episodes_are():
    for name, id in zip(tasks.names(), ids()):
        assert gymnasium.spec(id).max_episode_steps == tasks.load(name).max_steps > 0
    single = gymnasium.make("manyworlds/Pendulum-v0")
    assert single.spec.max_episode_steps == 200
    assert steps_until_truncated(single) == (200, True)
    # It is Gymnasium's to change, in both directions.
    for steps in (7, 300):
        assert steps_until_truncated(
            gymnasium.make("manyworlds/Pendulum-v0", max_episode_steps=steps)
        ) == (steps, True)
        many = gymnasium.make_vec("manyworlds/Pendulum-v0", 3, max_episode_steps=steps)
        assert steps_until_truncated(many) == (steps, True)
    many = gymnasium.make_vec("manyworlds/Pendulum-v0", 3)
    assert many.spec.max_episode_steps == 200 and steps_until_truncated(many) == (200, True)
    assert Env("Pendulum").task.max_steps == 200


def test_worlds_that_gymnasium_makes_are_the_same_bits_in_every_way():
    make = functools.partial(
        gymnasium.make_vec, "manyworlds/LunarLander-v0", 3, max_episode_steps=9
    )
    many, sync = make(), make(vectorization_mode="sync")
    a, b = many.reset(seed=4)[0], sync.reset(seed=4)[0]
    random = np.random.default_rng(0)
    for _ in range(25):
        assert a.tobytes() == b.tobytes()
        actions = random.integers(4, size=3)
        a, *more = many.step(actions)
        b, *others = sync.step(actions)
        for x, y in zip(more[:3], others[:3]):
            assert x.tobytes() == y.tobytes()


@pytest.mark.parametrize("name", tasks.names())
def test_check_env_has_nothing_to_say_of_bounds(name):
    env = gymnasium.make(f"manyworlds/{name}-v0")
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        check_env(env.unwrapped, skip_render_check=True)
    texts = [str(w.message) for w in caught]
    # Pendulum's torque is +-2 N m, as Gymnasium's own is.
    others = [t for t in texts if not (name == "Pendulum" and "symmetric and normalized" in t)]
    assert not others
    space = env.observation_space
    assert np.isfinite(space.low).all() and np.isfinite(space.high).all()


@pytest.mark.parametrize("name", tasks.names())
def test_what_is_seen_lies_in_the_space(name):
    env = VectorEnv(name, 64, autoreset_mode=AutoresetMode.NEXT_STEP, seed=1)
    env.action_space.seed(0)
    assert env.observation_space.contains(env.reset(seed=1)[0])
    lost = 0
    for step in range(200):
        actions = env.action_space.sample()
        if step % 50 == 7 and actions.dtype == np.float32:
            actions[::5] = np.nan
        observations, _, _, _, infos = env.step(actions)
        assert env.observation_space.contains(observations)
        lost += "lost" in infos
    assert lost or env.task.choices


def test_ranges_follow_from_what_expressions_are_made_of():
    task = tasks.load("LunarLander")
    task.rays = [mw.Ray(length=3)]
    t, inf = task.terms, np.inf
    angle, speed = t.angle("lander"), t.velocity("lander", "x")
    for value, wanted in [
        (2.5, (2.5, 2.5)),
        (t.touching(3) + t.lost(), (0, 2)),
        (3 - 2 * t.touching(3), (1, 3)),
        (t.action() * -2, (-6, 0)),
        (t.age() / 10, (0, 100)),
        (t.ray_distance(0) ** 2, (0, 9)),
        (abs(t.touching(1) - 3), (2, 3)),
        (abs(t.action() - 1), (0, 2)),
        (tasks.clip(speed, -1, 4), (-1, 4)),
        (tasks.where(speed > 0, t.action(), -1), (-1, 3)),
        (tasks.sqrt(t.action() - 1), (0, 2**0.5)),
        (tasks.floor(t.ray_distance(0) - 0.5), (-1, 2)),
        (tasks.log(1 + t.action()), (0, np.log(4))),
        (tasks.log(t.action()), (-inf, np.log(3))),
        (tasks.sign(speed), (-1, 1)),
        (tasks.mod(speed, 3), (0, 3)),
        (speed % -2, (-2, 0)),
        ((1 + t.touching(1)) ** 1.5, (1, 2**1.5)),
        ((1 + t.touching(1)) ** -0.25, (2**-0.25, 1)),
        (t.action() ** 1.5, (0, inf)),
        (speed**1.5, (-inf, inf)),
        (t.uniform("a", -2, 3), (-2, 3)),
        (t.parameter("gravity", 1), (-inf, inf)),
        (tasks.exp(-t.touching(1)), (np.exp(-1), 1)),
        (tasks.exp(abs(speed)), (1, inf)),
        (tasks.previous(-t.touching(1)), (-1, 0)),
        (tasks.held(speed > 3), (0, 1000)),
        (~(speed == 3) & (angle <= 2), (0, 1)),
        (1 / (2 + t.touching(1)), (1 / 3, 1 / 2)),
        (1 / t.touching(1), (-inf, inf)),
        (speed / 0, (-inf, inf)),
        (mw.Expression(0) * (1 / t.touching(1)), (0, 0)),
        (mw.Expression(np.nan), (-inf, inf)),
        (t.joint_position(0), (-inf, inf)),
    ]:
        assert range_of(value, task) == pytest.approx(wanted), value
    assert range_of(speed, task)[1] >= 1e5 and range_of(t.position(0, 0), task)[0] <= -1e10
    for value, most in [(angle, 3.15), (tasks.sin(speed), 1.001), (tasks.tanh(speed), 1.001), (t.direction(3, 0, 0), 1.001)]:
        low, high = range_of(value, task)
        assert 0.99 * most < high <= most and low == -high


def test_actions_have_their_range_where_they_are_clamped():
    task = tasks.load("CartPoleSwingUp")
    assert range_of(task.terms.action(), task) == (-1, 1)
    task.actions[0].clamped = False
    assert range_of(task.terms.action(), task) == (-np.inf, np.inf)


def test_bounds_that_a_task_gives_are_kept():
    task = tasks.load("Pendulum")
    task.observations = []
    task.observe("a", task.terms.angle("rod"), high=1)
    task.observe("b", task.terms.joint_position(0), low=-2)
    space, most = observation_space(task), np.finfo(np.float32).max
    assert space.high[0] == 1 and -3.2 < space.low[0] < -np.pi
    assert space.low[1] == -2 and space.high[1] == most


def test_metadata_is_what_gymnasium_wants():
    for kind in (Env, VectorEnv):
        assert kind.metadata["render_modes"] == ["rgb_array"]
    assert VectorEnv.metadata["autoreset_mode"] is AutoresetMode.NEXT_STEP
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for mode in AutoresetMode:
            env = gymnasium.make_vec("manyworlds/CartPole-v0", 2, autoreset_mode=mode)
            assert env.metadata["autoreset_mode"] is mode and env.metadata["render_fps"] == 50
        gymnasium.make("manyworlds/CartPole-v0").reset(seed=1)


# -- pickles


def copies(value):
    return copy.deepcopy(value), *(pickle.loads(pickle.dumps(value, p)) for p in range(2, 6))


def bits(env):
    env.reset(seed=3)
    env.action_space.seed(1)
    return [a.tobytes() for _ in range(12) for a in env.step(env.action_space.sample())[:2]]


def test_specs_with_tasks_of_ones_own_are_pickled():
    task = tasks.load("LunarLander")
    task.reward("bonus", tasks.cos(task.terms.angle("lander")))
    task.truncated = task.terms.age() >= 5
    id = "manyworlds-test/Own-v0"
    entries = dict(entry_point="manyworlds.gym:Env", vector_entry_point="manyworlds.gym:VectorEnv")
    gymnasium.register(id=id, kwargs={"task": task}, **entries)
    try:
        envs = gymnasium.make_vec(id, num_envs=4, threads=1, reward_terms=True)
        wanted = bits(envs)
        for spec in copies(gymnasium.spec(id)):
            assert bits(gymnasium.make_vec(spec, 4)) == wanted
        for spec in copies(envs.spec):
            again = gymnasium.make_vec(spec)
            assert again.num_envs == 4 and bits(again) == wanted
        for make in copies(functools.partial(VectorEnv, task, 4, threads=1)):
            assert bits(make()) == wanted
    finally:
        del gymnasium.registry[id]


def test_workers_of_gymnasiums_own_build_them():
    made = functools.partial(Env, tasks.load("CartPole"))
    makers = [functools.partial(made, reward_terms=False)] * 2
    many = gymnasium.vector.AsyncVectorEnv(makers, context="spawn")
    try:
        assert bits(many) == bits(gymnasium.vector.SyncVectorEnv(makers))
    finally:
        many.close()


@pytest.mark.parametrize("make", [Env, VectorEnv])
def test_environments_say_what_to_pickle_instead(make):
    env = make("CartPole")
    for call in (pickle.dumps, copy.deepcopy, copy.copy):
        with pytest.raises(TypeError, match=f"{make.__name__} objects .* its spec, or the task"):
            call(env)
