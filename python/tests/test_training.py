"""The policies of docs/training, trained here and in Gymnasium, and what trains and plays them."""

import importlib.util
import json
import sys
from pathlib import Path

import numpy as np
import pytest

if importlib.util.find_spec("manyworlds._mjcf") is None:
    pytest.skip("built without MuJoCo", allow_module_level=True)
pytest.importorskip("gymnasium")

from test_tasks import example  # noqa: E402

ROOT = Path(__file__).parents[2]
TRAINED = ROOT / "docs" / "training"
TRANSFER = json.loads((TRAINED / "transfer.json").read_text(encoding="utf-8"))


@pytest.fixture(autouse=True)
def their_folders(monkeypatch, tmp_path):
    """MuJoCo leaves its warnings in a file where it is."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(str(ROOT / "bench" / "python"))


def script(monkeypatch, path, *arguments):
    """What the script's main returns under these arguments."""
    spec = importlib.util.spec_from_file_location(path.stem, path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    monkeypatch.setattr(sys, "argv", [path.name, *map(str, arguments)])
    return module.main()


def test_wrappers_of_training_loops_take_robots():
    """Those of CleanRL's PPO for continuous actions, as vector wrappers."""
    import gymnasium
    from gymnasium.wrappers import vector

    import manyworlds.gym  # noqa: F401  (registers the tasks)

    envs = gymnasium.make_vec("manyworlds/Hopper-v5", num_envs=8)
    envs = vector.ClipAction(vector.RecordEpisodeStatistics(envs))
    envs = vector.NormalizeReward(vector.NormalizeObservation(envs), gamma=0.99)
    observations, _ = envs.reset(seed=1)
    rng, ended = np.random.default_rng(0), 0
    for _ in range(100):
        actions = rng.normal(0, 2, envs.action_space.shape).astype(np.float32)
        observations, rewards, terminated, _, infos = envs.step(actions)
        ended += terminated.sum()
        if terminated.any():
            assert (infos["_episode"] == terminated).all()
            assert (infos["episode"]["l"][terminated] > 3).all()
    assert ended > 8 and observations.std() < 3 and np.isfinite(rewards).all()
    envs.close()


@pytest.mark.parametrize("row", TRANSFER, ids=lambda row: row["policy"])
def test_trained_policies_score_as_they_did(row):
    policies = example("policy")
    task = "-".join(row["policy"].split("-")[:2])
    policy = policies.Policy.load(TRAINED / f"{row['policy']}.npz")
    returns, _ = policies.score(task, policy, worlds=32, seed=7)
    for found, was in ((returns, row["here"]), (returns, row["gymnasium"])):
        error = np.hypot(was["spread"] / 32**0.5, was["error"])
        assert abs(found.mean() - was["mean"]) < max(4 * error, 0.02 * was["mean"])


def test_returns_agree_by_five_percent_or_two_standard_errors():
    from transfer import agree, summary

    a = summary(np.array([90.0, 110.0] * 50), np.full(100, 3))
    assert a["mean"] == 100 and a["length"] == 3 and a["error"] == pytest.approx(1.005, abs=1e-3)
    for mean, error, good in ((104, 0, True), (106, 0, False), (110, 5, True), (110, 4, False)):
        assert agree(a, dict(mean=mean, error=error)) == good


def test_a_policy_is_played_in_both(monkeypatch, tmp_path):
    pytest.importorskip("mujoco")
    out = tmp_path / "transfer.json"
    file = TRAINED / "Hopper-v5-sb3.npz"
    sizes = "--worlds", 4, "--episodes", 2, "--json", out
    script(monkeypatch, ROOT / "bench/python/transfer.py", file, *sizes)
    (row,) = json.loads(out.read_text())
    was = next(row for row in TRANSFER if row["policy"] == "Hopper-v5-sb3")
    for where in ("here", "gymnasium"):
        assert abs(row[where]["mean"] - was[where]["mean"]) < 4 * was[where]["spread"]


def test_robots_are_measured_in_a_gait(monkeypatch, capsys):
    pytest.importorskip("mujoco")
    sizes = "--tasks HalfCheetah-v5 --worlds 2 --steps 50 --repeats 1".split()
    script(monkeypatch, ROOT / "bench/python/robots.py", "--policies", TRAINED, *sizes)
    printed = capsys.readouterr().out
    assert "| HalfCheetah-v5 | 2 | Environment |" in printed and "SyncVectorEnv |" in printed


def test_ppo_trains_a_robot_and_saves_its_policy(monkeypatch, tmp_path):
    jax = pytest.importorskip("jax")
    pytest.importorskip("optax")
    sizes = "--task Hopper-v5 --envs 32 --steps 16 --updates 3 --hidden 16 8 --threads 1"
    out = tmp_path / "curve.json", tmp_path / "policy.npz"
    result = example("ppo").main([*sizes.split(), "--json", str(out[0]), "--policy", str(out[1])])
    curve = json.loads(out[0].read_text())["curve"]
    assert len(curve) == 3 and curve == result["curve"] and curve[-1]["steps"] > 1400
    assert curve[-1]["learning"] > 0 and 0 < result["evaluation"] < 1000

    policy, seen = example("policy").Policy.load(out[1]), np.random.default_rng(0).normal(
        size=(7, 11)
    )
    layers = [(w, b) for w, b in zip(policy.weights, policy.biases)]
    assert [w.shape for w in policy.weights] == [(11, 16), (16, 8), (8, 3)]
    x = jax.numpy.clip((seen - policy.mean) / policy.scale, -10, 10)
    assert policy(seen) == pytest.approx(
        np.clip(example("learner").apply(layers, x), -1, 1), abs=1e-5
    )


def test_curves_are_drawn(tmp_path):
    pytest.importorskip("matplotlib")
    files = [str(file) for file in sorted(TRAINED.glob("HalfCheetah-v5-*.json"))]
    assert files
    curves = example("curves")
    for over in curves.AXES:
        curves.main([*files, "--over", over, "--out", str(tmp_path / "curves.png")])
        assert (tmp_path / "curves.png").read_bytes()[1:4] == b"PNG"
