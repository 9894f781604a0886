"""Recordings, scenes as JSON. Private: use manyworlds.record."""

from collections.abc import Sequence
import os
import pathlib
from typing import Annotated

import numpy
from numpy.typing import NDArray

import manyworlds._core


class RecordError(ValueError):
    """
    A recording that cannot be written, or an invalid, truncated or corrupt file.
    """

class FilmError(ValueError):
    """A picture or film failed: a program is missing or failed."""

class Recorder:
    """Private: use manyworlds.record.Recorder."""

    def __init__(self, batch: manyworlds._core.Batch, file: str | os.PathLike, worlds: Annotated[NDArray[numpy.int32], dict(order='C', device='cpu', writable=False)], every: int, first_world: int, flush_seconds: float, contacts: int) -> None: ...

    def sample(self) -> None: ...

    def close(self) -> None: ...

    @property
    def samples(self) -> int: ...

class LostWorldDumps:
    """Private: use manyworlds.record.LostWorldDumps."""

    def __init__(self, batch: manyworlds._core.Batch, folder: str | os.PathLike, checkpoint_steps: int, max_files: int, first_world: int) -> None: ...

    def close(self) -> list[pathlib.Path]: ...

class Recording:
    """Private: use manyworlds.record.Recording."""

    def __init__(self, file: str | os.PathLike) -> None: ...

    @property
    def kinds(self) -> int: ...

    @property
    def samples(self) -> int: ...

    @property
    def inputs(self) -> int: ...

    @property
    def precision(self) -> str: ...

    @property
    def sleep(self) -> bool: ...

    @property
    def finished(self) -> bool: ...

    @property
    def origin(self) -> str: ...

    @property
    def has_contacts(self) -> bool: ...

    @property
    def steps(self) -> NDArray[numpy.int64]: ...

    @property
    def worlds(self) -> NDArray[numpy.int64]: ...

    @property
    def hashes(self) -> NDArray[numpy.uint64]: ...

    @property
    def status(self) -> NDArray[numpy.uint32]: ...

    def close(self) -> None: ...

    @property
    def closed(self) -> bool: ...

    def scene(self, kind: int) -> object: ...

    def shape(self, field: object | None, kind: int) -> tuple: ...

    def read(self, field: object | None, kind: int, begin: int, out: Annotated[NDArray, dict(order='C', device='cpu')]) -> None: ...

    def contacts(self, sample: int, world: int) -> tuple: ...

    def replay(self, isa: object | None, threads: object, layout: object | None) -> dict: ...

def page(recordings: Sequence[Recording], empty: str | os.PathLike, file: str | os.PathLike | None, title: str, worlds: int, every: int, numbers: Sequence[tuple[str, Sequence[float]]]) -> object:
    """A page as text, or (worlds, bodies, frames, bytes) of a written page."""

def picture(page: str | os.PathLike, file: str | os.PathLike, width: int, height: int, view: str, time: float) -> None:
    """A picture of a page."""

def film(page: str | os.PathLike, file: str | os.PathLike, width: int, height: int, view: str, fps: float, speed: float, begin: float, end: float, encoder: str) -> tuple[int, float, int]:
    """A film of a page. Returns frames, seconds and bytes."""

def unfinished_recordings(file: str | os.PathLike) -> list[pathlib.Path]:
    """Part files of a file, with data and without a running writer."""

def scene_to_json(scene: object | None) -> str:
    """A scene as JSON, with exact numbers."""

def scene_from_json(json: object | None) -> object:
    """The scene of a JSON text."""
