"""Triangles and lines of geometries, for other renderers.

    look = mw.surface(mw.Box((1, 2, 3)))
    look.points[look.triangles]  # (12, 3, 3)
"""

from __future__ import annotations

from typing import NamedTuple, Sequence

import numpy as np
from numpy.typing import NDArray

from . import _core
from .names import Numbers, Space
from .shapes import Geometry

__all__ = ["Surface", "surface"]

_LOW, _HIGH = (-10.0, -10.0, -10.0), (10.0, 10.0, 10.0)


class Surface(NamedTuple):
    """Triangles and lines in the shape frame, in m. Points of round shapes are on the shape."""

    points: NDArray[np.float64]  # (n, 3)
    normals: NDArray[np.float64]  # (n, 3) unit, outward; in the plane: z
    # (t, 3) indices of points, counter-clockwise seen from outside; segments, terrains have none
    triangles: NDArray[np.int32]
    # (f, 2) first point and count: flat faces, convex polygons of consecutive points
    faces: NDArray[np.int32]
    # each (k, 3): edges of flat faces, in the plane outlines; closed ones repeat the first point
    lines: list[NDArray[np.float64]]
    marks: list[NDArray[np.float64]]  # lines that make the rotation of a round shape visible


def surface(
    geometry: Geometry,
    space: Space = "spatial",
    *,
    around: int = 24,
    low: Numbers = _LOW,
    high: Numbers = _HIGH,
) -> Surface:
    """The surface of a geometry; for a planar one, its inside and outline.

    space      space of a capsule, which exists in both
    around     segments of a full circle, 8 to 1024
    low, high  (3,) m, shape frame: the box to which planes and half-planes are clipped

    Raises ValueError if a value is out of range, SceneError if ``Scene.validate`` would reject the
    geometry, TypeError.
    """
    points, normals, triangles, faces, lines, marks = _core.surface(
        geometry, space, around, low, high
    )
    return Surface(points, normals, triangles, faces, _chains(lines), _chains(marks))


def _chains(found: Sequence[object]) -> list[NDArray[np.float64]]:
    return [np.asarray(line, np.float64) for line in found]
