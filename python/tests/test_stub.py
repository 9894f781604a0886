"""The type stub of the extension, kept in git, is what nanobind makes of it today.

Written anew by:  python -m nanobind.stubgen -m manyworlds._core -o python/manyworlds/_core.pyi
"""

import subprocess
import sys
from pathlib import Path

import pytest

import manyworlds

STUB = Path(manyworlds.__file__).with_name("_core.pyi")


def test_the_stub_is_up_to_date(tmp_path):
    nanobind = pytest.importorskip("nanobind")
    if nanobind.__version__ != "3.1.0":
        pytest.skip(f"the stub is that of nanobind 3.1.0, this is {nanobind.__version__}")
    out = tmp_path / "_core.pyi"
    run = [sys.executable, "-m", "nanobind.stubgen", "-q", "-m", "manyworlds._core", "-o", str(out)]
    subprocess.run(run, check=True)
    assert STUB.read_text() == out.read_text(), f"write it anew: {' '.join(run[1:-1])} {STUB}"


def test_the_package_is_typed():
    assert STUB.with_name("py.typed").exists()
