"""A batch in a browser while it steps. Private: use manyworlds.view."""

import os

import manyworlds._core


class LiveError(ValueError):
    """The page cannot be served."""

class Live:
    """Private: use manyworlds.view."""

    def __init__(self, batch: manyworlds._core.Batch, page: str | os.PathLike, title: str, port: int, worlds: int, max_worlds: int, folder: str | os.PathLike, parameters: bool) -> None: ...

    def apply(self, steps: int) -> None:
        """Carries out what pages asked for; before a call of so many steps."""

    def show(self) -> None:
        """Shows the worlds as they are."""

    def close(self) -> None:
        """Ends the server."""

    @property
    def url(self) -> str: ...

    @property
    def port(self) -> int: ...

    @property
    def pages(self) -> int: ...
