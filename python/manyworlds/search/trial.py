"""Trials of candidates in worlds of a scene."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import arrays
from ..batch import Batch
from ..kinds import AnyScene
from ..names import FieldName, Isa, Observer, Precision
from ..rollout import MAX_STEPS, Trajectories
from ..scene import Point, Ray
from .numbers import Numbers
from .outcome import Objective, Run
from .rounds import Rounds
from .space import Doubles, Space


class Trial(Rounds):
    """Tries candidates in worlds of a scene. The objective computes their values.

    scene      a Scene, a Plan or a name; a copy gets the variations of the parameters
    space      the parameters
    objective  function of a Run after the last step; returns values (worlds,) or a Score
    steps      number of steps; not with ``drive``
    begin      function of a Run after the reset, when its worlds have their parameters. Applies
               other parameters: velocities, positions, enabled bodies. Not for forces: they would
               act in every step
    controls   (steps, 1 or worlds, controls), or a function of a Run that returns them; None: the
               scene's values
    drive      function of a Run, instead of ``steps``, ``controls`` and ``fields``. Steps
               ``run.batch`` and returns ``run.fields``, a dict of arrays
    fields     fields of ``run.fields``, recorded after every ``every`` steps as in Batch.rollout
    worlds     number of concurrent worlds; None: the number of candidates, at most 16,384

    Other arguments are those of Batch. Each world starts with the seed of its candidate.
    """

    def __init__(
        self,
        scene: AnyScene,
        space: Space,
        objective: Objective,
        steps: int = 0,
        *,
        begin: Optional[Callable[[Run], None]] = None,
        controls: Union[ArrayLike, Callable[[Run], ArrayLike], None] = None,
        drive: Optional[Callable[[Run], Trajectories]] = None,
        fields: Sequence[FieldName] = (),
        every: int = 1,
        worlds: Optional[int] = None,
        threads: Optional[int] = None,
        precision: Precision = "f32",
        isa: Optional[Isa] = None,
        sleep: bool = False,
        observe: Sequence[Observer] = (),
        rays: Sequence[Ray] = (),
        points: Sequence[Point] = (),
    ) -> None:
        super().__init__(space, objective, worlds)
        self._steps = arrays.integer(steps, "steps", 0, MAX_STEPS)
        if drive is not None and (steps or controls is not None or fields):
            raise ValueError(
                "drive takes its own steps; expected no steps, controls or fields with it"
            )
        if drive is None and not steps:
            raise ValueError("steps is 0, must be 1 or more, or drive given")
        self._numbers = Numbers(scene, space)
        self._on_begin, self._controls, self._drive = begin, controls, drive
        self._fields, self._every = fields, arrays.integer(every, "every", 1, MAX_STEPS)
        self._batch = {
            "threads": threads,
            "precision": precision,
            "isa": isa,
            "sleep": sleep,
            "observe": observe,
            "rays": rays,
            "points": points,
        }
        self._make(1).close()  # raises errors early

    def _make(self, worlds: int) -> Batch:
        return Batch(self._numbers.plan, worlds, **self._batch)  # type: ignore[arg-type]

    def _begin(self, held: Batch, values: Doubles, seeds: NDArray[np.uint64]) -> Run:
        held.reset()
        held.reset(seeds=seeds)
        self._numbers.write(held, values)
        run = Run(self._space, held, values, seeds)
        if self._on_begin is not None:
            self._on_begin(run)
        return run

    def _play(self, run: Run) -> None:
        if self._drive is not None:
            run.fields = self._drive(run)
            return
        controls = self._controls(run) if callable(self._controls) else self._controls
        steps = self._steps if controls is None else None
        if controls is not None and np.shape(controls)[:1] != (self._steps,):
            raise ValueError(
                f"controls have shape {np.shape(controls)}; expected (steps={self._steps}, worlds, controls)"
            )
        if run.recording:
            run.fields = self._stepwise(run.batch, controls)
        elif controls is None and not self._fields:
            run.batch.step(self._steps)
        else:
            run.fields = run.batch.rollout(None, controls, steps, self._fields, self._every)

    # The bits of a rollout, with a call for every step.
    def _stepwise(self, batch: Batch, controls: Optional[ArrayLike]) -> Trajectories:
        frames: dict[str, list[NDArray[Any]]] = {name: [] for name in self._fields}
        for step in range(self._steps):
            batch.step(1, None if controls is None else np.asarray(controls)[step])
            if (step + 1) % self._every == 0:
                for name, seen in frames.items():
                    seen.append(batch.get(name))
        return {name: np.stack(seen) for name, seen in frames.items()}
