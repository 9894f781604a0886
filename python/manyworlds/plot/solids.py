"""Surfaces, faces and outlines of shapes. Lengths in m, arrays (n, 3) or (n, 2)."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from ..shapes import (
    Capsule,
    Ellipsoid,
    Geometry,
    HalfPlane,
    Plane,
    Segment,
    Shape,
    Sphere,
    Terrain,
)
from ..surfaces import Surface, surface

Floats = NDArray[np.float64]
Pose = tuple[Floats, Floats]  # (rotation (3, 3), position (3,)) in the world
PALETTE = ["#e4572e", "#f3a712", "#29335c", "#669bbc", "#76b041", "#8f5aa8", "#b08968"]
FIXED = "#8d99ae"
_ROUND = 24  # segments of a circle


def rotation_of(quaternion: ArrayLike) -> Floats:
    """The rotation matrix (3, 3) of a quaternion (w, x, y, z), which need not be unit."""
    q = np.asarray(quaternion, float)
    w, (x, y, z) = q[0], q[1:]
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    unit: Floats = np.eye(3) + (2 / (q @ q)) * (w * cross + cross @ cross)
    return unit


def resized(geometry: Geometry, size: Floats) -> Geometry:
    """The geometry with other values of the field "size", (3,)."""
    other: Geometry = _core.resized(geometry, [float(x) for x in size])
    return other


def patches_of(look: Surface) -> list[NDArray[np.intp]]:
    """Polygons that cover a surface, as indices of points: its flat faces, and triangles elsewhere."""
    flat = [np.arange(first, first + count) for first, count in look.faces]
    in_face = np.zeros(len(look.points), bool)
    for face in flat:
        in_face[face] = True
    rest = look.triangles[~in_face[look.triangles[:, 0]]] if len(look.triangles) else []
    return flat + [np.asarray(triangle, np.intp) for triangle in rest]


def outline_of(points: Floats) -> Floats:
    """The convex outline of points (n, 2), counter-clockwise."""
    return points[_convex(points)]


def _convex(points: Floats) -> list[int]:
    """Indices of the convex hull of points (n, 2) (Andrew's monotone chain)."""
    order = np.lexsort((points[:, 1], points[:, 0]))

    def half(indices: Any) -> list[int]:
        chain: list[int] = []
        for i in indices:
            while len(chain) > 1:
                p, q, r = points[chain[-2]], points[chain[-1]], points[i]
                if (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]) > 0:
                    break
                chain.pop()
            chain.append(int(i))
        return chain[:-1]

    return half(order) + half(order[::-1]) or [0]


class Solid(NamedTuple):
    """A shape of a body with its surface."""

    body: int  # index in the scene
    index: int  # index among all shapes of the scene
    geometry: Geometry
    rotation: Floats  # in the body frame
    position: Floats
    look: Surface  # empty: unbounded
    patches: list[NDArray[np.intp]]  # indices of points; empty: only an outline is drawn
    color: str

    @property
    def is_line(self) -> bool:
        """Whether the shape has no inside."""
        return isinstance(self.geometry, (Segment, Terrain))

    @property
    def points(self) -> Floats:
        """Points (n, 3) in the shape frame; for a line, its points."""
        return np.concatenate(self.look.lines) if self.is_line else self.look.points


def placed(solid: Solid, corners: Floats, rotation: Floats, position: Floats) -> Floats:
    """Corners of a shape in the world, for this pose of its body."""
    world: Floats = (corners @ solid.rotation.T + solid.position) @ rotation.T + position
    return world


def half_space_of(solid: Solid, rotation: Floats, position: Floats) -> tuple[Floats, float]:
    """Normal and offset of a plane or half-plane, in the world."""
    assert isinstance(solid.geometry, (Plane, HalfPlane))
    given = np.zeros(3)
    given[: len(solid.geometry.normal)] = solid.geometry.normal
    normal = rotation @ solid.rotation @ given
    shift = float(normal @ (rotation @ solid.position + position))
    return normal, solid.geometry.offset + shift


def look_of(geometry: Geometry, planar: bool) -> Surface:
    """The surface of a geometry; empty for unbounded ones."""
    look = surface(geometry, "planar" if planar else "spatial", around=_ROUND)
    if not isinstance(geometry, (Plane, HalfPlane)):
        return look
    return Surface(*(part[:0] for part in look))  # type: ignore[arg-type]


def solid_of(body: int, index: int, shape: Shape, fixed: bool, planar: bool) -> Solid:
    """The Solid of shape ``index`` of a scene, on body ``body``."""
    look = look_of(shape.geometry, planar)
    is_round = planar or isinstance(shape.geometry, (Sphere, Capsule, Ellipsoid))
    return Solid(
        body,
        index,
        shape.geometry,
        rotation_of(shape.rotation),
        np.asarray(shape.position, float),
        look,
        [] if is_round else patches_of(look),
        FIXED if fixed else PALETTE[body % len(PALETTE)],
    )
