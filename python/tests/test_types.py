"""Type checkers have nothing to say of the Python in README.md, docs, examples: mypy --strict, pyright.

What they say within the package is left out, as it is for who has installed it.
"""

import importlib.util
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import manyworlds

ROOT = Path(__file__).parents[2]
PACKAGE = Path(manyworlds.__file__).parent

# What an example takes for granted.
GIVEN = {
    "docs/python.md": """
import numpy as np
from typing import Any
from numpy.typing import NDArray
actions: NDArray[Any] = np.zeros((4096, 1))
plans: NDArray[Any] = np.zeros((20, 4096, 1))
mask: NDArray[np.bool_] = np.zeros(4096, np.bool_)
p: NDArray[Any] = np.zeros(3)
where: NDArray[Any] = np.zeros(3)
""",
}
# What has no types of its own, or is not installed everywhere: examples are checked as to ours.
UNTYPED = "h5py,cma,optax.*"

# Types are what they should be, and not Any: `type: ignore` that nothing needs is an error, too.
OWN = """
from typing import Any
import numpy as np
from numpy.typing import NDArray
import manyworlds as mw
from manyworlds import tasks

t = tasks.load("CartPole").terms
a: mw.Expression = 1 + t.angle("pole") * 2 - abs(-t.age()) / 3 ** 2
b: mw.Expression = (a < 1) & (2 >= a) | ~(a == 3) & (a != t.lost())
c: mw.Expression = tasks.where(b, 1, np.float64(0)) * np.float64(2) + True
wrong: str = a + 1  # type: ignore[assignment]
also_wrong: bool = a == 1  # type: ignore[assignment]
a + "x"  # type: ignore[operator]
batch = mw.Batch("stack10", worlds=2)
x: NDArray[Any] = batch.get("position", ids=[1], out=bytearray(120))
batch.set("linear_velocity", 0, ids=1)
for name in batch.fields:
    y: NDArray[Any] = batch.get(name)
batch.get("positon")  # type: ignore[arg-type]
batch.set("kinetic_energy", 0)  # type: ignore[arg-type]
batch.view("friction")  # type: ignore[arg-type]
batch.rollout(steps=1, fields=["positions"])  # type: ignore[list-item]
mw.Batch("stack10", observe=["motions"])  # type: ignore[list-item]
mw.Batch("stack10", isa="avx1024")  # type: ignore[arg-type]
mw.SolverOptions(method="tgs")  # type: ignore[arg-type]
t.observed("joint_forces", 0)  # type: ignore[arg-type]
batch.reset(seed=3)
batch.reset(redraw=True)
n: int = batch.step_to(1.0)
not_a_str: str = batch.step_to(1.0)  # type: ignore[assignment]
s: mw.Scene = mw.scenes.load("ragdoll")
not_a_scene: int = mw.scenes.load("ragdoll")  # type: ignore[assignment]
data: bytes = batch.save().bytes()
version: str = mw.__version__
"""


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """The examples of each file as one file of Python."""
    folder = tmp_path_factory.mktemp("types")
    (folder / "own.py").write_text(OWN)
    for path in (ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))):
        name = str(path.relative_to(ROOT))
        examples = re.findall(r"```python\n(.*?)```", path.read_text(), re.S)
        if examples:
            text = "\n".join([GIVEN.get(name, ""), *examples])
            (folder / (path.stem.lower() + "_md.py")).write_text(text)
    assert len(list(folder.glob("*_md.py"))) >= 4
    (folder / "examples").mkdir()
    for path in sorted((ROOT / "examples" / "python").glob("*.py")):
        shutil.copy(path, folder / "examples")
    assert len(list((folder / "examples").glob("*.py"))) >= 7
    return folder


def test_mypy(files):
    pytest.importorskip("mypy")
    (files / "mypy.ini").write_text(
        "[mypy]\nstrict = True\nfollow_imports = silent\n"
        f"mypy_path = {PACKAGE.parent}\n[mypy-{UNTYPED}]\nignore_missing_imports = True\n"
        # nanobind writes dict, tuple and NDArray without what is in them.
        "[mypy-manyworlds._core,manyworlds._mjcf,manyworlds._record]\ndisable_error_code = type-arg\n"
        # What others import and no example looks at takes half of the time.
        "[mypy-matplotlib.*,PIL.*,torch.*]\nfollow_imports = skip\n"
        "[mypy-jax.*,ray.*]\nfollow_imports = skip\nignore_missing_imports = True\n"
    )
    run = [sys.executable, "-m", "mypy", "--cache-dir", str(files / "cache"), "."]
    found = subprocess.run(run, cwd=files, capture_output=True, text=True)
    assert found.returncode == 0, found.stdout + found.stderr


def test_pyright(files):
    """Basedpyright is pyright with node in its wheel, so that nothing else needs to be installed."""
    if importlib.util.find_spec("basedpyright") is None:
        pytest.skip("basedpyright is not installed")
    config = {
        "typeCheckingMode": "standard",
        "extraPaths": [str(PACKAGE.parent)],
        "useLibraryCodeForTypes": False,  # no guesses of what h5py's functions return
        "enableTypeIgnoreComments": True,
        "reportUnnecessaryTypeIgnoreComment": True,
        # Examples may want what is not installed.
        "executionEnvironments": [
            {
                "root": "examples",
                "reportMissingImports": False,
                "extraPaths": [str(PACKAGE.parent)],
            },
            {"root": "."},
        ],
    }
    (files / "pyrightconfig.json").write_text(json.dumps(config))
    run = [sys.executable, "-m", "basedpyright", "--pythonpath", sys.executable, "--outputjson"]
    found = subprocess.run(run, cwd=files, capture_output=True, text=True)
    report = json.loads(found.stdout)
    errors = [
        f"{Path(d['file']).name}:{d['range']['start']['line'] + 1}: {d['message']}"
        for d in report["generalDiagnostics"]
    ]
    assert not errors, "\n".join(errors)
    assert report["summary"]["filesAnalyzed"] >= 12
