"""Tasks: actions, observations, rewards and ends of episodes in a scene, as expressions.

    from manyworlds import Task, tasks
    task = Task(name="Balance", scene=scene, choices=2, max_steps=500)
    t = task.terms                        # names of this scene's bodies, joints, controls
    task.controls = [tasks.where(t.action(), 10, -10)]
    task.observe("lean", t.angle("pole"))
    task.reward("alive", 1)
    task.terminated = abs(t.angle("pole")) > 0.2

All worlds evaluate expressions after every step, in the precision of the environment. True is 1;
every value except 0 counts as true. ``&``, ``|``, ``~`` are and, or, not.
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
    """Sine of an angle in rad, up to 1e5 rad."""
    return _x.sin(a)


def cos(a: Value) -> Expression:
    """Cosine of an angle in rad, up to 1e5 rad."""
    return _x.cos(a)


def exp(a: Value) -> Expression:
    """e to the power of ``a``."""
    return _x.exp(a)


def log(a: Value) -> Expression:
    """Natural logarithm: minus infinity at 0, NaN below."""
    return _x.log(a)


def tanh(a: Value) -> Expression:
    """Hyperbolic tangent."""
    return _x.tanh(a)


def arccos(a: Value) -> Expression:
    """Arc cosine, rad, 0 to pi; NaN outside -1 to 1."""
    return _x.arccos(a)


def sign(a: Value) -> Expression:
    """-1, 0 or 1."""
    return _x.sign(a)


def mod(a: Value, b: Value) -> Expression:
    """``a % b``: the remainder, with the sign of ``b``."""
    return _x.mod(a, b)


def power(a: Value, b: Value) -> Expression:
    """``a ** b``, to 2 + |b ln a| units in the last place; for negative ``a``, ``b`` must be whole.

    If ``b`` is a whole number up to 64, products are used and are more accurate: ``a ** 3``.
    """
    return Expression(a) ** b


def sqrt(a: Value) -> Expression:
    """Square root; NaN for negative values."""
    return _x.sqrt(a)


def floor(a: Value) -> Expression:
    """The largest whole number that does not exceed ``a``."""
    return _x.floor(a)


def square(a: Value) -> Expression:
    """``a`` times ``a``."""
    return Expression(a) ** 2


def minimum(a: Value, b: Value) -> Expression:
    """The smaller of two values."""
    return _x.minimum(a, b)


def maximum(a: Value, b: Value) -> Expression:
    """The larger of two values."""
    return _x.maximum(a, b)


def clip(a: Value, low: Value, high: Value) -> Expression:
    """``a``, clamped to ``low`` and ``high``."""
    return _x.clip(a, low, high)


def where(condition: Value, yes: Value, no: Value) -> Expression:
    """``yes`` in worlds where the condition is not 0, ``no`` in others."""
    return _x.where(condition, yes, no)


def arctan2(y: Value, x: Value) -> Expression:
    """Angle of the vector (x, y), rad, -pi to pi; 0 for (0, 0)."""
    return _x.arctan2(y, x)


@dataclass(slots=True)
class Action:
    """A component of a continuous action. Values are clamped to its range.

    With ``clamped=False`` the unclamped value is used, in costs too; an infinite value then makes
    the world lost. Controls of the scene always clamp to their own ranges.
    """

    name: str = ""
    low: float = -1.0
    high: float = 1.0
    clamped: bool = True


@dataclass(slots=True, eq=False)
class Observation:
    """An observation. Its range is declared; the value is not clamped."""

    name: str = ""
    value: Value = 0.0
    low: float = -inf
    high: float = inf


@dataclass(slots=True, eq=False)
class Reward:
    """A term of the reward. The reward of a step is the sum of all terms."""

    name: str = ""
    value: Value = 0.0


@dataclass(slots=True, eq=False)
class Info:
    """A diagnostic value, in double precision. The policy does not see it.

    Gymnasium's classes join infos with the names "a[0]", "a[1]" and so on into an array "a".
    """

    name: str = ""
    value: Value = 0.0
    of_steps_alone: bool = False  # not part of the infos at the start of an episode


@dataclass(slots=True, eq=False)
class Level:
    """A value of each world that persists over episodes, such as difficulty or number of successes.

    It is constant within an episode (``Terms.level``). ``begin`` is its value in the first episode
    of a seed. It may contain numbers and random numbers of the episode; NaN counts as 0. ``next``
    is its value in the next episode, computed at the end of the last step of this one; None: no
    change. The value also stays if ``next`` is NaN and if a reset ends the episode.
    """

    name: str = ""
    begin: Value = 0.0
    next: Optional[Value] = None


@dataclass(slots=True, eq=False)
class Memory:
    """A value of each world that lasts for an episode (``Terms.memory``).

    ``begin``: its value at the start of an episode, computed from the state; it cannot contain
    memories. ``next``: at the end of each step, before all other expressions, all memories change
    to their ``next`` simultaneously. In ``next``, memories have their values before the step. None:
    no change.

    Observations, rewards, ends and infos of a step use the updated memories. Controls use the
    values of the previous step.
    """

    name: str = ""
    begin: Value = 0.0
    next: Optional[Value] = None


@dataclass(slots=True, eq=False)
class InitialParameter:
    """The value of a scene parameter at a reset, instead of a drawn one.

    ``parameter``: ``Terms.parameter(...)``, with the variation's draw "none". ``value``: an
    expression of numbers, random numbers of the episode, and levels. It is clamped to the range of
    the variation. If it is NaN, the scene's value is used.
    """

    parameter: Value = 0.0
    value: Value = 0.0


@dataclass(slots=True, kw_only=True, eq=False)
class Task:
    """A task in a scene: actions, observations, rewards and ends of episodes."""

    name: str = ""
    scene: Scene = field(default_factory=Scene)
    frame_skip: int = 1  # steps of the scene in a step of the task

    choices: int = 0  # discrete tasks: the action is 0 to choices - 1, and `actions` is empty
    actions: list[Action] = field(default_factory=list)
    # Values of the scene's controls. They may contain actions, numbers, random numbers, parameters,
    # levels, memories, age() and previous(...).
    controls: list[Value] = field(default_factory=list)

    observations: list[Observation] = field(default_factory=list)
    rewards: list[Reward] = field(default_factory=list)
    terminated: Value = 0.0  # the episode ends
    truncated: Value = 0.0  # the episode is truncated, as for a lost world
    max_steps: int = 0  # truncation after this number of steps; 0: none
    solved_at: float = inf  # mean return, as information
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
        """Adds a component to the action (``Action``). Returns it as an expression."""
        self.actions.append(Action(name, low, high, clamped))
        return _x.action(len(self.actions) - 1)

    def observe(self, name: str, value: Value, low: float = -inf, high: float = inf) -> None:
        """Adds an observation."""
        self.observations.append(Observation(name, value, low, high))

    def reward(self, name: str, value: Value) -> None:
        """Adds a term of the reward."""
        self.rewards.append(Reward(name, value))

    def tell(
        self, name: str, value: Union[Value, Sequence[Value]], of_steps_alone: bool = False
    ) -> None:
        """Adds an info. Several values become one info each, "name[0]" and so on.

        Gymnasium's classes join these into one array.
        """
        if not isinstance(value, (list, tuple)):
            self.infos.append(Info(name, value, of_steps_alone))  # type: ignore[arg-type]
            return
        for i, one in enumerate(value):
            self.infos.append(Info(f"{name}[{i}]", one, of_steps_alone))

    def level(self, name: str, begin: Value = 0.0, next: Optional[Value] = None) -> Expression:
        """Adds a value that persists over episodes (``Level``). Returns it as an expression.

        ``next`` may use this expression if it is set later: ``task.levels[-1].next = ...``.
        """
        self.levels.append(Level(name, begin, next))
        return _x.level(name)

    def memory(
        self,
        name: str,
        begin: Value = 0.0,
        next: Union[Value, Callable[[Expression], Value], None] = None,
    ) -> Expression:
        """Adds a value that worlds store between steps (``Memory``). Returns it as an expression.

        ``next`` may be a function of this expression: ``task.memory("best", x, lambda best:
        maximum(best, x))``. It may also be set later: ``task.memories[-1].next = ...``.
        """
        own = _x.memory(name)
        if callable(next) and not isinstance(next, Expression):
            next = next(own)
        self.memories.append(Memory(name, begin, next))
        return own

    def initial_parameter(self, parameter: Expression, value: Value) -> None:
        """Sets the value of ``t.parameter(...)`` at resets (``InitialParameter``)."""
        self.initial_parameters.append(InitialParameter(parameter, value))

    def validate(self) -> list[Issue]:
        """All errors of the task and its scene. Empty: the task can run."""
        return [Issue(*issue) for issue in _core.validate_task(self)]


class TaskError(SceneError):
    """A task with errors; ``issues`` lists all of them."""

    def __init__(self, issues: Sequence[Issue]) -> None:
        self.issues = list(issues)
        count = f"{len(self.issues)} issue" + ("" if len(self.issues) == 1 else "s")
        ValueError.__init__(self, "\n  ".join([f"the task has {count}:", *map(str, self.issues)]))

    def __reduce__(self) -> tuple[Any, ...]:
        return TaskError, (self.issues,)


def names() -> list[str]:
    """The names that ``load`` accepts."""
    return [name for name, _ in _core.task_names()]


def summaries() -> dict[str, str]:
    """A line about each task, by name."""
    return dict(_core.task_names())


def load(name: str) -> Task:
    """A new copy of the task with this name. Raises ValueError with the nearest name if unknown."""
    if not isinstance(name, str):
        raise TypeError(f"the task's name is of type {type(name).__name__}; expected a str")
    task: Task = _core.load_task(name)
    return task
