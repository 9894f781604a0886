"""Planning without learning: model predictive path integral control swings up Acrobot.

    pip install manyworlds
    python mppi.py

For every action all worlds of a batch become copies of the real one, try random actions for a while,
and what they tried, weighted by how well they did, is what the real world does next (Williams et al.
2017, for choices: the weights of each choice are added up).
"""

import argparse
import time
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

import manyworlds as mw


def height(observations: NDArray[np.float32]) -> NDArray[np.float32]:
    """m, of the tip over the hinge: what a plan is worth, since Acrobot's reward says little."""
    cos1, sin1, cos2, sin2 = observations[:, :4].T
    tip: NDArray[np.float32] = -cos1 - (cos1 * cos2 - sin1 * sin2)
    return tip


def main(argv: Sequence[str] | None = None) -> tuple[bool, int]:
    """Whether it swung up, and after how many steps."""
    p = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    p.add_argument("--samples", type=int, default=256)
    p.add_argument("--horizon", type=int, default=40, help="steps of the task")
    p.add_argument("--steps", type=int, default=150, help="at most")
    p.add_argument("--temperature", type=float, default=0.1, help="m of height")
    p.add_argument("--seed", type=int, default=0)
    p.add_argument("--threads", type=int)
    o = p.parse_args(argv)

    random = np.random.default_rng(o.seed)
    task = mw.tasks.load("Acrobot")
    # One world steps by itself, so that planning does not move it.
    real = mw.Environment(task, 1, threads=1, seed=o.seed, autoreset="disabled")
    worlds = mw.Environment(task, o.samples, threads=o.threads, seed=o.seed, autoreset="disabled")
    plans = random.integers(task.choices, size=(o.horizon, o.samples))
    began = time.perf_counter()
    taken = 0
    for taken in range(1, o.steps + 1):
        worlds.restore(real.save(), source=0, ids=range(o.samples))
        best, done = np.full(o.samples, -2.0), np.zeros(o.samples, bool)
        for t in range(o.horizon):
            observations, _, terminated, _ = worlds.step(plans[t])
            best = np.where(done, best, np.maximum(best, height(observations)))
            best += 0.02 * (terminated & ~done) * (o.horizon - t)  # the sooner the better
            done |= terminated
        weights = np.exp((best - best.max()) / o.temperature)
        votes = np.bincount(plans[0], weights, minlength=task.choices)
        observations, _, terminated, _ = real.step([int(votes.argmax())])
        if terminated[0]:
            break
        # The next plans are good ones of these, a step later and changed here and there.
        chosen = random.choice(o.samples, o.samples, p=weights / weights.sum())
        plans = np.concatenate(
            [plans[1:, chosen], random.integers(task.choices, size=(1, o.samples))]
        )
        changed = random.random(plans.shape) < 0.1
        plans[changed] = random.integers(task.choices, size=int(changed.sum()))
    wall = time.perf_counter() - began
    up = bool(real.terminated[0])
    print(
        f"{'up' if up else 'not up'} after {taken} steps, {wall:.1f} s, "
        f"{taken * o.samples * o.horizon / wall / 1e3:.0f} k planned steps/s"
    )
    return up, taken


if __name__ == "__main__":
    main()
