"""Every public class, function, method and property says what it is."""

import ast
from pathlib import Path

import pytest

import manyworlds
from manyworlds import _core

PACKAGE = Path(manyworlds.__file__).parent
FILES = sorted(p.relative_to(PACKAGE) for p in PACKAGE.rglob("*.py"))


def undocumented(node, name):
    """Public definitions within a module or a class that have no docstring."""
    for child in ast.iter_child_nodes(node):
        if not isinstance(child, (ast.ClassDef, ast.FunctionDef)) or child.name.startswith("_"):
            continue
        if any(ast.unparse(d) == "overload" for d in child.decorator_list):
            continue  # what it overloads has one
        if not (ast.get_docstring(child) or "").strip():
            yield f"{name}.{child.name}"
        if isinstance(child, ast.ClassDef):
            yield from undocumented(child, f"{name}.{child.name}")


@pytest.mark.parametrize("file", FILES, ids=str)
def test_the_package(file):
    tree = ast.parse((PACKAGE / file).read_text())
    assert (ast.get_docstring(tree) or "").strip(), f"{file} has none itself"
    assert not list(undocumented(tree, str(file)))


def test_what_is_compiled():
    missing = []
    for kind in (_core.Plan, _core.Snapshot, _core.SnapshotError, _core.Expression):
        members = [(n, m) for n, m in vars(kind).items() if not n.startswith("_")]
        for name, value in [("", kind), *members]:
            if not (getattr(value, "__doc__", None) or "").strip():
                missing.append(f"{kind.__name__}.{name}")
    assert not missing
