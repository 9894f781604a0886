"""Rollouts on Ray's actors do what one process does, whatever happens to the actors."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import manyworlds as mw
from manyworlds import search

ray = pytest.importorskip("ray", reason="Ray is not installed (pip install 'manyworlds-sim[ray]')")

from manyworlds.ray import Rollouts, ShardError  # noqa: E402

WORLDS, BLOCK, SEED = 40, 8, 3
SHARDS = [1, 2, 5]


@pytest.fixture(scope="module", autouse=True)
def cluster():
    """Three nodes on this machine."""
    from ray.cluster_utils import Cluster

    os.environ["RAY_AUTH_MODE"] = "disabled"
    store = 80 * 2**20
    cluster = Cluster(
        initialize_head=True,
        head_node_args={
            "num_cpus": 2,
            "object_store_memory": store,
            "include_dashboard": False,
            # A node that is gone is missed after a second.
            "_system_config": {"health_check_period_ms": 300, "health_check_failure_threshold": 3},
        },
    )
    cluster.add_node(num_cpus=2, object_store_memory=store)
    paths = os.pathsep.join([os.path.dirname(__file__), os.environ.get("PYTHONPATH", "")])
    ray.init(
        address=cluster.address,
        log_to_driver=False,
        runtime_env={"env_vars": {"PYTHONPATH": paths}},
    )
    yield cluster
    ray.shutdown()
    cluster.shutdown()


def lean(observations):
    """Pushes the cart to where the pole leans."""
    return (observations[:, 0] + observations[:, 2] > 0).astype(np.int64)


def stand(observations):
    """Pushes the cart to the right."""
    return np.ones(len(observations), np.int64)


def cart_poles(shards, policy=lean, **arguments):
    """On actors, or here."""
    given = {"block": BLOCK, "threads": 1, **arguments}
    if shards:
        given.setdefault("cpus", 0.1)
    return Rollouts("CartPole", WORLDS, SEED, policy, shards, **given)


def same(a, b):
    """Bit by bit, arrays of names or results."""
    for name in a if isinstance(a, dict) else vars(a):
        x, y = (a[name], b[name]) if isinstance(a, dict) else (getattr(a, name), getattr(b, name))
        np.testing.assert_array_equal(x, y, err_msg=name)
    return True


@pytest.fixture(scope="module")
def alone():
    """What comes of 60 and 50 steps, and of whole episodes, in an Environment of all worlds."""
    with mw.Environment("CartPole", WORLDS, threads=1, seed=SEED) as e:
        returns = np.zeros((2, WORLDS))
        hashes = []
        for call, steps in enumerate([60, 50]):
            for _ in range(steps):
                e.step(lean(e.observations))
                returns[call] += e.rewards
            hashes.append(e.batch.hashes())
    return hashes, returns


@pytest.mark.parametrize("shards", [0, *SHARDS])
def test_worlds_do_the_same_whatever_shard_they_are_in(shards, alone):
    hashes, returns = alone
    with cart_poles(shards) as r:
        assert r.shards == shards and r.worlds == WORLDS and r.block == BLOCK
        for call, steps in enumerate([60, 50]):
            found = r.run(steps)
            np.testing.assert_array_equal(found.report.hashes, hashes[call])
            np.testing.assert_array_equal(found.report.returns, returns[call])
            arrays = found.gather()
            assert arrays["observations"].shape == (steps, WORLDS, 4)
            assert arrays["rewards"].sum(axis=0) == pytest.approx(returns[call])
            ended = (arrays["terminated"] | arrays["truncated"]).sum(axis=0)
            np.testing.assert_array_equal(ended, found.report.episodes)
        assert found.report.episodes.sum() > 0 and not found.report.lost.any()


@pytest.mark.parametrize("shards", [1, 3])
def test_whole_episodes_have_the_same_returns(shards):
    with cart_poles(0) as here, cart_poles(shards) as there:
        expected = here.evaluate(episodes=21)
        before = there.run(10).report.hashes
        assert same(expected, there.evaluate(episodes=21))
        assert expected.returns.shape == (21,) and (expected.lengths == expected.returns).all()
        assert same(here.evaluate(stand, 5), there.evaluate(stand, 5))
        np.testing.assert_array_equal(before, here.run(10).report.hashes)
        assert same(here.run(10).report, there.run(10).report)


@pytest.mark.parametrize("saved", ["never", "store", "folder"])
def test_an_actor_that_is_killed_in_mid_run_is_replaced_and_catches_up(saved, alone, tmp_path):
    more = {
        "never": {"checkpoint_every": 0},
        "store": {"checkpoint_every": 60},
        "folder": {"checkpoint_every": 60, "folder": tmp_path / "saved"},
    }[saved]
    with cart_poles(2, policy=stand, **more) as r, cart_poles(0, policy=stand) as here:
        assert same(r.run(7).report, here.run(7).report)
        r.use(lean), here.use(lean)
        assert same(r.run(60).report, here.run(60).report)
        if saved == "folder":
            assert sorted(p.suffix for p in (tmp_path / "saved").iterdir()) == [".pickle"] * 5
        victim = r.processes[1]
        calls = r.iterate(200, calls=3)
        killer = threading.Timer(0.05, os.kill, (victim, signal.SIGKILL))
        killer.start()
        for found in calls:
            assert same(found.report, here.run(200).report)
            killer.join()
        assert r.restarts == 1 and victim not in r.processes
        if saved == "folder":
            assert len(list((tmp_path / "saved").iterdir())) == 5
            assert len(r._crew.history) < 3 < r._crew._dropped
        assert same(r.run(20).gather(), here.run(20).gather())


def test_an_actor_that_hangs_is_replaced(tmp_path):
    flag = tmp_path / "hung"

    def once(observations):
        if not flag.exists():
            flag.write_text("")
            time.sleep(1000)
        return lean(observations)

    with cart_poles(1, policy=once, timeout=6) as r, cart_poles(0) as here:
        assert same(r.run(30).report, here.run(30).report)
        assert r.restarts == 1


def test_an_actor_that_always_dies_is_an_error():
    def fatal(observations):
        os.kill(os.getpid(), signal.SIGKILL)

    with cart_poles(1, policy=fatal, max_restarts=1) as r:
        with pytest.raises(ShardError, match=r"blocks 0 to 4 was lost 2 times in one call"):
            r.run(1)
        assert r.closed


def test_a_node_that_dies_takes_no_world_with_it(cluster):
    node = cluster.add_node(num_cpus=1, resources={"own": 2}, object_store_memory=80 * 2**20)
    with cart_poles(2, resources={"own": 1}, cpus=0.1, checkpoint_every=20) as r:
        with cart_poles(0) as here:
            assert same(r.run(20).report, here.run(20).report)
            assert same(r.run(5).report, here.run(5).report)
            cluster.remove_node(node, allow_graceful=False)
            cluster.add_node(num_cpus=1, resources={"own": 2}, object_store_memory=80 * 2**20)
            assert same(r.run(20).report, here.run(20).report)
            assert r.restarts >= 2


def test_shards_come_and_go(tmp_path):
    # Each run saves, so that a resize saves what was just saved.
    with cart_poles(2, folder=tmp_path, checkpoint_every=30) as r, cart_poles(0) as here:
        for shards in [3, 1]:
            r.resize(shards)
            assert r.shards == shards
            assert same(r.run(35).report, here.run(35).report)
            assert len(list(tmp_path.iterdir())) == 5
        os.kill(r.processes[0], signal.SIGKILL)
        assert same(r.run(35).gather(), here.run(35).gather())


def test_iterating_runs_ahead_no_farther_than_asked():
    with cart_poles(2) as r, cart_poles(0) as here:
        calls = r.iterate(10, ahead=2)
        for _ in range(3):
            assert same(next(calls).gather(), here.run(10).gather())
        calls.close()
        here.run(10), here.run(10)  # those that were ahead
        assert same(r.run(10).report, here.run(10).report)
        found = [t.report for t in r.iterate(5, calls=4)]
        assert all(same(a, here.run(5).report) for a in found) and len(found) == 4


def test_trajectories_lie_where_ray_has_them_and_are_not_copied():
    with cart_poles(2) as r:
        found = r.run(20)
        first = next(iter(found.parts))["observations"]
        assert not first.flags.writeable and first.shape == (20, BLOCK, 4)
        mean = ray.remote(num_cpus=0.1)(lambda parts: np.mean([p["rewards"].mean() for p in parts]))
        means = ray.get([mean.remote(one) for one in found.references])
        assert len(means) == 2 and all(0 < m <= 1 for m in means)


def test_what_is_not_kept_is_not_sent():
    with cart_poles(1) as r, cart_poles(0) as here:
        for rollouts in (r, here):
            found = rollouts.run(20, keep=["rewards"])
            assert [*found.gather()] == ["rewards"]
            assert rollouts.run(20, keep=[]).gather() == {}
            with pytest.raises(ValueError, match="keep has 'reward'; expected some of observations"):
                rollouts.run(1, keep=["reward"])
        assert same(r.run(20).gather(), here.run(20).gather())


def test_scenes_have_frames_of_their_fields():
    def push(batch):
        return np.full((batch.worlds, 3), 0.3)

    for policy in (None, push):
        given = {"fields": ("position",), "block": 4, "threads": 1}
        with Rollouts("lunar-lander", 10, 1, policy, 0, **given) as here:
            expected = here.run(30, every=10)
        with Rollouts("lunar-lander", 10, 1, policy, 3, cpus=0.1, **given) as r:
            found = r.run(30, every=10)
            os.kill(r.processes[0], signal.SIGKILL)
            r.run(30)
            after = r.run(1).report
        assert same(expected.report, found.report) and same(expected.gather(), found.gather())
        assert found.gather()["position"].shape[:2] == (3, 10)
        with Rollouts("lunar-lander", 10, 1, policy, 0, **given) as here:
            here.run(60)
            assert same(here.run(1).report, after)


def thrown(run):
    """How far bodies come."""
    return run.batch.get("position")[:, :, 0].max(axis=1)


def test_searches_find_the_same_whatever_the_shards():
    body = mw.Body(name="ball", shapes=[mw.Shape(geometry=mw.Sphere(0.1))], position=(0, 0, 1))
    scene = mw.Scene(name="throw", bodies=[body])

    def begin(run):
        speed = np.zeros((run.batch.worlds, 1, 3))
        speed[:, 0, 0] = run["speed"]
        run.batch.set("linear_velocity", speed)

    tables = []
    for shards in [0, 1, 3]:
        given = {"block": 4, "threads": 1, "cpus": 0.1 if shards else None}
        space = search.Space(search.Parameter("speed", 1, 5))
        with Rollouts(scene, 12, SEED, None, shards, **given) as r:
            found = r.search(
                space, search.Random(10), thrown, 3, goal="maximize", begin=begin, steps=20
            )
            tables.append(found.results)
    for other in tables[1:]:
        for a, b in zip(tables[0].generations, other.generations):
            np.testing.assert_array_equal(a.value, b.value)
            np.testing.assert_array_equal(a.hash, b.hash)
    assert len(tables[0]) == 30


def test_what_a_policy_raises_is_raised():
    def wrong(observations):
        raise KeyError("no such number")

    for shards in (0, 2):
        r = cart_poles(shards, policy=wrong)
        with pytest.raises(KeyError, match="no such number"):
            r.run(3)
        assert r.closed
        with pytest.raises(ValueError, match="closed"):
            r.run(1)


def test_lost_worlds_are_told():
    def broken(observations):
        actions = np.zeros((len(observations), 1), np.float32)
        actions[3] = np.nan
        return actions

    for shards in (0, 2):
        given = {"block": 8, "threads": 1, "cpus": 0.1 if shards else None}
        with Rollouts("Pendulum", 16, 0, broken, shards, **given) as r:
            assert np.flatnonzero(r.run(1).report.lost).tolist() == [3, 11]


@pytest.mark.parametrize(
    "arguments, error",
    [
        ({"worlds": 0}, "worlds is 0"),
        ({"seed": -1}, "seed is -1"),
        ({"policy": 3}, "policy is of type int; expected a callable"),
        ({"shards": 99}, "shards is 99, but 40 worlds are 5 blocks of 8; expected at most 5"),
        ({"timeout": 0}, "timeout is 0; expected seconds > 0"),
        ({"block": 0}, "block is 0"),
        ({"fields": ("position",)}, r"fields are \['position'\]; expected none for a task"),
        ({"precision": "f16"}, "f16"),
        ({"what": "no-such"}, "there is no task and no scene 'no-such'"),
    ],
)
def test_bad_arguments_are_refused(arguments, error):
    given = {"what": "CartPole", "worlds": WORLDS, "shards": 2, "block": BLOCK, **arguments}
    with pytest.raises((ValueError, TypeError), match=error):
        Rollouts(**given)


def test_without_ray_there_is_this_process():
    code = """
import sys
sys.modules["ray"] = None
from manyworlds.ray import Rollouts
with Rollouts("CartPole", 4, shards=0) as here:
    assert here.run(3).gather()["rewards"].shape == (3, 4)
try:
    Rollouts("CartPole", 4, shards=1)
except ModuleNotFoundError as error:
    assert "pip install 'manyworlds-sim[ray]'" in str(error)
else:
    raise AssertionError
"""
    subprocess.run([sys.executable, "-c", code], check=True)


def test_without_actors_there_is_nothing_to_resize():
    with cart_poles(0) as r, pytest.raises(ValueError, match="shards=0"):
        r.resize(2)
