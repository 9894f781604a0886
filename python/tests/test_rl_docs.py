"""The examples of docs/rl.md run."""

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
