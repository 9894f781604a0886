"""Writes the names of the library's enumerations and fields into python/manyworlds/names.py.

    PYTHONPATH=build/dev/python python python/write_names.py

They are the tables of the extension, ``manyworlds.enumerations()``. python/tests/test_stub.py checks
that the file has them.
"""

import importlib.util
import sys
import textwrap
from pathlib import Path

FILE = Path(__file__).parent / "manyworlds" / "names.py"
BEGIN, END = "# Written by python/write_names.py.\n", "# End of what it writes.\n"


def enumerations() -> dict[str, tuple[str, ...]]:
    """Those of the extension, without the package: it cannot be imported while a name is missing."""
    core = next(so for path in sys.path for so in Path(path).glob("manyworlds/_core.*.so"))
    spec = importlib.util.spec_from_file_location("_core", core)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.names()


def literals() -> str:
    """The Literal of each enumeration but Status, whose values are bits."""
    out = ""
    for kind, names in enumerations().items():
        if kind == "Status":
            continue
        listed = ", ".join(f'"{name}"' for name in names)
        line = f"{kind} = Literal[{listed}]\n"
        if len(line) > 100:
            rows = textwrap.wrap(listed + ",", 94, break_on_hyphens=False)
            line = f"{kind} = Literal[\n" + "".join(f"    {row}\n" for row in rows) + "]\n"
        out += line
    return out


def written(text: str) -> str:
    """The text of names.py with the names as they are today."""
    head, rest = text.split(BEGIN)
    return head + BEGIN + literals() + END + rest.split(END)[1]


if __name__ == "__main__":
    FILE.write_text(written(FILE.read_text()))
