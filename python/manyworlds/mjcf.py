"""Scenes from MJCF, MuJoCo's model format: ``manyworlds.mjcf.load("pile.xml")``.

MuJoCo's own library reads the file; ``pip install "manyworlds[mjcf]"`` brings it. What is read: free
bodies and static geoms of spheres, capsules, cylinders, boxes, meshes (their convex hulls), planes and
height fields, and the equality constraints connect and weld. Whatever else would change the motion,
such as hinges and slides, is an error that names it.
"""

from __future__ import annotations

import ctypes
import importlib.util
import warnings
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import files
from .files import File
from .scene import Scene

if TYPE_CHECKING:
    from ._mjcf import MjcfError

__all__ = ["MjcfError", "MjcfWarning", "load", "load_string"]


class MjcfWarning(UserWarning):
    """Something of the file that acts otherwise than it does in MuJoCo."""


def _extension() -> Any:
    """The extension module, with the libmujoco that the package mujoco has, if it is installed."""
    found = importlib.util.find_spec("mujoco")
    for folder in (found.submodule_search_locations or []) if found else []:
        for library in sorted(Path(folder).glob("libmujoco.so.*")):
            ctypes.CDLL(str(library))  # from now on the loader knows it by its name
    try:
        from . import _mjcf
    except ImportError as error:
        if "libmujoco" in str(error):
            wanted = 'the MuJoCo that it was built with; pip install "manyworlds[mjcf]"'
        else:
            wanted = "a build with MuJoCo's headers (tools/run --setup-only, then pip install .)"
        raise ImportError(f"manyworlds.mjcf needs {wanted}: {error}") from error
    return _mjcf


def load(file: File) -> Scene:
    """The scene of an MJCF file, with the masses and inertias that MuJoCo's compiler gives it.

    Bodies come in MuJoCo's order; a fixed one for each static body that has geoms. Warns
    (MjcfWarning) of what acts otherwise than in MuJoCo. Raises MjcfError, a ValueError, with one line
    for each thing that is wrong or not simulated, and ImportError without MuJoCo.
    """
    return _with_warnings(_extension().load(files.path(file, "file")))


def load_string(xml: str) -> Scene:
    """The scene of an MJCF text; its assets are looked up in the working directory."""
    return _with_warnings(_extension().load_string(xml))


def _with_warnings(result: tuple[Scene, list[str]]) -> Scene:
    scene, differences = result
    for difference in differences:
        warnings.warn(difference, MjcfWarning, stacklevel=3)
    return scene


def __getattr__(name: str) -> Any:
    if name == "MjcfError":  # which is the extension's
        return _extension().MjcfError
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
