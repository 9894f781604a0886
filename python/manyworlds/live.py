"""Shows a batch in a browser while it steps.

    view = mw.view(batch)
    print(view.url)
    while training:
        batch.step()
"""

from __future__ import annotations

import html
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

from . import arrays, files
from .batch import Batch
from .files import File
from .in_memory import InMemory
from .page import _empty_page

if TYPE_CHECKING:
    from .environment import Environment

__all__ = ["LiveView", "view"]


class LiveView(InMemory):
    """A page that shows a batch until ``close``.

    A separate thread serves it on 127.0.0.1. ``step`` and ``step_to`` of a batch, and ``step`` of an
    environment, first apply the requests of pages, then send the new state. Resets also send it. Call
    ``update`` after other changes. Without a connected page the cost is negligible. A page never delays
    a step.

    A page can drag bodies (a force in every step call until release), hit them (an impulse before the
    next step call) and save snapshots. For a batch, not for an environment, it can also set gravity and
    friction that the scene varies with ``draw="none"``. It cannot pause, reset or set controls: the
    program steps.
    """

    __slots__ = ("_batch", "_core")
    _instead = "make another one with mw.view"

    def __init__(self, core: Any, batch: Batch) -> None:
        self._core, self._batch = core, batch
        batch._views = (*batch._views, self)

    @property
    def url(self) -> str:
        """URL of the page, with the token that the server requires. Empty after ``close``."""
        return self._core.url

    @property
    def port(self) -> int:
        """Port on 127.0.0.1; 0 after ``close``."""
        return self._core.port

    @property
    def pages(self) -> int:
        """Number of connected pages."""
        return self._core.pages

    def update(self) -> None:
        """Sends the current state to pages. Steps and resets do so without this call."""
        self._core.show()

    def close(self) -> None:
        """Stops the server; pages show that. A second call has no effect."""
        self._batch._views = tuple(one for one in self._batch._views if one is not self)
        self._core.close()

    def __enter__(self) -> LiveView:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<manyworlds.LiveView: {self.url or 'closed'}>"

    def _repr_html_(self) -> str:
        url = html.escape(self.url)
        return f'<a href="{url}" target="_blank" rel="noopener">{url}</a>' if url else "closed"


def view(
    shown: Union[Batch, Environment],
    *,
    worlds: int = 64,
    title: str = "",
    port: int = 0,
    folder: Optional[File] = None,
) -> LiveView:
    """Serves a page that shows a batch, or an environment, while it steps.

    worlds    number of worlds that a page shows first; it can request up to 1024
    title     default: the name of the scene
    port      port on 127.0.0.1; 0: any free port
    folder    folder of snapshots that a page saves; default: the current folder

    Raises LiveError (a ValueError) if the page cannot be served, ImportError if the package was built
    without live pages, FileNotFoundError if it was built without the page.
    """
    from .environment import Environment

    environment = isinstance(shown, Environment)
    batch = shown.batch if isinstance(shown, Environment) else shown
    if not isinstance(batch, Batch):
        raise TypeError(f"shown is of type {type(shown).__name__}; expected a Batch or an Environment")
    if not isinstance(title, str):
        raise TypeError(f"title is of type {type(title).__name__}; expected a str")
    worlds = arrays.integer(worlds, "worlds", 1, 2**31 - 1)
    port = arrays.integer(port, "port", 0, 65535)
    place = Path.cwd() if folder is None else files.path(folder, "folder")
    page = _empty_page()
    try:
        from . import _live
    except ImportError as error:
        raise ImportError(
            "this package was built without live pages: the build needs Boost's headers "
            "(Debian: libboost-dev)"
        ) from error
    core = _live.Live(batch._held, page, title, port, worlds, max(worlds, 1024), place, not environment)
    return LiveView(core, batch)
