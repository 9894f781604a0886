"""Queries on single shapes, outside of any Batch: do two overlap, how far are they apart, where would
they touch, where does a ray hit.

    from manyworlds import query
    ball, box = mw.Sphere(0.5), mw.Box((1, 1, 1))
    query.distance(ball, mw.Pose((3, 0, 0)), box).distance  # 1.5

A pose places the body that the shape belongs to; ``Shape.position`` and ``rotation`` count as well, its
material, filter and density do not. A shape that is neither of space nor of the plane alone (a capsule)
takes the other's; of two such ``space`` ("planar", "spatial") decides. Double precision; manifolds and
rays in single where the library was built without float64. All raise SceneError for a shape or pose that
``Scene.validate`` would not accept, ValueError for a pair that makes no sense (two planes), TypeError.

Some microseconds each, ``manifold`` some hundreds: it sets up a world of two bodies.
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
        ("feature", np.int32),  # which features touch; equal ids persist in motion
    ]
)


@dataclass(slots=True)
class Pose:
    """Where a body is."""

    position: Numbers = (0.0, 0.0, 0.0)  # m, of the body frame in the world
    rotation: Numbers = (1.0, 0.0, 0.0, 0.0)  # (w, x, y, z); need not be unit


class Separation(NamedTuple):
    """How two shapes lie to each other: point_b = point_a + distance * normal."""

    distance: float  # m; negative: the shortest way that takes them apart, times -1
    point_a: Vector  # (3,) m, world: the nearest points, when they overlap the deepest ones
    point_b: Vector
    normal: Vector  # (3,) unit, from A to B


class RayHit(NamedTuple):
    """Where a ray hits a shape."""

    distance: float  # m; 0 where it begins inside
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
    """How far two shapes are apart, and where; closed forms over the features of both.

    A terrain is its line: what is wholly behind it is apart from it.
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
    """The points in which the step would let two shapes touch, (points,) of dtype MANIFOLD_POINT.

    Those no farther apart than ``margin`` m, found by the step's own collision kernels. One of the
    shapes at least must be able to move.
    """
    points = _core.manifold(_shape(a), pose_a, _shape(b), pose_b, margin, space)
    return np.array(points, MANIFOLD_POINT)


def ray_cast(
    shape: AnyShape, pose: Pose, ray: Ray, space: Optional[Space] = None
) -> Optional[RayHit]:
    """Where a ray of the world hits a shape, as observed rays do; None where it misses.

    ``Ray.body`` and ``mask`` do not count.
    """
    hit = _core.ray_cast(_shape(shape), pose, ray, space)
    if hit is None:
        return None
    far, normal = hit  # type: ignore[misc]
    return RayHit(far, np.array(normal))
