"""The examples of README.md, docs/python.md, docs/robots.md, docs/scale.md and docs/search.md run."""

import importlib.util
import re
from pathlib import Path

import numpy as np
import pytest

import manyworlds as mw

ROOT = Path(__file__).parents[2]


def examples(file):
    return re.findall(r"```python\n(.*?)```", (ROOT / file).read_text(), re.S)


def test_the_readme(capsys):
    code = next(e for e in examples("README.md") if "import manyworlds" in e)
    exec(code.replace("4096", "64").replace("step(300)", "step(30)"), {})
    assert "of 64 towers stand" in capsys.readouterr().out


def test_robots():
    places = {}
    for code in examples("docs/robots.md"):
        exec(code.replace("1024", "16"), places)
    assert places["q"].shape == (16, 2, 1) and np.isfinite(places["q"]).all()
    assert len(np.unique(places["q"])) == 2


def test_searches(tmp_path, monkeypatch):
    for package in ("cma", "scipy", "pyarrow"):
        pytest.importorskip(package)
    if importlib.util.find_spec("manyworlds._record") is None:
        pytest.skip("built without HDF5")
    monkeypatch.chdir(tmp_path)
    places = {}
    for code in examples("docs/search.md"):
        code = code.replace("candidates=1000", "candidates=100").replace("run(15, ", "run(4, ")
        code = code.replace('"speed": 20, "angle": 15', '"speed": 4, "angle": 5')
        code = code.replace("((500,", "((60,").replace("CmaEs(256)", "CmaEs(32)")
        if "write_page" in code and not (Path(mw.__file__).parent / "viewer.html").is_file():
            code = "\n".join(line for line in code.splitlines() if "write_page" not in line)
        exec(code, places)
    best = places["found"].best
    assert best.value > 25 and places["again"].hashes[0] == best.hash
    assert len(places["design"].results) == 60 and len(places["by_hand"].results) == 500
    assert places["annealed"].best.value > 20 and places["shots"].results.best.value > 2


def test_rollouts_beyond_one_machine():
    places = {}
    for code in examples("docs/scale.md"):
        exec(code.replace("worlds=4096", "worlds=64").replace("=500)", "=50)"), places)
    assert places["rewards"].shape == (100, 64)


def test_the_manual(tmp_path, monkeypatch):
    pytest.importorskip("matplotlib")
    if importlib.util.find_spec("manyworlds._record") is None:
        pytest.skip("built without HDF5")
    monkeypatch.chdir(tmp_path)
    places = {"mw": mw, "np": np}
    for code in examples("docs/python.md"):
        if "set_controls" in code or "rollout" in code:
            batch = mw.Batch(places["plan"], worlds=64)
            bodies, width = 1, 2
            places |= {
                "batch": batch,
                "actions": np.zeros((64, 1)),
                "plans": np.zeros((20, 64, 1)),
                "mask": np.arange(64) < 3,
                "p": np.zeros((bodies, width)),
                "where": np.zeros((bodies, width)),
            }
        exec(code.replace("worlds=4096", "worlds=64"), places)
    assert places["path"].shape == (2, 64, 1, 2)
    assert places["result"].same and places["frame"].shape == (400, 600, 3)
    assert sorted(f.name for f in tmp_path.iterdir()) == ["run.h5", "world.png"]
