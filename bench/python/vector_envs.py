#!/usr/bin/env python3
"""Steps per second of vector environments: Gymnasium's own LunarLander-v3 and CartPole-v1, one after
the other (sync) and in processes (async), against manyworlds, by Gymnasium's own measure
(gymnasium.utils.performance.benchmark_vector_step, which draws random actions, too); and manyworlds
without that, with actions made before; and the step of a task's scene alone, with new controls each.

    pip install "gymnasium[box2d]" envpool
    bench/python/vector_envs.py --seconds 5 --json build/vector_envs.json
    bench/python/vector_envs.py --peers --seconds 1 --repeats 7     # one thread each, alternately

With --peers the fastest peers of each task, in one thread each, with actions made before, take turns:
EnvPool, Gymnasium's CartPole in NumPy, SyncVectorEnv. Time is the processor's, of all threads of the
process, and the ratio is the median of those of each round, so that what else the machine does falls on
all alike. What is not installed is left out with a message.
"""

import argparse
import json
import platform
import statistics
import time

import gymnasium
import numpy as np
from gymnasium.utils.performance import benchmark_vector_step

import manyworlds as mw
from manyworlds.gym import VectorEnv

PAIRS = [("LunarLander-v3", "LunarLander"), ("CartPole-v1", "CartPole")]


def by_gymnasium(make, seconds, repeats):
    """Median of several runs."""
    env = make()
    found = [benchmark_vector_step(env, seconds, seed=i) for i in range(repeats)]
    env.close()
    return statistics.median(found)


def by_loop(step, actions, worlds, seconds, repeats, warm=True, clock=time.perf_counter):
    found = []
    for _ in range(repeats + warm):  # the first only warms up
        count, began = 0, clock()
        while clock() - began < seconds:
            for a in actions:
                step(a)
            count += len(actions)
        found.append(count * worlds / (clock() - began))
    return statistics.median(found[warm:])


def prepared(task, worlds):
    env = VectorEnv(task, worlds)
    env.action_space.seed(0)
    actions = [np.asarray(env.action_space.sample()) for _ in range(32)]
    env.close()
    return actions


def peers_of(theirs, ours, n):
    """{name: (make, dtype of its actions)} of what steps n environments in one thread."""

    def pool():
        import envpool

        return envpool.make_gymnasium(theirs, num_envs=n, num_threads=1, seed=0)

    def vectorized():
        return gymnasium.make_vec(theirs, n, vectorization_mode="vector_entry_point")

    def one_by_one():
        return gymnasium.make_vec(theirs, n, vectorization_mode="sync")

    out = {
        "manyworlds VectorEnv": (lambda: VectorEnv(ours, n, threads=1, copy=False), np.int64),
        "EnvPool": (pool, np.int32),
    }
    if n <= 512:  # more of them step no faster, and take long to make
        out["Gymnasium, SyncVectorEnv"] = one_by_one, np.int64
    if gymnasium.spec(theirs).vector_entry_point is not None:
        out["Gymnasium, NumPy (vector_entry_point)"] = vectorized, np.int64
    return out


def by_turns(theirs, ours, n, seconds, repeats):
    """{name: (median of steps per second of processor time, median of ours / theirs of a round)}."""
    choices = prepared(ours, n)[: max(2, 2048 // n)]  # turns of the slowest stay short
    envs, speeds = {}, {}
    for name, (make, dtype) in peers_of(theirs, ours, n).items():
        try:
            env = make()
        except (ImportError, gymnasium.error.DependencyNotInstalled) as error:
            print(f"{name} of {theirs} cannot be had here: {error}")
            continue
        env.reset()
        envs[name], speeds[name] = (env, [a.astype(dtype) for a in choices]), []
    for _ in range(repeats + 1):  # the first round warms up
        for name, (env, actions) in envs.items():
            speed = by_loop(env.step, actions, n, seconds, 1, False, time.process_time)
            speeds[name].append(speed)
    for env, _ in envs.values():
        env.close()
    mine = speeds["manyworlds VectorEnv"]
    return {
        name: (
            statistics.median(found[1:]),
            statistics.median(a / b for a, b in zip(mine[1:], found[1:])),
        )
        for name, found in speeds.items()
    }


def compare_peers(sizes, seconds, repeats):
    """Prints a table and returns its rows."""
    rows = []
    print("| task | envs | what, in one thread | steps/s | manyworlds / this |")
    print("|---|---:|---|---:|---:|")
    for theirs, ours in PAIRS:
        for n in sizes:
            for name, (speed, ratio) in by_turns(theirs, ours, n, seconds, repeats).items():
                rows.append(dict(task=ours, worlds=n, what=name, speed=speed, ratio=ratio))
                print(f"| {ours} | {n} | {name} | {speed:,.0f} | {ratio:.2f} |", flush=True)
    return rows


def controls_of(batch):
    """Sets of controls within their ranges."""
    ranges = [(c.low, c.high) for c in batch.plan.scene.controls]
    low, high = np.array(ranges, np.float32).T
    random = np.random.default_rng(0)
    shape = batch.worlds, len(ranges)
    return [low + (high - low) * random.random(shape, np.float32) for _ in range(32)]


def write_json(file, rows, kernels, seconds, repeats):
    """The rows of a table, and what they were measured with."""
    about = dict(
        machine=platform.processor() or platform.machine(),
        python=platform.python_version(),
        gymnasium=gymnasium.__version__,
        manyworlds=mw.__version__,
        kernels=kernels,
        seconds=seconds,
        repeats=repeats,
    )
    with open(file, "w") as to:
        json.dump({"about": about, "rows": rows}, to, indent=1)


def main():
    p = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    p.add_argument("--seconds", type=float, default=5)
    p.add_argument("--repeats", type=int, default=3)
    p.add_argument("--envs", type=int, nargs="*", default=[8, 64], help="of both sides")
    p.add_argument("--worlds", type=int, nargs="*", default=[4096], help="of manyworlds alone")
    p.add_argument("--threads", type=int, nargs="*", default=[1, 2])
    p.add_argument("--skip-async", action="store_true")
    p.add_argument("--peers", action="store_true", help="one thread each, alternately; see above")
    p.add_argument("--json")
    o = p.parse_args()
    if o.peers:
        rows = compare_peers(o.envs + o.worlds, o.seconds, o.repeats)
        if o.json:
            with open(o.json, "w") as file:
                json.dump({"rows": rows}, file, indent=1)
        return
    rows = []

    def add(task, what, how, worlds, threads, speed):
        row = dict(task=task, what=what, how=how, worlds=worlds, threads=threads, speed=speed)
        rows.append(row)
        threads = "-" if threads is None else threads
        print(f"| {task} | {what} | {how} | {worlds} | {threads} | {speed:,.0f} |", flush=True)

    print("| task | what | actions | envs | threads | steps/s |\n|---|---|---|---:|---:|---:|")
    for theirs, ours in PAIRS:
        for n in o.envs:
            for mode in ["sync"] + ["async"] * (not o.skip_async):
                make = lambda: gymnasium.make_vec(theirs, n, vectorization_mode=mode)  # noqa: E731
                try:
                    speed = by_gymnasium(make, o.seconds, o.repeats)
                except gymnasium.error.DependencyNotInstalled as error:
                    print(f"{theirs} cannot be had here: {error}")
                    break
                add(ours, f"Gymnasium {theirs} {mode}", "drawn", n, None, speed)
        for threads in o.threads:
            for n in o.envs + o.worlds:
                make = lambda: VectorEnv(ours, n, threads=threads)  # noqa: E731
                speed = by_gymnasium(make, o.seconds, o.repeats)
                add(ours, "VectorEnv", "drawn", n, threads, speed)
            for n in o.worlds:
                actions = prepared(ours, n)
                for copy in (True, False):
                    env = VectorEnv(ours, n, threads=threads, copy=copy)
                    env.reset(seed=0)
                    speed = by_loop(env.step, actions, n, o.seconds, o.repeats)
                    add(ours, f"VectorEnv, copy={copy}", "prepared", n, threads, speed)
                    env.close()
                with mw.Environment(ours, n, threads=threads) as env:
                    speed = by_loop(env.step, actions, n, o.seconds, o.repeats)
                    kernels = env.batch.kernel_table
                add(ours, "Environment", "prepared", n, threads, speed)
                with mw.Batch(mw.tasks.load(ours).scene, n, threads=threads) as batch:
                    sets = controls_of(batch)
                    speed = by_loop(lambda c: batch.step(1, c), sets, n, o.seconds, o.repeats)
                add(ours, "Batch.step with controls", "prepared", n, threads, speed)
    if o.json:
        write_json(o.json, rows, kernels, o.seconds, o.repeats)


if __name__ == "__main__":
    main()
