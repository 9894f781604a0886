"""PPO in one file: many worlds on the CPU, the network in JAX on the same CPU.

    pip install manyworlds[gym] jax optax
    python ppo.py --task LunarLander --seed 1 --seconds 300 --json lander.json

Proximal policy optimisation (Schulman et al. 2017) with generalised advantage estimation, normalised
observations and rewards, and an annealed step. Episodes are counted as Gymnasium's NEXT_STEP
autoreset has them: where one has ended, the next transition is a reset, and takes no part in the loss;
the observation before it is where the episode ended, from which a truncated one is bootstrapped.
"""

import argparse
import json
import time
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Union

import jax
import jax.numpy as jnp
import numpy as np
import optax
from gymnasium.spaces import Discrete
from numpy.typing import NDArray

from manyworlds.gym import VectorEnv

Options = argparse.Namespace
Layers = list[tuple[jax.Array, jax.Array]]
Params = dict[str, Any]  # "policy" and "value": Layers; "spread": jax.Array
Batch = dict[str, Any]  # arrays, (samples, ...)
State = tuple[Params, Any]  # with the optimizer's memory

# What differs from the defaults below, by task.
TUNED: dict[str, dict[str, float]] = {
    "CartPole": dict(envs=256, steps=32, updates=300, gamma=0.98, lam=0.9, rate=2e-3),
    "LunarLander": dict(updates=90, gamma=0.999, lam=0.98, entropy=0.002, goal=220),
}


def arguments(argv: Sequence[str] | None = None) -> Options:
    p = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    p.add_argument("--task", default="LunarLander")
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("--envs", type=int, default=512)
    p.add_argument("--steps", type=int, default=128, help="of a world between two updates")
    p.add_argument("--updates", type=int, default=250, help="at most")
    p.add_argument("--epochs", type=int, default=4)
    p.add_argument("--minibatch", type=int, default=4096)
    p.add_argument("--rate", type=float, default=1e-3, help="of Adam, annealed to a tenth")
    p.add_argument("--gamma", type=float, default=0.995)
    p.add_argument("--lam", type=float, default=0.95)
    p.add_argument("--clip", type=float, default=0.2)
    p.add_argument("--entropy", type=float, default=0.01)
    p.add_argument("--hidden", type=int, default=64)
    p.add_argument(
        "--seconds", type=float, default=300, help="stop after so many, compiling included"
    )
    p.add_argument("--goal", type=float, help="stop at this mean return; default: the task's")
    p.add_argument("--threads", type=int, help="that step the worlds")
    p.add_argument("--json", help="write the learning curve here")
    task = p.parse_known_args(argv)[0].task
    p.set_defaults(**TUNED.get(task, {}))
    return p.parse_args(argv)


# -- the network: two perceptrons, of the policy and of the value


def perceptron(key: jax.Array, sizes: list[int], last: float) -> Layers:
    layers = []
    for i, (n, m) in enumerate(zip(sizes, sizes[1:])):
        key, sub = jax.random.split(key)
        scale = last if i == len(sizes) - 2 else 2**0.5
        layers.append((jax.nn.initializers.orthogonal(scale)(sub, (n, m)), jnp.zeros(m)))
    return layers


def apply(layers: Layers, x: Any) -> jax.Array:
    for w, b in layers[:-1]:
        x = jnp.tanh(x @ w + b)
    w, b = layers[-1]
    return x @ w + b


class Categorical:
    """A choice among n: the network gives the logits."""

    def __init__(self, choices: int) -> None:
        self.outputs = choices

    def sample(self, params: Params, out: jax.Array, key: jax.Array) -> jax.Array:
        return jax.random.categorical(key, out)

    def best(self, params: Params, out: jax.Array) -> jax.Array:
        return jnp.argmax(out, -1)

    def log_prob(self, params: Params, out: jax.Array, a: jax.Array) -> jax.Array:
        return jnp.take_along_axis(jax.nn.log_softmax(out), a[..., None], -1)[..., 0]

    def entropy(self, params: Params, out: jax.Array) -> jax.Array:
        logp = jax.nn.log_softmax(out)
        return -(jnp.exp(logp) * logp).sum(-1)


class Gaussian:
    """Numbers: the network gives their means, and the spread is a parameter of its own."""

    def __init__(self, numbers: int) -> None:
        self.outputs = numbers

    def sample(self, params: Params, out: jax.Array, key: jax.Array) -> jax.Array:
        return out + jnp.exp(params["spread"]) * jax.random.normal(key, out.shape)

    def best(self, params: Params, out: jax.Array) -> jax.Array:
        return out

    def log_prob(self, params: Params, out: jax.Array, a: jax.Array) -> jax.Array:
        z = (a - out) / jnp.exp(params["spread"])
        return (-0.5 * z**2 - params["spread"] - 0.5 * jnp.log(2 * jnp.pi)).sum(-1)

    def entropy(self, params: Params, out: jax.Array) -> jax.Array:
        return (params["spread"] + 0.5 * jnp.log(2 * jnp.pi * jnp.e)).sum() + 0 * out[..., 0]


Kind = Union[Categorical, Gaussian]


# -- running moments, for normalisation


class Moments:
    def __init__(self, shape: tuple[int, ...] = ()) -> None:
        self.mean, self.var, self.count = np.zeros(shape), np.ones(shape), 1e-4

    def update(self, x: NDArray[Any]) -> None:
        mean, var, n = x.mean(0), x.var(0), len(x)
        total = self.count + n
        delta = mean - self.mean
        self.var = (self.var * self.count + var * n + delta**2 * self.count * n / total) / total
        self.mean, self.count = self.mean + delta * n / total, total

    def scale(self, x: NDArray[Any]) -> NDArray[np.float32]:
        return np.clip((x - self.mean) / np.sqrt(self.var + 1e-8), -10, 10).astype(np.float32)


# -- learning


def advantages(
    o: Options,
    rewards: NDArray[np.float32],
    values: NDArray[np.float32],
    terminated: NDArray[np.bool_],
    ended: NDArray[np.bool_],
) -> NDArray[np.float32]:
    """Generalised advantage estimation, from the last step to the first; values has one row more."""
    out, after = np.zeros_like(rewards), np.zeros_like(rewards[0])
    for t in reversed(range(len(rewards))):
        delta = rewards[t] + o.gamma * values[t + 1] * ~terminated[t] - values[t]
        out[t] = after = delta + o.gamma * o.lam * ~ended[t] * after
    return out


def make_loss(o: Options, kind: Kind) -> Callable[[Params, Batch], jax.Array]:
    def loss(params: Params, b: Batch) -> jax.Array:
        out, value = apply(params["policy"], b["x"]), apply(params["value"], b["x"])[..., 0]

        def mean(y: jax.Array) -> jax.Array:
            return (y * b["weight"]).sum() / b["weight"].sum()  # resets do not count

        a = b["advantage"] - mean(b["advantage"])
        a = a / jnp.sqrt(mean(a**2) + 1e-8)
        ratio = jnp.exp(kind.log_prob(params, out, b["action"]) - b["log_prob"])
        gain = jnp.minimum(ratio * a, jnp.clip(ratio, 1 - o.clip, 1 + o.clip) * a)
        error = (value - b["target"]) ** 2
        return -mean(gain) + 0.5 * mean(error) - o.entropy * mean(kind.entropy(params, out))

    return loss


def make_optimizer(o: Options) -> Any:
    """Adam (Kingma and Ba 2015), with a step that falls to a tenth over all updates."""
    steps = o.updates * o.epochs * (o.envs * o.steps // o.minibatch)
    rate = optax.linear_schedule(o.rate, 0.1 * o.rate, steps)
    return optax.chain(optax.clip_by_global_norm(0.5), optax.adam(rate, eps=1e-5))


def make_update(
    o: Options, kind: Kind, optimizer: Any
) -> Callable[[State, jax.Array, Batch], State]:
    """All epochs over one batch as one compiled function."""
    gradient = jax.grad(make_loss(o, kind))

    def minibatch(state: State, b: Batch) -> tuple[State, None]:
        params, memory = state
        change, memory = optimizer.update(gradient(params, b), memory, params)
        return (optax.apply_updates(params, change), memory), None

    def epoch(state: State, key: jax.Array, batch: Batch) -> tuple[State, None]:
        n = batch["x"].shape[0]
        order = jax.random.permutation(key, n)[: n // o.minibatch * o.minibatch]
        parts = jax.tree.map(lambda x: x[order].reshape(-1, o.minibatch, *x.shape[1:]), batch)
        done: tuple[State, None] = jax.lax.scan(minibatch, state, parts)
        return done

    def epochs(state: State, key: jax.Array, batch: Batch) -> State:
        keys = jax.random.split(key, o.epochs)
        done: State = jax.lax.scan(lambda s, k: epoch(s, k, batch), state, keys)[0]
        return done

    update: Callable[[State, jax.Array, Batch], State] = jax.jit(epochs)
    return update


def train(o: Options) -> dict[str, Any]:
    began = time.perf_counter()
    env = VectorEnv(o.task, o.envs, copy=False, threads=o.threads)
    n, seen = o.envs, env.environment.observations.shape[1]
    space = env.single_action_space
    numbers = env.environment.action_shape[1:]  # of an action; () where it is a choice
    kind = Categorical(int(space.n)) if isinstance(space, Discrete) else Gaussian(*numbers)
    goal = env.task.solved_at if o.goal is None else o.goal
    o.minibatch = min(o.minibatch, n * o.steps // 4)

    key, k1, k2 = jax.random.split(jax.random.PRNGKey(o.seed), 3)
    params = {
        "policy": perceptron(k1, [seen, o.hidden, o.hidden, kind.outputs], 0.01),
        "value": perceptron(k2, [seen, o.hidden, o.hidden, 1], 1.0),
        "spread": jnp.full(numbers or 0, -0.5),
    }
    optimizer = make_optimizer(o)
    state = params, optimizer.init(params)
    update = make_update(o, kind, optimizer)

    def choose(params: Params, x: Any, key: jax.Array) -> tuple[jax.Array, jax.Array, jax.Array]:
        out = apply(params["policy"], x)
        action = kind.sample(params, out, key)
        log_prob = kind.log_prob(params, out, action)
        return action, log_prob, apply(params["value"], x)[..., 0]

    act = jax.jit(choose)

    moments, gains = Moments((seen,)), Moments()
    discounted, returns, lengths = np.zeros(n), np.zeros(n), np.zeros(n, int)
    finished: list[tuple[float, int]] = []  # (return, length)
    observations, _ = env.reset(seed=1000 * o.seed)
    begins = np.zeros(n, bool)  # the next step is a reset
    curve, total = [], 0
    shape = (o.steps, n)
    batch = {
        "x": np.zeros((*shape, seen), np.float32),
        "action": np.zeros((*shape, *numbers), env.action_space.dtype),
        "log_prob": np.zeros(shape, np.float32),
        "weight": np.zeros(shape, np.float32),
    }
    rewards, values = np.zeros(shape, np.float32), np.zeros((o.steps + 1, n), np.float32)
    terminated, ended = np.zeros(shape, bool), np.zeros(shape, bool)
    for number in range(1, o.updates + 1):
        key, *keys = jax.random.split(key, o.steps + 3)
        seen_now = []
        for t in range(o.steps):
            seen_now.append(observations[~begins].copy())
            batch["x"][t] = moments.scale(observations)
            action, batch["log_prob"][t], values[t] = act(state[0], batch["x"][t], keys[t])
            batch["action"][t] = action
            batch["weight"][t] = ~begins
            observations, reward, terminated[t], truncated, _ = env.step(np.asarray(action))
            ended[t] = terminated[t] | truncated
            discounted = discounted * o.gamma * ~begins + reward
            gains.update(discounted[~begins])
            rewards[t] = np.clip(reward / np.sqrt(gains.var + 1e-8), -10, 10)
            returns += reward
            lengths += ~begins
            for i in np.flatnonzero(ended[t]):
                finished.append((returns[i], lengths[i]))
                returns[i] = lengths[i] = 0
            total += int((~begins).sum())
            begins = ended[t].copy()
        values[-1] = act(state[0], moments.scale(observations), keys[-1])[2]
        # The moments change between updates alone, so that old and new policy see the same numbers.
        moments.update(np.concatenate(seen_now))
        gain = advantages(o, rewards, values, terminated, ended)
        flat = {**batch, "advantage": gain, "target": gain + values[:-1]}
        flat = {name: x.reshape(-1, *x.shape[2:]) for name, x in flat.items()}
        state = update(state, keys[-2], flat)
        finished = finished[-max(200, n) :]
        wall = time.perf_counter() - began
        mean = float(np.mean([f[0] for f in finished])) if finished else float("nan")
        length = float(np.mean([f[1] for f in finished])) if finished else float("nan")
        curve.append({"seconds": round(wall, 2), "steps": total, "return": mean, "length": length})
        if number % 10 == 1:
            print(
                f"{wall:7.1f} s {total:10d} steps  return {mean:8.1f}  length {length:6.0f}",
                flush=True,
            )
        if wall > o.seconds or (len(finished) >= max(200, n) and mean >= goal):
            break
    env.close()
    policy = partial(best, kind, state[0], moments)
    score = evaluate(o, policy)
    wall = time.perf_counter() - began
    print(f"{wall:7.1f} s {total:10d} steps  return {score:8.1f} of the best actions, no noise")
    return {"task": o.task, "seed": o.seed, "curve": curve, "evaluation": score, "seconds": wall}


def best(kind: Kind, params: Params, moments: Moments, observations: NDArray[Any]) -> NDArray[Any]:
    out = apply(params["policy"], moments.scale(observations))
    return np.asarray(kind.best(params, out))


def evaluate(
    o: Options, policy: Callable[[NDArray[Any]], NDArray[Any]], worlds: int = 256
) -> float:
    """Mean return of the first episode of fresh worlds, without noise."""
    env = VectorEnv(o.task, worlds, copy=False, threads=o.threads)
    observations, _ = env.reset(seed=10**6)
    total, alive = np.zeros(worlds), np.ones(worlds, bool)
    while alive.any():
        observations, reward, terminated, truncated, _ = env.step(policy(observations))
        total += reward * alive
        alive &= ~(terminated | truncated)
    env.close()
    return float(total.mean())


def main(argv: Sequence[str] | None = None) -> dict[str, Any]:
    o = arguments(argv)
    result = train(o)
    if o.json:
        with open(o.json, "w") as file:
            json.dump(result, file)
    return result


if __name__ == "__main__":
    main()
