"""Pages: recordings as one HTML file, shown in a browser or notebook without server or network.

    recording = mw.record.Recording("run.h5")
    mw.write_page([recording], "page.html")
    mw.show(recording)  # in a notebook's cell
"""

from __future__ import annotations

import html
import os
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, Optional, Union

import numpy as np
from numpy.typing import ArrayLike

from . import arrays, files
from .batch import Batch
from .files import File

if TYPE_CHECKING:
    from .environment import Environment
    from .record import Recording

__all__ = ["Page", "PageReport", "show", "write_page"]

_HEIGHT = 560  # pixels, in a cell
# Limits of a batch as the value of a notebook's cell: a page of about a megabyte.
_MAX_WORLDS = 64
_MAX_BODIES = 20_000


class PageReport(NamedTuple):
    """Contents of a page."""

    worlds: int  # worlds of all recordings
    bodies: int  # moving bodies of all worlds
    frames: int
    bytes: int


class Page:
    """A page as text. A notebook shows it in the cell."""

    def __init__(self, text: str, height: int) -> None:
        self.text = text
        self.height = height

    def _repr_html_(self) -> str:
        return (
            f'<iframe srcdoc="{html.escape(self.text)}" sandbox="allow-scripts" '
            f'style="width: 100%; height: {self.height}px; border: 0; border-radius: 8px"></iframe>'
        )

    def save(self, file: File) -> None:
        """Writes the page."""
        files.path(file, "file").write_text(self.text, encoding="utf-8")

    def __repr__(self) -> str:
        return f"<Page of {len(self.text) / 1e6:.1f} MB; save(file) writes it>"


def write_page(
    recordings: Sequence[Recording],
    file: File,
    *,
    title: str = "",
    worlds: Optional[int] = None,
    every: int = 1,
    numbers: Optional[Mapping[str, ArrayLike]] = None,
) -> PageReport:
    """Writes a page of recordings: one, or several to compare.

    title     default: the name of the scene
    worlds    number of worlds taken from each recording; None: all
    every     take every n-th sample
    numbers   values by name, (samples, worlds) of the first recording; the page can color worlds by them

    Raises RecordError if a recording cannot be read or the file cannot be written, ValueError, TypeError,
    and FileNotFoundError if the package was built without the page.
    """
    made = _page(recordings, title, worlds, every, numbers, files.path(file, "file"))
    return PageReport(*made)  # type: ignore[misc]


def show(
    shown: Union[Recording, Sequence[Recording], Batch],
    *,
    title: str = "",
    worlds: Optional[int] = None,
    every: int = 1,
    numbers: Optional[Mapping[str, ArrayLike]] = None,
    height: int = _HEIGHT,
) -> Page:
    """The page of recordings, or of the current state of a batch, for a notebook's cell.

    height    height of the cell, in pixels; other arguments as in ``write_page``
    """
    height = arrays.integer(height, "height", 100, 10_000)
    if isinstance(shown, Batch):
        from .record import Recorder, Recording

        first = None if worlds is None else range(min(arrays.integer(worlds, "worlds", 1, 2**31 - 1), shown.worlds))
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "now.h5"
            Recorder(shown, file, first, every=0).close()
            with Recording(file) as now:
                return Page(str(_page([now], title, worlds, every, numbers, None)), height)
    several = list(shown) if isinstance(shown, Sequence) else [shown]
    return Page(str(_page(several, title, worlds, every, numbers, None)), height)


def cell_of(shown: Union[Batch, Environment]) -> Optional[str]:
    """HTML for a notebook's cell with value ``shown``: its repr and a page of its current worlds, at most 64.

    None if no page can be made; the cell then shows the repr. Reasons: the package has no page or no
    recordings; ``shown`` is closed, has forces for its next step, or another thread steps it.
    """
    if shown.closed:
        return None
    batch = shown if isinstance(shown, Batch) else shown.batch
    each = max(1, max(plan.bodies for plan, _ in batch._plans))
    count = min(batch.worlds, _MAX_WORLDS, max(1, _MAX_BODIES // each))
    try:
        page = show(batch, worlds=count, height=_HEIGHT)
    except (ImportError, OSError, RuntimeError, ValueError):
        return None
    of = "" if count == batch.worlds else f"; shown: the first {count} of {batch.worlds} worlds"
    return f"<div><code>{html.escape(repr(shown))}</code>{of}</div>{page._repr_html_()}"


def _empty_page() -> Path:
    """The page without data: MANYWORLDS_VIEWER, or the file in the package."""
    given = os.environ.get("MANYWORLDS_VIEWER")
    place = Path(given) if given else Path(__file__).with_name("viewer.html")
    if place.is_file():
        return place
    raise FileNotFoundError(
        f"there is no page at {place}: the package was built without it. tools/viewer in the "
        "repository builds it, with Node 18 or later and npm; MANYWORLDS_VIEWER sets the path of "
        "another one"
    )


def _page(
    recordings: Sequence[Recording],
    title: str,
    worlds: Optional[int],
    every: int,
    numbers: Optional[Mapping[str, ArrayLike]],
    file: Optional[Path],
) -> object:
    from . import _record
    from .record import Recording

    for i, one in enumerate(recordings):
        if not isinstance(one, Recording):
            raise TypeError(f"recordings[{i}] is of type {type(one).__name__}; expected a Recording")
    if not isinstance(title, str):
        raise TypeError(f"title is of type {type(title).__name__}; expected a str")
    most = 0 if worlds is None else arrays.integer(worlds, "worlds", 1, 2**31 - 1)
    given = []
    for name, values in (numbers or {}).items():
        shape = (len(recordings[0].steps), len(recordings[0].worlds)) if recordings else (0, 0)
        table = arrays.numbers(values, shape, ("sample", "world"), f"numbers[{name!r}]", np.float32)
        given.append((str(name), table.reshape(-1).tolist()))
    if not recordings:
        raise ValueError("recordings is empty; expected one or more")
    every = arrays.integer(every, "every", 1, 2**31 - 1)
    held = [one._held for one in recordings]
    return _record.page(held, _empty_page(), file, title, most, every, given)
