#!/usr/bin/env python3
"""Environment steps per second of one core: Gymnasium's MuJoCo tasks here, in Gymnasium's own vector
environment, and in EnvPool where it is installed, in turns.

    pip install gymnasium mujoco-core==4.0.1 glfw imageio envpool
    bench/python/robots.py --tasks HalfCheetah-v5 Ant-v5 --seconds 1 --repeats 5 --json build/robots.json

    bench/python/robots.py --policies docs/training --tasks HalfCheetah-v5 --worlds 64 --repeats 3

Each steps in one thread under actions that were made before, through its own resets: random ones or, with
--policies FOLDER, those of the trained policies there (TASK-SEED.npz, of examples/python/ppo.py) in the same worlds,
which were played once to record them, so that contacts are those of a gait. Time is the processor's, of all threads of the process; figures are medians over rounds, and ratios are those of each
round, so that what else the machine does falls on all alike. Gymnasium and EnvPool solve as the files say (the
humanoids by PGS); here the solver is Newton's with the files' tolerance. What is not installed is left out
with a message.
"""

import argparse
import statistics
import sys
import time
from pathlib import Path

import gymnasium
import numpy as np

import manyworlds as mw
from manyworlds.gym import mujoco as tasks

from vector_envs import write_json

sys.path.insert(0, str(Path(__file__).parents[2] / "examples" / "python"))
from policy import Policy  # noqa: E402

FEW = 64  # environments of Gymnasium, at most: more step no faster, and take long to make


def ours(name, n, environment):
    task = tasks.task(name)
    if environment:
        env = mw.Environment(task, n, threads=1)
        return env.observations, env.step, env.close
    env = mw.gym.VectorEnv(task, n, threads=1, copy=False)
    return env.reset(seed=0)[0], env.step, env.close


def gymnasiums(name, n):
    env = gymnasium.make_vec(name, n, vectorization_mode="sync")
    return env.reset(seed=0)[0], env.step, env.close


def envpools(name, n):
    import envpool

    env = envpool.make_gymnasium(name, num_envs=n, num_threads=1, seed=0)
    return env.reset()[0], env.step, env.close


def peers(name, n):
    """{what: a function that makes (first observations, step, close), always the same}."""
    out = {
        "Environment": lambda: ours(name, n, True),
        "VectorEnv": lambda: ours(name, n, False),
        "EnvPool": lambda: envpools(name, n),
    }
    if n <= FEW:
        out["Gymnasium, SyncVectorEnv"] = lambda: gymnasiums(name, n)
    return out


def speed_of(step, actions, n, seconds):
    """Environment steps per second of processor time."""
    count, began = 0, time.process_time()
    while time.process_time() - began < seconds:
        step(actions[count % len(actions)])
        count += 1
    return count * n / (time.process_time() - began)


ABSENT = (ImportError, RuntimeError, ValueError, AssertionError, KeyError)


def say_absent(what, name, error):
    print(f"{what} of {name} cannot be had here: {error}")


def by_turns(name, n, seconds, repeats):
    """{what: speeds of each round} under random actions."""
    space = gymnasium.make(name).action_space
    shape = (32, n, *space.shape)
    actions = np.random.default_rng(0).uniform(space.low, space.high, shape).astype(np.float32)
    steps, closes, speeds = {}, [], {}
    for what, make in peers(name, n).items():
        try:
            _, steps[what], close = make()
        except ABSENT as error:
            say_absent(what, name, error)
            continue
        closes.append(close)
        speeds[what] = []
    for _ in range(repeats + 1):  # the first round warms up
        for what, step in steps.items():
            speeds[what].append(speed_of(step, actions, n, seconds))
    for close in closes:
        close()
    return {what: found[1:] for what, found in speeds.items()}


def recorded(make, policy, steps):
    """The actions of a policy in new worlds, (steps, n, numbers), and the mean reward of a step."""
    observations, step, close = make()
    actions, rewards = [], []
    for _ in range(steps):
        actions.append(policy(observations))
        observations, reward = step(actions[-1])[:2]
        rewards.append(np.mean(reward))
    close()
    return np.array(actions), np.mean(rewards)


def in_a_gait(name, n, policy, steps, repeats):
    """{what: speeds of each round}, of the same episodes played over and over; the first fifth, in which
    robots start to walk, is not measured."""
    actions, speeds = {}, {}
    makers = peers(name, n)
    for what, make in makers.items():
        try:
            actions[what], reward = recorded(make, policy, steps)
        except ABSENT as error:
            say_absent(what, name, error)
            continue
        print(f"<!-- {name}, {n} envs, {what}: mean reward of a step {reward:.2f} -->", flush=True)
        speeds[what] = []
    for _ in range(repeats + 1):
        for what, of in actions.items():
            _, step, close = makers[what]()
            for action in of[: steps // 5]:
                step(action)
            began = time.process_time()
            for action in of[steps // 5 :]:
                step(action)
            took = time.process_time() - began
            speeds[what].append((steps - steps // 5) * n / took)
            close()
    return {what: found[1:] for what, found in speeds.items()}


def main():
    p = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    p.add_argument("--tasks", nargs="*", help="default: all, or those that have a policy")
    p.add_argument("--worlds", type=int, nargs="*", default=[1, 64, 4096])
    p.add_argument("--seconds", type=float, default=0.5, help="of a round of random actions")
    p.add_argument("--policies", type=Path, help="the folder of TASK-SEED.npz")
    p.add_argument("--steps", type=int, default=500, help="of a round of a policy")
    p.add_argument("--repeats", type=int, default=5)
    p.add_argument("--json")
    o = p.parse_args()
    has, files = tasks.names(), {}
    if o.policies:
        files = {name: sorted(o.policies.glob(f"{name}-[0-9].npz")) for name in has}
        has = [name for name in has if files[name]]
    rows = []
    print("| task | envs | what, on one core | steps/s | Environment / this |")
    print("|---|---:|---|---:|---:|")
    for name in o.tasks or has:
        for n in o.worlds:
            if o.policies:
                policy = Policy.load(files[name][0])
                speeds = in_a_gait(name, n, policy, o.steps, o.repeats)
            else:
                speeds = by_turns(name, n, o.seconds, o.repeats)
            for what, found in speeds.items():
                ratio = statistics.median(a / b for a, b in zip(speeds["Environment"], found))
                row = dict(
                    task=name, worlds=n, what=what, speed=statistics.median(found), ratio=ratio
                )
                rows.append(row)
                print(f"| {name} | {n} | {what} | {row['speed']:,.0f} | {ratio:.2f} |", flush=True)
    if o.json:
        with mw.Environment("CartPole", threads=1) as env:
            kernels = env.batch.kernel_table
        write_json(o.json, rows, kernels, o.seconds, o.repeats)


if __name__ == "__main__":
    main()
