"""Gymnasium's MuJoCo tasks, version 5, simulated by manyworlds: "manyworlds/Ant-v5" and others.

MuJoCo's library (``pip install "manyworlds-sim[gym,mjcf]"``) reads the model files of the installed
Gymnasium package. Arguments, observations, rewards, infos and ends equal Gymnasium's;
docs/gymnasium.md lists the differences.
"""

from __future__ import annotations

import importlib.util
import inspect
from pathlib import Path
from typing import Any, Optional

from .. import _core, files, mjcf
from ..tasks import Task
from .single_env import Env
from .vector_env import VectorEnv

_TASKS: dict[str, tuple[str, dict[str, Any]]] = _core.gymnasium_tasks()


def names() -> list[str]:
    """The names that ``task`` accepts: "Ant-v5", ..."""
    return list(_TASKS)


def arguments(name: str) -> dict[str, Any]:
    """Arguments of ``task`` for this name besides ``xml_file``, with their defaults."""
    return dict(_task(name)[1])


def task(name: str, xml_file: Optional[files.File] = None, **given: Any) -> Task:
    """A Gymnasium task as a Task, which can be changed.

    ``xml_file``: the model. A path that starts with ".", "~" or "/", or the name of a Gymnasium
    file. Other arguments: see ``arguments(name)``. Raises ValueError for an unknown task and an
    unsuitable model, TypeError for unknown arguments, and the errors of ``mjcf.load``.
    """
    model, known = _task(name)
    if unknown := sorted(set(given) - set(known)):
        raise TypeError(f"{name} has no {', '.join(unknown)}; it has xml_file, {', '.join(known)}")
    scene = mjcf.load(model_path(model if xml_file is None else xml_file))
    if isinstance(given.get("main_body"), str):
        moving = [body.name for body in scene.bodies if body.motion == "dynamic"]
        if given["main_body"] not in moving:
            raise ValueError(f"main_body is '{given['main_body']}'; expected one of {moving}")
        given["main_body"] = 1 + moving.index(given["main_body"])
    found: Task = _core.gymnasium_task(name, scene, given)
    return found


def model_path(file: files.File) -> Path:
    """The path of a model, found as in Gymnasium."""
    path = Path(file).expanduser()
    if path.is_absolute() or str(file).startswith("."):
        return path
    found = importlib.util.find_spec("gymnasium")
    assert found is not None and found.submodule_search_locations
    return Path(found.submodule_search_locations[0]) / "envs" / "mujoco" / "assets" / path


def _task(name: str) -> tuple[str, dict[str, Any]]:
    if name not in _TASKS:
        raise ValueError(f"there is no task '{name}'; expected one of {', '.join(_TASKS)}")
    return _TASKS[name]


def _split(kind: type, given: dict[str, Any]) -> tuple[dict[str, Any], dict[str, Any]]:
    """Splits arguments into those of the environment and those of the task."""
    own = inspect.signature(kind.__init__).parameters  # type: ignore[misc]
    return (
        {key: value for key, value in given.items() if key in own},
        {key: value for key, value in given.items() if key not in own},
    )


def make_vector_env(mujoco_task: str, num_envs: int = 1, **given: Any) -> VectorEnv:
    """Entry point of ``gymnasium.make_vec``: arguments of ``VectorEnv`` and of the task."""
    own, of_task = _split(VectorEnv, given)
    return VectorEnv(task(mujoco_task, **of_task), num_envs, **own)


def make_env(mujoco_task: str, **given: Any) -> Env:
    """Entry point of ``gymnasium.make``, whose TimeLimit ends the episodes."""
    own, of_task = _split(Env, given)
    return Env(task(mujoco_task, **of_task), **{"max_episode_steps": 0, **own})
