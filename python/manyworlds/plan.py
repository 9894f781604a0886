"""Plan: the stages and arrays that a step of a scene needs. Immutable, shared by batches."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Optional

from . import _core, shown
from .ids import (
    BodyId,
    BodyRef,
    ControlId,
    ControlRef,
    JointId,
    JointRef,
    KeyframeId,
    KeyframeRef,
    ShapeId,
    SiteId,
    SiteRef,
    TendonId,
    TendonRef,
)
from .names import BroadPhase, Feature
from .options import Options
from .scene import Issue, Scene, SceneError


def _value_text(value: float | str) -> str:
    return value if isinstance(value, str) else f"{value:.4g}"


class Plan(_core.Plan):
    """The stages and arrays that a step of a scene needs.

    ``keep`` enables features that the scene does not need, ``broad_phase`` chooses the pair search.
    Neither changes a result. Raises SceneError, which lists all issues of the scene.
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
        self._broad_phase, self._keep = broad_phase, tuple(keep)

    @property
    def broad_phase(self) -> BroadPhase:
        """The requested pair search; ``report()["broad_phase"]`` is the chosen one."""
        return self._broad_phase

    @property
    def keep(self) -> tuple[Feature, ...]:
        """The requested features."""
        return self._keep

    @property
    def scene(self) -> Scene:
        """A copy of the scene."""
        scene: Scene = super().scene  # type: ignore[assignment]
        return scene

    @property
    def resolved(self) -> Options:
        """The options of the scene, with the values that the plan chose. A copy."""
        options: Options = super().resolved  # type: ignore[assignment]
        return options

    def body(self, name: BodyRef) -> BodyId:
        """The body with a name, as Scene.body. Raises ValueError if there is none or several, IndexError."""
        return BodyId(self.find("body", name))

    def joint(self, name: JointRef) -> JointId:
        """The joint with a name: see body."""
        return JointId(self.find("joint", name))

    def control(self, name: ControlRef) -> ControlId:
        """The control with a name: see body."""
        return ControlId(self.find("control", name))

    def tendon(self, name: TendonRef) -> TendonId:
        """The tendon with a name: see body."""
        return TendonId(self.find("tendon", name))

    def site(self, name: SiteRef) -> SiteId:
        """The site with a name: see body."""
        return SiteId(self.find("site", name))

    def keyframe(self, name: KeyframeRef) -> KeyframeId:
        """The keyframe with a name: see body."""
        return KeyframeId(self.find("keyframe", name))

    def shape(self, name: str, body: Optional[BodyRef] = None) -> ShapeId:
        """The shape with a name, of any body or of ``body``: see body."""
        of, index = self.find_shape(name, body)
        return ShapeId(BodyId(of), index)

    def body_in_row(self, row: int) -> BodyId:
        """The body in a row of arrays (worlds, bodies, ...). Raises IndexError."""
        return BodyId(super().body_in_row(row))

    def text(self) -> str:
        """The report as text: choices, features and stages with reasons, pairs, arrays."""
        report: dict[str, Any] = self.report()
        lines = [
            f"broad phase {report['broad_phase']}, {report['bytes_per_world']} bytes per world, "
            f"room for {report['pair_capacity']} + {report['fixed_capacity']} manifolds"
        ]
        if report["choices"]:
            lines.append("chosen by the plan:")
        for choice in report["choices"]:
            value = _value_text(choice["value"])
            lines.append(f"  {choice['option']:<22} {value:<10} {choice['why']}")
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
        return shown.line(
            "Plan",
            super().scene.name,  # type: ignore[attr-defined]
            f"{self.bodies} bodies",
            f"{self.coordinates} joint coordinates",
            f"fingerprint {self.fingerprint:016x}",
        )

    def _repr_html_(self) -> str:
        """Features, stages and pairs of shapes as tables, for notebooks."""
        report: dict[str, Any] = self.report()
        chosen = [(c["option"], _value_text(c["value"]), c["why"]) for c in report["choices"]]
        parts = [shown.table("chosen by the plan", ("option", "value", "why"), chosen)]
        parts += [
            shown.table(
                f"Plan {self.scene.name}: {part}",
                ("", "in", "why"),
                [(i["name"], "yes" if i["in"] else "no", i["why"]) for i in report[part]],
            )
            for part in ("features", "stages")
        ]
        pairs = [(p["kernel"], p["kind"], p["candidates"], p["culled"]) for p in report["pairs"]]
        head = "kernel", "kind", "tested", "never touch"
        return "".join(parts) + shown.table("pairs of shapes", head, pairs)
