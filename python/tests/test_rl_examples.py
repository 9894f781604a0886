"""The examples of examples/python, in short form."""

import importlib.util

import numpy as np
import pytest

from test_tasks import example


def test_a_composed_pole_is_balanced():
    assert example("compose").main().mean() > 400


def test_design_search_improves():
    pytest.importorskip("cma")
    history = example("design_search").main(["--candidates", "256", "--generations", "4"])
    assert history[-1][0] > history[0][0]


def test_planning_swings_a_pole_up_and_keeps_it_up():
    seen = example("mppi").main(["--branches", "128", "--seconds", "3"])
    assert len(seen) == 150
    upright = seen[:, 2]
    assert upright[0] < -0.9 and upright[-25:].min() > 0.95


def test_planning_raises_a_humanoid():
    seen = example("mppi").main("--task humanoid --branches 64 --seconds 0.8 --horizon 0.4".split())
    height, upright = seen.T
    assert height[0] < 0.15 and upright[0] < 0.2
    assert height[-1] > height[5] + 0.1 and upright[-1] > 0.7


def test_a_gait_is_found():
    pytest.importorskip("cma")
    pytest.importorskip("gymnasium")
    if importlib.util.find_spec("manyworlds._mjcf") is None:
        pytest.skip("built without MuJoCo")
    short = "--candidates 128 --generations 10 --seconds 1.5"
    history, far = example("gait_search").main(short.split())
    assert history[-1] > history[0] + 0.3  # m: from about -0.3 to 0.4
    assert np.median(far) > 0.5  # 1.3


def test_friction_and_damping_are_found_in_a_recording():
    pytest.importorskip("cma")
    if importlib.util.find_spec("manyworlds._record") is None:
        pytest.skip("built without HDF5")
    short = "--candidates 128 --generations 30 --seconds 1"
    numbers = example("identification").main(short.split())
    assert len(numbers) == 7
    for name, (hidden, found) in numbers.items():
        assert found == pytest.approx(hidden, rel=0.02), name


def test_every_task_has_a_picture(tmp_path):
    pytest.importorskip("matplotlib")
    example("gallery").main(["--steps", "2", "--out", str(tmp_path / "tasks.png")])
    assert (tmp_path / "tasks.png").read_bytes()[1:4] == b"PNG"


def test_throughput_is_printed():
    pytest.importorskip("gymnasium")
    found = example("throughput").main(["--worlds", "64", "--seconds", "0.1"])
    assert len(found) == 3 and min(found.values()) > 1000


def test_ppo_learns_to_balance():
    pytest.importorskip("gymnasium")
    pytest.importorskip("jax")
    pytest.importorskip("optax")
    short = "--task CartPole --envs 64 --steps 32 --updates 25 --seconds 900 --goal 150"
    result = example("ppo").main(short.split())
    assert result["curve"][0]["return"] < 40
    assert result["curve"][-1]["return"] > 60
    assert result["evaluation"] > 300
