"""Pictures of worlds: ``manyworlds.plot.draw(batch, world=3).figure.savefig("world.png")``.

Needs matplotlib: ``pip install "manyworlds-sim[plot]"``.
"""

from __future__ import annotations

from typing import Any, Optional

from .._distribution import needs
from ..batch import Batch, checked_batch

with needs("matplotlib", extra="plot", what="manyworlds.plot"):
    from .picture import Camera, Picture

__all__ = ["Camera", "Picture", "draw"]


def draw(batch: Batch, world: int = 0, ax: Optional[Any] = None, **options: Any) -> Any:
    """Draws a world of a batch as it is now into axes of matplotlib, or new ones; returns the axes.

    ``options``: those of Picture. Keep a Picture to draw many.
    """
    return Picture(checked_batch(batch).plan.scene, **options).draw(batch, world, ax)
