"""Scenes from MJCF, MuJoCo's model format: ``manyworlds.mjcf.load("pile.xml")``.

MuJoCo's library compiles the model; ``pip install "manyworlds-sim[mjcf]"`` installs it. Robots with
hinges, slides, ball and free joints, actuators and fixed tendons become scenes for
the solver ``newton``. Models with free joints only use the default solver. An element that changes the
motion and is not supported raises an error that names it (docs/robots.md).

A model is read into memory and checked before MuJoCo reads it. It may read files only from its own
folder and from ``roots``, within ``limits``. An error names the exceeded limit:
``mw.mjcf.load("crowd.xml", limits={"copies": 50_000})`` allows more. ``limits()`` returns all of
them.

Load untrusted models in a separate process that can be killed. Even within the limits, MuJoCo's
compiler may take minutes.
"""

from __future__ import annotations

import ctypes
import importlib.util
import operator
import sys
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import files
from ._distribution import install_command, needs
from .files import File
from .scene import Scene

if TYPE_CHECKING:
    from ._mjcf import MjcfError

__all__ = ["MjcfError", "MjcfWarning", "limits", "load", "load_string"]


class MjcfWarning(UserWarning):
    """An element of the file that behaves differently than in MuJoCo."""


# Tested versions of mujoco-core, whose C structs have the same layout
# (tools/scripts/check_mujoco_versions). pyproject.toml and src/mjcf/mjcf.cpp have the same list.
_TESTED = ("4.0.0", "4.0.1")


def _library() -> Path:
    """The libmujoco of the installed package mujoco-core. ImportError if none is supported."""
    if sys.version_info < (3, 11):
        raise ImportError("manyworlds.mjcf needs Python 3.11 or later, as mujoco-core does")
    with needs("mujoco", extra="mjcf", what="manyworlds.mjcf"):
        spec = importlib.util.find_spec("mujoco")
        if spec is None:
            raise ModuleNotFoundError("No module named 'mujoco'", name="mujoco")
    folders = [Path(folder) for folder in spec.submodule_search_locations or []]
    found = {
        library.name.removeprefix("libmujoco.so."): library
        for folder in folders
        for library in folder.glob("libmujoco.so.*")
    }
    if len(found) == 1 and found.keys() <= set(_TESTED):
        return next(iter(found.values()))
    where = ", ".join(str(folder) for folder in folders)
    if len(found) > 1:  # each of the packages has overwritten files of the other
        remedy = f"pip uninstall mujoco mujoco-core, then {install_command('mjcf')}"
    else:
        remedy = install_command("mjcf")
    raise ImportError(
        f"manyworlds.mjcf found MuJoCo {' and '.join(sorted(found)) or 'without its library'} in {where}; "
        f"expected one of {', '.join(_TESTED)}; fix it with: {remedy}"
    )


def _extension() -> Any:
    """The extension module. It is not linked with libmujoco, whose file name has a version.

    It uses the functions of the installed library, which is loaded first for the whole process.
    """
    if importlib.util.find_spec("manyworlds._mjcf") is None:
        raise ImportError(
            "manyworlds.mjcf needs a build with MuJoCo's headers "
            "(tools/run --all --setup-only, then pip install .)"
        )
    ctypes.CDLL(str(_library()), mode=ctypes.RTLD_GLOBAL)
    from . import _mjcf

    return _mjcf


def load(file: File, *, roots: Sequence[File] = (), limits: Mapping[str, int] | None = None) -> Scene:
    """The scene of an MJCF file, with masses and inertias from MuJoCo's compiler.

    Bodies have MuJoCo's order. Each static body with geoms becomes a fixed body. ``roots``: other
    folders from which the file may include files and read meshes. ``limits`` replaces entries of
    ``limits()``.

    Emits MjcfWarning for differences from MuJoCo. Raises MjcfError, a ValueError, with one line for
    each error or unsupported element, and ImportError without MuJoCo.
    """
    found = _extension().load(files.path(file, "file"), _paths(roots), _limits(limits))
    return _with_warnings(found)


def load_string(
    xml: str, *, roots: Sequence[File] = (), limits: Mapping[str, int] | None = None
) -> Scene:
    """The scene of an MJCF text. Its files are read from the first of ``roots``."""
    return _with_warnings(_extension().load_string(xml, _paths(roots), _limits(limits)))


def limits() -> dict[str, int]:
    """The default limits of a model.

    Sizes: ``file_bytes`` of each file, ``total_bytes`` of all files. Counts: opened ``files``,
    ``depth`` of nesting, ``elements``, ``copies`` by replicate, attach and similar elements,
    ``samples`` of a height field, ``vertices`` of a mesh.
    """
    return _extension().limits()


def _paths(roots: Sequence[File]) -> list[Path]:
    if isinstance(roots, (str, bytes)):
        raise TypeError(f"roots must be a list of folders, is {roots!r}")
    return [Path(files.path(root, "roots")) for root in roots]


def _limits(limits: Mapping[str, int] | None) -> dict[str, int]:
    return {str(name): operator.index(value) for name, value in (limits or {}).items()}


def _with_warnings(result: tuple[Scene, list[str]]) -> Scene:
    scene, differences = result
    for difference in differences:
        warnings.warn(difference, MjcfWarning, stacklevel=3)
    return scene


def __getattr__(name: str) -> Any:
    if name == "MjcfError":  # which is the extension's
        return _extension().MjcfError
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
