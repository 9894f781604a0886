"""Pictures and films of worlds, drawn by headless Chromium and encoded by ffmpeg.

    recording = mw.record.Recording("run.h5")
    mw.write_film([recording], "run.mp4", speed=0.25)
    mw.write_picture([recording], "run.png", time=1.2, size=(1080, 600))

Both programs run as separate processes. CHROMIUM in the environment names another Chromium. Films
use the ffmpeg of FFMPEG in the environment, of PATH, or of the package imageio-ffmpeg. Every frame
shows the page of ``write_page`` at exactly its time, however long rendering takes.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple, Optional
from urllib.parse import quote, urlencode

from numpy.typing import ArrayLike

from . import arrays, files
from .files import File
from .ids import BodyId, BodyRef, index_of
from .page import write_page

if TYPE_CHECKING:
    from .record import Recording

__all__ = ["FilmReport", "write_film", "write_picture"]

_LEAST, _MOST = 64, 8192  # pixels


class FilmReport(NamedTuple):
    """Contents of a film."""

    frames: int
    seconds: float  # duration of the film
    bytes: int


def write_picture(
    recordings: Sequence[Recording],
    file: File,
    *,
    time: Optional[float] = None,
    size: tuple[int, int] = (1280, 720),
    world: Optional[int] = None,
    follow: Optional[BodyRef] = None,
    color: str = "body",
    dark: bool = False,
    title: str = "",
    worlds: Optional[int] = None,
    numbers: Optional[Mapping[str, ArrayLike]] = None,
) -> None:
    """Writes a PNG file of recordings, all in one picture.

    time    simulated time, s; None, and times after the end: the end
    size    width and height, pixels, 64 to 8192
    world   index of the shown world at which the camera is aimed, from 0; None: all
    follow  the camera is aimed at this body of that world (world 0 if world is None), and follows
            it in films: a name, or an index in the scene such as a BodyId
    color   color of bodies: "body", "speed", "spin", "rest", "height"; "contact" if contacts were
            recorded; "run" for several recordings; "number:reward" for an entry of ``numbers``
    dark    True: use the dark theme
    title, worlds, numbers    as in ``write_page``

    Raises record.FilmError (a ValueError) if Chromium is missing or fails, or the file cannot be
    written. Raises the errors of ``write_page``.
    """
    from . import _record

    width, height = _size(size, 1)
    moment = float("inf") if time is None else arrays.at_least(time, "time", 0)
    view = _view(world, follow, color, dark)
    target = files.path(file, "file")
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder) / "page.html"
        write_page(recordings, page, title=title, worlds=worlds, numbers=numbers)
        _record.picture(page, target, width, height, view, moment)


def write_film(
    recordings: Sequence[Recording],
    file: File,
    *,
    fps: float = 30,
    speed: float = 1,
    begin: float = 0,
    end: Optional[float] = None,
    size: tuple[int, int] = (1280, 720),
    world: Optional[int] = None,
    follow: Optional[BodyRef] = None,
    color: str = "body",
    dark: bool = False,
    title: str = "",
    worlds: Optional[int] = None,
    numbers: Optional[Mapping[str, ArrayLike]] = None,
) -> FilmReport:
    """Writes an MP4 file (H.264) of recordings, all in one picture.

    fps     frames per second of the film, 0.01 to 1000
    speed   simulated seconds per second of the film: 0.25 is slow motion
    begin   start time, s, 0 or later: frame k is at begin + k * speed / fps
    end     end time, s; None, and times after the end: the end
    size    width and height, pixels, even numbers from 64 to 8192
    other arguments  as in ``write_picture``

    Motion between samples is linear. For slow motion, record samples more often. Raises
    record.FilmError (a ValueError) if Chromium or ffmpeg is missing or fails, or the file cannot be
    written. Raises the errors of ``write_page``.
    """
    from . import _record

    width, height = _size(size, 2)
    fps = _within(fps, "fps", 0.01, 1000)
    speed = _within(speed, "speed", 1e-6, 1e6)
    begin = arrays.at_least(begin, "begin", 0)
    encoder = encoder_program()
    last = float("inf") if end is None else arrays.at_least(end, "end", begin)
    view = _view(world, follow, color, dark)
    target = files.path(file, "file")
    with tempfile.TemporaryDirectory() as folder:
        page = Path(folder) / "page.html"
        write_page(recordings, page, title=title, worlds=worlds, numbers=numbers)
        return FilmReport(*_record.film(page, target, width, height, view, fps, speed, begin, last, encoder))


def encoder_program() -> str:
    """The ffmpeg of the package imageio-ffmpeg, if it is installed and no other is found; else
    empty.

    FFMPEG in the environment and PATH take precedence.
    """
    if os.environ.get("FFMPEG") or shutil.which("ffmpeg"):
        return ""
    try:
        from imageio_ffmpeg import get_ffmpeg_exe

        return str(get_ffmpeg_exe())
    except (ImportError, RuntimeError):  # not installed, or without a program for this machine
        return ""


def _size(size: tuple[int, int], step: int) -> tuple[int, int]:
    if not isinstance(size, (tuple, list)) or len(size) != 2:
        raise TypeError(f"size is {size!r}; expected a width and a height")
    width, height = (arrays.integer(side, f"size[{i}]", _LEAST, _MOST) for i, side in enumerate(size))
    if width % step or height % step:
        raise ValueError(f"size is {width} x {height}; films need even numbers")
    return width, height


def _within(value: float, name: str, low: float, high: float) -> float:
    value = arrays.at_least(value, name, low)
    if value > high:
        raise ValueError(f"{name} is {value}; expected {low} to {high}")
    return value


def _view(world: Optional[int], follow: Optional[BodyRef], color: str, dark: bool) -> str:
    """The options of a page's address, after '#'."""
    if not isinstance(color, str):
        raise TypeError(f"color is of type {type(color).__name__}; expected a str")
    wanted = {"color": color, "theme": "dark" if dark else "light"}
    if world is not None:
        wanted["world"] = str(arrays.integer(world, "world", 0, 2**31 - 1))
    if isinstance(follow, str):
        if not follow:
            raise ValueError("follow is empty; expected the name of a body")
        wanted["follow"] = follow
    elif follow is not None:
        body = index_of(follow, BodyId, int, "follow")
        wanted["follow"] = str(int(arrays.integer(body, "follow", 0, 2**31 - 1)))
    return urlencode(wanted, quote_via=quote)
