"""Terms: what a world is at the end of a step, as expressions that tasks are made of."""

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
    """What a world is at the end of a step, as expressions.

    Bodies, joints, controls, tendons and sites by handle, index or, of a scene that is given, by name. What
    does not exist raises ValueError here when it is a name, and is an issue of the task when it is an index.
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

    def observed(self, what: Observed, item: Any = 0, component: Axis = 0) -> Expression:
        """A component of an observed field, by its name (``Batch.fields``): whatever has no term.

        ``item``: a body, joint, tendon or site by handle, index or name, the index of a ray, point
        or dof, 0 for the world; of coordinates the joint, and ``component`` counts its coordinates.
        """
        kind = _core.item_of(what)
        kind = "joint" if kind == "coordinate" else kind
        index = self._index(kind, item) if kind in _HANDLES else item
        return _x.observed(what, index, self._axis(component))

    def joint_force(self, joint: JointRef, axis: Axis) -> Expression:
        """N, of the joint on body B in the last substep, world axes; of every solver."""
        return _x.observed("joint_force", self._index("joint", joint), self._axis(axis))

    def joint_torque(self, joint: JointRef, axis: Axis = 2) -> Expression:
        """N m, of the joint on body B about its anchor in the last substep; in the plane about axis 2."""
        return _x.observed("joint_torque", self._index("joint", joint), self._axis(axis))

    def drive_force(self, joint: JointRef, coordinate: int = 0) -> Expression:
        """N or N m along a coordinate in the last substep: of the joint's drive or spring, with the
        solver newton of its actuators. 0 where it has none."""
        return _x.observed("drive_force", self._index("joint", joint), coordinate)

    # Terms of links and dofs are those of the solver newton. Of other solvers there are link_position,
    # link_center, external_force and external_torque; a task with another one has an issue, which
    # names the term to use instead.

    def generalized_position(self, coordinate: int) -> Expression:
        """m, rad or a number of a quaternion, of the solver newton: MuJoCo's qpos."""
        return _x.generalized_position(coordinate)

    def generalized_velocity(self, dof: int) -> Expression:
        """m/s or rad/s, of the solver newton: MuJoCo's qvel."""
        return _x.generalized_velocity(dof)

    def link_position(self, body: BodyRef, axis: Axis) -> Expression:
        """m, of the body frame: MuJoCo's xpos after a step, where the last forces were found; of other
        solvers than newton where the state has it."""
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
        """N m, of contacts and inputs about the mass centre of the body's tree: of cfrc_ext. Of other
        solvers than newton about the body's own mass centre, the mean over the last physics step."""
        return self._link("external_torque", body, axis)

    def external_force(self, body: BodyRef, axis: Axis) -> Expression:
        """N, of contacts and inputs: of cfrc_ext. Of other solvers than newton the mean over the last
        physics step."""
        return self._link("external_force", body, axis)

    def _link(self, what: str, body: BodyRef, axis: Axis) -> Expression:
        return _x.observed(what, self._index("body", body), self._axis(axis))

    def actuator_force(self, dof: int) -> Expression:
        """N or N m, of all actuators: qfrc_actuator."""
        return _x.observed("actuator_force", dof, 0)

    def constraint_force(self, dof: int) -> Expression:
        """N or N m, of limits and contacts: qfrc_constraint."""
        return _x.observed("constraint_force", dof, 0)

    def tendon_length(self, tendon: TendonRef) -> Expression:
        """m or rad, as its terms are, where the last forces were found: ten_length."""
        return _x.observed("tendon_length", self._index("tendon", tendon), 0)

    def tendon_velocity(self, tendon: TendonRef) -> Expression:
        """m/s or rad/s, there: ten_velocity."""
        return _x.observed("tendon_velocity", self._index("tendon", tendon), 0)

    def site_position(self, site: SiteRef, axis: Axis) -> Expression:
        """m, world, there: site_xpos. Of other solvers than newton where the state has it."""
        return _x.observed("site_position", self._index("site", site), self._axis(axis))

    def action(self, index: int = 0) -> Expression:
        """The action that led here; of discrete tasks its number. 0 at the beginning."""
        return _x.action(index)

    def control(self, control: ControlRef) -> Expression:
        """The control of the scene that led here."""
        return _x.control(self._index("control", control))

    def age(self) -> Expression:
        """Steps of the task since the episode began, including this one.

        In ``Task.controls`` the step to take counts: 1 in the first step. ``age() * time_step()`` is in s.
        """
        return _x.age()

    def time_step(self) -> Expression:
        """s, of one step of the task: ``frame_skip`` steps of the scene."""
        return _x.time_step()

    def lost(self) -> Expression:
        """Whether the world is lost (``Status.lost()``)."""
        return _x.lost()

    def uniform(
        self, name: str, low: Value = 0.0, high: Value = 1.0, *, every: Every = "step"
    ) -> Expression:
        """A random number from ``low`` to ``high``, of every "step" of the task or "episode".

        It depends on its name, the world's seed and episode and, of every step, ``age()`` alone; in
        ``Task.controls`` on that of the step to take. So one name is one number wherever it stands.
        """
        return _x.uniform(name, every, low, high)

    def normal(
        self, name: str, mean: Value = 0.0, deviation: Value = 1.0, *, every: Every = "step"
    ) -> Expression:
        """A normal random number, drawn as those of ``uniform``."""
        return _x.normal(name, every, mean, deviation)

    def level(self, name: str) -> Expression:
        """A number of this world that outlives its episodes (``Task.levels``), by its name."""
        return _x.level(name)

    def memory(self, name: str) -> Expression:
        """A number of this world that the task remembers from step to step (``Task.memories``), by name.

        In ``Task.controls`` it is as the last step left it, elsewhere as this step leaves it.
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
        """A number of the scene as this world has it (``Scene.variations``), of what has it.

        A shape that is an int is one of ``body``, an attractor one of ``Scene.attractors``. ``component`` counts within the parameter's numbers.
        Raises ValueError where it is no number of what is given.
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
