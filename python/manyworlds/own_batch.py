"""The batch of an environment."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from . import _core
from .batch import Batch

if TYPE_CHECKING:
    from .environment import Environment


class _OwnBatch(Batch):
    """The batch of an environment."""

    def __init__(self, environment: Environment) -> None:
        held = environment._held.batch()
        self.plan = environment._plan
        self._held = held
        self._worlds = held.worlds
        self._plans = [(self.plan, held.worlds)]
        self._kinds = None
        self._real = np.dtype(np.float32 if held.precision == "f32" else np.float64)
        # The task's observers are active; the extension rejects the others.
        self._watched = frozenset(_core.names()["Observer"])
        self._bodies = self.plan.bodies
        self._controls = held.controls()
        self._joints = len(self.plan.scene.joints)
        self._planar = self.plan.scene.space == "planar"
        self._find_fields()
