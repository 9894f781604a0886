"""Shapes: geometries, materials, filters. Lengths in m, in the shape frame."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Optional, Union

from .names import Numbers

__all__ = [
    "Box",
    "Capsule",
    "Circle",
    "Compliance",
    "Cylinder",
    "Ellipsoid",
    "Filter",
    "Geometry",
    "HalfPlane",
    "HeightField",
    "Hull",
    "Material",
    "Plane",
    "Polygon",
    "Segment",
    "Shape",
    "SoftContact",
    "Sphere",
    "Terrain",
]

# -- in space


@dataclass(slots=True)
class Sphere:
    """A ball. Spatial."""

    radius: float = 0.5  # m


@dataclass(slots=True)
class Box:
    """A box centred on the shape frame. Spatial."""

    half_extents: Numbers = (0.5, 0.5, 0.5)  # m


@dataclass(slots=True)
class Plane:
    """The solid of all points p with normal . p <= offset. Spatial, fixed bodies only."""

    normal: Numbers = (0.0, 0.0, 1.0)  # unit, pointing out of the solid
    offset: float = 0.0  # m


@dataclass(slots=True)
class Capsule:
    """Points within ``radius`` of a line of length 2 half_length: along z in space, y in the plane."""

    radius: float = 0.25  # m
    half_length: float = 0.5  # m, without the round ends


@dataclass(slots=True)
class Cylinder:
    """A cylinder about z of the shape frame. Spatial."""

    radius: float = 0.5  # m
    half_length: float = 0.5  # m


@dataclass(slots=True)
class Ellipsoid:
    """An ellipsoid centred on the shape frame. Spatial."""

    radii: Numbers = (0.5, 0.4, 0.3)  # m, along its axes


@dataclass(slots=True)
class Hull:
    """The convex hull of 4 to 8192 vertices (``make_hull`` finds them). Spatial."""

    vertices: Sequence[Numbers] = field(default_factory=list)  # m, (n, 3)


@dataclass(slots=True)
class HeightField:
    """The solid below triangles over a grid of points, centred. Spatial, fixed bodies only."""

    heights: Numbers = field(default_factory=list)  # m, flat: x varies fastest
    columns: int = 2  # points along x
    cell: Numbers = (1.0, 1.0)  # m, between points along x and y


# -- in the plane


@dataclass(slots=True)
class Circle:
    """A disc. Planar."""

    radius: float = 0.5  # m


@dataclass(slots=True)
class Polygon:
    """A convex polygon of 3 to 8 vertices, and all points within ``radius`` of it. Planar."""

    vertices: Sequence[Numbers] = field(default_factory=list)  # m, (n, 2), counter-clockwise
    radius: float = 0.0  # m

    @staticmethod
    def box(half_x: float, half_y: float) -> Polygon:
        """A rectangle centred on the shape frame, with half extents in m."""
        x, y = float(half_x), float(half_y)
        return Polygon([(-x, -y), (x, -y), (x, y), (-x, y)])


@dataclass(slots=True)
class HalfPlane:
    """The solid of all points p with normal . p <= offset. Planar, fixed bodies only."""

    normal: Numbers = (0.0, 1.0)  # unit, pointing out of the solid
    offset: float = 0.0  # m


@dataclass(slots=True)
class Segment:
    """A line that is solid from both sides. Planar, fixed bodies only."""

    a: Numbers = (-0.5, 0.0)  # m
    b: Numbers = (0.5, 0.0)  # m


@dataclass(slots=True)
class Terrain:
    """A chain of segments, solid on the right of its point order. Planar, fixed bodies only."""

    points: Sequence[Numbers] = field(default_factory=list)  # m, (n, 2)
    loop: bool = False  # connect the last point to the first


Geometry = Union[
    Sphere,
    Box,
    Plane,
    Circle,
    Polygon,
    HalfPlane,
    Capsule,
    Segment,
    Terrain,
    Cylinder,
    Hull,
    HeightField,
    Ellipsoid,
]


@dataclass(slots=True, kw_only=True)
class Compliance:
    """Softness of a constraint of the newton solver: MuJoCo's solref and solimp.

    A constraint with violation r has the reference acceleration -damping v - stiffness d(r) r, and
    yields to the fraction 1 - d(r) of the forces against it. The impedance d increases from
    min_impedance at 0 to max_impedance at ``width``, along a power curve with its inflection at
    ``midpoint``.
    """

    time_constant: float = 0.02  # s; if both are negative: -stiffness, 1/s^2
    damping_ratio: float = 1.0  # if both are negative: -damping, 1/s
    min_impedance: float = 0.9  # in (0, 1)
    max_impedance: float = 0.95  # in (0, 1)
    width: float = 0.001  # m or rad
    midpoint: float = 0.5  # fraction of the width, in (0, 1)
    power: float = 2.0  # whole, 1 to 100


@dataclass(slots=True, kw_only=True)
class SoftContact:
    """Contacts of the newton solver, combined for a pair as in MuJoCo.

    The material of higher priority decides. If priorities are equal, the pair has the larger friction
    and dimensions, and the mean of the compliances by weight, or the smaller of two direct ones.
    Margins are added.
    """

    dimensions: int = 3  # 1: no friction, 3: friction along the surface
    compliance: Compliance = field(default_factory=Compliance)
    margin: float = 0.0  # m, separation below which a contact acts
    gap: float = 0.0  # m, extra distance at which MuJoCo lists a contact; no effect on the motion
    priority: int = 0
    weight: float = 1.0  # weight of the compliance in the mean


@dataclass(slots=True)
class Material:
    """Contact properties of a shape.

    A contact with the normal force N resists rolling by moments up to rolling_resistance N, and
    spinning about the normal up to torsional_resistance N. They are MuJoCo's rolling and torsional
    friction. Box2D's rollingResistance is rolling_resistance over the radius. A ball of radius R
    rests on slopes up to atan(rolling_resistance / R). The newton solver refuses both.
    """

    friction: float = 0.6  # Coulomb coefficient; a pair takes the geometric mean
    restitution: float = 0.0  # 0 to 1; a pair takes the larger
    rolling_resistance: float = 0.0  # m; a pair takes the larger
    torsional_resistance: float = 0.0  # m, spatial scenes only; a pair takes the larger
    # newton solver only, which uses the larger friction and no restitution
    soft: SoftContact = field(default_factory=SoftContact)


@dataclass(slots=True)
class Filter:
    """Two shapes collide if the category of each is in the mask of the other."""

    category: int = 1
    mask: int = 0xFFFFFFFF


@dataclass(slots=True, kw_only=True)
class Shape:
    """A geometry at a pose on a body."""

    geometry: Geometry = field(default_factory=Sphere)
    position: Numbers = (0.0, 0.0, 0.0)  # m, in the body frame
    rotation: Numbers = (1.0, 0.0, 0.0, 0.0)  # (w, x, y, z), in the body frame; need not be unit
    density: Optional[float] = None  # kg/m^3 (planar: kg/m^2); None: Options.density
    material: Material = field(default_factory=Material)
    filter: Filter = field(default_factory=Filter)
    name: str = ""
