"""System identification: friction and damping of a robot from a recording of its motion, by CMA-ES.

    pip install manyworlds cma
    python identification.py

A cheetah with hidden friction under its feet and hidden damping in its six joints moves under known torques; its
coordinates are recorded, and noise is added. Then every world of a batch is a candidate: it plays the same torques
with numbers of its own, and the search goes where the motions are alike.

Two seconds tell enough. The longer a motion with contacts, the more it depends on every number, and the more places
there are in which a search gets stuck.
"""

import argparse
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import cma
import numpy as np
from numpy.typing import NDArray

import manyworlds as mw
from manyworlds import record

JOINTS = "hip_hind", "knee_hind", "ankle_hind", "hip_fore", "knee_fore", "ankle_fore"
EVERY = 2  # steps between two samples
MOST = np.log(4)  # of the logarithm by which a number differs from the guess
Array = NDArray[Any]


def robot() -> tuple[mw.Scene, Array]:
    """What may differ from world to world is declared, and guessed as the model has it."""
    scene = mw.scenes.load("cheetah")
    joints = [scene.joints[int(scene.joint(name))] for name in JOINTS]
    damping = [joint.dynamics.damping for joint in joints]
    scene.add(mw.vary("friction", 0.1, 2, draw="none"))
    for name in JOINTS:
        scene.add(mw.vary("damping", 0.3, 30, draw="none", joint=name))
    return scene, np.array([0.45, *damping])


def give(batch: mw.Batch, numbers: Array) -> None:
    """(worlds, 7): of each world the friction, and the damping of its joints in N m s/rad."""
    damping = batch.get("damping")
    damping[:, [int(batch.plan.joint(name)) for name in JOINTS], 0] = numbers[:, 1:]
    batch.set("damping", damping)
    batch.set("friction", numbers[:, :1, None])


def torques(steps: int, dt: float, random: np.random.Generator) -> Array:
    """(steps, 1, joints), in shares of what each motor can: waves that are not in step."""
    t = np.arange(steps)[:, None] * dt
    rate, phase = random.uniform(0.7, 2.5, (3, 1, 6)), random.uniform(0, 2 * np.pi, (3, 1, 6))
    waves: Array = 0.4 * np.sin(2 * np.pi * rate * t + phase).sum(axis=0)
    return np.clip(waves, -1, 1)[:, None]


def recording(scene: mw.Scene, hidden: Array, controls: Array) -> Array:
    """(samples, coordinates): the motion, from a file."""
    with tempfile.TemporaryDirectory() as folder, mw.Batch(scene, 1, threads=1) as real:
        give(real, hidden[None])
        file = Path(folder) / "motion.h5"
        with record.Recorder(real, file, every=EVERY):
            for row in controls:
                real.step(1, controls=row)
        with record.Recording(file) as motion:
            return motion.get("generalized_position")[1:, 0, :, 0]


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

    scene, guess = robot()
    random = np.random.default_rng(o.seed)
    controls = torques(round(o.seconds / scene.options.dt), scene.options.dt, random)
    hidden = guess * np.exp(random.uniform(-0.7, 0.7, len(guess)))  # half to twice
    seen = recording(scene, hidden, controls)
    seen = seen + o.noise * random.normal(size=seen.shape)
    batch = mw.Batch(scene, o.candidates, threads=o.threads)

    def errors(numbers: Array) -> Array:
        """(worlds,): root mean square of how far motions are from what was seen, m and rad alike."""
        batch.reset()
        give(batch, numbers)
        fields = ["generalized_position"]
        motion = batch.rollout(None, controls=controls, fields=fields, every=EVERY)[fields[0]]
        found: Array = np.sqrt(np.mean((motion[..., 0] - seen[:, None]) ** 2, axis=(0, 2)))
        return found

    search = cma.CMAEvolutionStrategy(
        np.zeros(len(guess)),
        0.4,
        {"popsize": o.candidates, "CMA_mu": o.candidates // 10, "bounds": [-MOST, MOST],
         "seed": o.seed, "verbose": -9},
    )  # fmt: skip
    began = time.perf_counter()
    for generation in range(o.generations):
        tried = np.array(search.ask())
        error = errors(guess * np.exp(tried))
        search.tell(tried, error)
        if generation % 5 == 4:
            wall = time.perf_counter() - began
            print(f"generation {generation}: off by {error.min():.4f} m and rad, {wall:.1f} s")
    batch.close()
    found = guess * np.exp(search.result.xfavorite)
    for name, a, b in zip(("friction", *JOINTS), hidden, found):
        print(f"{name:10}  hidden {a:7.4f}  found {b:7.4f}  {100 * (b / a - 1):+.2f} %")
    return {name: (a, b) for name, a, b in zip(("friction", *JOINTS), hidden, found)}


if __name__ == "__main__":
    main()
