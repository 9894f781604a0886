"""manyworlds.sb3, with Stable-Baselines3 where it is installed, else with a stand-in for the base
class that does what its documentation says."""

import importlib.util
import sys
import types

import numpy as np
import pytest

pytest.importorskip("gymnasium")


class _Base:
    """stable_baselines3.common.vec_env.VecEnv, in so far as the adapter meets it."""

    def __init__(self, num_envs, observation_space, action_space):
        self.num_envs = num_envs
        self.observation_space, self.action_space = observation_space, action_space
        self.reset_infos = [{} for _ in range(num_envs)]
        self._seeds = [None] * num_envs
        self.get_attr("render_mode")

    def seed(self, seed):
        self._seeds = [seed + i for i in range(self.num_envs)]

    def _reset_seeds(self):
        self._seeds = [None] * self.num_envs

    def _reset_options(self):
        pass

    def step(self, actions):
        self.step_async(actions)
        return self.step_wait()


@pytest.fixture
def VecEnv(monkeypatch):
    try:
        import stable_baselines3  # noqa: F401
    except ImportError:
        for name in ("", ".common", ".common.vec_env"):
            module = types.ModuleType("stable_baselines3" + name)
            module.VecEnv = _Base
            monkeypatch.setitem(sys.modules, "stable_baselines3" + name, module)
        monkeypatch.delitem(sys.modules, "manyworlds.sb3", raising=False)
    return importlib.import_module("manyworlds.sb3").VecEnv


def test_episodes_end_as_stable_baselines_has_it(VecEnv):
    env = VecEnv("CartPole", 4, max_episode_steps=8)
    env.seed(5)
    start = env.reset()
    env.seed(5)
    assert (env.reset() == start).all()
    ended = 0
    for _ in range(30):
        observations, rewards, dones, infos = env.step(np.ones(4, int))
        assert observations.shape == (4, 4) and rewards.dtype == np.float32 and len(infos) == 4
        for i, info in enumerate(infos):
            assert ("terminal_observation" in info) == dones[i]
            if dones[i]:
                ended += 1
                last = info["terminal_observation"]
                assert last.shape == (4,) and (last != observations[i]).any()
                assert info["TimeLimit.truncated"] == bool(abs(last[2]) <= 0.2094)
    assert ended >= 12
    assert env.env_is_wrapped(object) == [False] * 4 and env.get_attr("num_envs", 0) == [4]
    env.close()


def test_robots_are_trained(VecEnv):
    if importlib.util.find_spec("manyworlds._mjcf") is None:
        pytest.skip("built without MuJoCo")
    from manyworlds.gym import mujoco

    env = VecEnv(mujoco.task("Hopper-v5", reset_noise_scale=0.0), 3)
    assert env.reset().shape == (3, 11) and env.action_space.shape == (3,)
    dones = np.zeros(3, bool)
    while not dones.any():
        observations, rewards, dones, infos = env.step(np.ones((3, 3), np.float32))
    assert dones.all() and len({info["terminal_observation"].tobytes() for info in infos}) == 1
    assert not infos[0]["TimeLimit.truncated"]
    env.close()


def test_other_autoresets_are_refused(VecEnv):
    with pytest.raises(ValueError, match="SAME_STEP"):
        VecEnv("CartPole", 2, autoreset_mode="NextStep")


def test_it_renders(VecEnv):
    pytest.importorskip("matplotlib")
    env = VecEnv("CartPole", 2, render_mode="rgb_array")
    env.reset()
    frames = env.get_images()
    assert env.render_mode == "rgb_array" and len(frames) == 2 and frames[0].shape == (400, 600, 3)
    assert not VecEnv("CartPole", 2).get_images()
