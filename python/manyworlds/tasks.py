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

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import inf
from typing import Any, Optional, Union

from . import _core, shown
from ._core import Expression
from ._core import expressions as _x
from .ids import BodyId, BodyRef, ControlId, ControlRef, JointId, JointRef, index_of
from .scene import Issue, Point, Ray, Scene, SceneError

Value = Union[Expression, float]  # numbers are expressions
Axis = Union[int, str]  # 0, 1, 2 or "x", "y", "z", of the world


def sin(a: Value) -> Expression:
    """Sine of rad, of up to 1e5 rad."""
    return _x.sin(a)


def cos(a: Value) -> Expression:
    """Cosine of rad, of up to 1e5 rad."""
    return _x.cos(a)


def exp(a: Value) -> Expression:
    """e to the power of ``a``."""
    return _x.exp(a)


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


def previous(value: Value) -> Expression:
    """What ``value`` was at the end of the step before; in the first step where the world began."""
    return _x.previous(value)


def held(condition: Value) -> Expression:
    """Steps in a row, up to this one, at whose end the condition was true."""
    return _x.held(condition)


def largest(value: Value) -> Expression:
    """The largest that ``value`` has been since the episode began."""
    return _x.largest(value)


class Terms:
    """What a world is at the end of a step, as expressions.

    Bodies, joints and controls by handle, index or, of a scene that is given, by name. What does not exist
    raises ValueError here when it is a name, and is an issue of the task when it is an index.
    """

    def __init__(self, scene: Optional[Scene] = None) -> None:
        self._scene = scene

    def _index(self, what: str, key: Any) -> Any:
        kind = {"body": BodyId, "joint": JointId, "control": ControlId}[what]

        def find(name: str) -> int:
            if self._scene is None:
                raise ValueError(f"the {what} '{key}': names are those of a scene, use Terms(scene)")
            return _core.find_in_scene(self._scene, what, name)

        return index_of(key, kind, find, f"the {what}")

    @staticmethod
    def _axis(axis: Axis) -> int:
        if not isinstance(axis, str):
            return axis
        if axis not in ("x", "y", "z"):
            raise ValueError(f"the axis is '{axis}'; expected 'x', 'y', 'z' or 0, 1, 2")
        return "xyz".index(axis)

    def position(self, body: BodyRef, axis: Axis) -> Expression:
        """m, of the body frame."""
        return _x.position(self._index("body", body), self._axis(axis))

    def velocity(self, body: BodyRef, axis: Axis) -> Expression:
        """m/s, of the centre of mass."""
        return _x.velocity(self._index("body", body), self._axis(axis))

    def angular_velocity(self, body: BodyRef, axis: Axis = 2) -> Expression:
        """rad/s; in the plane about axis 2."""
        return _x.angular_velocity(self._index("body", body), self._axis(axis))

    def angle(self, body: BodyRef) -> Expression:
        """rad, -pi to pi, in the plane."""
        return _x.angle(self._index("body", body))

    def direction(self, body: BodyRef, of: Axis, axis: Axis) -> Expression:
        """A component of the body's x, y or z axis."""
        return _x.direction(self._index("body", body), self._axis(of), self._axis(axis))

    def joint_position(self, joint: JointRef, coordinate: int = 0) -> Expression:
        """m or rad, from where the joint began."""
        return _x.observed("joint_position", self._index("joint", joint), coordinate)

    def joint_speed(self, joint: JointRef, coordinate: int = 0) -> Expression:
        """m/s or rad/s."""
        return _x.observed("joint_speed", self._index("joint", joint), coordinate)

    def touching(self, body: BodyRef) -> Expression:
        """1 where a contact acted on the body in the last step; 0 where a world begins."""
        return _x.observed("touching", self._index("body", body), 0)

    def linear_acceleration(self, body: BodyRef, axis: Axis) -> Expression:
        """m/s^2, of the centre of mass in the last physics step, impacts included; world."""
        return _x.observed("linear_acceleration", self._index("body", body), self._axis(axis))

    def angular_acceleration(self, body: BodyRef, axis: Axis = 2) -> Expression:
        """rad/s^2, in the last physics step; in the plane about axis 2."""
        return _x.observed("angular_acceleration", self._index("body", body), self._axis(axis))

    def proper_acceleration(self, body: BodyRef, axis: Axis) -> Expression:
        """m/s^2, what an accelerometer at the centre of mass reads; body axes, g upwards at rest."""
        return _x.observed("proper_acceleration", self._index("body", body), self._axis(axis))

    def point_position(self, point: int, axis: Axis) -> Expression:
        """m, of Task.points; world."""
        return _x.observed("point_position", point, self._axis(axis))

    def point_velocity(self, point: int, axis: Axis) -> Expression:
        """m/s, of Task.points; world."""
        return _x.observed("point_velocity", point, self._axis(axis))

    def ray_distance(self, ray: int) -> Expression:
        """m, of Task.rays."""
        return _x.observed("ray_distance", ray, 0)

    def generalized_position(self, coordinate: int) -> Expression:
        """m, rad or a number of a quaternion, of the solver newton: MuJoCo's qpos."""
        return _x.generalized_position(coordinate)

    def generalized_velocity(self, dof: int) -> Expression:
        """m/s or rad/s, of the solver newton: MuJoCo's qvel."""
        return _x.generalized_velocity(dof)

    def link_position(self, body: BodyRef, axis: Axis) -> Expression:
        """m, of the body frame where the last forces were found: MuJoCo's xpos after a step."""
        return self._link("link_position", body, axis)

    def link_center(self, body: BodyRef, axis: Axis) -> Expression:
        """m, of the centre of mass there: xipos."""
        return self._link("link_center", body, axis)

    def link_inertia(self, body: BodyRef, axis: Axis) -> Expression:
        """kg m^2, xx, yy or zz about the mass centre of the body's tree, world axes: of cinert."""
        return self._link("link_inertia", body, axis)

    def link_product(self, body: BodyRef, index: int) -> Expression:
        """kg m^2, xy, xz or yz of the same."""
        return self._link("link_product", body, index)

    def link_moment(self, body: BodyRef, axis: Axis) -> Expression:
        """kg m, its mass times the way from its tree's mass centre to its own: of cinert."""
        return self._link("link_moment", body, axis)

    def link_mass(self, body: BodyRef) -> Expression:
        """kg."""
        return self._link("link_mass", body, 0)

    def link_angular_velocity(self, body: BodyRef, axis: Axis) -> Expression:
        """rad/s, world axes, where the last forces were found: of cvel."""
        return self._link("link_angular_velocity", body, axis)

    def link_velocity(self, body: BodyRef, axis: Axis) -> Expression:
        """m/s, of the body where the mass centre of its tree is: of cvel."""
        return self._link("link_velocity", body, axis)

    def external_torque(self, body: BodyRef, axis: Axis) -> Expression:
        """N m, of contacts and inputs about the mass centre of the body's tree: of cfrc_ext."""
        return self._link("external_torque", body, axis)

    def external_force(self, body: BodyRef, axis: Axis) -> Expression:
        """N, of contacts and inputs: of cfrc_ext."""
        return self._link("external_force", body, axis)

    def _link(self, what: str, body: BodyRef, axis: Axis) -> Expression:
        return _x.observed(what, self._index("body", body), self._axis(axis))

    def actuator_force(self, dof: int) -> Expression:
        """N or N m, of all actuators: qfrc_actuator."""
        return _x.observed("actuator_force", dof, 0)

    def constraint_force(self, dof: int) -> Expression:
        """N or N m, of limits and contacts: qfrc_constraint."""
        return _x.observed("constraint_force", dof, 0)

    def action(self, index: int = 0) -> Expression:
        """The action that led here; of discrete tasks its number. 0 at the beginning."""
        return _x.action(index)

    def control(self, control: ControlRef) -> Expression:
        """The control of the scene that led here."""
        return _x.control(self._index("control", control))

    def age(self) -> Expression:
        """Steps of the task since the episode began, with this one."""
        return _x.age()

    def lost(self) -> Expression:
        """Whether the world is lost (``Status.lost()``)."""
        return _x.lost()


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
    """What people are told beside, in double; of no account to the policy."""

    name: str = ""
    value: Value = 0.0
    of_steps_alone: bool = False  # not told where an episode begins


@dataclass(slots=True, kw_only=True, eq=False)
class Task:
    """What a policy has to do in a scene: actions, observations, rewards, and when it ends."""

    name: str = ""
    scene: Scene = field(default_factory=Scene)
    frame_skip: int = 1  # steps of the scene in a step of the task

    choices: int = 0  # discrete tasks: the action is 0 to choices - 1, and `actions` is empty
    actions: list[Action] = field(default_factory=list)
    # What each control of the scene is set to: of actions, numbers and previous(...).
    controls: list[Value] = field(default_factory=list)

    observations: list[Observation] = field(default_factory=list)
    rewards: list[Reward] = field(default_factory=list)
    terminated: Value = 0.0  # the episode has come to its end
    truncated: Value = 0.0  # it is broken off; so is a world that is lost
    max_steps: int = 0  # broken off after so many; 0: never
    solved_at: float = inf  # mean return; said to people only
    infos: list[Info] = field(default_factory=list)

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

    def tell(self, name: str, value: Value, of_steps_alone: bool = False) -> None:
        """Adds an info."""
        self.infos.append(Info(name, value, of_steps_alone))

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
