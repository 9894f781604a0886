"""Queries on single shapes, without a Batch: overlap, distance, contact manifold and ray cast.

    from manyworlds import query
    ball, box = mw.Sphere(0.5), mw.Box((1, 1, 1))
    query.distance(ball, mw.Pose((3, 0, 0)), box).distance  # 1.5

A pose is that of the shape's body. ``Shape.position`` and ``rotation`` are used; material, filter and
density are ignored. A capsule exists in both spaces and takes that of the other shape. For two capsules,
``space`` ("planar", "spatial") decides. Queries use double precision. Manifolds and rays use single
precision if the library has no float64 kernels. All raise SceneError if ``Scene.validate`` would reject a
shape or pose, ValueError for a pair without a meaning (two planes), TypeError.

A query takes some microseconds. ``manifold`` takes some hundreds, because it sets up a world of two bodies.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, NamedTuple, Optional, Union, get_args

import numpy as np
from numpy.typing import NDArray

from . import _core
from .names import Numbers, Space
from .scene import Ray
from .shapes import Geometry, Shape

Vector = NDArray[np.float64]

MANIFOLD_POINT = np.dtype(
    [
        ("normal", np.float64, (3,)),  # unit, from A to B
        ("point", np.float64, (3,)),  # m, world, half way between the surfaces
        ("separation", np.float64),  # m, negative where the shapes overlap
        ("feature", np.int32),  # id of the touching features; stays the same during motion
    ]
)


@dataclass(slots=True)
class Pose:
    """Position and rotation of a body."""

    position: Numbers = (0.0, 0.0, 0.0)  # m, of the body frame in the world
    rotation: Numbers = (1.0, 0.0, 0.0, 0.0)  # (w, x, y, z); need not be unit


class Separation(NamedTuple):
    """Distance of two shapes: point_b = point_a + distance * normal."""

    distance: float  # m; negative: minus the shortest displacement that separates them
    point_a: Vector  # (3,) m, world: the nearest points; the deepest ones if the shapes overlap
    point_b: Vector
    normal: Vector  # (3,) unit, from A to B


class RayHit(NamedTuple):
    """The hit of a ray."""

    distance: float  # m; 0 if the ray starts inside
    normal: Vector  # (3,) unit, out of the shape, world


_HERE = Pose()
AnyShape = Union[Shape, Geometry]


def _shape(given: AnyShape) -> object:
    return Shape(geometry=given) if isinstance(given, get_args(Geometry)) else given


def distance(
    a: AnyShape,
    pose_a: Pose,
    b: AnyShape,
    pose_b: Pose = _HERE,
    space: Optional[Space] = None,
) -> Separation:
    """Distance and nearest points of two shapes, by closed forms over the features of both.

    A terrain counts as its line: a shape completely behind the line is separated from it.
    """
    far, *vectors = _core.distance(_shape(a), pose_a, _shape(b), pose_b, space)
    return Separation(far, *map(np.array, vectors))


def overlap(
    a: AnyShape,
    pose_a: Pose,
    b: AnyShape,
    pose_b: Pose = _HERE,
    space: Optional[Space] = None,
) -> bool:
    """Whether two shapes touch or overlap: ``distance(...).distance <= 0``."""
    return _core.overlap(_shape(a), pose_a, _shape(b), pose_b, space)


def manifold(
    a: AnyShape,
    pose_a: Pose,
    b: AnyShape,
    pose_b: Pose = _HERE,
    margin: float = 0.0,
    space: Optional[Space] = None,
) -> NDArray[Any]:
    """The contact points of two shapes, (points,) of dtype MANIFOLD_POINT.

    The collision kernels of the step find them. Points of a separation above ``margin`` m are omitted.
    At least one of the shapes must be of a type that can move.
    """
    points = _core.manifold(_shape(a), pose_a, _shape(b), pose_b, margin, space)
    return np.array(points, MANIFOLD_POINT)


def ray_cast(
    shape: AnyShape, pose: Pose, ray: Ray, space: Optional[Space] = None
) -> Optional[RayHit]:
    """The hit of a ray, in the world, as for observed rays. None if it misses.

    Ignores ``Ray.body`` and ``mask``.
    """
    hit = _core.ray_cast(_shape(shape), pose, ray, space)
    if hit is None:
        return None
    far, normal = hit  # type: ignore[misc]
    return RayHit(far, np.array(normal))
