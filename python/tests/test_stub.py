"""The type stubs of the extensions, kept in git, are what nanobind makes of them today.

Written anew by:
    python -m nanobind.stubgen -m manyworlds._core -p python/stub_patterns.txt -o python/manyworlds/_core.pyi
That of _mjcf by what the test says, since it needs manyworlds.mjcf to load MuJoCo first.
"""

import importlib.util
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

import manyworlds

PACKAGE = Path(manyworlds.__file__).parent
PATTERNS = Path(__file__).parents[1] / "stub_patterns.txt"


@pytest.mark.parametrize("name", ["_core", "_live", "_record", "_mjcf"])
def test_the_stub_is_up_to_date(tmp_path, name):
    nanobind = pytest.importorskip("nanobind")
    if nanobind.__version__ != "3.1.0":
        pytest.skip(f"the stub is that of nanobind 3.1.0, this is {nanobind.__version__}")
    module = f"manyworlds.{name}"
    if importlib.util.find_spec(module) is None:
        pytest.skip(f"built without {module}")
    stub, out = PACKAGE / f"{name}.pyi", tmp_path / f"{name}.pyi"
    run = [sys.executable, "-m", "nanobind.stubgen"]
    if name == "_mjcf":
        run[1:] = ["-c", "import sys, manyworlds.mjcf as m; m.limits(); "
                   "from nanobind.stubgen import main; main(sys.argv[1:])"]  # fmt: skip
    run += ["-q", "-m", module, "-p", str(PATTERNS), "-o", str(out)]
    subprocess.run(run, check=True)
    assert stub.read_text() == out.read_text(), f"write it anew: {shlex.join(run[1:-1])} {stub}"


def test_the_names_are_those_of_the_library():
    spec = importlib.util.spec_from_file_location("write_names", PATTERNS.parent / "write_names.py")
    write_names = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(write_names)
    write_names.enumerations = manyworlds.enumerations
    text = (PACKAGE / "names.py").read_text()
    assert text == write_names.written(text), "write it anew: python python/write_names.py"
    fields = manyworlds.Batch("stack10").fields
    known = manyworlds.enumerations()
    assert list(fields) == [*known["Field"], *known["Parameter"], *known["Observed"]]


def test_the_package_is_typed():
    assert (PACKAGE / "py.typed").exists()
