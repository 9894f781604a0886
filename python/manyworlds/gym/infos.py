"""A task's infos in Gymnasium's format: a[0], a[1] and so on become the array a."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from typing import NamedTuple, Union

from ..tasks import Info

_ELEMENT = re.compile(r"(.+)\[\d+\]")


class Told(NamedTuple):
    """An info with one name: its columns of ``Environment.infos``."""

    name: str
    columns: Union[int, list[int]]  # several are an array, in their order
    of_steps_alone: bool


def told(infos: Sequence[Info]) -> Iterator[Told]:
    """The infos of a task, each at the position of its first column."""
    arrays: dict[str, list[int]] = {}
    for column, info in enumerate(infos):
        if element := _ELEMENT.fullmatch(info.name):
            arrays.setdefault(element[1], []).append(column)
    for column, info in enumerate(infos):
        element = _ELEMENT.fullmatch(info.name)
        if element is None:
            yield Told(info.name, column, info.of_steps_alone)
        elif arrays[element[1]][0] == column:
            yield Told(element[1], arrays[element[1]], info.of_steps_alone)
