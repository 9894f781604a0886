"""Pictures of worlds: ``manyworlds.plot.draw(batch, world=3).figure.savefig("world.png")``.

Needs matplotlib: pip install "manyworlds[plot]".
"""

from __future__ import annotations

from typing import Any, Optional

try:
    from .picture import Camera, Picture
except ModuleNotFoundError as error:
    if not (error.name or "").startswith("matplotlib"):
        raise
    raise ImportError(
        f'manyworlds.plot needs matplotlib; pip install "manyworlds[plot]": {error}'
    ) from error
from ..batch import Batch, checked_batch

__all__ = ["Camera", "Picture", "draw"]


def draw(batch: Batch, world: int = 0, ax: Optional[Any] = None, **options: Any) -> Any:
    """Draws a world of a batch as it is now into axes of matplotlib, or new ones; returns the axes.

    ``options``: those of Picture. Keep a Picture to draw many.
    """
    return Picture(checked_batch(batch).plan.scene, **options).draw(batch, world, ax)
