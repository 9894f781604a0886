"""How fast is it? Random actions, by the arrays of Environment and by Gymnasium's interface.

pip install "manyworlds-sim[gym]"
python throughput.py --task LunarLander --worlds 4096
"""

import argparse
import time
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

import manyworlds as mw
from manyworlds.gym import VectorEnv


def rate(
    step: Callable[[NDArray[Any]], object],
    actions: list[NDArray[Any]],
    worlds: int,
    seconds: float,
) -> float:
    """Steps of worlds per second; the actions were made before."""
    for a in actions:
        step(a)
    count, began = 0, time.perf_counter()
    while time.perf_counter() - began < seconds:
        for a in actions:
            step(a)
        count += len(actions)
    return count * worlds / (time.perf_counter() - began)


def main(argv: Sequence[str] | None = None) -> dict[str, float]:
    """Steps of worlds per second, by how they were taken."""
    p = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    p.add_argument("--task", default="LunarLander")
    p.add_argument("--worlds", type=int, default=4096)
    p.add_argument("--threads", type=int)
    p.add_argument("--seconds", type=float, default=3)
    o = p.parse_args(argv)

    env = VectorEnv(o.task, o.worlds, copy=False, threads=o.threads, seed=0)
    env.action_space.seed(0)
    actions = [np.asarray(env.action_space.sample()) for _ in range(16)]
    env.close()
    found = {}
    with mw.Environment(o.task, o.worlds, threads=o.threads) as raw:
        found["Environment.step"] = rate(raw.step, actions, o.worlds, o.seconds)
    for copy in (False, True):
        env = VectorEnv(o.task, o.worlds, copy=copy, threads=o.threads, seed=0)
        found[f"VectorEnv.step, copy={copy}"] = rate(env.step, actions, o.worlds, o.seconds)
        env.close()
    for name, speed in found.items():
        print(f"{o.task}, {o.worlds} worlds, {name}: {speed / 1e6:.2f} M steps/s")
    return found


if __name__ == "__main__":
    main()
