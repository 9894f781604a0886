"""Bodies, their initial state, and how it varies from world to world."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Optional

from .ids import BodyRef
from .names import Motion, Numbers
from .shapes import Shape


@dataclass(slots=True)
class MassProperties:
    """Mass, centre and inertia of a body. Planar bodies use only inertia[2][2]."""

    mass: float = 1.0  # kg
    center: Numbers = (0.0, 0.0, 0.0)  # m, centre of mass in the body frame
    # kg m^2 about the centre of mass, body axes, (3, 3)
    inertia: object = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    # Principal axes of inertia, a quaternion (w, x, y, z), along which drag of a medium acts. None:
    # computed from inertia.
    axes: Optional[Numbers] = None


@dataclass(slots=True, kw_only=True)
class Jitter:
    """Half ranges of uniform draws around the values of a body, for each world at each reset."""

    position: Numbers = (0.0, 0.0, 0.0)  # m
    linear_velocity: Numbers = (0.0, 0.0, 0.0)  # m/s
    angular_velocity: Numbers = (0.0, 0.0, 0.0)  # rad/s, world
    angle: float = 0.0  # rad, about z
    any_orientation: bool = False  # spatial: any rotation, uniformly
    # A body whose draws also move this one, as one rigid piece; -1: none. Chains are followed: the
    # draws of that body's own with_body move this one, too.
    with_body: BodyRef = -1


@dataclass(slots=True, kw_only=True)
class Body:
    """A rigid body. Its mass is computed from its shapes unless ``mass_properties`` is set."""

    name: str = ""
    motion: Motion = "dynamic"
    enabled: bool = True  # False: absent until Batch.spawn or Batch.set_enabled
    position: Numbers = (0.0, 0.0, 0.0)  # m, of the body frame in the world
    rotation: Numbers = (1.0, 0.0, 0.0, 0.0)  # (w, x, y, z); need not be unit
    linear_velocity: Numbers = (0.0, 0.0, 0.0)  # m/s, of the centre of mass
    angular_velocity: Numbers = (0.0, 0.0, 0.0)  # rad/s
    shapes: list[Shape] = field(default_factory=list)
    mass_properties: Optional[MassProperties] = None
    gravity_scale: float = 1.0
    linear_drag: float = 0.0  # 1/s
    angular_drag: float = 0.0  # 1/s
    jitter: Jitter = field(default_factory=Jitter)
