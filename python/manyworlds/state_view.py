"""View: direct access to a state field, without a copy."""

from __future__ import annotations

from typing import Any, Optional

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from .in_memory import InMemory


class View(InMemory):
    """The memory of a state field, (groups, items, components, lanes).

    World w is lane ``i % lanes`` of group ``i // lanes``, with ``i = Batch.lane_indices()[w]``. Lanes
    after the last world are unused. Positions are those of centres of mass, orientations those of
    principal axes: ``Batch.get`` converts them to the body's frame. Written values act at the next step.
    Writing does not wake bodies or clear the impulses for warm starting.

    ``numpy.asarray(view)``, ``view[...]`` and DLPack return arrays that share this memory and keep it
    alive. After ``Batch.close()`` a view raises ValueError. Arrays made before stay readable, but steps
    no longer change them. Do not access them while another thread steps.
    """

    __slots__ = ("_held", "_name", "_blocks")
    _instead = "pickle numpy.array(view), or Batch.get of the field"

    def __init__(self, core: _core.Batch, name: str, blocks: NDArray[Any]) -> None:
        self._held, self._name, self._blocks = core, name, blocks

    def _open(self) -> NDArray[Any]:
        if self._held.closed:
            raise ValueError(f"the batch of this view of {self._name} is closed")
        return self._blocks

    @property
    def shape(self) -> tuple[int, int, int, int]:
        """(groups, items, components, lanes)."""
        groups, items, components, lanes = self._open().shape
        return groups, items, components, lanes

    @property
    def strides(self) -> tuple[int, ...]:
        """Strides in bytes, as in NumPy."""
        return self._open().strides

    @property
    def dtype(self) -> np.dtype[Any]:
        """The precision of the batch: float32 or float64."""
        return self._open().dtype

    def __len__(self) -> int:
        return len(self._open())

    def __array__(self, dtype: Any = None, copy: Optional[bool] = None) -> NDArray[Any]:
        blocks = self._open()
        if dtype is not None and np.dtype(dtype) != blocks.dtype:
            if copy is False:
                raise ValueError(f"a view of {blocks.dtype} cannot become {dtype} without a copy")
            return blocks.astype(dtype)
        return blocks.copy() if copy else blocks

    def __getitem__(self, index: Any) -> Any:
        return self._open()[index]

    def __setitem__(self, index: Any, values: ArrayLike) -> None:
        self._open()[index] = values

    def __dlpack__(self, **arguments: Any) -> Any:
        return self._open().__dlpack__(**arguments)

    def __dlpack_device__(self) -> tuple[int, int]:
        return self._open().__dlpack_device__()

    def __repr__(self) -> str:
        if self._held.closed:
            return f"<manyworlds.View of {self._name}: the batch is closed>"
        return f"<manyworlds.View of {self._name}: {self.shape} {self.dtype}>"
