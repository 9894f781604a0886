"""Pickles and deep copies of scenes, tasks, plans and results, for spawned processes and
checkpoints.

A pickle contains the version and format that wrote it. Unreadable or modified pickles raise
``pickle.UnpicklingError``. Reading a pickle may run any code: read only pickles from trusted
sources. Objects that own worlds in memory cannot be pickled (in_memory.py).
"""

from __future__ import annotations

import copyreg
import dataclasses
from collections.abc import Callable
from pickle import UnpicklingError
from typing import Any, NamedTuple

from . import _core, bodies, environment, fields, joints, options, plan, scene, shapes, tasks

FORMAT = 1  # of the contents; changes when this module can no longer read older ones

Members = dict[str, Any]
Reduced = tuple[Callable[..., Any], tuple[Any, ...]]


def _check(name: Any, form: Any, version: Any) -> None:
    if form != FORMAT:
        raise UnpicklingError(
            f"the pickle of a {name} is of manyworlds {version}, in format {form}; this is "
            f"{_core.__version__}, which reads format {FORMAT}"
        )


# -- dataclasses: their members by name

_VALUES: dict[str, type] = {}


def register(*kinds: type) -> None:
    """Registers dataclasses for the pickles and copies of this module, without subclasses."""
    for kind in kinds:
        _VALUES[kind.__name__] = kind
        copyreg.pickle(kind, _reduce_value)


def _members(value: Any) -> Members:
    return {f.name: getattr(value, f.name) for f in dataclasses.fields(value)}


def _reduce_value(value: Any) -> Reduced:
    return restore_value, (FORMAT, _core.__version__, type(value).__name__, _members(value))


def restore_value(form: int, version: str, name: str, members: Members) -> Any:
    """A dataclass of the package. Members that the pickle does not have get their defaults."""
    _check(name, form, version)
    if not isinstance(name, str) or name not in _VALUES:
        raise UnpicklingError(
            f"a pickle of manyworlds {version} has a {name}, which does not exist in this version"
        )
    if not isinstance(members, dict):
        found = type(members).__name__
        raise UnpicklingError(f"the pickle of a {name} is damaged: its members are of type {found}")
    kind = _VALUES[name]
    known = {f.name for f in dataclasses.fields(kind)}
    if unknown := sorted(map(str, set(members) - known)):
        raise UnpicklingError(
            f"the pickle of a {name}, of manyworlds {version}, has {', '.join(unknown)}, which a "
            f"{name} of {_core.__version__} does not have"
        )
    try:
        return kind(**members)
    except TypeError as error:  # a member without a default
        raise UnpicklingError(f"the pickle of a {name} is incomplete: {error}") from None


# -- expressions as a graph; one per task, which preserves shared subexpressions


class Root(NamedTuple):
    """Reference from a pickled task to an expression: the index of its graph."""

    index: int


def _reduce_expression(value: _core.Expression) -> Reduced:
    return restore_expression, (FORMAT, _core.__version__, *_core.expression_graph([value]))


def restore_expression(form: int, version: str, nodes: Any, roots: Any) -> _core.Expression:
    """An Expression."""
    _check("Expression", form, version)
    found = _expressions(nodes, roots)
    if len(found) != 1:
        raise UnpicklingError(f"the pickle of an Expression is damaged: it has {len(found)} roots")
    return found[0]


def _expressions(nodes: Any, roots: Any) -> list[_core.Expression]:
    try:
        return _core.expressions_of_graph(nodes, roots)
    except (TypeError, ValueError) as error:
        raise UnpicklingError(f"the pickle of an Expression is damaged: {error}") from None


_HOLD_EXPRESSIONS: dict[type, tuple[str, ...]] = {
    tasks.Observation: ("value",),
    tasks.Reward: ("value",),
    tasks.Info: ("value",),
    tasks.Level: ("begin", "next"),
    tasks.Memory: ("begin", "next"),
    tasks.InitialParameter: ("parameter", "value"),
}


def _exchanged(members: Members, exchange: Callable[[Any], Any]) -> Members:
    """The members of a task, with expressions replaced by other values."""

    def part(one: Any) -> Any:
        for kind, names in _HOLD_EXPRESSIONS.items():
            if isinstance(one, kind):
                return dataclasses.replace(one, **{n: exchange(getattr(one, n)) for n in names})
        return one

    return members | {
        "controls": [exchange(value) for value in members["controls"]],
        "observations": [part(one) for one in members["observations"]],
        "rewards": [part(one) for one in members["rewards"]],
        "infos": [part(one) for one in members.get("infos", [])],
        "levels": [part(one) for one in members.get("levels", [])],
        "memories": [part(one) for one in members.get("memories", [])],
        "initial_parameters": [part(one) for one in members.get("initial_parameters", [])],
        "terminated": exchange(members["terminated"]),
        "truncated": exchange(members["truncated"]),
    }


def _reduce_task(task: tasks.Task) -> Reduced:
    found: list[_core.Expression] = []

    def exchange(value: Any) -> Any:
        if not isinstance(value, _core.Expression):
            return value
        found.append(value)
        return Root(len(found) - 1)

    members = _exchanged(_members(task), exchange)
    return restore_task, (FORMAT, _core.__version__, members, *_core.expression_graph(found))


def restore_task(form: int, version: str, members: Members, nodes: Any, roots: Any) -> tasks.Task:
    """A Task."""
    _check("Task", form, version)
    found = _expressions(nodes, roots)

    def exchange(value: Any) -> Any:
        return found[value.index] if isinstance(value, Root) else value

    try:
        task: tasks.Task = restore_value(form, version, "Task", _exchanged(members, exchange))
    except (LookupError, TypeError) as error:
        raise UnpicklingError(f"the pickle of a Task is damaged: {error}") from None
    return task


# -- plans: compiled again


def _reduce_plan(value: plan.Plan) -> Reduced:
    state = value.scene, value.broad_phase, value.keep, value.fingerprint
    return restore_plan, (FORMAT, _core.__version__, *state)


def restore_plan(
    form: int, version: str, scene: scene.Scene, broad_phase: Any, keep: Any, fingerprint: int
) -> plan.Plan:
    """A Plan. Worlds of the pickled one continue in its worlds."""
    _check("Plan", form, version)
    found = plan.Plan(scene, broad_phase=broad_phase, keep=keep)
    if found.fingerprint != fingerprint:
        raise UnpicklingError(
            f"manyworlds {version} made another plan of this scene (fingerprint {fingerprint:016x}) "
            f"than {_core.__version__} does ({found.fingerprint:016x}): pickle the Scene instead"
        )
    return found


for module in (shapes, bodies, joints, options, scene, tasks, fields, environment):
    register(
        *(
            kind
            for kind in vars(module).values()
            if isinstance(kind, type) and dataclasses.is_dataclass(kind)
        )
    )
copyreg.pickle(_core.Expression, _reduce_expression)
copyreg.pickle(tasks.Task, _reduce_task)
copyreg.pickle(plan.Plan, _reduce_plan)
