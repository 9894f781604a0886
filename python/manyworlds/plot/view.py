"""The default view of a picture."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Optional

import numpy as np

from ..joints import BallJoint, DistanceJoint, HingeJoint
from ..scene import Scene
from ..shapes import HalfPlane, Plane
from . import solids
from .pieces import Eye, View
from .solids import Floats, Pose, Solid

_MAX_AROUND = 1  # most widening by the other bodies, relative to the extent of the moving ones
_INSET = 0.15  # least distance of the leading body from the border, relative to the view's size


def view_of(
    scene: Scene, parts: Sequence[Solid], poses: Sequence[Pose], eye: Eye, size: Sequence[int]
) -> View:
    """The view around the moving bodies, with their jitter, the reach about their pivots and the floor
    below. Other bodies widen it at most by ``_MAX_AROUND``. ``poses``: initial poses of the scene's
    bodies. ``size``: size of the picture, whose aspect ratio the view has."""
    dynamic = [body.motion == "dynamic" for body in scene.bodies]
    room = [_room_of(scene, b, parts, poses) for b in range(len(scene.bodies))]
    moving = [points for points, moves in zip(room, dynamic) if moves] + _swings(scene, room, poses)
    others = [points for points, moves in zip(room, dynamic) if not moves]
    above = np.concatenate([*moving, np.zeros((0, 3))])
    for part in parts:
        if isinstance(part.geometry, (Plane, HalfPlane)):
            normal, offset = solids.half_space_of(part, *poses[part.body])
            if normal[1 if eye.planar else 2] > 0.5:
                moving.append(above + (offset - above @ normal)[:, None] * normal)
    points, rest = (eye.flat(np.concatenate([*p, np.zeros((0, 3))])) for p in (moving, others))
    if len(points) == 0:
        points = rest if len(rest) else np.array([[-1.0, -1.0], [1.0, 1.0]])
    low, high = points.min(axis=0), points.max(axis=0)
    most = _MAX_AROUND * max(*(high - low), 1e-3)
    points = np.concatenate([points, np.clip(rest, low - most, high + most)])
    low, high = points.min(axis=0), points.max(axis=0)
    # Widen one axis to the aspect ratio of the picture.
    middle, half = (low + high) / 2, 0.55 * np.maximum(high - low, 1e-3)
    width, height = size
    half = np.maximum(half, half[::-1] * np.array([width / height, height / width]))
    (left, bottom), (right, top) = (middle - half).tolist(), (middle + half).tolist()
    return (left, right), (bottom, top)


def scrolled(view: View, leader: Optional[Pose], eye: Eye) -> View:
    """The view, moved so that the leading body stays away from its border."""
    if leader is None:
        return view
    (left, right), (bottom, top) = view
    low, high = np.array([left, bottom]), np.array([right, top])
    inset = _INSET * (high - low)
    at = eye.flat(leader[1])
    dx, dy = (at - np.clip(at, low + inset, high - inset)).tolist()
    return (left + dx, right + dx), (bottom + dy, top + dy)


def _around(middle: Floats, radius: float) -> Floats:
    """Points with the extent of a ball."""
    return middle + radius * np.concatenate([np.eye(3), -np.eye(3)])


def _room_of(scene: Scene, b: int, parts: Sequence[Solid], poses: Sequence[Pose]) -> Floats:
    """Points around the initial extent of a body, with its jitter."""
    jitters, leader = [scene.bodies[b].jitter], b
    while jitters[-1].with_body >= 0:
        leader = jitters[-1].with_body
        jitters.append(scene.bodies[leader].jitter)
    spread = sum(np.abs(np.asarray(j.position, float)) for j in jitters)
    points = [np.zeros((0, 3))]
    for part in parts:
        if part.body == b:
            points.append(solids.placed(part, part.points, *poses[b]))
    room = np.concatenate(points)
    if len(room) and any(j.any_orientation or j.angle > 0 for j in jitters):
        middle = poses[leader][1]
        room = _around(middle, np.linalg.norm(room - middle, axis=1).max())
    return np.concatenate([room - spread, room + spread])


def _swings(scene: Scene, room: Sequence[Floats], poses: Sequence[Pose]) -> list[Floats]:
    """The reach of moving bodies about their pivots on other bodies or the world."""

    def moves(body: int) -> bool:
        return body >= 0 and scene.bodies[body].motion == "dynamic"

    ends = [(j.type, j.body_a, j.frame_a, j.body_b) for j in scene.joints]
    ends += [(j.type, j.body_b, j.frame_b, j.body_a) for j in scene.joints]
    out = []
    for kind, support, frame, body in ends:
        pivots = isinstance(kind, (HingeJoint, BallJoint, DistanceJoint))
        if not pivots or moves(support) or not moves(body):
            continue
        rotation, position = poses[support] if support >= 0 else (np.eye(3), np.zeros(3))
        pivot = rotation @ np.asarray(frame.position, float) + position
        hanging = {body}
        while more := {b for _, a, _, b in ends if a in hanging and moves(b)} - hanging:
            hanging |= more
        points = np.concatenate([room[b] for b in hanging])
        if len(points):
            out.append(_around(pivot, np.linalg.norm(points - pivot, axis=1).max()))
    return out
