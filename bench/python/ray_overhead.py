"""What Ray costs: the same rollouts by one actor and in this process, in turns, by steps of a call.

    python bench/python/ray_overhead.py [--task Hopper] [--worlds 4096] [--turns 5] [--json FILE]

Real time of calls of 1, 10, 100 and 400 steps, with all their trajectories and without, the least of some turns;
both have as many threads as there are cores. Then bytes of a world's state, of its trajectory by step, and of a
snapshot, and how long it takes to save worlds and to put another actor in the place of one that was killed.
"""

import argparse
import json
import os
import pickle
import signal
import time
from collections.abc import Sequence
from typing import Any

import numpy as np

import manyworlds as mw
from manyworlds.ray import Rollouts
from manyworlds.ray.shard import OF_A_TASK


def seconds(call: Any) -> float:
    """Real time of a call."""
    began = time.perf_counter()
    call()
    return time.perf_counter() - began


def overhead(
    here: Rollouts, there: Rollouts, steps: int, turns: int, keep: Sequence[str]
) -> dict[str, float]:
    """World-steps/s of both, and what a call of the actor takes more, in ms and per cent."""
    best = [np.inf, np.inf]
    for _ in range(turns):
        for i, rollouts in enumerate((here, there)):
            best[i] = min(best[i], seconds(lambda r=rollouts: list(r.run(steps, 1, keep).parts)))
    speeds = [here.worlds * steps / one for one in best]
    return {
        "steps": steps,
        "here": speeds[0],
        "actor": speeds[1],
        "ms": (best[1] - best[0]) * 1e3,
        "percent": (best[1] / best[0] - 1) * 100,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--task", default="Hopper")
    parser.add_argument("--worlds", type=int, default=4096)
    parser.add_argument("--turns", type=int, default=5)
    parser.add_argument("--json")
    given = parser.parse_args()
    cores = len(os.sched_getaffinity(0))
    common = {"threads": cores, "block": given.worlds}
    result: dict[str, Any] = {"task": given.task, "worlds": given.worlds, "cores": cores}
    with (
        Rollouts(given.task, given.worlds, shards=0, **common) as here,
        Rollouts(given.task, given.worlds, shards=1, cpus=cores, **common) as there,
    ):
        for rollouts in (here, there):
            rollouts.run(20)
        result["calls"] = []
        for keep in (OF_A_TASK, ()):
            for steps in (1, 10, 100, 400):
                row = overhead(here, there, steps, given.turns, keep)
                result["calls"].append(row | {"trajectories": bool(keep)})
                print(
                    f"{steps:5} steps a call, {'all' if keep else 'no'} trajectories: here "
                    f"{row['here']:.4g}, actor {row['actor']:.4g} world-steps/s; a call takes "
                    f"{row['ms']:.2f} ms more, {row['percent']:.1f} %"
                )
        same = np.array_equal(here.run(1).report.hashes, there.run(1).report.hashes)
        trajectory = sum(a.nbytes for part in here.run(1).parts for a in part.values())
        result["trajectory_bytes"] = trajectory / given.worlds
        os.kill(there.processes[0], signal.SIGKILL)
        result["replaced_s"] = seconds(lambda: there.run(1))
        result["same"] = same and bool(there.restarts == 1)
    with mw.Environment(given.task, given.worlds, threads=cores) as e:
        e.step(np.zeros(e.action_shape, np.int64 if e.discrete else np.float32))
        result["save_s"] = min(seconds(e.save) for _ in range(3))
        result["snapshot_bytes"] = len(pickle.dumps(e.save())) / given.worlds
        result["state_bytes"] = e.batch.bytes_per_world
    print(
        f"a world: {result['state_bytes']} B of state, {result['trajectory_bytes']:.0f} B of trajectory a step, "
        f"{result['snapshot_bytes']:.0f} B of snapshot; all are saved in {result['save_s'] * 1e3:.1f} ms, and an "
        f"actor that was killed is replaced, with its worlds, in {result['replaced_s']:.2f} s; bits "
        f"{'equal' if result['same'] else 'DIFFER'}"
    )
    if given.json:
        with open(given.json, "w", encoding="utf-8") as file:
            json.dump(result, file, indent=1)


if __name__ == "__main__":
    main()
