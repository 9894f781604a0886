"""Lines and patches, each with its depth, of shapes at given poses."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..shapes import Cylinder, HeightField
from . import solids
from .solids import Floats, Pose, Solid

View = tuple[tuple[float, float], tuple[float, float]]  # (left, right), (bottom, top), m

_GROUND = "#cfd4dd"
_LIGHT = np.array([0.3, -0.5, 0.8]) / np.linalg.norm([0.3, -0.5, 0.8])
_BEHIND = -np.inf
_LINES = 40  # lines of a floor's grid on each side


class Piece(NamedTuple):
    """A patch, or a line."""

    depth: float  # distance towards the viewer
    points: Floats  # (n, 2)
    fill: Any  # (red, green, blue) of 0 to 1; None: a line
    edge: Any
    alpha: float


class Eye(NamedTuple):
    """View direction: unit vectors to the right and up in the picture and towards the viewer."""

    right: Floats
    up: Floats
    towards: Floats
    planar: bool

    def flat(self, points: Floats) -> Floats:
        """Positions of points (..., 3) in the picture, (..., 2)."""
        return np.stack([points @ self.right, points @ self.up], axis=-1)


def pieces_of(solid: Solid, pose: Pose, eye: Eye) -> list[Piece]:
    """Pieces of a bounded solid whose body has this pose."""
    points = solids.placed(solid, solid.points, *pose)
    if solid.is_line:
        return [Piece(0.0, eye.flat(points), None, rgb("#555b66"), 1.0)]
    if solid.patches:
        return _shaded(solid, points, eye)
    return _round(solid, points, pose, eye)


def _alpha(solid: Solid, eye: Eye) -> float:
    see_through = solid.color == solids.FIXED and not eye.planar
    return 0.25 if see_through and not isinstance(solid.geometry, HeightField) else 1.0


def _shaded(solid: Solid, corners: Floats, eye: Eye) -> list[Piece]:
    """The visible faces, darker at larger angles to the light."""
    pieces = []
    color = np.array(rgb(solid.color))
    for face in solid.patches:
        ring = corners[face]
        normal = np.cross(ring[1] - ring[0], ring[2] - ring[0])
        if normal @ eye.towards <= 0:
            continue
        lit = 0.65 + 0.35 * max(0.0, float(normal @ _LIGHT / np.linalg.norm(normal)))
        of_round_side = isinstance(solid.geometry, (HeightField, Cylinder)) and len(face) == 3
        edge = (lit if of_round_side else 0.5) * color
        depth = float(ring.mean(axis=0) @ eye.towards)
        outline = eye.flat(np.concatenate([ring, ring[:1]]))
        pieces.append(Piece(depth, outline, lit * color, edge, _alpha(solid, eye)))
    return pieces


def _round(solid: Solid, points: Floats, pose: Pose, eye: Eye) -> list[Piece]:
    """The outline of a round or flat shape, and marks that show its rotation."""
    color = np.array(rgb(solid.color))
    outline = solids.outline_of(eye.flat(points))
    middle = points.mean(axis=0)
    depth = float(middle @ eye.towards)
    closed = np.concatenate([outline, outline[:1]])
    pieces = [Piece(depth, closed, color, 0.5 * color, _alpha(solid, eye))]
    for line in solid.look.marks:
        mark = solids.placed(solid, line, *pose)
        if not eye.planar:
            mark = _seen_part(mark, (mark - middle) @ eye.towards >= 0)
        pieces.append(Piece(depth, eye.flat(mark), None, 0.5 * color, 1.0))
    return pieces


def half_plane(normal: Floats, offset: float, view: View, eye: Eye) -> list[Piece]:
    """The visible part of a half-plane."""
    (left, right), (bottom, top) = view
    reach = 2 * max(right - left, top - bottom)
    middle = _middle(view, eye)
    foot = middle + (offset - middle @ normal) * normal
    along, deep = reach * np.cross(normal, eye.towards), -reach * normal
    corners = np.stack([foot - along, foot + along, foot + along + deep, foot - along + deep])
    ground = rgb(_GROUND)
    return [Piece(_BEHIND, eye.flat(corners), ground, ground, 1.0)]


def floor(normal: Floats, offset: float, view: View, eye: Eye) -> list[Piece]:
    """A grid on a plane that is a floor seen from above. Walls are omitted: they would hide bodies."""
    if normal[2] < 0.5 or normal @ eye.towards < 0.01:
        return []
    (left, right), _ = view
    middle, (x, y, z) = _middle(view, eye), np.eye(3)
    # Where the line of sight through the middle of the picture meets the plane.
    foot = middle + (offset - middle @ normal) / (normal @ eye.towards) * eye.towards
    cell = 10 ** np.floor(np.log10(right - left))
    pieces = []
    for one, other in ((x, y), (y, x)):
        along, across = (d - (d @ normal) / normal[2] * z for d in (one, other))
        first = np.round(foot @ one / cell) * cell - foot @ one
        for shift in first + cell * np.arange(-_LINES, _LINES + 1):
            line = foot + shift * along + np.array([[-1.0], [1.0]]) * _LINES * cell * across
            pieces.append(Piece(_BEHIND, eye.flat(line), None, rgb(_GROUND), 1.0))
    return pieces


def _middle(view: View, eye: Eye) -> Floats:
    """A point of the world in the middle of the picture."""
    (left, right), (bottom, top) = view
    middle: Floats = (left + right) / 2 * eye.right + (bottom + top) / 2 * eye.up
    return middle


def _seen_part(line: Floats, seen: NDArray[np.bool_]) -> Floats:
    """The visible part of a line (n, 3) with contiguous visible points; the line may be closed."""
    if seen.all() or not (line[0] == line[-1]).all():
        return line if seen.all() else line[seen]
    ring, inside = line[:-1], seen[:-1]
    start = -int(np.flatnonzero(~inside)[0])
    return np.roll(ring, start, axis=0)[np.roll(inside, start)]


def rgb(color: str) -> tuple[float, ...]:
    """(red, green, blue) of 0 to 1 of "#rrggbb"."""
    return tuple(int(color[i : i + 2], 16) / 255 for i in (1, 3, 5))
