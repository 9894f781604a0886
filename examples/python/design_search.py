"""Design search: the shot that displaces most boxes, by CMA-ES over BirdSling.

    pip install manyworlds cma
    python design_search.py --generations 8

One world is one candidate: 10,000 shots a generation, all of them simulated at once.
"""

import argparse
import time
from collections.abc import Sequence
from typing import Any

import cma
import numpy as np
from numpy.typing import NDArray

import manyworlds as mw


def main(argv: Sequence[str] | None = None) -> list[tuple[float, float]]:
    """(mean, best) of each generation."""
    p = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    p.add_argument("--candidates", type=int, default=10_000, help="of a generation")
    p.add_argument("--generations", type=int, default=8)
    p.add_argument("--threads", type=int)
    o = p.parse_args(argv)

    task = mw.tasks.load("BirdSling")
    n, steps = o.candidates, task.max_steps
    env = mw.Environment(task, n, threads=o.threads, seed=1, autoreset="disabled")
    low, high = (np.array([getattr(a, end) for a in task.actions]) for end in ("low", "high"))

    def scores(designs: NDArray[Any]) -> NDArray[np.float64]:
        """Returns of one shot each, every generation in the very same worlds."""
        env.reset(seeds=1)
        actions = np.ascontiguousarray(low + (high - low) * np.clip(designs, 0, 1), np.float32)
        total = np.zeros(n)
        for _ in range(steps):
            total += env.step(actions)[1]
        return total

    search = cma.CMAEvolutionStrategy(
        [0.5] * len(task.actions),
        0.3,
        # Few shots hit anything: the best twentieth says where to look.
        {"popsize": n, "CMA_mu": n // 20, "bounds": [0, 1], "seed": 1, "verbose": -9},
    )
    history = []
    for generation in range(o.generations):
        designs = np.array(search.ask())
        began = time.perf_counter()
        found = scores(designs)
        wall = time.perf_counter() - began
        search.tell(designs, -found)
        top = designs[np.argmax(found)]
        history.append((float(found.mean()), float(found.max())))
        print(
            f"generation {generation}: mean {found.mean():6.2f}, best {found.max():6.2f} at strength "
            f"{top[0]:.3f}, steepness {top[1]:.3f}; {n} shots in {wall:.2f} s"
        )
    env.close()
    return history


if __name__ == "__main__":
    main()
