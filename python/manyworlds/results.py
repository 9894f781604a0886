"""Results of Batch: status, hashes, energy, contacts and snapshots."""

from __future__ import annotations

from enum import IntFlag
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from . import _core, arrays
from .arrays import Writable
from .names import Ids


class Status(IntFlag):
    """Faults of a world: a set of bits."""

    ok = 0
    non_finite = 1  # frozen: a number was not finite
    out_of_range = 2  # frozen: |x| > 1e10 m or |v| > 1e5 m/s
    out_of_bounds = 4  # a body left Options.bounds; the world still steps
    contact_overflow = 8  # more contacts than the plan has room for; some were dropped
    joint_broken = 16  # a joint bore more than it could
    diverged = 32  # it gained energy that nothing gave it; the world still steps

    @classmethod
    def lost(cls) -> Status:
        """The bits that mark a world as lost."""
        return cls.non_finite | cls.out_of_range | cls.out_of_bounds


_VECTOR = (np.float64, (3,))
_PLACE: list[Any] = [
    ("body_a", np.int32),  # scene bodies; when one is fixed it is body_a
    ("body_b", np.int32),
    ("shape_a", np.int32),  # index in Body.shapes
    ("shape_b", np.int32),
    ("feature", np.int32),  # which features touch
]
_NUMBERS: list[Any] = [
    ("normal", *_VECTOR),  # unit, from A to B, world
    ("point", *_VECTOR),  # m, world, half way between the surfaces
    ("separation", np.float64),  # m, negative when the shapes overlap
    ("normal_impulse", np.float64),  # N s
]
# CONTACT: of Batch.contacts.
CONTACT = np.dtype(_PLACE + _NUMBERS)
# STEP_CONTACT: of Batch.step_contacts, with the impulses of the last step.
STEP_CONTACT = np.dtype(
    _PLACE
    + _NUMBERS
    + [("friction_impulse", *_VECTOR), ("twist_impulse", np.float64)]  # N s, world; N m s
)


def _records(columns: tuple[NDArray[Any], NDArray[Any]], dtype: np.dtype[Any]) -> NDArray[Any]:
    """Integer and number columns as one structured array (contacts,)."""
    integers, reals = columns
    out = np.empty(len(integers), dtype=dtype)
    at = 0
    for i, name in enumerate(dtype.names or ()):
        if i < integers.shape[1]:
            out[name] = integers[:, i]
            continue
        width = dtype[name].shape[0] if dtype[name].shape else 1
        out[name] = reals[:, at : at + width] if width > 1 else reals[:, at]
        at += width
    return out


class Results:
    """Status, hashes, energy, contacts, snapshots."""

    _held: _core.Batch
    _worlds: int
    _watched: frozenset[str]

    def _world(self, world: Any) -> int:
        return arrays.index(world, self._worlds, "world")

    def status(self, out: Optional[Writable] = None) -> NDArray[np.uint32]:
        """Bits of Status of every world, (worlds,) uint32. A reset of the world clears them."""
        out = arrays.output(out, (self._worlds,), ("worlds",), np.uint32)
        self._held.status(out)
        return out

    def status_names(self, world: int) -> list[str]:
        """The names of a world's status bits. Empty: no fault."""
        bits = int(self.status()[self._world(world)])
        return [name for name, bit in Status.__members__.items() if bit & bits]

    def lost(self) -> NDArray[np.bool_]:
        """Which worlds are lost, (worlds,) bool: frozen, or out of their bounds."""
        return (self.status() & np.uint32(Status.lost())) != 0

    def hash(self, world: Optional[int] = None) -> int:
        """Hash of the state of a world, or of all worlds. Equal bits have equal hashes."""
        return int(self._held.hash(None if world is None else self._world(world)))

    def hashes(self, out: Optional[Writable] = None) -> NDArray[np.uint64]:
        """Hash of the state of every world, (worlds,) uint64."""
        out = arrays.output(out, (self._worlds,), ("worlds",), np.uint64)
        self._held.hashes(out)
        return out

    def energy(self, out: Optional[Writable] = None) -> NDArray[np.float64]:
        """Kinetic and potential energy, J, (worlds, 2) float64. Potential energy is 0 at the
        origin.
        """
        out = arrays.output(out, (self._worlds, 2), ("worlds", ""), np.float64)
        self._held.energy(out)
        return out

    def contacts(self, world: int) -> NDArray[Any]:
        """Contact points of a world at its current state, structured, (contacts,) of CONTACT.

        Runs the collision stages again. In loops that run often, use step_contacts.
        """
        return _records(self._held.contacts(self._world(world)), CONTACT)

    def step_contacts(self, world: int) -> NDArray[Any]:
        """Contact points of the last step with impulses, structured, (contacts,) of STEP_CONTACT.

        Raises ValueError unless the batch was created with observe=["contacts"].
        """
        if "contacts" not in self._watched:
            raise ValueError("contacts are not observed; make the Batch with observe=['contacts']")
        return _records(self._held.step_contacts(self._world(world)), STEP_CONTACT)

    def measure_contacts(self) -> dict[str, float]:
        """Four statistics of the contacts of all worlds. As slow as ``contacts``."""
        return self._held.measure_contacts()

    def look(self) -> None:
        """Updates observed motion, joints, rays and points at the current state, without a step."""
        if not self._watched:
            raise ValueError("nothing is observed; make the Batch with observe=[...] or rays=[...]")
        self._held.look()

    # -- snapshots

    def save(self, ids: Optional[Ids] = None) -> _core.Snapshot:
        """A Snapshot of all worlds with clock and episodes, or of the worlds ``ids`` in order."""
        return self._held.save(None if ids is None else arrays.worlds(ids, self._worlds))

    def restore(
        self,
        snapshot: _core.Snapshot,
        source: Optional[Ids] = None,
        ids: Optional[Ids] = None,
    ) -> None:
        """Restores worlds from a snapshot. They continue bitwise equal to the saved worlds.

        Without indices it restores all worlds from a snapshot with the same number of worlds.
        Otherwise it copies world ``source[i]`` of the snapshot to world ``ids[i]`` of the batch
        (None: all worlds). A single source is copied to all of ``ids``. Raises SnapshotError, and
        changes nothing, if plan or precision differ.
        """
        if not isinstance(snapshot, _core.Snapshot):
            found = type(snapshot).__name__
            raise TypeError(f"snapshot is of type {found}; expected a manyworlds.Snapshot")
        if source is None and ids is None:
            self._held.restore(snapshot, None)
            return
        pairs = arrays.pairs(source, snapshot.worlds, ids, self._worlds)
        self._held.restore(snapshot, pairs)

    def copy_world(self, source: int, target: int) -> None:
        """Copies the state of world ``source`` to world ``target``."""
        self._held.copy_world(self._world(source), self._world(target))
