"""System identification: friction and damping of a robot from a recording of its motion, by CMA-ES.

    pip install "manyworlds-sim[search]"
    python identification.py

A cheetah with hidden friction under its feet and hidden damping in its six joints moves under known torques; its
coordinates are recorded, and noise is added. Then every world of a batch is a candidate: it plays the same torques
with numbers of its own, and the search goes where the motions are alike.

Two seconds tell enough. The longer a motion with contacts, the more it depends on every number, and the more places
there are in which a search gets stuck.
"""

import argparse
import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray

import manyworlds as mw
from manyworlds import record, search

JOINTS = "hip_hind", "knee_hind", "ankle_hind", "hip_fore", "knee_fore", "ankle_fore"
EVERY = 2  # steps between two samples
Array = NDArray[Any]


def numbers(scene: mw.Scene) -> search.Space:
    """Friction of everything, and the damping of each joint; a quarter to four times what the model has."""
    friction = search.Parameter(
        "friction", 0.45 / 4, 0.45 * 4, "log", sets=search.Number("friction")
    )
    damping = []
    for name in JOINTS:
        guess = scene.joints[int(scene.joint(name))].dynamics.damping
        sets = search.Number("damping", joint=name)
        damping.append(search.Parameter(name, guess / 4, guess * 4, "log", sets=sets))
    return search.Space(friction, *damping)


def torques(steps: int, dt: float, random: np.random.Generator) -> Array:
    """(steps, 1, joints), in shares of what each motor can: waves that are not in step."""
    t = np.arange(steps)[:, None] * dt
    rate, phase = random.uniform(0.7, 2.5, (3, 1, 6)), random.uniform(0, 2 * np.pi, (3, 1, 6))
    waves: Array = 0.4 * np.sin(2 * np.pi * rate * t + phase).sum(axis=0)
    return np.clip(waves, -1, 1)[:, None]


def main(argv: Sequence[str] | None = None) -> dict[str, tuple[float, float]]:
    """What was hidden and what was found, by name."""
    p = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    p.add_argument("--candidates", type=int, default=512, help="of a generation")
    p.add_argument("--generations", type=int, default=40)
    p.add_argument("--seconds", type=float, default=2, help="of the recording")
    p.add_argument("--noise", type=float, default=1e-3, help="of what is recorded, m and rad")
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("--threads", type=int)
    o = p.parse_args(argv)

    scene = mw.scenes.load("cheetah")
    space, steps = numbers(scene), round(o.seconds / scene.options.dt)
    random = np.random.default_rng(o.seed)
    controls = torques(steps, scene.options.dt, random)
    hidden = space.named(space.values([random.uniform(0.25, 0.75, len(space))])[0])  # half to twice
    motion: Literal["generalized_position"] = "generalized_position"
    seen = np.zeros((steps // EVERY, scene.compile().coordinates))

    def error(run: search.Run) -> Array:
        """(worlds,): root mean square of how far motions are from what was seen, m and rad alike."""
        off = run.fields[motion][..., 0] - seen[:, None]
        found: Array = np.sqrt(np.mean(off**2, axis=(0, 2)))
        return found

    trial = search.Trial(
        scene, space, error, steps, controls=controls, fields=[motion], every=EVERY, threads=o.threads
    )  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        file, _ = trial.record(hidden, 0, Path(folder) / "motion.h5", every=EVERY)
        with file:
            seen[:] = file.get(motion)[1:, 0, :, 0]
    seen += o.noise * random.normal(size=seen.shape)
    hunt = search.Search(trial, search.CmaEs(o.candidates, sigma=0.15), seed=o.seed)
    hunt.run(o.generations, on_generation=lambda g: print(g) if g.index % 5 == 4 else None)
    found = hunt.mean
    assert found is not None
    for name, a in hidden.items():
        b = found[name]
        print(f"{name:10}  hidden {a:7.4f}  found {b:7.4f}  {100 * (b / a - 1):+.2f} %")
    return {name: (a, found[name]) for name, a in hidden.items()}


if __name__ == "__main__":
    main()
