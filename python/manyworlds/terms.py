"""Terms: expressions for the state of a world at the end of a step, for tasks."""

from __future__ import annotations

from typing import Any, Optional, Union

from . import _core
from ._core import Expression
from ._core import expressions as _x
from .ids import (
    BodyId,
    BodyRef,
    ControlId,
    ControlRef,
    JointId,
    JointRef,
    ShapeId,
    ShapeRef,
    SiteId,
    SiteRef,
    TendonId,
    TendonRef,
    index_of,
)
from .names import Every, Observed, Parameter
from .scene import Scene

Value = Union[Expression, float]  # numbers are expressions
Axis = Union[int, str]  # 0, 1, 2 or "x", "y", "z", of the world

_HANDLES = {
    "body": BodyId,
    "joint": JointId,
    "control": ControlId,
    "tendon": TendonId,
    "site": SiteId,
}


class Terms:
    """Expressions for the state of a world at the end of a step.

    Arguments select bodies, joints, controls, tendons and sites by handle, index, or, if a scene is
    set, by name. An unknown name raises ValueError here. An unknown index is an issue of the task.
    """

    def __init__(self, scene: Optional[Scene] = None) -> None:
        self._scene = scene

    def _index(self, what: str, key: Any) -> Any:
        kind = _HANDLES[what]

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
        """Position of the body frame, m."""
        return _x.position(self._index("body", body), self._axis(axis))

    def velocity(self, body: BodyRef, axis: Axis) -> Expression:
        """Velocity of the centre of mass, m/s."""
        return _x.velocity(self._index("body", body), self._axis(axis))

    def angular_velocity(self, body: BodyRef, axis: Axis = 2) -> Expression:
        """Angular velocity, rad/s; in the plane about axis 2."""
        return _x.angular_velocity(self._index("body", body), self._axis(axis))

    def angle(self, body: BodyRef) -> Expression:
        """Angle of a planar body, rad, -pi to pi."""
        return _x.angle(self._index("body", body))

    def direction(self, body: BodyRef, of: Axis, axis: Axis) -> Expression:
        """A component of the body's x, y or z axis."""
        return _x.direction(self._index("body", body), self._axis(of), self._axis(axis))

    def joint_position(self, joint: JointRef, coordinate: int = 0) -> Expression:
        """Coordinate of a joint, m or rad; each type of joint has others (docs/observers.md)."""
        return _x.observed("joint_position", self._index("joint", joint), coordinate)

    def joint_speed(self, joint: JointRef, coordinate: int = 0) -> Expression:
        """Velocity of a joint coordinate, m/s or rad/s."""
        return _x.observed("joint_speed", self._index("joint", joint), coordinate)

    def touching(self, body: BodyRef) -> Expression:
        """1 if a contact acted on the body in the last step; 0 at the start of an episode."""
        return _x.observed("touching", self._index("body", body), 0)

    def linear_acceleration(self, body: BodyRef, axis: Axis) -> Expression:
        """Acceleration of the centre of mass in the last physics step, m/s^2, world frame.

        Includes impacts.
        """
        return _x.observed("linear_acceleration", self._index("body", body), self._axis(axis))

    def angular_acceleration(self, body: BodyRef, axis: Axis = 2) -> Expression:
        """Angular acceleration in the last physics step, rad/s^2; in the plane about axis 2."""
        return _x.observed("angular_acceleration", self._index("body", body), self._axis(axis))

    def proper_acceleration(self, body: BodyRef, axis: Axis) -> Expression:
        """Accelerometer reading at the centre of mass, m/s^2, body axes; g upwards at rest."""
        return _x.observed("proper_acceleration", self._index("body", body), self._axis(axis))

    def point_position(self, point: int, axis: Axis) -> Expression:
        """Position of a point of Task.points, m, world frame."""
        return _x.observed("point_position", point, self._axis(axis))

    def point_velocity(self, point: int, axis: Axis) -> Expression:
        """Velocity of a point of Task.points, m/s, world frame."""
        return _x.observed("point_velocity", point, self._axis(axis))

    def ray_distance(self, ray: int) -> Expression:
        """Distance to the hit of a ray of Task.rays, m."""
        return _x.observed("ray_distance", ray, 0)

    def observed(self, what: Observed, item: Any = 0, component: Axis = 0) -> Expression:
        """A component of an observed field by its name (``Batch.fields``), for values without a
        term.

        ``item``: a body, joint, tendon or site by handle, index or name; the index of a ray, point
        or dof; 0 for the world. For coordinates it is the joint, and ``component`` counts the
        joint's coordinates.
        """
        kind = _core.item_of(what)
        kind = "joint" if kind == "coordinate" else kind
        index = self._index(kind, item) if kind in _HANDLES else item
        return _x.observed(what, index, self._axis(component))

    def joint_force(self, joint: JointRef, axis: Axis) -> Expression:
        """Force of the joint on body B in the last substep, N, world axes. All solvers."""
        return _x.observed("joint_force", self._index("joint", joint), self._axis(axis))

    def joint_torque(self, joint: JointRef, axis: Axis = 2) -> Expression:
        """Torque of the joint on body B about its anchor in the last substep, N m. All solvers.

        In the plane about axis 2.
        """
        return _x.observed("joint_torque", self._index("joint", joint), self._axis(axis))

    def drive_force(self, joint: JointRef, coordinate: int = 0) -> Expression:
        """Force of the joint's drive or spring along a coordinate in the last substep, N or N m.

        With the newton solver: force of the joint's actuators. 0 for joints without one.
        """
        return _x.observed("drive_force", self._index("joint", joint), coordinate)

    # Terms of links and dofs require the newton solver. Only link_position, link_center,
    # external_force and external_torque work with other solvers. For the rest a task has an issue,
    # which names the term to use instead.

    def generalized_position(self, coordinate: int) -> Expression:
        """m, rad or a component of a quaternion. newton solver only; MuJoCo's qpos."""
        return _x.generalized_position(coordinate)

    def generalized_velocity(self, dof: int) -> Expression:
        """m/s or rad/s. newton solver only; MuJoCo's qvel."""
        return _x.generalized_velocity(dof)

    def link_position(self, body: BodyRef, axis: Axis) -> Expression:
        """Position of the body frame, m: MuJoCo's xpos after a step.

        With the newton solver it is the position at the last evaluation of forces, with other
        solvers the position of the state.
        """
        return self._link("link_position", body, axis)

    def link_center(self, body: BodyRef, axis: Axis) -> Expression:
        """Position of the centre of mass at the same instant as ``link_position``, m: xipos."""
        return self._link("link_center", body, axis)

    def link_inertia(self, body: BodyRef, axis: Axis) -> Expression:
        """Inertia xx, yy or zz about the mass centre of the body's tree, kg m^2, world axes:
        cinert.
        """
        return self._link("link_inertia", body, axis)

    def link_product(self, body: BodyRef, index: int) -> Expression:
        """Product of inertia xy, xz or yz about the same point, kg m^2: cinert."""
        return self._link("link_product", body, index)

    def link_moment(self, body: BodyRef, axis: Axis) -> Expression:
        """Mass times the vector from its tree's mass centre to its own, kg m: cinert."""
        return self._link("link_moment", body, axis)

    def link_mass(self, body: BodyRef) -> Expression:
        """Mass of the body, kg."""
        return self._link("link_mass", body, 0)

    def link_angular_velocity(self, body: BodyRef, axis: Axis) -> Expression:
        """rad/s, world axes, at the last evaluation of forces: cvel."""
        return self._link("link_angular_velocity", body, axis)

    def link_velocity(self, body: BodyRef, axis: Axis) -> Expression:
        """Velocity of the body at the mass centre of its tree, m/s: cvel."""
        return self._link("link_velocity", body, axis)

    def external_torque(self, body: BodyRef, axis: Axis) -> Expression:
        """Torque of contacts and inputs about the mass centre of the body's tree, N m: cfrc_ext.

        With other solvers than newton: about the body's own mass centre, mean over the last physics
        step.
        """
        return self._link("external_torque", body, axis)

    def external_force(self, body: BodyRef, axis: Axis) -> Expression:
        """Force of contacts and inputs, N: cfrc_ext.

        With other solvers than newton: mean over the last physics step.
        """
        return self._link("external_force", body, axis)

    def _link(self, what: str, body: BodyRef, axis: Axis) -> Expression:
        return _x.observed(what, self._index("body", body), self._axis(axis))

    def actuator_force(self, dof: int) -> Expression:
        """Force of all actuators along a dof, N or N m: qfrc_actuator."""
        return _x.observed("actuator_force", dof, 0)

    def constraint_force(self, dof: int) -> Expression:
        """Force of limits and contacts along a dof, N or N m: qfrc_constraint."""
        return _x.observed("constraint_force", dof, 0)

    def tendon_length(self, tendon: TendonRef) -> Expression:
        """Length of a tendon at the last evaluation of forces, m or rad: ten_length."""
        return _x.observed("tendon_length", self._index("tendon", tendon), 0)

    def tendon_velocity(self, tendon: TendonRef) -> Expression:
        """Velocity of a tendon at the last evaluation of forces, m/s or rad/s: ten_velocity."""
        return _x.observed("tendon_velocity", self._index("tendon", tendon), 0)

    def site_position(self, site: SiteRef, axis: Axis) -> Expression:
        """Position of a site, m, world frame: site_xpos.

        With the newton solver it is the position at the last evaluation of forces, with other
        solvers the position of the state.
        """
        return _x.observed("site_position", self._index("site", site), self._axis(axis))

    def action(self, index: int = 0) -> Expression:
        """The last action; for discrete tasks its number. 0 at the start of an episode."""
        return _x.action(index)

    def control(self, control: ControlRef) -> Expression:
        """The last value of a control of the scene."""
        return _x.control(self._index("control", control))

    def age(self) -> Expression:
        """Number of task steps since the start of the episode, including this one.

        In ``Task.controls`` the next step counts: 1 in the first step. ``age() * time_step()`` is
        in s.
        """
        return _x.age()

    def time_step(self) -> Expression:
        """Duration of one step of the task, s: ``frame_skip`` steps of the scene."""
        return _x.time_step()

    def lost(self) -> Expression:
        """1 if the world is lost (``Status.lost()``)."""
        return _x.lost()

    def uniform(
        self, name: str, low: Value = 0.0, high: Value = 1.0, *, every: Every = "step"
    ) -> Expression:
        """A random number from ``low`` to ``high``, drawn for every "step" of the task or
        "episode".

        It depends only on its name, the seed and episode of the world and, for every step, on
        ``age()``. In ``Task.controls`` the age is that of the next step. Terms with equal names are
        equal.
        """
        return _x.uniform(name, every, low, high)

    def normal(
        self, name: str, mean: Value = 0.0, deviation: Value = 1.0, *, every: Every = "step"
    ) -> Expression:
        """A normal random number, drawn as in ``uniform``."""
        return _x.normal(name, every, mean, deviation)

    def level(self, name: str) -> Expression:
        """A value of this world that persists over episodes (``Task.levels``), by name."""
        return _x.level(name)

    def memory(self, name: str) -> Expression:
        """A value of this world that the task stores between steps (``Task.memories``), by name.

        In ``Task.controls`` it is the value after the last step, elsewhere the value after this
        step.
        """
        return _x.memory(name)

    def parameter(
        self,
        parameter: Parameter,
        component: int = 0,
        *,
        body: Optional[BodyRef] = None,
        shape: Optional[ShapeRef] = None,
        joint: Optional[JointRef] = None,
        control: Optional[ControlRef] = None,
        attractor: Optional[int] = None,
    ) -> Expression:
        """The value of a scene parameter in this world (``Scene.variations``).

        The arguments select its owner. An int ``shape`` is a shape of ``body``; an attractor is an
        index of ``Scene.attractors``. ``component`` is an index into the parameter's values. Raises
        ValueError if the owner does not have this parameter.
        """
        if shape is not None:
            return _x.parameter(parameter, "shape", *self._shape(shape, body), component)
        for kind, ref in (("body", body), ("joint", joint), ("control", control)):
            if ref is not None:
                return _x.parameter(parameter, kind, self._index(kind, ref), -1, component)
        if attractor is not None:
            return _x.parameter(parameter, "attractor", attractor, -1, component)
        return _x.parameter(parameter, "world", -1, -1, component)

    def _shape(self, shape: ShapeRef, body: Optional[BodyRef]) -> tuple[int, int]:
        if isinstance(shape, ShapeId):
            return shape
        of = None if body is None else self._index("body", body)
        if not isinstance(shape, str):
            return -1 if of is None else of, shape
        if self._scene is None:
            raise ValueError(f"the shape '{shape}': names are those of a scene, use Terms(scene)")
        return _core.find_shape_in_scene(self._scene, shape, of)
