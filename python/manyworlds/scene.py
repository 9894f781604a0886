"""Scene: the description of one world. Plain values, independent of batches and steps."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from math import inf
from typing import TYPE_CHECKING, Any, NamedTuple, Optional, Union, overload

from . import _core, shown
from .bodies import Body, MassProperties
from .ids import (
    BodyId,
    BodyRef,
    ControlId,
    ControlRef,
    JointId,
    JointRef,
    KeyframeId,
    KeyframeRef,
    ShapeId,
    ShapeRef,
    SiteId,
    SiteRef,
    TendonId,
    TendonRef,
)
from .joints import Frame, Joint, JointType, Limit
from .names import BroadPhase, ControlKind, Draw, Feature, Numbers, Parameter, Space
from .options import Options
from .shapes import Hull

if TYPE_CHECKING:
    from .plan import Plan


class Issue(NamedTuple):
    """One error of a scene."""

    place: str  # "body 3 'crate', shape 1: half_extents.y"
    message: str  # "is -0.2 m, must be > 0"

    def __str__(self) -> str:
        return f"{self.place} {self.message}"


class SceneError(ValueError):
    """A scene cannot be compiled; ``issues`` lists all errors."""

    def __init__(self, issues: Sequence[Issue]) -> None:
        self.issues = list(issues)
        count = f"{len(self.issues)} issue" + ("" if len(self.issues) == 1 else "s")
        super().__init__("\n  ".join([f"the scene has {count}:", *map(str, self.issues)]))

    def __reduce__(self) -> tuple[Any, ...]:
        return SceneError, (self.issues,)


@dataclass(slots=True, kw_only=True)
class Actuator:
    """A force along a joint's coordinate, N or N m. Only the newton solver uses it.

    With the control u, clamped to its range, and the length l = gear x and speed s = gear v of the
    joint's coordinate x and its speed v:
    gear clamp((gain[0] + gain[1] l + gain[2] s) u + bias[0] + bias[1] l + bias[2] s, low, high).
    A motor has gain 1; a position servo gain kp and bias (0, -kp, -kv); a velocity servo gain kv and
    bias (0, 0, -kv).
    """

    gear: float = 1.0
    gain: Numbers = (1.0, 0.0, 0.0)
    bias: Numbers = (0.0, 0.0, 0.0)
    low: float = -inf
    high: float = inf


@dataclass(slots=True, kw_only=True)
class Control:
    """A value set for each world, which stays in effect until another is set."""

    name: str = ""
    kind: ControlKind = "target_speed"
    # A joint with a drive (target_position, target_speed), or a hinge or slider (joint_force).
    joint: JointRef = -1
    body: BodyRef = -1  # dynamic; thrust, torque
    point: Numbers = (0.0, 0.0, 0.0)  # m, body frame
    direction: Numbers = (1.0, 0.0, 0.0)  # body frame, need not be unit
    low: float = -1.0  # range, to which values are clamped; a joint_force's may be infinite
    high: float = 1.0
    initial: float = 0.0
    actuator: Actuator = field(default_factory=Actuator)  # joint_force only


@dataclass(slots=True, kw_only=True)
class Attractor:
    """A point that accelerates bodies towards it, strength d / (d^2 + softening^2)^(3/2), m/s^2."""

    position: Numbers = (0.0, 0.0, 0.0)  # m, world
    strength: float = 0.0  # m^3/s^2; a planet: G M
    softening: float = 0.0  # m


@dataclass(slots=True, kw_only=True)
class Variation:
    """A parameter that differs from world to world, and its range. ``vary`` makes simple ones."""

    parameter: Parameter = "friction"
    body: BodyRef = -1  # -1: every body with the parameter
    shape: ShapeRef = -1  # an int: a shape of that body; -1: every shape
    joint: JointRef = -1  # -1: every joint with the parameter
    control: ControlRef = -1
    attractor: int = -1  # in Scene.attractors; -1: every attractor
    low: Numbers = (0.0, 0.0, 0.0)  # a parameter of one value uses [0] only
    high: Numbers = (0.0, 0.0, 0.0)
    draw: Draw = "uniform"
    together: bool = False  # one draw for all owners instead of one for each


def vary(
    parameter: Parameter, low: float, high: float, draw: Draw = "uniform", **more: Any
) -> Variation:
    """A Variation of a parameter with one value, between ``low`` and ``high``."""
    ends = (float(low), 0.0, 0.0), (float(high), 0.0, 0.0)
    return Variation(parameter=parameter, low=ends[0], high=ends[1], draw=draw, **more)


@dataclass(slots=True, kw_only=True)
class Exclusion:
    """Two bodies whose shapes do not collide with each other."""

    body_a: BodyRef = -1
    body_b: BodyRef = -1


@dataclass(slots=True, kw_only=True)
class TendonTerm:
    """A hinge or slider, and the factor of its coordinate in a tendon's length."""

    joint: JointRef = -1
    coefficient: float = 1.0  # m/rad or 1, or any unit that the limit is in


@dataclass(slots=True, kw_only=True)
class Tendon:
    """A weighted sum of joint coordinates, kept within its limit. Only the newton solver uses it.

    A tendon without a limit is for observation only: observer "tendons".
    """

    name: str = ""
    terms: list[TendonTerm] = field(default_factory=list)
    limit: Optional[Limit] = None


@dataclass(slots=True, kw_only=True)
class Site:
    """A named point of a body or of the world, for observation only: observer "sites"."""

    name: str = ""
    body: BodyRef = -1  # -1: the world
    position: Numbers = (0.0, 0.0, 0.0)  # m, in the body's frame or in the world


@dataclass(slots=True, kw_only=True)
class Keyframe:
    """A state that worlds can be reset to. A reset draws empty members as usual.

    ``generalized_position`` (coordinates,) and ``generalized_velocity`` (dofs,) are for the newton
    solver and equal the fields of that name. ``controls`` is (controls,).
    """

    name: str = ""  # empty, or no other keyframe's
    generalized_position: Numbers = field(default_factory=list)  # m, rad, quaternions
    generalized_velocity: Numbers = field(default_factory=list)  # m/s or rad/s
    controls: Numbers = field(default_factory=list)


@dataclass(slots=True, kw_only=True)
class CoordinateDraw:
    """Initial generalised positions or velocities, drawn at each reset. Only for the newton solver.

    ``low`` and ``high`` have one value for each coordinate or dof from ``first`` on. Draws are uniform
    in this range. ``normal`` draws have the mean of the two and half the range as standard deviation.
    Several CoordinateDraw are applied in their order.
    """

    velocity: bool = False  # True: dofs; False: coordinates
    first: int = 0  # index in MuJoCo's qpos or qvel
    low: Numbers = field(default_factory=list)
    high: Numbers = field(default_factory=list)
    normal: bool = False
    replaces: bool = False  # True: replace the earlier value; False: add to it
    nearest: float = -inf  # drawn again until the norm is above this
    farthest: float = inf  # and below this


@dataclass(slots=True, kw_only=True)
class Ray:
    """A ray that every world casts against all its shapes."""

    origin: Numbers = (0.0, 0.0, 0.0)  # m, in the world or, with a body, in that body's frame
    direction: Numbers = (1.0, 0.0, 0.0)  # need not be unit
    length: float = inf  # m, range of the ray
    body: BodyRef = -1  # the ray moves and rotates with it; -1: fixed in the world
    mask: int = 0xFFFFFFFF  # hits shapes whose Filter.category is in it


@dataclass(slots=True, kw_only=True)
class Point:
    """A point fixed to a moving body."""

    position: Numbers = (0.0, 0.0, 0.0)  # m, in the body's frame
    body: BodyRef = -1


Part = Union[
    Body,
    Joint,
    Control,
    Attractor,
    Variation,
    Exclusion,
    Tendon,
    Keyframe,
    CoordinateDraw,
    Site,
]


@dataclass(slots=True, kw_only=True)
class Scene:
    """One world: bodies, joints, controls, options. Units are SI; planar scenes use x and y."""

    name: str = ""
    space: Space = "spatial"
    bodies: list[Body] = field(default_factory=list)
    joints: list[Joint] = field(default_factory=list)
    controls: list[Control] = field(default_factory=list)
    attractors: list[Attractor] = field(default_factory=list)
    options: Options = field(default_factory=Options)
    variations: list[Variation] = field(default_factory=list)
    exclusions: list[Exclusion] = field(default_factory=list)  # in addition to those of joints
    tendons: list[Tendon] = field(default_factory=list)
    keyframes: list[Keyframe] = field(default_factory=list)
    coordinate_draws: list[CoordinateDraw] = field(default_factory=list)
    sites: list[Site] = field(default_factory=list)

    def __repr__(self) -> str:
        return shown.line(
            "Scene",
            self.name,
            str(self.space),
            shown.count(self.bodies, "body", "bodies"),
            shown.count(self.joints, "joint", "joints"),
            shown.count(self.controls, "control", "controls"),
            shown.count(self.variations, "variation", "variations"),
        )

    def _repr_html_(self) -> str:
        """Bodies and joints as tables, for notebooks."""
        bodies = [
            (
                i,
                getattr(b, "name", "?"),
                getattr(b, "motion", "?"),
                shown.attempt(lambda b=b: shown.short(tuple(map(float, b.position)))),
                shown.attempt(lambda b=b: ", ".join(type(s.geometry).__name__ for s in b.shapes)),
            )
            for i, b in enumerate(self.bodies)
        ]
        joints = [
            (i, *(getattr(j, name, "?") for name in ("name", "body_a", "body_b")))
            + (type(getattr(j, "type", None)).__name__,)
            for i, j in enumerate(self.joints)
        ]
        return shown.table(
            f"Scene {self.name}: bodies",
            ("", "name", "motion", "position, m", "shapes"),
            bodies,
        ) + shown.table("joints", ("", "name", "body_a", "body_b", "type"), joints)

    @overload
    def add(self, part: Body) -> BodyId: ...
    @overload
    def add(self, part: Joint) -> JointId: ...
    @overload
    def add(self, part: Control) -> ControlId: ...
    @overload
    def add(self, part: Tendon) -> TendonId: ...
    @overload
    def add(self, part: Site) -> SiteId: ...
    @overload
    def add(self, part: Keyframe) -> KeyframeId: ...
    @overload
    def add(self, part: Union[Attractor, Variation, Exclusion, CoordinateDraw]) -> int: ...
    def add(self, part: Part) -> int:
        """Appends a body, joint, control, ... or keyframe. Returns its handle or index."""
        places: list[tuple[type, list[Any], type[int]]] = [
            (Body, self.bodies, BodyId),
            (Joint, self.joints, JointId),
            (Control, self.controls, ControlId),
            (Attractor, self.attractors, int),
            (Variation, self.variations, int),
            (Exclusion, self.exclusions, int),
            (Tendon, self.tendons, TendonId),
            (Keyframe, self.keyframes, KeyframeId),
            (CoordinateDraw, self.coordinate_draws, int),
            (Site, self.sites, SiteId),
        ]
        for kind, place, handle in places:
            if isinstance(part, kind):
                place.append(part)
                return handle(len(place) - 1)
        names = ", ".join(kind.__name__ for kind, _, _ in places)
        raise TypeError(f"cannot add a {type(part).__name__}; expected one of {names}")

    # -- by name. Empty and shared names find nothing.

    def body(self, name: BodyRef) -> BodyId:
        """The body with a name. Raises ValueError, which lists the names, if there is none or several."""
        return BodyId(_core.find_in_scene(self, "body", name))

    def joint(self, name: JointRef) -> JointId:
        """The joint with a name: see body."""
        return JointId(_core.find_in_scene(self, "joint", name))

    def control(self, name: ControlRef) -> ControlId:
        """The control with a name: see body."""
        return ControlId(_core.find_in_scene(self, "control", name))

    def tendon(self, name: TendonRef) -> TendonId:
        """The tendon with a name: see body."""
        return TendonId(_core.find_in_scene(self, "tendon", name))

    def site(self, name: SiteRef) -> SiteId:
        """The site with a name: see body."""
        return SiteId(_core.find_in_scene(self, "site", name))

    def keyframe(self, name: KeyframeRef) -> KeyframeId:
        """The keyframe with a name: see body."""
        return KeyframeId(_core.find_in_scene(self, "keyframe", name))

    def shape(self, name: str, body: Optional[BodyRef] = None) -> ShapeId:
        """The shape with a name, of any body or of ``body``: see body."""
        of, index = _core.find_shape_in_scene(self, name, body)
        return ShapeId(BodyId(of), index)

    def validate(self) -> list[Issue]:
        """All errors of the scene, in its order. Empty: the scene can be compiled.

        Raises TypeError or ValueError, which name the member, if a value has a wrong type or name.
        """
        return [Issue(*issue) for issue in _core.validate(self)]

    def compile(
        self, *, broad_phase: BroadPhase = "automatic", keep: Sequence[Feature] = ()
    ) -> Plan:
        """The Plan of this scene. Raises SceneError."""
        from .plan import Plan  # which imports scenes

        return Plan(self, broad_phase=broad_phase, keep=keep)

    def joint_at(self, body_a: BodyRef, body_b: BodyRef, frame: Frame, type: JointType) -> Joint:
        """A joint of two bodies (-1: the world) whose frames coincide with ``frame`` in the world.

        The scene must have no issues. Returns the joint and does not add it.
        """
        return _core.joint_at(self, body_a, body_b, frame, type)

    def mass_properties(self, body: BodyRef) -> MassProperties:
        """Mass (kg), centre (m) and inertia (kg m^2) of a body, set or computed from its shapes."""
        return _core.mass_properties(self, body)


def make_hull(points: Sequence[Numbers]) -> Hull:
    """The convex hull of points (n, 3) in m. Raises ValueError if it is flat or has over 8192 corners."""
    return _core.make_hull(points)


def mesh_mass_properties(
    vertices: Sequence[Numbers], triangles: Sequence[Sequence[int]], density: float
) -> MassProperties:
    """Mass properties of the solid in a closed mesh: vertices (n, 3) in m, triangles (m, 3).

    Triangles are counter-clockwise seen from outside. ``density`` is in kg/m^3. Raises ValueError,
    which lists all errors of the mesh.
    """
    return _core.mesh_mass_properties(vertices, triangles, density)
