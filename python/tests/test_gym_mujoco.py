"""Gymnasium's MuJoCo tasks here and there: the same states, the same actions, the same numbers.

MANYWORLDS_GYM_STATES is how many states of each task are compared; docs/gymnasium.md has the figures of 1000.
"""

import importlib.util
import inspect
import os
import pickle

import numpy as np
import pytest

if importlib.util.find_spec("manyworlds._mjcf") is None:
    pytest.skip("built without MuJoCo", allow_module_level=True)
gymnasium = pytest.importorskip("gymnasium")
mujoco = pytest.importorskip("mujoco")

import manyworlds as mw  # noqa: E402
import manyworlds.gym  # noqa: E402
from manyworlds.gym import infos as gym_infos  # noqa: E402
from manyworlds.gym import mujoco as tasks  # noqa: E402

STATES = int(os.environ.get("MANYWORLDS_GYM_STATES", "300"))
STEPS = 2  # of the task, from each state
# Contacts whose points are not MuJoCo's (docs/mujoco.md), of the two kinds of shapes.
KINDS = mujoco.mjtGeom
OTHERS = {(KINDS.mjGEOM_CAPSULE, KINDS.mjGEOM_CYLINDER)}
# Infos that are sums of numbers of the observation, and no nearer than those.
SUMS = {"tendon_length", "tendon_velocity"}


@pytest.fixture(autouse=True)
def log_elsewhere(monkeypatch, tmp_path):
    """MuJoCo leaves its warnings in a file where it is."""
    monkeypatch.chdir(tmp_path)


def converge(options):
    options.tolerance = 1e-10
    options.iterations = 100


class Theirs:
    """A task of Gymnasium's, whose solver goes to its end, and what touched in its last steps."""

    def __init__(self, name, **arguments):
        self.env = gymnasium.make(name, max_episode_steps=10**6, **arguments).unwrapped
        self.model, self.data = self.env.model, self.env.data
        self.model.opt.solver = mujoco.mjtSolver.mjSOL_NEWTON
        converge(self.model.opt)
        self.env._step_mujoco_simulation = self._step
        self.smooth, self.touched = True, set()

    def _step(self, ctrl, n_frames):
        self.data.ctrl[:] = ctrl
        for _ in range(n_frames):
            mujoco.mj_step(self.model, self.data)
            self.smooth &= self.data.nefc == 0
            for contact in self.data.contact:
                kinds = self.model.geom_type[contact.geom]
                self.touched.add(tuple(KINDS(kind) for kind in sorted(kinds)))
        mujoco.mj_rnePostConstraint(self.model, self.data)

    def begin(self, qpos, qvel):
        mujoco.mj_resetData(self.model, self.data)
        self.env.set_state(qpos, qvel)
        self.smooth, self.touched = self.data.nefc == 0, set()
        return self.env._get_obs()

    def states(self, count, rng):
        """Those that random actions lead to, from the task's own beginnings."""
        found = []
        self.env.reset(seed=int(rng.integers(2**31)))
        self.env.action_space.seed(int(rng.integers(2**31)))
        while len(found) < count:
            if len(found) % 25 == 0:
                self.env.reset()
            for _ in range(int(rng.integers(1, 4))):
                self.env.step(self.env.action_space.sample())
            found.append((self.data.qpos.copy(), self.data.qvel.copy()))
        return found


def ours(name, worlds, precision, **arguments):
    task = tasks.task(name, **arguments)
    converge(task.scene.options.solver)
    return mw.Environment(
        task, worlds, threads=1, precision=precision, autoreset="disabled", observation_dtype="float64"
    )


def apart(found, expected, precision, terms=None):
    """The largest difference, of float64 relative to the number itself or to 1, of float32 relative to the
    largest number of all, as small torques there are differences of large ones; or to that of the terms."""
    found, size = np.atleast_1d(found), np.abs(np.atleast_1d(expected))
    scale = size if precision == "f64" else np.max(np.abs(terms if terms is not None else size))
    return np.max(np.abs(found - expected) / np.maximum(1.0, scale))


def compare(name, precision, count, reach=1.0, **arguments):
    """What differs from Gymnasium's in each state: (errors, whether no constraint acted, touched).

    ``reach``: of actions, in their ranges.
    """
    rng = np.random.default_rng(7)
    theirs = Theirs(name, **arguments)
    states = theirs.states(count, rng)
    env = ours(name, count, precision, **arguments)
    told_of = list(gym_infos.told(env.task.infos))
    env.batch.set("generalized_position", np.array([q for q, _ in states])[..., None])
    env.batch.set("generalized_velocity", np.array([v for _, v in states])[..., None])
    space = theirs.env.action_space
    actions = rng.uniform(space.low, space.high, (STEPS, count, *space.shape)).astype(np.float32)
    actions *= np.float32(reach)
    results = [(env.begin().copy(), None, None, None)]
    for action in actions:
        observations, rewards, terminated, _ = env.step(action)
        results.append(
            (observations.copy(), rewards.copy(), terminated.copy(), env.infos.copy())
        )
    errors, smooth, touched = np.zeros(count), np.zeros(count, bool), []
    for world, (qpos, qvel) in enumerate(states):
        began = theirs.begin(qpos, qvel)
        # What constraints do is known of steps alone here.
        error = apart(results[0][0][world], began, precision) if theirs.smooth else 0.0
        for action, (observations, rewards, terminated, infos) in zip(actions, results[1:]):
            # Costs of float32 actions are worked out in float32 there.
            obs, reward, ended, truncated, info = theirs.env.step(action[world].astype(np.float64))
            assert not truncated
            error = max(error, apart(observations[world], obs, precision))
            error = max(error, apart(rewards[world], reward, precision))
            told = {name: infos[world, columns] for name, columns, _ in told_of}
            assert set(told) == set(info)
            for key, value in info.items():
                assert np.shape(told[key]) == np.shape(value), key
                error = max(error, apart(told[key], value, precision, obs if key in SUMS else None))
            if bool(terminated[world]) != ended:
                error = np.inf
        errors[world], smooth[world] = error, theirs.smooth
        touched.append(theirs.touched)
    return errors, smooth, touched


def gate(name, precision, free, constrained, median, states=STATES, **arguments):
    errors, smooth, touched = compare(name, precision, states, **arguments)
    beyond = errors > np.where(smooth, free, constrained)
    excused = np.array([bool(kinds & OTHERS) for kinds in touched])
    report = (
        f"{name} {precision}: {smooth.sum()} of {states} states without constraints; largest "
        f"{np.max(errors[smooth], initial=0):.1e} and {np.max(errors[~smooth], initial=0):.1e}, median "
        f"{np.median(errors):.1e}; {beyond.sum()} beyond the gates, {(beyond & excused).sum()} excused"
    )
    for world in np.flatnonzero(beyond):
        kinds = [f"{a.name} and {b.name}" for a, b in touched[world] & OTHERS]
        report += f"\n  state {world}: {errors[world]:.1e}, {', '.join(kinds) or 'not excused'}"
    print(report)
    assert not (beyond & ~excused).any(), report
    assert (beyond & excused).mean() <= 0.01, report
    assert np.median(errors) <= median, report


@pytest.mark.parametrize("name", tasks.names())
def test_float64_is_gymnasiums(name):
    gate(name, "f64", 1e-8, 1e-6, 1e-8)


@pytest.mark.parametrize("name", tasks.names())
def test_float32_is_close(name):
    gate(name, "f32", 1e-2, 1e-2, 1e-4)


# -- through Gymnasium


@pytest.mark.parametrize("name", tasks.names())
def test_spaces_lengths_and_arguments_are_gymnasiums(name):
    theirs = gymnasium.spec(name)
    mine = gymnasium.spec(f"manyworlds/{name}")
    assert mine.max_episode_steps == theirs.max_episode_steps
    assert mine.reward_threshold == theirs.reward_threshold
    env = gymnasium.make(name).unwrapped
    known = inspect.signature(type(env).__init__).parameters
    wanted = {key: p.default for key, p in known.items() if p.default is not inspect.Parameter.empty}
    own = tasks.arguments(name)
    assert set(own) == set(wanted) - {"xml_file", "default_camera_config"}
    for key, value in own.items():
        assert value == pytest.approx(wanted[key]), key
    # All of them by name, the model too; what a camera sees is not part of the task.
    given = {key: value for key, value in wanted.items() if key != "default_camera_config"}
    one = gymnasium.make(f"manyworlds/{name}", **given)
    assert one.observation_space.shape == env.observation_space.shape
    assert one.action_space == env.action_space
    one.close()
    envs = gymnasium.make_vec(
        f"manyworlds/{name}", num_envs=3, observation_dtype="float64", **given
    )
    assert envs.single_observation_space.shape == env.observation_space.shape
    assert envs.single_observation_space.dtype == env.observation_space.dtype
    assert envs.single_action_space == env.action_space
    assert envs.metadata["render_fps"] == env.metadata["render_fps"]
    observations, infos = envs.reset(seed=3)
    assert observations.dtype == np.float64
    _, expected = env.reset(seed=3)
    assert {key for key in infos if key[0] != "_"} == set(expected)
    assert all(infos[key].shape == (3, *np.shape(expected[key])) for key in expected)
    threshold = theirs.reward_threshold
    assert tasks.task(name).solved_at == (np.inf if threshold is None else threshold)
    assert tasks.task(name).max_steps == theirs.max_episode_steps
    envs.close()


OTHER_ARGUMENTS = {
    "InvertedDoublePendulum-v5": {"healthy_reward": 7.0},
    "Reacher-v5": {"reward_dist_weight": 3.0, "reward_control_weight": 0.25},
    "Pusher-v5": {"reward_near_weight": 2.0, "reward_control_weight": 0.5, "frame_skip": 2},
    "Swimmer-v5": {"exclude_current_positions_from_observation": False, "ctrl_cost_weight": 0.5},
    "Hopper-v5": {"healthy_state_range": (-1.0, 1.0), "terminate_when_unhealthy": False},
    "HalfCheetah-v5": {"exclude_current_positions_from_observation": False, "frame_skip": 3},
    "Walker2d-v5": {"healthy_z_range": (1.2, 1.3), "healthy_angle_range": (-0.01, 0.3)},
    "Ant-v5": {"contact_force_range": (-50.0, 0.5), "main_body": "front_left_leg",
               "include_cfrc_ext_in_observation": False, "healthy_z_range": (0.5, 0.7)},
    "Humanoid-v5": {"contact_cost_range": (0.1, 0.2), "contact_cost_weight": 0.1,
                    "include_cinert_in_observation": False, "include_cvel_in_observation": False},
    "HumanoidStandup-v5": {"impact_cost_weight": 1e-3, "include_cfrc_ext_in_observation": False,
                           "include_qfrc_actuator_in_observation": False, "uph_cost_weight": 5.0},
}  # fmt: skip


@pytest.mark.parametrize("name", OTHER_ARGUMENTS)
def test_arguments_do_what_they_do_there(name):
    gate(name, "f64", 1e-8, 1e-6, 1e-8, states=60, **OTHER_ARGUMENTS[name])


@pytest.mark.parametrize("name", tasks.names())
def test_costs_are_of_actions_as_given(name):
    """Beyond their ranges, too, where the controls stay within theirs."""
    gate(name, "f64", 1e-8, 1e-6, 1e-8, states=40, reach=3.0)


@pytest.mark.parametrize("name", tasks.names())
def test_worlds_begin_as_there(name):
    """Positions and velocities of many beginnings have the same means and spreads."""
    count = 400
    env = gymnasium.make(name).unwrapped
    theirs = []
    for seed in range(count):
        env.reset(seed=seed)
        theirs.append(np.concatenate([env.data.qpos, env.data.qvel]))
    theirs = np.array(theirs)
    with mw.Environment(tasks.task(name), count, threads=1, precision="f64") as mine:
        begun = [mine.batch.get(f"generalized_{what}")[..., 0] for what in ("position", "velocity")]
    begun = np.concatenate(begun, axis=1)
    spread = theirs.std(axis=0)
    # Five standard errors of the difference of two means, and of two spreads.
    assert (np.abs(begun.mean(axis=0) - theirs.mean(axis=0)) <= 5 * spread * (2 / count) ** 0.5 + 1e-12).all()
    assert (np.abs(begun.std(axis=0) - spread) <= 5 * spread * count**-0.5 + 1e-12).all()
    if name == "Pusher-v5":
        assert (np.hypot(*begun[:, 7:9].T) > 0.17).all()
    if name == "Reacher-v5":
        assert (np.hypot(*begun[:, 2:4].T) < 0.2).all()


@pytest.mark.parametrize("mode", ["NextStep", "SameStep", "Disabled"])
@pytest.mark.parametrize("name", ["Hopper-v5", "Ant-v5", "Reacher-v5"])
def test_the_contract_of_vector_environments_holds(name, mode):
    envs = gymnasium.make_vec(f"manyworlds/{name}", num_envs=3, autoreset_mode=mode, max_episode_steps=20)
    mw.gym.check_vector_env(envs, steps=60, seed=1)
    envs.close()


def test_one_environment():
    env = gymnasium.make("manyworlds/Ant-v5", healthy_z_range=(0.1, 2.0))
    _, info = env.reset(seed=4)
    assert set(info) == {"x_position", "y_position", "distance_from_origin"}
    *_, info = env.step(env.action_space.sample())
    assert {"x_velocity", "reward_forward", "reward_contact"} <= set(info)
    copy = pickle.loads(pickle.dumps(env.spec)).make()
    assert copy.observation_space == env.observation_space
    task = env.unwrapped.task
    again = pickle.loads(pickle.dumps(task))
    assert [i.name for i in again.infos] == [i.name for i in task.infos]
    assert again.scene == task.scene
    env.close(), copy.close()


def test_wrong_arguments_are_named():
    with pytest.raises(TypeError, match="Reacher-v5 has no helthy_reward; it has xml_file, frame_skip"):
        gymnasium.make_vec("manyworlds/Reacher-v5", num_envs=2, helthy_reward=2)
    with pytest.raises(ValueError, match="there is no task 'Ant-v4'"):
        tasks.task("Ant-v4")
    with pytest.raises(ValueError, match="has 6 coordinates, must have 7 or more"):
        tasks.task("Ant-v5", xml_file="hopper.xml")
    with pytest.raises(ValueError, match="main_body is 'tail'"):
        tasks.task("Ant-v5", main_body="tail")
    with pytest.raises(TypeError, match="frame_skip"):
        tasks.task("Ant-v5", frame_skip=2.5)
    with pytest.raises(mw.mjcf.MjcfError, match="nowhere.xml"):
        tasks.task("Ant-v5", xml_file="/nowhere.xml")


@pytest.mark.parametrize("name", ["InvertedDoublePendulum-v5", "Hopper-v5", "Walker2d-v5", "Humanoid-v5"])
def test_whole_episodes_are_worth_the_same(name):
    """Returns and lengths under one policy, from beginnings to ends, have the same means."""
    here, there = 1000, 150
    theirs = gymnasium.make(name)
    rng = np.random.default_rng(2)
    size, actions = theirs.observation_space.shape[0], theirs.action_space
    weights = 0.5 * rng.normal(size=(size, actions.shape[0])) / np.sqrt(size)

    def act(observations):
        return (actions.high * np.tanh(np.clip(observations, -10, 10) @ weights)).astype(np.float32)

    expected = []
    for seed in range(there):
        observation, ended = theirs.reset(seed=seed)[0], False
        total = length = 0
        while not ended:
            observation, reward, terminated, truncated, _ = theirs.step(act(observation))
            total, length, ended = total + reward, length + 1, terminated or truncated
        expected.append((total, length))
    envs = gymnasium.make_vec(f"manyworlds/{name}", num_envs=here)
    observations, _ = envs.reset(seed=0)
    found, running = np.zeros((here, 2)), np.ones(here, bool)
    while running.any():
        observations, rewards, terminated, truncated, _ = envs.step(act(observations))
        found[running] += np.stack([rewards, np.ones(here)], axis=1)[running]
        running &= ~(terminated | truncated)
    envs.close()
    expected = np.array(expected)
    error = np.sqrt(expected.var(axis=0) / there + found.var(axis=0) / here)
    assert (np.abs(found.mean(axis=0) - expected.mean(axis=0)) <= 4 * error + 1e-9).all()
    print(name, "here", found.mean(axis=0), "there", expected.mean(axis=0), "standard error", error)
