"""The examples of docs/rl.md run."""

import importlib.util
import re
from pathlib import Path

import numpy as np
import pytest

import manyworlds as mw
from manyworlds import tasks

ROOT = Path(__file__).parents[2]


def test_the_manual():
    pytest.importorskip("gymnasium")
    text = (ROOT / "docs" / "rl.md").read_text()
    places = {"mw": mw, "np": np}
    for code in re.findall(r"```python\n(.*?)```", text, re.S):
        if "row_of_my_buffer" not in code:
            small = re.sub(r"(worlds|num_envs)=\d+", r"\1=16", code)
            exec(small.replace("range(1000)", "range(150)"), places)
    assert places["task"].validate() == []
    for name in tasks.names():
        assert f"| {name} |" in text


def test_peers_are_measured(monkeypatch, capsys):
    """The script of the table of peers: who is there has a row, who is not is named."""
    pytest.importorskip("gymnasium")
    path = ROOT / "bench" / "python" / "vector_envs.py"
    spec = importlib.util.spec_from_file_location("vector_envs", path)
    script = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(script)
    monkeypatch.setattr(script, "PAIRS", [("CartPole-v1", "CartPole")])
    rows = {row["what"]: row for row in script.compare_peers([8], 0.02, 1)}
    assert rows["manyworlds VectorEnv"]["ratio"] == 1
    assert rows["Gymnasium, NumPy (vector_entry_point)"]["speed"] > 0
    assert rows["Gymnasium, SyncVectorEnv"]["ratio"] > 0
    absent = "EnvPool of CartPole-v1 cannot be had here" in capsys.readouterr().out
    assert ("EnvPool" in rows) != absent
