"""Ray Tune chooses numbers of a task; a trial tries each choice in many worlds at once.

    pip install "ray[tune]"
    python examples/python/tune_search.py [--trials 24] [--worlds 256]

Which gains of a linear controller keep the pole up, on the mean of many beginnings. (manyworlds.search tries one
candidate a world, without Ray; Tune is for those who have their schedulers, loggers and searches there.)
"""

import argparse
from typing import Any

import numpy as np
from numpy.typing import NDArray
from ray import tune

import manyworlds as mw


def upright(choice: dict[str, Any]) -> dict[str, float]:
    """The mean return of an episode under a linear controller, over many worlds."""
    gains: NDArray[np.float64] = np.array([choice["x"], choice["v"], choice["angle"], choice["spin"]])
    with mw.Environment("CartPole", worlds=int(choice["worlds"]), threads=1, seed=1) as e:
        alive = np.ones(e.worlds, bool)
        returns = np.zeros(e.worlds)
        while alive.any():
            e.step(np.where(e.observations @ gains > 0, 1, 0))
            returns[alive] += e.rewards[alive]
            alive &= ~(e.terminated | e.truncated)
    return {"mean_return": float(returns.mean())}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--trials", type=int, default=24)
    parser.add_argument("--worlds", type=int, default=256)
    given = parser.parse_args()
    space = {name: tune.uniform(-1, 1) for name in ("x", "v", "angle", "spin")}
    tuner = tune.Tuner(
        tune.with_resources(upright, {"cpu": 1}),
        param_space={**space, "worlds": given.worlds},
        tune_config=tune.TuneConfig(metric="mean_return", mode="max", num_samples=given.trials),
    )
    best = tuner.fit().get_best_result()
    assert best.metrics is not None and best.config is not None
    print(f"mean return {best.metrics['mean_return']:.1f} with {best.config}")


if __name__ == "__main__":
    main()
