#!/usr/bin/env python3
"""Policies that carry over: each scored in the worlds here and in Gymnasium's own environment.

    pip install gymnasium mujoco-core==4.0.1 glfw imageio
    bench/python/transfer.py docs/training/*.npz --json build/transfer.json

Files are those of examples/python/ppo.py, or of sb3_policy.py for those trained in Gymnasium, and are
named TASK-WHATEVER.npz. Played are whole episodes with the policy's best actions, 1,000 here, one in a world,
and 100 there. Returns agree where the means differ by no more than 5 % or two standard errors of their
difference. The status is 1 where one does not.
"""

import argparse
import json
import sys
from pathlib import Path

import gymnasium
import numpy as np

import manyworlds.gym  # noqa: F401  (registers the tasks)

sys.path.insert(0, str(Path(__file__).parents[2] / "examples" / "python"))
from policy import Policy, first_episodes, score  # noqa: E402


def there(task, policy, episodes, seed=10**6):
    """Returns and lengths of episodes of Gymnasium's environment."""
    envs = gymnasium.make_vec(task, episodes, vectorization_mode="sync")
    observations, _ = envs.reset(seed=seed)
    found = first_episodes(envs.step, policy, observations)
    envs.close()
    return found


def summary(returns, lengths):
    error = returns.std(ddof=1) / len(returns) ** 0.5
    return dict(mean=returns.mean(), error=error, spread=returns.std(ddof=1), length=lengths.mean())


def agree(a, b):
    apart = abs(a["mean"] - b["mean"])
    return bool(apart <= max(0.05 * abs(b["mean"]), 2 * np.hypot(a["error"], b["error"])))


def main():
    p = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    p.add_argument("policies", nargs="+", type=Path)
    p.add_argument("--worlds", type=int, default=1000, help="episodes here")
    p.add_argument("--episodes", type=int, default=100, help="in Gymnasium")
    p.add_argument("--threads", type=int)
    p.add_argument("--json")
    o = p.parse_args()
    rows = []
    print("| policy | here | length | in Gymnasium | length | apart | |")
    print("|---|---:|---:|---:|---:|---:|---|")
    for file in o.policies:
        task = "-".join(file.stem.split("-")[:2])
        policy = Policy.load(file)
        a = summary(*score(task, policy, o.worlds, threads=o.threads))
        b = summary(*there(task, policy, o.episodes))
        good = agree(a, b)
        rows.append(dict(policy=file.stem, here=a, gymnasium=b, agree=good))
        print(
            f"| {file.stem} | {a['mean']:.0f} +- {a['error']:.0f} | {a['length']:.0f} "
            f"| {b['mean']:.0f} +- {b['error']:.0f} | {b['length']:.0f} "
            f"| {100 * (a['mean'] / b['mean'] - 1):+.1f} % | {'agree' if good else 'do NOT agree'} |",
            flush=True,
        )
    if o.json:
        Path(o.json).write_text(json.dumps(rows, indent=1), encoding="utf-8")
    return not all(row["agree"] for row in rows)


if __name__ == "__main__":
    sys.exit(main())
