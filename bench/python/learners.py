#!/usr/bin/env python3
"""What an update of examples/python/ppo.py costs in JAX, and the same update written in PyTorch, where it is
installed, in turns.

    pip install jax optax torch
    bench/python/learners.py --observations 17 --numbers 6 --threads 1

An update is 4 epochs over 1024 worlds x 32 steps in minibatches of 8192, two perceptrons 64 x 64. Medians over
rounds of the processor's time, of all threads, and of the wall's.
"""

import argparse
import os
import statistics
import sys
import time
from pathlib import Path

import numpy as np

EXAMPLES = Path(__file__).parents[2] / "examples" / "python"


def made_up(o, n, steps):
    rng, shape = np.random.default_rng(0), (steps, n)
    return {
        "x": rng.standard_normal((steps + 1, n, o.observations)).astype(np.float32),
        "action": rng.standard_normal((*shape, o.numbers)).astype(np.float32),
        "reward": rng.standard_normal(shape).astype(np.float32),
        "weight": np.ones(shape, np.float32),
        "terminated": np.zeros(shape, bool),
        "ended": np.zeros(shape, bool),
    }


def in_jax(o, settings):
    """A function that does an update."""
    import jax

    sys.path.insert(0, str(EXAMPLES))
    from learner import Gaussian, make_learner

    n, steps = settings.envs, settings.steps
    batch, rng = made_up(o, n, steps), np.random.default_rng(0)
    state, _, update = make_learner(settings, Gaussian(o.numbers), o.observations)

    def run():
        order = np.array([rng.permutation(n * steps) for _ in range(settings.epochs)])
        jax.block_until_ready(update(state, batch, order))

    return run


def in_torch(o, settings):
    import torch
    from torch import nn

    torch.set_num_threads(o.threads)
    n, steps = settings.envs, settings.steps
    batch = {name: torch.from_numpy(x) for name, x in made_up(o, n, steps).items()}
    x, action = batch["x"].flatten(0, 1), batch["action"].flatten(0, 1)

    def perceptron(outputs):
        parts = []
        for a, b in zip([o.observations, *settings.hidden], settings.hidden):
            parts += [nn.Linear(a, b), nn.Tanh()]
        return nn.Sequential(*parts, nn.Linear(settings.hidden[-1], outputs))

    policy, value = perceptron(o.numbers), perceptron(1)
    spread = nn.Parameter(torch.full((o.numbers,), -0.5))
    params = [*policy.parameters(), *value.parameters(), spread]
    adam = torch.optim.Adam(params, settings.rate, eps=1e-5, foreach=True)

    def log_prob(x, action):
        z = (action - policy(x)) / spread.exp()
        return (-0.5 * z**2 - spread - 0.919).sum(-1)

    @torch.no_grad()
    def targets():
        values = value(x)[:, 0].reshape(steps + 1, n)
        old, gains, after = log_prob(x[:-n], action), torch.zeros(steps, n), torch.zeros(n)
        for t in reversed(range(steps)):
            delta = batch["reward"][t] + settings.gamma * values[t + 1] - values[t]
            gains[t] = after = delta + settings.gamma * settings.lam * after
        return old, gains.flatten(), (gains + values[:-1]).flatten()

    def run():
        old, gains, aims = targets()
        for _ in range(settings.epochs):
            for i in torch.randperm(n * steps).split(settings.minibatch):
                a = (gains[i] - gains[i].mean()) / (gains[i].std() + 1e-8)
                change = log_prob(x[i], action[i]) - old[i]
                ratio = change.exp()
                clipped = ratio.clamp(1 - settings.clip, 1 + settings.clip)
                loss = -torch.minimum(ratio * a, clipped * a).mean()
                loss = loss + 0.5 * ((value(x[i])[:, 0] - aims[i]) ** 2).mean()
                adam.zero_grad()
                loss.backward()
                nn.utils.clip_grad_norm_(params, 0.5)
                adam.step()

    return run


def main():
    p = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    p.add_argument("--observations", type=int, default=17)
    p.add_argument("--numbers", type=int, default=6, help="of an action")
    p.add_argument("--threads", type=int, choices=[1, 2], default=1)
    p.add_argument("--repeats", type=int, default=11)
    o = p.parse_args()
    if o.threads == 1:
        os.environ["XLA_FLAGS"] = "--xla_cpu_multi_thread_eigen=false"
    settings = argparse.Namespace(
        envs=1024, steps=32, epochs=4, minibatch=8192, updates=100, seed=0, hidden=[64, 64],
        rate=1e-3, kl=0.01, clip=0.2, gamma=0.99, lam=0.95, entropy=0.0,
    )  # fmt: skip
    runs = {}
    for what, make in {"JAX": in_jax, "PyTorch": in_torch}.items():
        try:
            runs[what] = make(o, settings)
        except ImportError as error:
            print(f"{what} cannot be had here: {error}")
    found = {what: [] for what in runs}
    for _ in range(o.repeats + 1):  # the first round compiles
        for what, run in runs.items():
            began = time.process_time(), time.perf_counter()
            run()
            found[what].append((time.process_time() - began[0], time.perf_counter() - began[1]))
    for what, times in found.items():
        cpu, wall = (1e3 * statistics.median(x) for x in zip(*times[1:]))
        each = 1e3 * cpu / (settings.envs * settings.steps)
        print(
            f"{what}: {cpu:.0f} ms of the processor, {wall:.0f} ms; {each:.1f} us for each step of a world"
        )


if __name__ == "__main__":
    main()
