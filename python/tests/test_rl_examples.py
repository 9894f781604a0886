"""The examples of examples/python, in short form."""

import pytest

from test_tasks import example


def test_a_composed_pole_is_balanced():
    assert example("compose").main().mean() > 400


def test_design_search_improves():
    pytest.importorskip("cma")
    history = example("design_search").main(["--candidates", "256", "--generations", "4"])
    assert history[-1][0] > history[0][0]


def test_planning_swings_acrobot_up():
    up, steps = example("mppi").main(["--samples", "128", "--seed", "1"])
    assert up and steps < 150


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
