"""Recordings: what worlds did, in an HDF5 file from which it can be done again bit by bit.

    with mw.record.Recorder(batch, "run.h5", worlds=[0, 5], every=4):
        batch.step(100)
    recording = mw.record.Recording("run.h5")
    x = recording.get("position")                  # (samples, worlds, bodies, components)
    assert recording.replay(isa="scalar").same

The file's layout is in docs/recordings.md; the program's ``replay`` reads it, too, and so does h5py.
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
    """Writes what some worlds of a batch do, from now until ``close``.

    batch        a Batch; an environment's, too
    file         to be written; it is there only once it is complete
    worlds       indices, ascending, or a mask; None: the first 64
    every        a sample is taken at once and after the first step call that ends on or beyond each
                 multiple of so many steps; 0: only by ``sample``
    first_world  what the batch's world 0 is called in the file
    flush_seconds  what is older than so many seconds of wall time when a call of the batch ends is
                 flushed, and survives the end of the process, whatever that is (see
                 unfinished_recordings); 0: at each call, inf: never
    contacts     contact points of a world and sample that are kept at most, those of the largest forces; 0: none
                 are recorded. Wants a batch made with observe=["contacts"]

    The batch reports every input to it, so nothing needs to go through the Recorder. Steps of some worlds
    alone (``ids``) are recorded as the states that they came to. As a context manager it is closed at the
    end, also after an exception. Without ``close`` no file is left, unless the process is cut off. Raises
    RecordError, a ValueError, when the file cannot be written (from ``close`` for what failed while
    stepping), ValueError when forces were added for the next step already or contacts are not observed.
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
        """Taken so far."""
        return self._held.samples

    def sample(self) -> None:
        """Takes a sample now; nothing when there is one of this state already."""
        if self._closed:
            raise ValueError("the recorder is closed")
        self._held.sample()

    def close(self) -> None:
        """Finishes the file and gives it its name. Twice is once.

        RuntimeError while another thread steps the batch: it goes on recording, and can be closed later.
        """
        self._held.close()
        self._closed = True

    def __enter__(self) -> Recorder:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


class LostWorldDumps(InMemory):
    """Writes a small recording, "world_17.h5", of every world that gets lost from now until ``close``.

    batch             whose worlds are watched
    folder            is made; the files go there
    checkpoint_steps  all worlds are saved in memory every so many steps; a dump begins at the last
                      one before the world was lost, and ends there
    max_files         files; worlds lost after that are left out
    first_world       what the batch's world 0 is called in the files
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
        """Stops watching and returns the files. Raises RecordError for what could not be written, and
        RuntimeError, as ``Recorder.close``."""
        self.files += self._held.close()  # none when it was closed before
        return self.files

    def __enter__(self) -> LostWorldDumps:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


class Difference(NamedTuple):
    """Where a replay first did something else."""

    world: int  # as the recording calls it
    step: int  # since the recording began
    body: int  # of the scene; -1: no field differs, but hash or status does
    what: str  # "position.x is 1.5, recorded 1.25"


@dataclass(frozen=True)
class ReplayResult:
    """What came of simulating a recording again."""

    worlds: int
    samples: int
    steps: int
    compared: int  # hashes, each with its status and fields
    different: int  # of them
    difference: Optional[Difference]  # the first
    lost_worlds: int  # at the end
    kernel_table: str

    @property
    def same(self) -> bool:
        """Whether every bit was as recorded."""
        return self.different == 0


pickling.register(ReplayResult)


class Recording(InMemory):
    """A recording that was opened and checked: every size, index, type and text in it.

    Raises RecordError, a ValueError, for what is no recording, cut, corrupted or inconsistent. It can
    be closed, also by ``with``.
    """

    _instead = "pickle the path of its file"

    def __init__(self, file: File) -> None:
        self.file = files.path(file, "file")
        self._held = _record.Recording(self.file)

    @property
    def kinds(self) -> int:
        """Of worlds; those of a kind have one scene. Batches made in Python have one kind."""
        return self._held.kinds

    @property
    def worlds(self) -> NDArray[np.int64]:
        """What the recorded worlds were called in their batch, (worlds,), one kind after the other."""
        return self._held.worlds

    @property
    def steps(self) -> NDArray[np.int64]:
        """Since the recording began, at each sample, (samples,)."""
        return self._held.steps

    @property
    def hashes(self) -> NDArray[np.uint64]:
        """(samples, worlds); see Batch.hash."""
        return self._held.hashes

    @property
    def status(self) -> NDArray[np.uint32]:
        """(samples, worlds): bits of Status."""
        return self._held.status

    @property
    def inputs(self) -> int:
        """How many there were."""
        return self._held.inputs

    @property
    def precision(self) -> str:
        """Of the recorded state: "f32" or "f64"."""
        return self._held.precision

    @property
    def sleep(self) -> bool:
        """Whether bodies could fall asleep."""
        return self._held.sleep

    @property
    def finished(self) -> bool:
        """Whether its Recorder was closed; False for one of unfinished_recordings."""
        return self._held.finished

    @property
    def origin(self) -> str:
        """By which program, instruction set, threads and seed it was made; for people."""
        return self._held.origin

    def scene(self, kind: int = 0) -> Scene:
        """A copy of the scene of a kind, with all its options."""
        scene: Scene = self._held.scene(arrays.index(kind, self.kinds, "kind"))  # type: ignore[assignment]
        return scene

    def get(self, field: Field, sample: Optional[int] = None, kind: int = 0) -> NDArray[Any]:
        """A state field of a kind's worlds at every sample, (samples, worlds, items, components), or
        at one, (worlds, items, components); float32 or float64, as the batch had it."""
        kind = arrays.index(kind, self.kinds, "kind")
        count = self._held.samples
        first = 0 if sample is None else arrays.index(sample, count, "sample")
        shape = (count if sample is None else 1, *self._held.shape(field, kind))
        out = np.empty(shape, np.float32 if self.precision == "f32" else np.float64)
        self._held.read(field, kind, first, out)
        return out if sample is None else out[0]

    @property
    def has_contacts(self) -> bool:
        """Whether it was recorded with ``contacts``."""
        return self._held.has_contacts

    def contacts(self, sample: int, world: int) -> NDArray[Any]:
        """Contact points that bore a force in the last step before a sample, structured, (contacts,) of
        RECORDED_CONTACT. ``world`` counts those of ``worlds``. Empty where none were recorded."""
        sample = arrays.index(sample, self._held.samples, "sample")
        bodies, numbers, _ = self._held.contacts(sample, arrays.index(world, len(self.worlds), "world"))
        out = np.empty(len(bodies), RECORDED_CONTACT)
        out["body_a"], out["body_b"] = bodies[:, 0], bodies[:, 1]
        out["point"], out["normal"], out["force"] = numbers[:, :3], numbers[:, 3:6], numbers[:, 6]
        return out

    def contacts_found(self, sample: int, world: int) -> int:
        """How many there were, of which ``Recorder``'s ``contacts`` were kept."""
        sample = arrays.index(sample, self._held.samples, "sample")
        return int(self._held.contacts(sample, arrays.index(world, len(self.worlds), "world"))[2])

    def replay(
        self,
        isa: Optional[Isa] = None,
        threads: Optional[int] = None,
        layout: ContactLayout = "automatic",
    ) -> ReplayResult:
        """Simulates it again from its first state and its inputs, without the GIL, and compares hash,
        status and fields at every sample, bit by bit."""
        count = 0 if threads is None else arrays.integer(threads, "threads", 1, MAX_THREADS)
        found = self._held.replay(isa, count, layout)
        if found["difference"] is not None:
            found["difference"] = Difference(*found["difference"])
        return ReplayResult(**found)

    def close(self) -> None:
        """Lets go of the file; every later use raises ValueError. Twice is once."""
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
    """What processes that were cut off (kill -9, a power cut) had recorded of ``file``, by name.

    The files beside it, "run.h5.part-8c1f03ab5e6d7790", that have contents and no writer any
    more. Each can be opened and replayed up to where it was last flushed (``Recorder``'s
    ``flush_seconds``); nothing deletes them. Raises RecordError when ``file`` is no name of a file.
    """
    return _record.unfinished_recordings(files.path(file, "file"))


def scene_to_json(scene: Scene) -> str:
    """Everything of a scene as JSON, every number exactly."""
    return _record.scene_to_json(scene)


def scene_from_json(text: str) -> Scene:
    """The scene of such a text. Raises RecordError with everything that is missing, unknown or wrong."""
    scene: Scene = _record.scene_from_json(text)  # type: ignore[assignment]
    return scene
