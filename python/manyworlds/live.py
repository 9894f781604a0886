"""A batch in a browser while it steps.

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
    """A page that shows a batch for as long as this is open.

    A thread of its own serves it on 127.0.0.1. ``step`` and ``step_to`` of the batch, and ``step``
    of an environment, carry out before what pages asked for, and show them after what came of it, as resets
    do; what else changes the worlds is shown by ``update``. Where nobody looks that costs nearly nothing, and no page can hold up a step.

    A page may drag bodies (a force in every step call until it lets go), push them (an impulse before the
    next one) and save snapshots; of a batch, not of an environment, also set gravity and friction where its scene varies
    them with ``draw="none"``. It can neither pause nor reset nor drive anything: the program steps.
    """

    __slots__ = ("_batch", "_core")
    _instead = "make another one with mw.view"

    def __init__(self, core: Any, batch: Batch) -> None:
        self._core, self._batch = core, batch
        batch._views = (*batch._views, self)

    @property
    def url(self) -> str:
        """Of the page, with the token without which nothing is served. Empty when it is closed."""
        return self._core.url

    @property
    def port(self) -> int:
        """Of 127.0.0.1; 0 when it is closed."""
        return self._core.port

    @property
    def pages(self) -> int:
        """How many are connected."""
        return self._core.pages

    def update(self) -> None:
        """Shows the worlds as they are: for what changes them but steps and resets."""
        self._core.show()

    def close(self) -> None:
        """Ends the server; pages say so. Twice is once."""
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

    worlds    that a page shows at first; it can ask for up to 1024
    title     default: the name of the scene
    port      of 127.0.0.1; 0: any that is free
    folder    where snapshots are saved that a page asks for; default: the current one

    Raises LiveError (a ValueError) where it cannot be served, ImportError where the package was built without it,
    FileNotFoundError where it was built without the page.
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
            "this package was built without live pages: they want Boost's headers where it is built "
            "(Debian: libboost-dev)"
        ) from error
    core = _live.Live(batch._held, page, title, port, worlds, max(worlds, 1024), place, not environment)
    return LiveView(core, batch)
