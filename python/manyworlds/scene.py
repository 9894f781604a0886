"""Scene: what one world is. Plain values; independent of batches and steps."""

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
    """One thing that is wrong with a scene."""

    place: str  # "body 3 'crate', shape 1: half_extents.y"
    message: str  # "is -0.2 m, must be > 0"

    def __str__(self) -> str:
        return f"{self.place} {self.message}"


class SceneError(ValueError):
    """A scene that cannot be compiled; ``issues`` lists everything that is wrong with it."""

    def __init__(self, issues: Sequence[Issue]) -> None:
        self.issues = list(issues)
        count = f"{len(self.issues)} issue" + ("" if len(self.issues) == 1 else "s")
        super().__init__("\n  ".join([f"the scene has {count}:", *map(str, self.issues)]))

    def __reduce__(self) -> tuple[Any, ...]:
        return SceneError, (self.issues,)


@dataclass(slots=True, kw_only=True)
class Actuator:
    """A force along a joint's coordinate, N or N m, of the newton solver.

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
    """A number that each world is given from outside, and acts on until it is given another."""

    name: str = ""
    kind: ControlKind = "target_speed"
    # With a drive (target_position, target_speed), or a hinge or slider (joint_force).
    joint: JointRef = -1
    body: BodyRef = -1  # dynamic; thrust, torque
    point: Numbers = (0.0, 0.0, 0.0)  # m, body frame
    direction: Numbers = (1.0, 0.0, 0.0)  # body frame, need not be unit
    low: float = -1.0  # of joint_force it may be infinite
    high: float = 1.0
    initial: float = 0.0
    actuator: Actuator = field(default_factory=Actuator)  # of joint_force


@dataclass(slots=True, kw_only=True)
class Attractor:
    """A point that draws bodies with strength d / (d^2 + softening^2)^(3/2), m/s^2."""

    position: Numbers = (0.0, 0.0, 0.0)  # m, world
    strength: float = 0.0  # m^3/s^2; a planet: G M
    softening: float = 0.0  # m


@dataclass(slots=True, kw_only=True)
class Variation:
    """A parameter that may differ from world to world, and its range. ``vary`` makes simple ones."""

    parameter: Parameter = "friction"
    body: BodyRef = -1  # -1: every one that has the parameter
    shape: ShapeRef = -1  # an int is one of that body; -1: every shape
    joint: JointRef = -1  # -1: every one that has the parameter
    control: ControlRef = -1
    attractor: int = -1  # in Scene.attractors; -1: every one
    low: Numbers = (0.0, 0.0, 0.0)  # [0] alone counts where the parameter is one number
    high: Numbers = (0.0, 0.0, 0.0)
    draw: Draw = "uniform"
    together: bool = False  # one draw for all that it is about, instead of one for each


def vary(
    parameter: Parameter, low: float, high: float, draw: Draw = "uniform", **more: Any
) -> Variation:
    """A Variation of a parameter of one number, between ``low`` and ``high``."""
    ends = (float(low), 0.0, 0.0), (float(high), 0.0, 0.0)
    return Variation(parameter=parameter, low=ends[0], high=ends[1], draw=draw, **more)


@dataclass(slots=True, kw_only=True)
class Exclusion:
    """Two bodies whose shapes do not collide with each other."""

    body_a: BodyRef = -1
    body_b: BodyRef = -1


@dataclass(slots=True, kw_only=True)
class TendonTerm:
    """A hinge or slider, and how much of its coordinate counts in a tendon."""

    joint: JointRef = -1
    coefficient: float = 1.0  # m/rad or 1, or any unit that the limit is in


@dataclass(slots=True, kw_only=True)
class Tendon:
    """A length made of coordinates of joints, kept within its limit. Of the solver newton.

    Without a limit it is only looked at: the observer "tendons".
    """

    name: str = ""
    terms: list[TendonTerm] = field(default_factory=list)
    limit: Optional[Limit] = None


@dataclass(slots=True, kw_only=True)
class Site:
    """A point of a body, or of the world, that has a name, to be looked at: the observer "sites"."""

    name: str = ""
    body: BodyRef = -1  # -1: the world
    position: Numbers = (0.0, 0.0, 0.0)  # m, in the body's frame or in the world


@dataclass(slots=True, kw_only=True)
class Keyframe:
    """A state that worlds can be reset to; what is empty is as any reset leaves it.

    Of the solver newton ``generalized_position`` (coordinates,) and ``generalized_velocity`` (dofs,),
    as the fields of that name have them, and ``controls`` (controls,).
    """

    name: str = ""  # empty, or no other keyframe's
    generalized_position: Numbers = field(default_factory=list)  # m, rad, quaternions
    generalized_velocity: Numbers = field(default_factory=list)  # m/s or rad/s
    controls: Numbers = field(default_factory=list)


@dataclass(slots=True, kw_only=True)
class CoordinateDraw:
    """Numbers of the generalised positions or velocities that worlds begin with, drawn at each reset.

    ``low`` and ``high`` have one number for each coordinate or dof from ``first`` on; ``normal`` draws
    have their mean half way between the two and half the range as standard deviation, others are uniform.
    They act in their order. Of the solver newton.
    """

    velocity: bool = False  # of dofs, else of coordinates
    first: int = 0  # as MuJoCo counts qpos and qvel
    low: Numbers = field(default_factory=list)
    high: Numbers = field(default_factory=list)
    normal: bool = False
    replaces: bool = False  # what is there by then; else they are added to it
    nearest: float = -inf  # drawn again until their norm is more than this
    farthest: float = inf  # and less than that


@dataclass(slots=True, kw_only=True)
class Ray:
    """A ray that every world casts against all of its shapes."""

    origin: Numbers = (0.0, 0.0, 0.0)  # m, in the world or, with a body, in that body's frame
    direction: Numbers = (1.0, 0.0, 0.0)  # need not be unit
    length: float = inf  # m: it sees what is nearer
    body: BodyRef = -1  # moves and rotates with it; -1: stays
    mask: int = 0xFFFFFFFF  # of Filter.category


@dataclass(slots=True, kw_only=True)
class Point:
    """A point that is fixed to a body that can move."""

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
    exclusions: list[Exclusion] = field(default_factory=list)  # beside those of joints
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
        """Appends a body, joint, control, ... or keyframe and returns its handle or index."""
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

    # -- by name. Names may be empty or shared, but then they find nothing.

    def body(self, name: BodyRef) -> BodyId:
        """The body of a name. Raises ValueError, which lists the names, for none or several."""
        return BodyId(_core.find_in_scene(self, "body", name))

    def joint(self, name: JointRef) -> JointId:
        """The joint of a name: see body."""
        return JointId(_core.find_in_scene(self, "joint", name))

    def control(self, name: ControlRef) -> ControlId:
        """The control of a name: see body."""
        return ControlId(_core.find_in_scene(self, "control", name))

    def tendon(self, name: TendonRef) -> TendonId:
        """The tendon of a name: see body."""
        return TendonId(_core.find_in_scene(self, "tendon", name))

    def site(self, name: SiteRef) -> SiteId:
        """The site of a name: see body."""
        return SiteId(_core.find_in_scene(self, "site", name))

    def keyframe(self, name: KeyframeRef) -> KeyframeId:
        """The keyframe of a name: see body."""
        return KeyframeId(_core.find_in_scene(self, "keyframe", name))

    def shape(self, name: str, body: Optional[BodyRef] = None) -> ShapeId:
        """The shape of a name, among all or among those of a body: see body."""
        of, index = _core.find_shape_in_scene(self, name, body)
        return ShapeId(BodyId(of), index)

    def validate(self) -> list[Issue]:
        """Everything that is wrong with the scene, in its order; empty: it can be compiled.

        Values of a wrong type or name raise TypeError or ValueError, which name the place.
        """
        return [Issue(*issue) for issue in _core.validate(self)]

    def compile(
        self, *, broad_phase: BroadPhase = "automatic", keep: Sequence[Feature] = ()
    ) -> Plan:
        """The Plan of this scene. Raises SceneError."""
        from .plan import Plan  # which imports scenes

        return Plan(self, broad_phase=broad_phase, keep=keep)

    def joint_at(self, body_a: BodyRef, body_b: BodyRef, frame: Frame, type: JointType) -> Joint:
        """A joint of two bodies (-1: the world) whose frames are where ``frame`` is in the world.

        The scene must have no issues. The joint is returned, not added.
        """
        return _core.joint_at(self, body_a, body_b, frame, type)

    def mass_properties(self, body: BodyRef) -> MassProperties:
        """Mass (kg), centre (m) and inertia (kg m^2) of a body: its own, or those of its shapes."""
        return _core.mass_properties(self, body)


def make_hull(points: Sequence[Numbers]) -> Hull:
    """The convex hull of points (n, 3) in m. Raises ValueError when it is flat or too detailed."""
    return _core.make_hull(points)


def mesh_mass_properties(
    vertices: Sequence[Numbers], triangles: Sequence[Sequence[int]], density: float
) -> MassProperties:
    """Mass properties of the solid in a closed mesh: vertices (n, 3) in m, triangles (m, 3).

    Triangles run counter-clockwise seen from outside. ``density`` is in kg/m^3. Raises ValueError
    with everything that is wrong with the mesh.
    """
    return _core.mesh_mass_properties(vertices, triangles, density)
