"""Joints connect two bodies, or one body and the world.

A hinge rotates about z of its frames, a slider slides along x. A coordinate is the motion of B's frame
relative to A's: an angle in rad, a travel or length in m. It may have a limit and a drive.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from math import inf
from typing import Optional, Union

from .ids import BodyRef, JointRef
from .names import Numbers
from .shapes import Compliance

__all__ = [
    "BallJoint",
    "DistanceJoint",
    "Drive",
    "FixedJoint",
    "Frame",
    "HingeJoint",
    "Joint",
    "JointDynamics",
    "JointType",
    "Limit",
    "PulleyJoint",
    "SliderJoint",
    "Spring",
    "TargetJoint",
    "WheelJoint",
]


@dataclass(slots=True)
class Frame:
    """A position and axes on a body, or in the world."""

    position: Numbers = (0.0, 0.0, 0.0)  # m
    rotation: Numbers = (1.0, 0.0, 0.0, 0.0)  # (w, x, y, z); need not be unit


@dataclass(slots=True, kw_only=True)
class Spring:
    """A spring and damper: stiffness and damping, or frequency and damping ratio."""

    stiffness: float = 0.0  # N/m or N m/rad
    damping: float = 0.0  # N s/m or N m s/rad
    frequency: float = 0.0  # Hz
    damping_ratio: float = 0.0  # 1: critical


@dataclass(slots=True)
class Limit:
    """Keeps a coordinate between two values. Hard without a spring, except with the newton solver."""

    low: float = 0.0  # m or rad
    high: float = 0.0  # m or rad
    spring: Optional[Spring] = None
    # newton solver only, whose limits have no spring: softness, and the distance at which it acts
    compliance: Compliance = field(default_factory=Compliance)
    margin: float = 0.0  # m or rad, distance from the limit


@dataclass(slots=True, kw_only=True)
class Drive:
    """Moves a coordinate to targets with a spring; without one, a motor that holds a speed."""

    target_position: float = 0.0  # m or rad
    target_speed: float = 0.0  # m/s or rad/s
    spring: Optional[Spring] = None
    max_force: float = inf  # N or N m


@dataclass(slots=True, kw_only=True)
class BallJoint:
    """The frames' origins coincide. Spatial."""

    cone: Optional[float] = None  # rad, 0 to pi: largest angle between z of B and z of A
    twist: Optional[Limit] = None  # rad, about z
    # newton solver only, which supports neither: limit of the rotation angle, rad
    limit: Optional[Limit] = None  # low is 0


@dataclass(slots=True, kw_only=True)
class HingeJoint:
    """The frames' origins coincide, and in space their z axes, too."""

    limit: Optional[Limit] = None  # rad
    drive: Optional[Drive] = None


@dataclass(slots=True, kw_only=True)
class SliderJoint:
    """B's frame slides along x of A's and does not rotate relative to it."""

    limit: Optional[Limit] = None  # m
    drive: Optional[Drive] = None


@dataclass(slots=True)
class FixedJoint:
    """The frames coincide."""


@dataclass(slots=True, kw_only=True)
class DistanceJoint:
    """The distance of the frames' origins: fixed, pulled by a spring, or kept within a limit."""

    length: Optional[float] = None  # m; None: the distance at the start
    limit: Optional[Limit] = None  # m
    spring: Optional[Spring] = None


@dataclass(slots=True, kw_only=True)
class WheelJoint:
    """B is a wheel: it moves along x of A's frame on a suspension and rotates about z."""

    suspension: Spring = field(default_factory=Spring)
    travel: Optional[Limit] = None  # m, along x
    drive: Optional[Drive] = None  # drives the rotation about z


@dataclass(slots=True, kw_only=True)
class PulleyJoint:
    """A rope over two pulleys: |A - ground_a| + ratio |B - ground_b| = length."""

    ground_a: Numbers = (0.0, 0.0, 0.0)  # m, world
    ground_b: Numbers = (0.0, 0.0, 0.0)  # m, world
    ratio: float = 1.0
    length: Optional[float] = None  # m; None: the length at the start


@dataclass(slots=True, kw_only=True)
class TargetJoint:
    """Pulls the origin of B's frame to the origin of A's, or to a point of the world."""

    spring: Spring = field(default_factory=Spring)
    max_force: float = inf  # N


JointType = Union[
    BallJoint,
    HingeJoint,
    SliderJoint,
    FixedJoint,
    DistanceJoint,
    WheelJoint,
    PulleyJoint,
    TargetJoint,
]


@dataclass(slots=True, kw_only=True)
class JointDynamics:
    """newton solver only: passive forces along each coordinate of a joint, and its zero."""

    armature: float = 0.0  # kg m^2 or kg, rotor inertia
    damping: float = 0.0  # N m s/rad or N s/m
    # N m/rad or N/m. Pulls a hinge or slider to ``rest``, a ball joint to coinciding frames.
    stiffness: float = 0.0
    rest: float = 0.0  # rad or m, hinge or slider
    reference: float = 0.0  # rad or m, coordinate of a hinge or slider with coinciding frames


@dataclass(slots=True, kw_only=True)
class Joint:
    """A joint of bodies ``body_a`` and ``body_b``; -1: the world."""

    name: str = ""
    type: JointType = field(default_factory=HingeJoint)
    body_a: BodyRef = -1
    body_b: BodyRef = -1
    frame_a: Frame = field(default_factory=Frame)  # in the body frame of A, or in the world
    frame_b: Frame = field(default_factory=Frame)  # in the body frame of B
    collide: bool = False  # whether shapes of A and B collide with each other
    break_force: float = inf  # N
    break_torque: float = inf  # N m
    # newton solver only: the joint of the same A and B that precedes this one in a series; -1: none.
    # Each joint's frame_a is in the frame that the preceding joint moves. The last joint moves B.
    after: JointRef = -1
    dynamics: JointDynamics = field(default_factory=JointDynamics)  # newton solver only
