"""A batch in a browser while it steps. Private: use manyworlds.view."""

import os

import manyworlds._core


class LiveError(ValueError):
    """The page cannot be served."""

class Live:
    """Private: use manyworlds.view."""

    def __init__(self, batch: manyworlds._core.Batch, page: str | os.PathLike, title: str, port: int, worlds: int, max_worlds: int, folder: str | os.PathLike, parameters: bool) -> None: ...

    def apply(self, steps: int) -> None:
        """Applies requests of pages before a call of this number of steps."""

    def show(self) -> None:
        """Sends the current state to pages."""

    def close(self) -> None:
        """Stops the server."""

    @property
    def url(self) -> str: ...

    @property
    def port(self) -> int: ...

    @property
    def pages(self) -> int: ...
