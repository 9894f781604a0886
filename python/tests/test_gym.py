"""manyworlds.gym: Gymnasium's contract, held against its own SyncVectorEnv, and its wrappers."""

import numpy as np
import pytest

gymnasium = pytest.importorskip("gymnasium")

from gymnasium.vector import AutoresetMode  # noqa: E402
from gymnasium.wrappers import vector as wrappers  # noqa: E402

import manyworlds as mw  # noqa: E402
from manyworlds import tasks  # noqa: E402
from manyworlds.gym import Env, VectorEnv, check_vector_env, ids  # noqa: E402

MODES = list(AutoresetMode)


@pytest.mark.parametrize("mode", MODES, ids=lambda m: m.value)
@pytest.mark.parametrize("name", tasks.names())
def test_every_task_keeps_to_the_contract(name, mode):
    for options in (dict(reward_terms=True), dict(copy=False, threads=2)):
        env = VectorEnv(name, 7, max_episode_steps=9, autoreset_mode=mode, **options)
        assert check_vector_env(env, steps=40) >= 7 * 3
        env.close()


class _Wrong(VectorEnv):
    """Breaks the contract in one of several ways."""

    way = ""

    def step(self, actions):
        observations, rewards, terminated, truncated, infos = super().step(actions)
        if self.way == "dtype":
            rewards = rewards.astype(np.float32)
        if self.way == "bits":
            observations[0, 0] += 1e-6
        if self.way == "mask" and "_final_obs" in infos:
            del infos["_final_obs"]
        if self.way == "ends":
            truncated[:] = False
        if self.way == "copy":
            self.kept = observations = getattr(self, "kept", observations)
            observations[:] = self.environment.observations
        return observations, rewards, terminated, truncated, infos

    def reset(self, *, seed=None, options=None):
        return super().reset(seed=None if self.way == "seed" else seed, options=options)


@pytest.mark.parametrize("way", ["dtype", "bits", "mask", "ends", "copy", "seed"])
def test_the_checker_finds_what_is_wrong(way):
    env = _Wrong("CartPole", 5, max_episode_steps=9, autoreset_mode=AutoresetMode.SAME_STEP)
    env.way = way
    with pytest.raises(AssertionError):
        check_vector_env(env, steps=30)


def test_tasks_are_registered():
    assert len(ids()) == 11
    envs = gymnasium.make_vec("manyworlds/LunarLander-v0", num_envs=5, threads=1)
    assert isinstance(envs.unwrapped, VectorEnv) and envs.num_envs == 5
    assert envs.spec.id == "manyworlds/LunarLander-v0" and envs.spec.reward_threshold == 200
    assert envs.single_action_space == gymnasium.spaces.Discrete(4)
    assert envs.action_space == gymnasium.spaces.MultiDiscrete([4] * 5)
    assert envs.observation_space.shape == (5, 8) and envs.observation_space.dtype == np.float32
    observations, infos = envs.reset(seed=3)
    assert envs.observation_space.contains(observations) and infos == {}
    envs.close()
    envs.close()
    modes = gymnasium.make_vec("manyworlds/Pusher-v0", 2, autoreset_mode="SameStep")
    assert modes.metadata["autoreset_mode"] is AutoresetMode.SAME_STEP
    from gymnasium.utils.env_checker import check_env

    for name in ("CartPole", "LunarLanderContinuous"):
        check_env(Env(name), skip_render_check=True)
    assert gymnasium.make("manyworlds/CartPole-v0").reset(seed=1)[0].shape == (4,)


def test_world_i_has_the_seed_s_plus_i():
    env = VectorEnv("LunarLander", 8)
    a, _ = env.reset(seed=40)
    for i in (0, 5):
        assert (VectorEnv("LunarLander", 1).reset(seed=40 + i)[0][0] == a[i]).all()
    b, _ = env.reset(seed=[40, None, 42, None, 44, 45, None, 47])
    given = np.array([0, 2, 4, 5, 7])
    others = np.setdiff1d(np.arange(8), given)
    assert (b[given] == a[given]).all() and (b[others] != a[others]).any(1).all()
    c, _ = env.reset(seed=np.int64(40))
    assert (c == a).all()
    assert (env.reset()[0] != a).any(1).all()
    # Without a seed every environment is another one.
    assert (VectorEnv("LunarLander").reset()[0] != VectorEnv("LunarLander").reset()[0]).any()
    assert env.reset(seed=3) and env.np_random_seed == 3


@pytest.mark.parametrize("copy", [True, False])
def test_arrays_are_copies_unless_they_need_not_be(copy):
    env = VectorEnv("CartPole", 3, copy=copy)
    first = env.reset(seed=1)[0]
    results = [env.step(env.action_space.sample()) for _ in range(2)]
    for a, b in zip(results[0][:4], results[1][:4]):
        assert (a is b) != copy
    assert (results[0][0] is first) != copy


def test_lost_worlds_are_truncated_and_told_apart():
    env = VectorEnv("Pendulum", 4, max_episode_steps=6)
    env.reset(seed=0)
    actions = np.zeros((4, 1), np.float32)
    actions[2] = np.nan
    *_, terminated, truncated, infos = env.step(actions)
    assert truncated.tolist() == [False, False, True, False] and not terminated.any()
    assert infos["lost"].tolist() == truncated.tolist() == infos["_lost"].tolist()
    actions[2] = 0
    for _ in range(5):
        *_, truncated, infos = env.step(actions)
    assert truncated.tolist() == [True, True, False, True] and "lost" not in infos


def test_parts_of_the_reward_come_by_name():
    env = VectorEnv("LunarLander", 3, reward_terms=True)
    env.reset(seed=0)
    _, rewards, _, _, infos = env.step(np.array([0, 2, 3]))
    parts = infos["reward_terms"]
    assert parts["main engine"].tolist() == [0, np.float32(-0.3), 0]
    names = env.environment.reward_names
    np.testing.assert_allclose(sum(parts[name] for name in names), rewards, atol=1e-12)
    assert infos["_reward_terms"].all() and parts["_main engine"].all()


def test_gymnasiums_wrappers_run():
    env = VectorEnv("LunarLander", 16, max_episode_steps=50)
    env = wrappers.RecordEpisodeStatistics(env)
    env = wrappers.NormalizeObservation(env)
    env = wrappers.NormalizeReward(env)
    env = wrappers.ClipReward(env, -5, 5)
    env = wrappers.DtypeObservation(env, np.float64)
    observations, _ = env.reset(seed=1)
    lengths = []
    for _ in range(120):
        observations, _, _, _, infos = env.step(env.action_space.sample())
        if "episode" in infos:
            lengths += infos["episode"]["l"][infos["_episode"]].tolist()
    assert observations.dtype == np.float64 and np.isfinite(observations).all()
    assert len(lengths) >= 16 and max(lengths) == 50 and min(lengths) > 1
    env.close()


def test_a_composed_task_is_an_environment():
    task = tasks.load("Pendulum")
    task.reward("bonus", tasks.cos(task.terms.angle("rod")))
    env = VectorEnv(task, 3, max_episode_steps=5)
    assert check_vector_env(env, 20) > 0 and task.max_steps == 200


@pytest.mark.parametrize(
    "call, error, words",
    [
        (lambda e: e.reset(seed=[1]), ValueError, "seed has 1 numbers, expected 3"),
        (lambda e: e.reset(seed=-1), Exception, "seed|Seed"),
        (lambda e: e.reset(options={"reset_mask": [True] * 3}), TypeError, "list"),
        (lambda e: e.reset(options={"reset_mask": np.ones(3)}), TypeError, "float64"),
        (lambda e: e.reset(options={"reset_mask": np.ones(2, bool)}), ValueError, "shape"),
        (lambda e: e.reset(options={"reset_mask": np.zeros(3, bool)}), ValueError, "no world"),
        (lambda e: e.step(np.zeros(2, int)), ValueError, "shape"),
        (lambda e: e.step(np.full(3, 2)), ValueError, "must be 0 to 1"),
    ],
)
def test_wrong_calls_are_errors(call, error, words):
    env = VectorEnv("CartPole", 3)
    with pytest.raises(error, match=words):
        call(env)
    env.close()
    with pytest.raises(ValueError, match="closed"):
        env.step(np.zeros(3, int))


def test_wrong_constructions_are_errors():
    for wrong in (
        dict(render_mode="human"),
        dict(autoreset_mode="Never"),
        dict(max_episode_steps=-1),
        dict(num_envs=0),
    ):
        with pytest.raises(ValueError):
            VectorEnv("CartPole", **wrong)


def test_the_library_is_usable_without_gymnasium():
    import subprocess
    import sys

    code = "import sys, manyworlds; assert 'gymnasium' not in sys.modules"
    subprocess.run([sys.executable, "-c", code], check=True)
    assert mw.Environment("CartPole").worlds == 1
