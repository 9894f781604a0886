"""Checks of rotations for all setters of states."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from .joints import BallJoint, FixedJoint
from .plan import Plan

_SLACK = 1e-3  # of the length of an orientation


def check(
    name: str, numbers: NDArray[Any], worlds: Optional[NDArray[Any]], quaternions: list[int]
) -> None:
    """Raises ValueError for invalid rotations in values (worlds, items, components) of a field.

    ``quaternions``: first indices of quaternions among the items of ``generalized_position``.
    """
    if name == "orientation":
        length = np.linalg.norm(numbers.astype(np.float64), axis=2)
        wrong = ~(np.abs(length - 1) <= _SLACK)
        if wrong.any():
            world, row = np.argwhere(wrong)[0]
            what = "(w, x, y, z)" if numbers.shape[2] == 4 else "(cos, sin)"
            at = world if worlds is None else worlds[world]
            raise ValueError(
                f"orientation of row {row} in world {at} is {numbers[world, row].tolist()}, of length "
                f"{length[world, row]:g}; expected {what} of length 1: divide it by its length"
            )
    for first in quaternions:
        length = np.linalg.norm(numbers[:, first : first + 4, 0].astype(np.float64), axis=1)
        wrong = ~(np.isfinite(length) & (length > 0))
        if wrong.any():
            world = int(np.flatnonzero(wrong)[0])
            at = world if worlds is None else worlds[world]
            raise ValueError(
                f"generalized_position of coordinates {first} to {first + 3} in world {at} is "
                f"{numbers[world, first : first + 4, 0].tolist()}; expected a quaternion (w, x, y, z) "
                "that is finite and not of length 0"
            )


def among_coordinates(plan: Plan, coordinates: int) -> list[int]:
    """First indices of quaternions among generalised coordinates.

    Ball joints have one. Bodies without a joint have seven coordinates, a position and a
    quaternion.
    """
    of_joints, out = set(), []
    for index, joint in enumerate(plan.scene.joints):
        if isinstance(joint.type, FixedJoint):
            continue
        first = plan.first_coordinate(index)
        ball = isinstance(joint.type, BallJoint)
        of_joints.update(range(first, first + (4 if ball else 1)))
        if ball:
            out.append(first)
    at = 0
    while at < coordinates:
        if at in of_joints:
            at += 1
        else:
            out.append(at + 3)
            at += 7
    return sorted(out)
