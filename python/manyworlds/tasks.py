"""Tasks: what a policy has to do in a scene, as values; and what their expressions are made of.

    from manyworlds import Task, tasks
    task = Task(name="Balance", scene=scene, choices=2, max_steps=500)
    t = task.terms                        # names of this scene's bodies, joints, controls
    task.controls = [tasks.where(t.action(), 10, -10)]
    task.observe("lean", t.angle("pole"))
    task.reward("alive", 1)
    task.terminated = abs(t.angle("pole")) > 0.2

Expressions are worked out after every step in all worlds at once, in the precision of the
environment. Truth is 1, and what is not 0; ``&``, ``|``, ``~`` are and, or, not.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import inf
from typing import Any, Optional, Union

from . import _core, shown
from ._core import Expression
from ._core import expressions as _x
from .over_steps import delayed as delayed
from .over_steps import held as held
from .over_steps import largest as largest
from .over_steps import latched as latched
from .over_steps import phase as phase
from .over_steps import previous as previous
from .over_steps import smoothed as smoothed
from .over_steps import summed as summed
from .scene import Issue, Point, Ray, Scene, SceneError
from .terms import Terms as Terms

Value = Union[Expression, float]  # numbers are expressions


def sin(a: Value) -> Expression:
    """Sine of rad, of up to 1e5 rad."""
    return _x.sin(a)


def cos(a: Value) -> Expression:
    """Cosine of rad, of up to 1e5 rad."""
    return _x.cos(a)


def exp(a: Value) -> Expression:
    """e to the power of ``a``."""
    return _x.exp(a)


def log(a: Value) -> Expression:
    """Natural logarithm: minus infinity of 0, not a number below."""
    return _x.log(a)


def tanh(a: Value) -> Expression:
    """Hyperbolic tangent."""
    return _x.tanh(a)


def arccos(a: Value) -> Expression:
    """rad, 0 to pi; not a number beyond -1 to 1."""
    return _x.arccos(a)


def sign(a: Value) -> Expression:
    """-1, 0 or 1."""
    return _x.sign(a)


def mod(a: Value, b: Value) -> Expression:
    """``a % b``: what is left beside whole multiples of ``b``, with the sign of ``b``."""
    return _x.mod(a, b)


def power(a: Value, b: Value) -> Expression:
    """``a ** b``, to 2 + |b ln a| units in the last place; of ``a`` below 0 where ``b`` is whole.

    Of a number, whole powers up to 64 are exacter: ``a ** 3`` is a product.
    """
    return Expression(a) ** b


def sqrt(a: Value) -> Expression:
    """Square root; of what is below 0 not a number."""
    return _x.sqrt(a)


def floor(a: Value) -> Expression:
    """The next whole number below."""
    return _x.floor(a)


def square(a: Value) -> Expression:
    """``a`` times ``a``."""
    return Expression(a) ** 2


def minimum(a: Value, b: Value) -> Expression:
    """The smaller of two."""
    return _x.minimum(a, b)


def maximum(a: Value, b: Value) -> Expression:
    """The larger of two."""
    return _x.maximum(a, b)


def clip(a: Value, low: Value, high: Value) -> Expression:
    """``a``, at least ``low`` and at most ``high``."""
    return _x.clip(a, low, high)


def where(condition: Value, yes: Value, no: Value) -> Expression:
    """``yes`` in worlds where the condition is not 0, ``no`` in others."""
    return _x.where(condition, yes, no)


def arctan2(y: Value, x: Value) -> Expression:
    """rad, -pi to pi; 0 for (0, 0)."""
    return _x.arctan2(y, x)


@dataclass(slots=True)
class Action:
    """One number of a continuous action. Beyond its range it counts as the end of the range.

    Where it is not ``clamped`` it counts as given, in costs too; an infinite one then loses the world.
    Controls of the scene are kept within their own ranges either way.
    """

    name: str = ""
    low: float = -1.0
    high: float = 1.0
    clamped: bool = True


@dataclass(slots=True, eq=False)
class Observation:
    """An observation; its range is declared, the value is not clamped."""

    name: str = ""
    value: Value = 0.0
    low: float = -inf
    high: float = inf


@dataclass(slots=True, eq=False)
class Reward:
    """A part of the reward of a step; a task's reward is their sum."""

    name: str = ""
    value: Value = 0.0


@dataclass(slots=True, eq=False)
class Info:
    """What people are told beside, in double; of no account to the policy.

    Those named "a[0]", "a[1]" and so on are the array "a" in the infos of Gymnasium's classes.
    """

    name: str = ""
    value: Value = 0.0
    of_steps_alone: bool = False  # not told where an episode begins


@dataclass(slots=True, eq=False)
class Level:
    """A number that every world keeps over its episodes: how hard its task is, how often it succeeded.

    It is the same through a whole episode (``Terms.level``). ``begin`` is its value in the first episode of a
    seed, of numbers and random ones of the episode; 0 where that is not a number. ``next`` is its value in the
    episode after this one, worked out at the end of the step that ends this one; None: it stays. It also
    stays where that is not a number, and where a reset ends the episode.
    """

    name: str = ""
    begin: Value = 0.0
    next: Optional[Value] = None


@dataclass(slots=True, eq=False)
class Memory:
    """A number of every world that lasts for an episode (``Terms.memory``).

    ``begin``: its value where an episode begins, computed from the state there; of anything but memories.
    ``next``: at the end of each step of the task, before anything else is computed, all memories become their
    ``next`` at once: in ``next``, memories are what they were before the step. None: it stays. So
    observations, rewards, ends and infos of a step see memories after their update; controls see them as
    the last step left them.
    """

    name: str = ""
    begin: Value = 0.0
    next: Optional[Value] = None


@dataclass(slots=True, eq=False)
class InitialParameter:
    """What a number of the scene is where an episode begins by a reset, instead of one that is drawn.

    ``parameter``: ``Terms.parameter(...)``, which varies with the draw "none". ``value``: of numbers, random
    ones of the episode, and levels; kept within the range that the variation declares. Where it is not a
    number, the scene's own number counts.
    """

    parameter: Value = 0.0
    value: Value = 0.0


@dataclass(slots=True, kw_only=True, eq=False)
class Task:
    """What a policy has to do in a scene: actions, observations, rewards, and when it ends."""

    name: str = ""
    scene: Scene = field(default_factory=Scene)
    frame_skip: int = 1  # steps of the scene in a step of the task

    choices: int = 0  # discrete tasks: the action is 0 to choices - 1, and `actions` is empty
    actions: list[Action] = field(default_factory=list)
    # What each control of the scene is set to: of actions, numbers, random ones, parameters,
    # levels, memories, age() and previous(...).
    controls: list[Value] = field(default_factory=list)

    observations: list[Observation] = field(default_factory=list)
    rewards: list[Reward] = field(default_factory=list)
    terminated: Value = 0.0  # the episode has come to its end
    truncated: Value = 0.0  # it is broken off; so is a world that is lost
    max_steps: int = 0  # broken off after so many; 0: never
    solved_at: float = inf  # mean return; said to people only
    infos: list[Info] = field(default_factory=list)

    levels: list[Level] = field(default_factory=list)
    memories: list[Memory] = field(default_factory=list)
    initial_parameters: list[InitialParameter] = field(default_factory=list)

    rays: list[Ray] = field(default_factory=list)  # for ray_distance
    points: list[Point] = field(default_factory=list)  # for point_position, point_velocity

    def __repr__(self) -> str:
        actions = shown.count(self.actions, "action", "actions")
        return shown.line(
            "Task",
            self.name,
            f"{self.choices} choices" if self.choices else actions,
            shown.count(self.observations, "observation", "observations"),
            shown.count(self.rewards, "reward", "rewards"),
            f"max_steps {self.max_steps}",
        )

    @property
    def terms(self) -> Terms:
        """Terms with the names of this task's scene."""
        return Terms(self.scene)

    def act(
        self, name: str, low: float = -1.0, high: float = 1.0, clamped: bool = True
    ) -> Expression:
        """Adds a number to the action (``Action``), and returns it as an expression."""
        self.actions.append(Action(name, low, high, clamped))
        return _x.action(len(self.actions) - 1)

    def observe(self, name: str, value: Value, low: float = -inf, high: float = inf) -> None:
        """Adds an observation."""
        self.observations.append(Observation(name, value, low, high))

    def reward(self, name: str, value: Value) -> None:
        """Adds a part of the reward."""
        self.rewards.append(Reward(name, value))

    def tell(
        self, name: str, value: Union[Value, Sequence[Value]], of_steps_alone: bool = False
    ) -> None:
        """Adds an info; of several values one each, "name[0]" and so on, of which Gymnasium's classes
        make one array."""
        if not isinstance(value, (list, tuple)):
            self.infos.append(Info(name, value, of_steps_alone))  # type: ignore[arg-type]
            return
        for i, one in enumerate(value):
            self.infos.append(Info(f"{name}[{i}]", one, of_steps_alone))

    def level(self, name: str, begin: Value = 0.0, next: Optional[Value] = None) -> Expression:
        """Adds a number that worlds keep over their episodes (``Level``), and returns it as an expression.

        ``next`` may be said later, of the expression that is returned: ``task.levels[-1].next = ...``.
        """
        self.levels.append(Level(name, begin, next))
        return _x.level(name)

    def memory(
        self,
        name: str,
        begin: Value = 0.0,
        next: Union[Value, Callable[[Expression], Value], None] = None,
    ) -> Expression:
        """Adds a number that worlds remember from step to step (``Memory``), and returns it as an expression.

        ``next`` may be a function of that expression: ``task.memory("best", x, lambda best: maximum(best, x))``.
        It may be said later, too: ``task.memories[-1].next = ...``.
        """
        own = _x.memory(name)
        if callable(next) and not isinstance(next, Expression):
            next = next(own)
        self.memories.append(Memory(name, begin, next))
        return own

    def initial_parameter(self, parameter: Expression, value: Value) -> None:
        """Says what ``t.parameter(...)`` is where episodes begin (``InitialParameter``)."""
        self.initial_parameters.append(InitialParameter(parameter, value))

    def validate(self) -> list[Issue]:
        """Everything that is wrong with the task and its scene; empty: it can be run."""
        return [Issue(*issue) for issue in _core.validate_task(self)]


class TaskError(SceneError):
    """A task that cannot be run; ``issues`` lists everything that is wrong with it."""

    def __init__(self, issues: Sequence[Issue]) -> None:
        self.issues = list(issues)
        count = f"{len(self.issues)} issue" + ("" if len(self.issues) == 1 else "s")
        ValueError.__init__(self, "\n  ".join([f"the task has {count}:", *map(str, self.issues)]))

    def __reduce__(self) -> tuple[Any, ...]:
        return TaskError, (self.issues,)


def names() -> list[str]:
    """The tasks that ``load`` accepts."""
    return [name for name, _ in _core.task_names()]


def summaries() -> dict[str, str]:
    """One line about each task, by its name."""
    return dict(_core.task_names())


def load(name: str) -> Task:
    """The task of that name, to take or to change. Raises ValueError with the nearest name."""
    if not isinstance(name, str):
        raise TypeError(f"the task's name is of type {type(name).__name__}; expected a str")
    task: Task = _core.load_task(name)
    return task
