"""What geometries look like, as triangles and lines: for those who draw worlds by other means.

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
    """In the shape frame, lengths in m. Round shapes are inscribed: their points lie on the shape."""

    points: NDArray[np.float64]  # (n, 3)
    normals: NDArray[np.float64]  # (n, 3) unit, outward; planar: z
    # (t, 3) of points, counter-clockwise seen from outside; segments and terrains have none
    triangles: NDArray[np.int32]
    # (f, 2) first point and number of them: flat faces, convex polygons of consecutive points
    faces: NDArray[np.int32]
    # each (k, 3): edges between flat faces, in the plane outlines; closed ones end where they begin
    lines: list[NDArray[np.float64]]
    marks: list[NDArray[np.float64]]  # more of them, which show how a round shape turns


def surface(
    geometry: Geometry,
    space: Space = "spatial",
    *,
    around: int = 24,
    low: Numbers = _LOW,
    high: Numbers = _HIGH,
) -> Surface:
    """The surface of a geometry, of a planar one its inside and outline.

    space      of a capsule, which both spaces have
    around     corners that stand for a full circle, 8 to 1024
    low, high  (3,) m, shape frame: the box at which planes and half-planes end

    Raises ValueError for numbers out of range, SceneError for a geometry that ``Scene.validate``
    would not accept, TypeError.
    """
    points, normals, triangles, faces, lines, marks = _core.surface(
        geometry, space, around, low, high
    )
    return Surface(points, normals, triangles, faces, _chains(lines), _chains(marks))


def _chains(found: Sequence[object]) -> list[NDArray[np.float64]]:
    return [np.asarray(line, np.float64) for line in found]
