"""The models of Gymnasium's MuJoCo tasks, and MuJoCo's own humanoid, beside MuJoCo."""

import json
import os
import pathlib
import subprocess

import pytest

gymnasium = pytest.importorskip("gymnasium")

PROGRAM = os.environ.get("MANYWORLDS_CLI")
ASSETS = pathlib.Path(gymnasium.__file__).parent / "envs" / "mujoco" / "assets"
OWN = pathlib.Path(__file__).parents[2] / "tests" / "mjcf" / "models"
MODELS = [OWN / "humanoid.xml"] + [
    ASSETS / f"{name}.xml"
    for name in ("inverted_pendulum", "inverted_double_pendulum", "reacher", "pusher", "pusher_v5",
                 "swimmer", "hopper", "half_cheetah", "walker2d", "walker2d_v5", "ant", "humanoid",
                 "humanoidstandup")
]


@pytest.mark.skipif(not PROGRAM, reason="the command line was not built with MJCF")
@pytest.mark.parametrize("model", MODELS, ids=lambda path: path.stem)
def test_states_and_paths_are_mujocos(model):
    run = subprocess.run(
        [PROGRAM, "compare", str(model), "--worlds", "96", "--steps", "100", "--no-speed", "--json"],
        capture_output=True, text=True, check=False)
    assert run.returncode == 0, run.stderr
    found = json.loads(run.stdout)
    assert {s["precision"] for s in found["states"]} == {"f64", "f32"}
    assert all(s["states"] == 96 for s in found["states"])
    assert found["failures"] == [] and found["speed"] == []
