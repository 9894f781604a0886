"""Plan: what a step of a scene consists of. Immutable; batches share it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from . import _core
from .names import BroadPhase, Feature
from .scene import Issue, Scene, SceneError


class Plan(_core.Plan):
    """What the step needs for a scene, and nothing else.

    ``keep`` switches features on that the scene does not need, ``broad_phase`` chooses how pairs are
    found; neither changes a result. Raises SceneError with every issue of the scene.
    """

    def __init__(
        self,
        scene: Scene,
        *,
        broad_phase: BroadPhase = "automatic",
        keep: Sequence[Feature] = (),
    ) -> None:
        issues = _core.validate(scene)
        if issues:
            raise SceneError([Issue(*issue) for issue in issues])
        super().__init__(scene, broad_phase, keep)

    @property
    def scene(self) -> Scene:
        """A copy of the scene."""
        scene: Scene = super().scene  # type: ignore[assignment]
        return scene

    def state_body_named(self, name: str) -> int:
        """Index of the state body of that name: where its row in arrays is. Raises ValueError."""
        names = [body.name for body in self.scene.bodies]
        if name not in names:
            raise ValueError("the body " + _core.unknown_name(name, sorted({*names} - {""})))
        body: int = self.state_body(names.index(name))
        if body < 0:
            raise ValueError(f"the body '{name}' is fixed and has no state")
        return body

    def text(self) -> str:
        """The report for people: features and stages with their reasons, pairs, arrays."""
        report: dict[str, Any] = self.report()
        lines = [
            f"broad phase {report['broad_phase']}, {report['bytes_per_world']} bytes per world, "
            f"room for {report['pair_capacity']} + {report['fixed_capacity']} manifolds"
        ]
        for part in ("features", "stages"):
            lines.append(f"{part}:")
            for item in report[part]:
                lines.append(f"  {'+' if item['in'] else '-'} {item['name']:<18} {item['why']}")
        lines.append("pairs of shapes:")
        for pair in report["pairs"]:
            lines.append(
                f"  {pair['kernel']:<22} {pair['kind']:<6} {pair['candidates']} tested, "
                f"{pair['culled']} never touch"
            )
        lines.append("arrays:")
        for array in report["arrays"]:
            size = f"{array['bytes_per_world']} bytes per world"
            lines.append(f"  {array['name']:<22} {array['shape']:<16} {size}")
        return "\n".join(lines)

    def __repr__(self) -> str:
        return f"<manyworlds.Plan: {self.bodies} bodies, fingerprint {self.fingerprint:016x}>"
