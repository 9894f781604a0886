"""Base of objects that own worlds in memory: they cannot be pickled or copied."""

from __future__ import annotations

from typing import Any, NoReturn


class InMemory:
    """Raises TypeError for ``pickle`` and ``copy``."""

    __slots__ = ()
    _instead = ""  # "pickle its scene ..."

    def __reduce_ex__(self, protocol: Any) -> NoReturn:
        name = next(c.__name__ for c in type(self).__mro__ if not c.__name__.startswith("_"))
        raise TypeError(
            f"{name} objects own memory and cannot be pickled or copied; {self._instead}"
        )
