"""Inputs of Batch: controls, forces, enabled bodies and joints, rays."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core, arrays
from .arrays import Writable
from .ids import BodyRef, BodyRefs, Chooser, JointRefs, Named
from .names import Ids
from .plan import Plan
from .scene import Ray


class Inputs(Named):
    """Controls, forces, enabled bodies and joints, rays."""

    _held: _core.Batch
    _worlds: int
    _bodies: int
    _joints: int
    _choose: Chooser
    _controls: int
    _planar: bool
    _real: np.dtype[Any]
    plan: Plan

    # -- controls

    def get_controls(self, out: Optional[Writable] = None) -> NDArray[Any]:
        """The current controls, (worlds, controls), in the precision of the batch."""
        shape = self._worlds, self._controls
        out = arrays.output(out, shape, ("worlds", "controls"), self._real)
        self._held.read_controls(out)
        return out

    def set_controls(self, values: ArrayLike, ids: Optional[Ids] = None) -> None:
        """Sets the scene's controls in all worlds, or in the worlds ``ids``.

        ``values``: (worlds, controls) or (len(ids), controls), of any dtype, or an array that
        broadcasts as in ``set``: a number, a row (controls,), a column (worlds, 1). Controls stay
        in effect until they are set again. Values are clamped to the range of the control. NaN
        freezes its world. Raises ValueError for a wrong shape, IndexError for wrong ids.
        """
        worlds = None if ids is None else arrays.worlds(ids, self._worlds)
        shape = self._worlds if worlds is None else len(worlds), self._controls
        axes = "worlds" if worlds is None else "ids", "controls"
        self._held.write_controls(arrays.broadcast(values, shape, axes, "controls"), worlds)

    # -- forces and impulses

    def add_force(
        self,
        force: ArrayLike,
        bodies: Optional[BodyRefs] = None,
        ids: Optional[Ids] = None,
        points: Optional[ArrayLike] = None,
    ) -> None:
        """Adds forces, N in the world frame, which act in all steps of the next ``step`` call.

        ``force``: (worlds, bodies, 3), planar 2, or an array that broadcasts to it. ``bodies``:
        handles, names or indices of the scene's bodies, or a mask over rows; None: all rows.
        ``ids`` selects worlds. Forces act at the centre of mass, or at ``points`` (shape of
        ``force``, m, world frame). Rows of zeros have no effect. Raises ValueError for shapes,
        names and fixed bodies, IndexError for indices.
        """
        self._apply("force", force, bodies, ids, points)

    def add_torque(
        self, torque: ArrayLike, bodies: Optional[BodyRefs] = None, ids: Optional[Ids] = None
    ) -> None:
        """Adds torques, N m, (worlds, bodies, 3), planar 1: see add_force."""
        self._apply("torque", torque, bodies, ids)

    def add_impulse(
        self,
        impulse: ArrayLike,
        bodies: Optional[BodyRefs] = None,
        ids: Optional[Ids] = None,
        points: Optional[ArrayLike] = None,
    ) -> None:
        """Changes velocities immediately by impulses, N s: see add_force."""
        self._apply("impulse", impulse, bodies, ids, points)

    def add_angular_impulse(
        self, impulse: ArrayLike, bodies: Optional[BodyRefs] = None, ids: Optional[Ids] = None
    ) -> None:
        """Changes angular velocities immediately by angular impulses, N m s: see add_torque."""
        self._apply("angular_impulse", impulse, bodies, ids)

    def _apply(
        self,
        kind: str,
        values: ArrayLike,
        bodies: Optional[BodyRefs],
        ids: Optional[Ids],
        points: Optional[ArrayLike] = None,
    ) -> None:
        worlds = arrays.worlds(ids, self._worlds)
        chosen = self._choose.bodies(bodies, "bodies")
        spin = kind in ("torque", "angular_impulse")
        full = self._vectors(values, (len(worlds), len(chosen)), kind, spin)
        at = None
        if points is not None:
            at = self._vectors(points, (len(worlds), len(chosen)), "points", False)
        self._held.apply_external(kind, worlds, chosen, full, at)

    def _vectors(
        self, values: ArrayLike, lead: tuple[int, ...], name: str, spin: bool
    ) -> NDArray[np.float64]:
        """Vectors of this scene as vectors in space, (*lead, 3)."""
        width = (1 if spin else 2) if self._planar else 3
        axes = (*("worlds", "bodies")[: len(lead)], "components")
        own = arrays.broadcast(values, (*lead, width), axes, name, np.float64)
        if width == 3:
            return own
        full = np.zeros((*lead, 3))
        full[..., 2 if spin else slice(0, 2)] = own[..., 0] if spin else own
        return full

    # -- bodies and joints that come and go, sleep

    def get_enabled(self, out: Optional[Writable] = None) -> NDArray[np.bool_]:
        """Which bodies are enabled, (worlds, bodies) bool."""
        out = arrays.output(out, (self._worlds, self._bodies), ("worlds", "bodies"), np.bool_)
        self._held.enabled(out)
        return out

    def set_enabled(
        self, enabled: ArrayLike, bodies: Optional[BodyRefs] = None, ids: Optional[Ids] = None
    ) -> None:
        """Enables or disables bodies (see add_force): bools that broadcast to (worlds, bodies)."""
        worlds = arrays.worlds(ids, self._worlds)
        chosen = self._choose.bodies(bodies, "bodies")
        shape, axes = (len(worlds), len(chosen)), ("worlds", "bodies")
        flags = arrays.broadcast(enabled, shape, axes, "enabled", np.bool_)
        self._held.set_enabled(worlds, chosen, flags)

    def spawn(
        self,
        body: BodyRef,
        position: ArrayLike,
        orientation: Optional[ArrayLike] = None,
        linear_velocity: Optional[ArrayLike] = None,
        angular_velocity: Optional[ArrayLike] = None,
        ids: Optional[Ids] = None,
    ) -> None:
        """Enables a body with a new state in all worlds or in the worlds ``ids``.

        Arrays are (worlds, components), or broadcast to it. Units and components are those of the
        state fields: position in m, orientation (w, x, y, z) or planar (cos, sin), velocities in
        m/s and rad/s. Raises ValueError for shapes and for orientations of length 0, IndexError for
        indices.
        """
        worlds = arrays.worlds(ids, self._worlds)
        chosen = self._choose.body(body, "body")
        lead = (len(worlds),)
        states = np.zeros((len(worlds), 13))
        states[:, 0:3] = self._vectors(position, lead, "position", False)
        states[:, 3] = 1
        if orientation is not None:
            states[:, 3:7] = self._quaternions(orientation, len(worlds))
        if linear_velocity is not None:
            states[:, 7:10] = self._vectors(linear_velocity, lead, "linear_velocity", False)
        if angular_velocity is not None:
            states[:, 10:13] = self._vectors(angular_velocity, lead, "angular_velocity", True)
        self._held.spawn(worlds, chosen, states)

    def _quaternions(self, orientation: ArrayLike, count: int) -> NDArray[np.float64]:
        axes = ("worlds", "components")
        width = 2 if self._planar else 4
        own = arrays.broadcast(orientation, (count, width), axes, "orientation", np.float64)
        length = np.linalg.norm(own, axis=1)
        wrong = ~(np.isfinite(length) & (length > 0))
        if wrong.any():
            found = own[np.flatnonzero(wrong)[0]].tolist()
            raise ValueError(f"orientation is {found}; expected finite numbers, not of length 0")
        if not self._planar:
            return own
        half = np.arctan2(own[:, 1], own[:, 0]) / 2
        zero = np.zeros_like(half)
        return np.stack([np.cos(half), zero, zero, np.sin(half)], axis=1)

    def get_joints_enabled(self, out: Optional[Writable] = None) -> NDArray[np.bool_]:
        """Which joints are enabled, (worlds, joints) bool. False: disabled or broken."""
        out = arrays.output(out, (self._worlds, self._joints), ("worlds", "joints"), np.bool_)
        self._held.joints_enabled(out)
        return out

    def set_joints_enabled(
        self, enabled: ArrayLike, joints: Optional[JointRefs] = None, ids: Optional[Ids] = None
    ) -> None:
        """Enables (repairs) or disables joints: bools that broadcast to (worlds, joints)."""
        worlds = arrays.worlds(ids, self._worlds)
        chosen = self._choose.joints(joints, "joints")
        shape, axes = (len(worlds), len(chosen)), ("worlds", "joints")
        flags = arrays.broadcast(enabled, shape, axes, "enabled", np.bool_)
        self._held.set_joints_enabled(worlds, chosen, flags)

    def asleep(self, out: Optional[Writable] = None) -> NDArray[np.bool_]:
        """Which bodies are asleep, (worlds, bodies) bool. Kinematic bodies never sleep."""
        out = arrays.output(out, (self._worlds, self._bodies), ("worlds", "bodies"), np.bool_)
        self._held.asleep(out)
        return out

    def wake(self, ids: Optional[Ids] = None) -> None:
        """Wakes all bodies of these worlds; None: all worlds."""
        self._held.wake(arrays.worlds(ids, self._worlds))

    def set_rays(self, rays: Sequence[Ray], world: Optional[int] = None) -> None:
        """Replaces the rays; their number must stay the same. In one world, body and mask cannot
        change.
        """
        if world is not None:
            world = arrays.index(world, self._worlds, "world")
        self._held.set_rays(rays, world)
