"""Recordings of worlds in HDF5 files, which can be replayed bit by bit.

    with mw.record.Recorder(batch, "run.h5", worlds=[0, 5], every=4):
        batch.step(100)
    recording = mw.record.Recording("run.h5")
    x = recording.get("position")                  # (samples, worlds, bodies, components)
    assert recording.replay(isa="scalar").same

docs/recordings.md describes the layout of the file. The program's ``replay`` and h5py read it, too.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, Optional

import numpy as np
from numpy.typing import NDArray

from . import arrays, files, pickling
from .batch import MAX_THREADS, Batch, checked_batch
from .files import File
from .in_memory import InMemory
from .names import ContactLayout, Field, Ids, Isa
from .scene import Scene

try:
    from . import _record
    from ._record import FilmError, RecordError
except ImportError as error:
    raise ImportError(
        "manyworlds.record needs a build with HDF5 and nlohmann_json "
        f"(apt-get install libhdf5-dev nlohmann-json3-dev, then pip install .): {error}"
    ) from error

__all__ = [
    "RECORDED_CONTACT",
    "Difference",
    "FilmError",
    "LostWorldDumps",
    "RecordError",
    "Recorder",
    "Recording",
    "ReplayResult",
    "scene_from_json",
    "scene_to_json",
    "unfinished_recordings",
]

MAX_WORLDS_BY_DEFAULT = 64
MAX_CONTACTS = 2**16  # of a world and sample
# RECORDED_CONTACT: of Recording.contacts.
RECORDED_CONTACT = np.dtype(
    [
        ("body_a", np.int32),  # scene bodies; when one is fixed it is body_a
        ("body_b", np.int32),
        ("point", np.float64, (3,)),  # m, world
        ("normal", np.float64, (3,)),  # unit, from A to B, world
        ("force", np.float64),  # N, along the normal: the impulse of the step over its dt
    ]
)
_MAX_STEPS = 2**31 - 1


class Recorder(InMemory):
    """Records worlds of a batch from now until ``close``.

    batch        a Batch, or the batch of an environment
    file         the file to write; it appears under this name only when it is complete
    worlds       indices, ascending, or a mask; None: the first 64
    every        samples are taken now, and after each step call that reaches or passes a multiple
                 of ``every`` steps; 0: only by ``sample``
    first_world  index in the file of the batch's world 0
    flush_seconds  data older than this wall time, in s, is flushed at the end of a batch call. It
                 survives a crash of the process (see unfinished_recordings). 0: every call flushes;
                 inf: no flush
    contacts     maximum number of contact points per world and sample; those with the largest
                 forces are kept. 0: none. Requires a batch created with observe=["contacts"]

    The batch reports all inputs to the recorder, so other code needs no change. Steps of some
    worlds (``ids``) are recorded as their final states. The recorder is a context manager, which
    closes it, also after an exception. Without ``close`` no file remains, except after a crash.

    Raises RecordError, a ValueError, if the file cannot be written; ``close`` raises it for
    failures during steps. Raises ValueError if forces are pending for the next step, or if contacts
    are not observed.
    """

    _instead = "pickle the path of its file"

    def __init__(
        self,
        batch: Batch,
        file: File,
        worlds: Optional[Ids] = None,
        every: int = 1,
        first_world: int = 0,
        flush_seconds: float = 5.0,
        contacts: int = 0,
    ) -> None:
        contacts = arrays.integer(contacts, "contacts", 0, MAX_CONTACTS)
        first_world = arrays.integer(first_world, "first_world", 0, 2**62)
        every = arrays.integer(every, "every", 0, _MAX_STEPS)
        flush_seconds = arrays.at_least(flush_seconds, "flush_seconds", 0)
        count = checked_batch(batch).worlds
        if worlds is None:
            chosen = np.arange(min(count, MAX_WORLDS_BY_DEFAULT), dtype=np.int32)
        else:
            chosen = arrays.worlds(worlds, count, "worlds")
            if len(chosen) == 0:
                raise ValueError("worlds is empty; expected at least one")
        self.file = files.path(file, "file")
        self._held = _record.Recorder(
            batch._held, self.file, chosen, every, first_world, flush_seconds, contacts
        )
        self._closed = False

    @property
    def samples(self) -> int:
        """Number of samples."""
        return self._held.samples

    def sample(self) -> None:
        """Takes a sample now, unless there is one of this state."""
        if self._closed:
            raise ValueError("the recorder is closed")
        self._held.sample()

    def close(self) -> None:
        """Completes the file and gives it its name. A second call has no effect.

        Raises RuntimeError while another thread steps the batch. The recorder then continues, and
        can be closed later.
        """
        self._held.close()
        self._closed = True

    def __enter__(self) -> Recorder:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


class LostWorldDumps(InMemory):
    """Writes a short recording, "world_17.h5", of every world that becomes lost until ``close``.

    batch             the batch to watch
    folder            folder of the files; created if missing
    checkpoint_steps  interval in steps of snapshots of all worlds in memory. A recording starts at
                      the last snapshot before the world was lost, and ends at the loss
    max_files         maximum number of files; later lost worlds are ignored
    first_world       index in the files of the batch's world 0
    """

    _instead = "pickle what close() returns"

    def __init__(
        self,
        batch: Batch,
        folder: File,
        checkpoint_steps: int = 600,
        max_files: int = 16,
        first_world: int = 0,
    ) -> None:
        self._held = _record.LostWorldDumps(
            checked_batch(batch)._held,
            files.path(folder, "folder"),
            arrays.integer(checkpoint_steps, "checkpoint_steps", 1, _MAX_STEPS),
            arrays.integer(max_files, "max_files", 0, _MAX_STEPS),
            arrays.integer(first_world, "first_world", 0, 2**62),
        )
        self.files: list[Path] = []

    def close(self) -> list[Path]:
        """Stops watching and returns the files.

        Raises RecordError for files that could not be written, and RuntimeError as
        ``Recorder.close``.
        """
        self.files += self._held.close()  # none when it was closed before
        return self.files

    def __enter__(self) -> LostWorldDumps:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


class Difference(NamedTuple):
    """The first difference between a replay and its recording."""

    world: int  # index in the recording
    step: int  # since the start of the recording
    body: int  # index in the scene; -1: hash or status differs, but no field
    what: str  # "position.x is 1.5, recorded 1.25"


@dataclass(frozen=True)
class ReplayResult:
    """Result of a replay."""

    worlds: int
    samples: int
    steps: int
    compared: int  # number of compared hashes, each with status and fields
    different: int  # number of different ones
    difference: Optional[Difference]  # the first one
    lost_worlds: int  # number at the end
    kernel_table: str

    @property
    def same(self) -> bool:
        """Whether every bit equals the recording."""
        return self.different == 0


pickling.register(ReplayResult)


class Recording(InMemory):
    """An open recording. Every size, index, type and text in it has been checked.

    Raises RecordError, a ValueError, for other files and for truncated, corrupt or inconsistent
    ones. It is a context manager, which closes it.
    """

    _instead = "pickle the path of its file"

    def __init__(self, file: File) -> None:
        self.file = files.path(file, "file")
        self._held = _record.Recording(self.file)

    @property
    def kinds(self) -> int:
        """Number of groups of worlds; each has one scene."""
        return self._held.kinds

    @property
    def worlds(self) -> NDArray[np.int64]:
        """Indices of the recorded worlds in their batch, (worlds,), group by group."""
        return self._held.worlds

    @property
    def steps(self) -> NDArray[np.int64]:
        """Steps since the start of the recording, at each sample, (samples,)."""
        return self._held.steps

    @property
    def hashes(self) -> NDArray[np.uint64]:
        """State hashes, (samples, worlds); see Batch.hash."""
        return self._held.hashes

    @property
    def status(self) -> NDArray[np.uint32]:
        """Bits of Status, (samples, worlds)."""
        return self._held.status

    @property
    def inputs(self) -> int:
        """Number of recorded inputs."""
        return self._held.inputs

    @property
    def precision(self) -> str:
        """Precision of the recorded state: "f32" or "f64"."""
        return self._held.precision

    @property
    def sleep(self) -> bool:
        """Whether bodies could fall asleep."""
        return self._held.sleep

    @property
    def finished(self) -> bool:
        """Whether its Recorder was closed. False for a file of unfinished_recordings."""
        return self._held.finished

    @property
    def origin(self) -> str:
        """Program, instruction set, threads and seed of the recorded run, as information."""
        return self._held.origin

    def scene(self, kind: int = 0) -> Scene:
        """A copy of the scene of a group of worlds, with all options."""
        scene: Scene = self._held.scene(arrays.index(kind, self.kinds, "kind"))  # type: ignore[assignment]
        return scene

    def get(self, field: Field, sample: Optional[int] = None, kind: int = 0) -> NDArray[Any]:
        """A state field of a group's worlds, in the precision of the batch: float32 or float64.

        At every sample (samples, worlds, items, components), or at one sample (worlds, items,
        components).
        """
        kind = arrays.index(kind, self.kinds, "kind")
        count = self._held.samples
        first = 0 if sample is None else arrays.index(sample, count, "sample")
        shape = (count if sample is None else 1, *self._held.shape(field, kind))
        out = np.empty(shape, np.float32 if self.precision == "f32" else np.float64)
        self._held.read(field, kind, first, out)
        return out if sample is None else out[0]

    @property
    def has_contacts(self) -> bool:
        """Whether contacts were recorded."""
        return self._held.has_contacts

    def contacts(self, sample: int, world: int) -> NDArray[Any]:
        """Contact points with a force in the last step before a sample, (contacts,) of
        RECORDED_CONTACT.

        ``world`` is an index of ``worlds``. Empty if none were recorded.
        """
        sample = arrays.index(sample, self._held.samples, "sample")
        bodies, numbers, _ = self._held.contacts(sample, arrays.index(world, len(self.worlds), "world"))
        out = np.empty(len(bodies), RECORDED_CONTACT)
        out["body_a"], out["body_b"] = bodies[:, 0], bodies[:, 1]
        out["point"], out["normal"], out["force"] = numbers[:, :3], numbers[:, 3:6], numbers[:, 6]
        return out

    def contacts_found(self, sample: int, world: int) -> int:
        """Number of contacts before ``Recorder``'s maximum was applied."""
        sample = arrays.index(sample, self._held.samples, "sample")
        return int(self._held.contacts(sample, arrays.index(world, len(self.worlds), "world"))[2])

    def replay(
        self,
        isa: Optional[Isa] = None,
        threads: Optional[int] = None,
        layout: ContactLayout = "automatic",
    ) -> ReplayResult:
        """Simulates the recording again from its first state and inputs, without the GIL.

        Compares hash, status and fields at every sample, bit by bit.
        """
        count = 0 if threads is None else arrays.integer(threads, "threads", 1, MAX_THREADS)
        found = self._held.replay(isa, count, layout)
        if found["difference"] is not None:
            found["difference"] = Difference(*found["difference"])
        return ReplayResult(**found)

    def close(self) -> None:
        """Closes the file. Every later use raises ValueError. A second call has no effect."""
        self._held.close()

    def __enter__(self) -> Recording:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    @property
    def closed(self) -> bool:
        """Whether ``close`` was called."""
        return self._held.closed

    def __repr__(self) -> str:
        if self.closed:
            return "<manyworlds.record.Recording: closed>"
        counts = f"{len(self.worlds)} worlds, {self._held.samples} samples, {self.inputs} inputs"
        if not self.finished:
            counts += ", unfinished"
        return f"<manyworlds.record.Recording: {counts}>"


def unfinished_recordings(file: File) -> list[Path]:
    """Recordings of ``file`` by processes that ended early (kill -9, a power cut), by name.

    These are files in the same folder, "run.h5.part-8c1f03ab5e6d7790", with data and without a
    running writer. Each can be opened and replayed up to its last flush (``flush_seconds`` of
    Recorder). Nothing deletes them. Raises RecordError if ``file`` is not a file name.
    """
    return _record.unfinished_recordings(files.path(file, "file"))


def scene_to_json(scene: Scene) -> str:
    """A scene as JSON text, with exact numbers."""
    return _record.scene_to_json(scene)


def scene_from_json(text: str) -> Scene:
    """The scene of a JSON text. RecordError lists all missing, unknown and wrong members."""
    scene: Scene = _record.scene_from_json(text)  # type: ignore[assignment]
    return scene
