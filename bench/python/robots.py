#!/usr/bin/env python3
"""Environment steps per second of one core: Gymnasium's MuJoCo tasks here, in Gymnasium's own vector
environments, and in EnvPool where it is installed, in turns; and, under random actions, the physics alone of such
steps in MuJoCo's Batch and in MJX.

    pip install gymnasium mujoco-core==4.0.1 glfw imageio envpool mujoco-mjx
    bench/python/robots.py --tasks HalfCheetah-v5 Ant-v5 --seconds 1 --repeats 5 --json build/robots.json

    bench/python/robots.py --policies docs/training --tasks HalfCheetah-v5 --worlds 64 --repeats 3

Each steps in one thread under actions that were made before, through its own resets: random ones or, with
--policies FOLDER, those of the trained policies there (TASK-SEED.npz, of examples/python/ppo.py) in the same worlds,
which were played once to record them, so that contacts are those of a gait. Time is the processor's, of all threads
of the process and of the processes that it steps with; figures are medians over rounds, and ratios are those of each
round, so that what else the machine does falls on all alike. Gymnasium and EnvPool solve as the files say (the
humanoids by PGS); here the solver is Newton's with the files' tolerance. Batch and MJX have no observations, rewards
and resets. MJX takes the processor that XLA gives it (XLA_FLAGS=--xla_cpu_multi_thread_eigen=false: one thread).
What is not installed, or cannot step a model, is left out with a message.
"""

import argparse
import os
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
PROCESSES = 8  # of AsyncVectorEnv, at most


class Peer:
    """One that steps: `observations` of its start, step(actions), close(), and the processes that it has."""

    def __init__(self, observations, step, close, pids=()):
        self.observations, self.step, self.close, self.pids = observations, step, close, pids

    def clock(self):
        """Seconds of the processor so far."""
        ticks = 0
        for pid in self.pids:
            with open(f"/proc/{pid}/stat", encoding="ascii") as file:
                user, system = file.read().rsplit(")", 1)[1].split()[11:13]
            ticks += int(user) + int(system)
        return time.process_time() + ticks / os.sysconf("SC_CLK_TCK")


def ours(name, n, environment):
    task = tasks.task(name)
    if environment:
        env = mw.Environment(task, n, threads=1)
        return Peer(env.observations, env.step, env.close)
    env = mw.gym.VectorEnv(task, n, threads=1, copy=False)
    return Peer(env.reset(seed=0)[0], env.step, env.close)


def gymnasiums(name, n, mode):
    env = gymnasium.make_vec(name, n, vectorization_mode=mode)
    pids = [process.pid for process in env.unwrapped.processes] if mode == "async" else []
    return Peer(env.reset(seed=0)[0], env.step, env.close, pids)


def envpools(name, n):
    import envpool

    env = envpool.make_gymnasium(name, num_envs=n, num_threads=1, seed=0)
    return Peer(env.reset()[0], env.step, env.close)


def of_gymnasium(name):
    """The model of a task, and its steps of physics in a step."""
    env = gymnasium.make(name).unwrapped
    return env.model, env.frame_skip


def mujoco_batches(name, n):
    from mujoco.batch import Batch

    model, skip = of_gymnasium(name)
    batch = Batch(model, nsim=n, nthread=1)
    controls = batch.bind("ctrl")

    def step(actions):
        controls[:] = actions
        batch.step(nstep=skip)

    return Peer(None, step, lambda: None)


def mjx_batches(name, n):
    import jax
    from mujoco import mjx

    model, skip = of_gymnasium(name)
    on_device = mjx.put_model(model)
    state = jax.vmap(lambda _: mjx.make_data(on_device))(jax.numpy.arange(n))

    def one(data, control):
        data = data.replace(ctrl=control)
        return jax.lax.fori_loop(0, skip, lambda _, d: mjx.step(on_device, d), data)

    go = jax.jit(jax.vmap(one), donate_argnums=0)

    def step(actions):
        nonlocal state
        state = go(state, actions)
        state.qpos.block_until_ready()

    return Peer(None, step, lambda: None)


def peers(name, n):
    """{what: a function that makes a Peer, always the same}."""
    out = {
        "Environment": lambda: ours(name, n, True),
        "VectorEnv": lambda: ours(name, n, False),
        "EnvPool": lambda: envpools(name, n),
    }
    if n <= FEW:
        out["Gymnasium, SyncVectorEnv"] = lambda: gymnasiums(name, n, "sync")
    if n <= PROCESSES:
        out["Gymnasium, AsyncVectorEnv"] = lambda: gymnasiums(name, n, "async")
    return out


def physics(name, n):
    """The same of those that have no environments."""
    return {
        "MuJoCo's Batch, physics alone": lambda: mujoco_batches(name, n),
        "MJX, physics alone": lambda: mjx_batches(name, n),
    }


def speed_of(peer, actions, n, seconds):
    """Environment steps per second of processor time."""
    count, began = 0, peer.clock()
    while peer.clock() - began < seconds:
        peer.step(actions[count % len(actions)])
        count += 1
    return count * n / (peer.clock() - began)


ABSENT = (ImportError, RuntimeError, ValueError, AssertionError, KeyError, NotImplementedError)


def say_absent(what, name, error):
    print(f"{what} of {name} cannot be had here: {error}")


def by_turns(name, n, seconds, repeats):
    """{what: speeds of each round} under random actions."""
    space = gymnasium.make(name).action_space
    shape = (32, n, *space.shape)
    actions = np.random.default_rng(0).uniform(space.low, space.high, shape).astype(np.float32)
    made, speeds = {}, {}
    for what, make in {**peers(name, n), **physics(name, n)}.items():
        try:
            made[what] = make()
            made[what].step(actions[0])  # MJX compiles
        except ABSENT as error:
            made.pop(what, None)
            say_absent(what, name, error)
            continue
        speeds[what] = []
    for _ in range(repeats + 1):  # the first round warms up
        for what, peer in made.items():
            speeds[what].append(speed_of(peer, actions, n, seconds))
    for peer in made.values():
        peer.close()
    return {what: found[1:] for what, found in speeds.items()}


def recorded(make, policy, steps):
    """The actions of a policy in new worlds, (steps, n, numbers), and the mean reward of a step."""
    peer = make()
    observations, actions, rewards = peer.observations, [], []
    for _ in range(steps):
        actions.append(policy(observations))
        observations, reward = peer.step(actions[-1])[:2]
        rewards.append(np.mean(reward))
    peer.close()
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
            peer = makers[what]()
            for action in of[: steps // 5]:
                peer.step(action)
            began = peer.clock()
            for action in of[steps // 5 :]:
                peer.step(action)
            took = peer.clock() - began
            speeds[what].append((steps - steps // 5) * n / took)
            peer.close()
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
