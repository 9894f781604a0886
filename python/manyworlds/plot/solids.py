"""What shapes look like: corners and a radius, faces, outlines. Lengths in m, arrays (n, 3) or (n, 2)."""

from __future__ import annotations

from itertools import combinations
from typing import Any, NamedTuple, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from ..shapes import Geometry, HalfPlane, HeightField, Plane, Segment, Shape, Terrain

Floats = NDArray[np.float64]
Pose = tuple[Floats, Floats]  # (rotation (3, 3), position (3,)) in the world
PALETTE = ["#e4572e", "#f3a712", "#29335c", "#669bbc", "#76b041", "#8f5aa8", "#b08968"]
FIXED = "#8d99ae"
_ROUND = 24  # corners that stand for a circle
_AROUND = np.linspace(0, 2 * np.pi, _ROUND, endpoint=False)
_CIRCLE = np.stack([np.cos(_AROUND), np.sin(_AROUND)], axis=1)
# Of a unit ball, closed: a line that shows how it turns.
EQUATOR = np.pad(np.concatenate([_CIRCLE, _CIRCLE[:1]]), ((0, 0), (0, 1)))


def rotation_of(quaternion: ArrayLike) -> Floats:
    """The matrix (3, 3) of (w, x, y, z), which need not be unit."""
    q = np.asarray(quaternion, float)
    w, (x, y, z) = q[0], q[1:]
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    unit: Floats = np.eye(3) + (2 / (q @ q)) * (w * cross + cross @ cross)
    return unit


def corners_of(geometry: Geometry, planar: bool) -> Optional[tuple[Floats, float]]:
    """(corners (n, 3), radius): the geometry is all points within ``radius`` of their convex hull.

    None for those that are not convex or have no end.
    """
    found = _core.outline(geometry, planar)
    return None if found is None else (np.array(found[0], float), found[1])


def resized(geometry: Geometry, size: Floats) -> Geometry:
    """The geometry with other numbers of the field "size", (3,)."""
    other: Geometry = _core.resized(geometry, [float(x) for x in size])
    return other


def faces_of(corners: Floats) -> list[NDArray[np.intp]]:
    """Faces of the convex hull of corners (n, 3), counter-clockwise seen from outside.

    Every plane through three corners with all the others on one side is a face: plain, and quick
    enough for the 64 that a shape may have.
    """
    triples = np.array(list(combinations(range(len(corners)), 3)), dtype=np.intp).reshape(-1, 3)
    a, b, c = (corners[triples[:, i]] for i in range(3))
    normals = np.cross(b - a, c - a)
    lengths = np.linalg.norm(normals, axis=1)
    size = np.ptp(corners, axis=0).max()
    wide = lengths > 1e-9 * size**2
    normals, a = normals[wide] / lengths[wide, None], a[wide]
    heights = normals @ corners.T - np.sum(normals * a, axis=1)[:, None]  # of corners above planes
    flat = 1e-6 * size
    found: dict[tuple[int, ...], NDArray[np.intp]] = {}
    for sign in (1, -1):
        for i in np.flatnonzero((sign * heights <= flat).all(axis=1)):
            on_it = np.flatnonzero(np.abs(heights[i]) <= flat)
            if tuple(on_it) not in found:
                found[tuple(on_it)] = _sorted_around(corners, on_it, sign * normals[i])
    return list(found.values())


def _sorted_around(corners: Floats, chosen: NDArray[np.intp], normal: Floats) -> NDArray[np.intp]:
    along, across = tangents_of(normal)
    from_middle = corners[chosen] - corners[chosen].mean(axis=0)
    return chosen[np.argsort(np.arctan2(from_middle @ across, from_middle @ along))]


def tangents_of(normal: Floats) -> tuple[Floats, Floats]:
    """Two unit vectors that are right-handed with a unit normal."""
    along = np.cross(normal, np.eye(3)[np.argmin(np.abs(normal))])
    along /= np.linalg.norm(along)
    return along, np.cross(normal, along)


def outline_of(points: Floats, radius: float) -> Floats:
    """The convex outline of all within ``radius`` of points (n, 2), counter-clockwise."""
    if radius > 0:
        points = (points[:, None] + radius * _CIRCLE).reshape(-1, 2)
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
    """A shape of a body, ready to be placed."""

    body: int  # of the scene
    index: int  # of the shape among all shapes of the scene
    geometry: Geometry
    rotation: Floats  # in the body
    position: Floats
    corners: Floats  # (n, 3), shape frame; empty: has no end
    radius: float
    faces: list[NDArray[np.intp]]  # of corners; none: only an outline is drawn
    color: str

    @property
    def is_line(self) -> bool:
        """Whether it has no inside."""
        return isinstance(self.geometry, (Segment, Terrain))


def placed(solid: Solid, corners: Floats, rotation: Floats, position: Floats) -> Floats:
    """Corners of a shape in the world, whose body has this pose."""
    world: Floats = (corners @ solid.rotation.T + solid.position) @ rotation.T + position
    return world


def surface(solid: Solid, rotation: Floats, position: Floats) -> tuple[Floats, float]:
    """Normal and offset in the world of a plane or a half-plane."""
    assert isinstance(solid.geometry, (Plane, HalfPlane))
    given = np.zeros(3)
    given[: len(solid.geometry.normal)] = solid.geometry.normal
    normal = rotation @ solid.rotation @ given
    shift = float(normal @ (rotation @ solid.position + position))
    return normal, solid.geometry.offset + shift


def solid_of(body: int, index: int, shape: Shape, fixed: bool, planar: bool) -> Solid:
    """Shape ``index`` of a scene, of body ``body``."""
    geometry = shape.geometry
    convex = corners_of(geometry, planar)
    faces: list[NDArray[np.intp]] = []
    radius = 0.0
    if convex is not None:
        corners, radius = convex
        if not planar and radius == 0:
            faces = faces_of(corners)
    elif isinstance(geometry, HeightField):
        corners, faces = _grid(geometry)
    elif isinstance(geometry, Segment):
        corners = np.pad(np.array([geometry.a, geometry.b], float), ((0, 0), (0, 1)))
    elif isinstance(geometry, Terrain):
        line = np.asarray(geometry.points, float)
        corners = np.pad(
            np.concatenate([line, line[:1]]) if geometry.loop else line, ((0, 0), (0, 1))
        )
    else:
        corners = np.zeros((0, 3))
    return Solid(
        body,
        index,
        geometry,
        rotation_of(shape.rotation),
        np.asarray(shape.position, float),
        corners,
        radius,
        faces,
        FIXED if fixed else PALETTE[body % len(PALETTE)],
    )


def _grid(field: HeightField) -> tuple[Floats, list[NDArray[np.intp]]]:
    """Corners of a height field and its cells' two triangles each."""
    heights = np.asarray(field.heights, float).reshape(-1, field.columns)
    rows, columns = heights.shape
    x = (np.arange(columns) - (columns - 1) / 2) * field.cell[0]
    y = (np.arange(rows) - (rows - 1) / 2) * field.cell[1]
    corners = np.stack([*np.meshgrid(x, y), heights], axis=-1).reshape(-1, 3)
    a = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).reshape(-1)
    triangles = np.concatenate(
        [
            np.stack([a, a + 1, a + columns + 1], axis=1),
            np.stack([a, a + columns + 1, a + columns], axis=1),
        ]
    )
    return corners, list(triangles)
