"""What learns in ppo.py, in JAX: two perceptrons, and the update of PPO as one compiled function.

Proximal policy optimisation (Schulman et al. 2017) with generalised advantage estimation (Schulman et
al. 2016), observations and rewards normalised by running moments, and a step that is annealed or, with
``kl``, is kept to where an update changes the policy by about that divergence (Rudin et al. 2022).
"""

import argparse
from collections.abc import Callable
from typing import Any, Union

import jax
import jax.numpy as jnp
import numpy as np
import optax
from numpy.typing import NDArray

Options = argparse.Namespace
Layers = list[tuple[jax.Array, jax.Array]]
Params = dict[str, Any]  # "policy" and "value": Layers; "spread": jax.Array
Batch = dict[str, Any]  # arrays, (steps, worlds, ...)
State = dict[str, Any]  # "params", the optimizer's "memory" and "rate", running moments
Update = Callable[[State, Batch, NDArray[Any]], State]
Act = Callable[[State, NDArray[Any], int], jax.Array]


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
        self.outputs, self.shape, self.dtype = choices, (), np.dtype(np.int64)

    def sample(self, params: Params, out: jax.Array, key: jax.Array) -> jax.Array:
        return jax.random.categorical(key, out)

    def log_prob(self, params: Params, out: jax.Array, a: jax.Array) -> jax.Array:
        return jnp.take_along_axis(jax.nn.log_softmax(out), a[..., None], -1)[..., 0]

    def entropy(self, params: Params, out: jax.Array) -> jax.Array:
        logp = jax.nn.log_softmax(out)
        return -(jnp.exp(logp) * logp).sum(-1)


class Gaussian:
    """Numbers: the network gives their means, and the spread is a parameter of its own."""

    def __init__(self, numbers: int) -> None:
        self.outputs, self.shape, self.dtype = numbers, (numbers,), np.dtype(np.float32)

    def sample(self, params: Params, out: jax.Array, key: jax.Array) -> jax.Array:
        return out + jnp.exp(params["spread"]) * jax.random.normal(key, out.shape)

    def log_prob(self, params: Params, out: jax.Array, a: jax.Array) -> jax.Array:
        z = (a - out) / jnp.exp(params["spread"])
        return (-0.5 * z**2 - params["spread"] - 0.5 * jnp.log(2 * jnp.pi)).sum(-1)

    def entropy(self, params: Params, out: jax.Array) -> jax.Array:
        return (params["spread"] + 0.5 * jnp.log(2 * jnp.pi * jnp.e)).sum() + 0 * out[..., 0]


Kind = Union[Categorical, Gaussian]


# -- running moments, for normalisation: (mean, variance, count)

Moments = tuple[jax.Array, jax.Array, jax.Array]


def no_moments(*shape: int) -> Moments:
    return jnp.zeros(shape), jnp.ones(shape), jnp.array(1e-4)


def with_more(moments: Moments, x: jax.Array, weight: jax.Array) -> Moments:
    """Those of what was seen and of x (steps, worlds, ...) where weight (steps, worlds) is 1."""
    mean, var, count = moments
    w = weight.reshape(weight.shape + (1,) * (x.ndim - 2))
    n = weight.sum()
    new = (x * w).sum((0, 1)) / n
    spread = (w * (x - new) ** 2).sum((0, 1)) / n
    total, delta = count + n, new - mean
    var = (var * count + spread * n + delta**2 * count * n / total) / total
    return mean + delta * n / total, var, total


def scaled(moments: Moments, x: Any) -> jax.Array:
    return jnp.clip((x - moments[0]) / jnp.sqrt(moments[1] + 1e-8), -10, 10)


# -- learning


def advantages(o: Options, b: Batch, rewards: jax.Array, values: jax.Array) -> jax.Array:
    """Generalised advantage estimation, from the last step to the first; values has one row more."""

    def step(after: jax.Array, x: Any) -> tuple[jax.Array, jax.Array]:
        reward, value, next_value, terminated, ended = x
        delta = reward + o.gamma * next_value * ~terminated - value
        after = delta + o.gamma * o.lam * ~ended * after
        return after, after

    rows = rewards, values[:-1], values[1:], b["terminated"], b["ended"]
    out: jax.Array = jax.lax.scan(step, jnp.zeros_like(values[0]), rows, reverse=True)[1]
    return out


def discounted(o: Options, b: Batch, before: jax.Array) -> tuple[jax.Array, jax.Array]:
    """Discounted sums of what an episode has had so far: the last, and of each step."""

    def step(sum: jax.Array, x: Any) -> tuple[jax.Array, jax.Array]:
        reward, weight = x
        sum = sum * o.gamma * weight + reward
        return sum, sum

    out: tuple[jax.Array, jax.Array] = jax.lax.scan(step, before, (b["reward"], b["weight"]))
    return out


def make_loss(o: Options, kind: Kind) -> Callable[[Params, Batch], tuple[jax.Array, jax.Array]]:
    def loss(params: Params, b: Batch) -> tuple[jax.Array, jax.Array]:
        """And the divergence from the policy that acted, as Schulman (2020) estimates it."""
        out, value = apply(params["policy"], b["x"]), apply(params["value"], b["x"])[..., 0]

        def mean(y: jax.Array) -> jax.Array:
            return (y * b["weight"]).sum() / b["weight"].sum()  # resets do not count

        a = b["advantage"] - mean(b["advantage"])
        a = a / jnp.sqrt(mean(a**2) + 1e-8)
        change = kind.log_prob(params, out, b["action"]) - b["log_prob"]
        ratio = jnp.exp(change)
        gain = jnp.minimum(ratio * a, jnp.clip(ratio, 1 - o.clip, 1 + o.clip) * a)
        error = (value - b["target"]) ** 2
        total = -mean(gain) + 0.5 * mean(error) - o.entropy * mean(kind.entropy(params, out))
        return total, mean(ratio - 1 - change)

    return loss


def make_learner(o: Options, kind: Kind, seen: int) -> tuple[State, Act, Update]:
    """What learns; its actions, with noise; and one update: all epochs over one batch, in the orders
    (epochs, samples) that are given. A batch's "x" has one row more than it has steps."""
    k1, k2 = jax.random.split(jax.random.PRNGKey(o.seed))
    params = {
        "policy": perceptron(k1, [seen, *o.hidden, kind.outputs], 0.01),
        "value": perceptron(k2, [seen, *o.hidden, 1], 1.0),
        "spread": jnp.full(kind.shape or 0, -0.5),
    }
    # Adam (Kingma and Ba 2015), times a rate that changes.
    optimizer: Any = optax.chain(optax.clip_by_global_norm(0.5), optax.scale_by_adam(eps=1e-5))
    gradient = jax.grad(make_loss(o, kind), has_aux=True)
    annealed = 0.9 * o.rate / (o.updates * o.epochs * (o.envs * o.steps // o.minibatch))

    def act(state: State, x: Any, number: int) -> jax.Array:
        out = apply(state["params"]["policy"], scaled(state["moments"], x))
        key = jax.random.fold_in(jax.random.PRNGKey(o.seed), number)
        return kind.sample(state["params"], out, key)

    def minibatch(state: Any, b: Batch) -> tuple[Any, None]:
        params, memory, rate = state
        slope, kl = gradient(params, b)
        change, memory = optimizer.update(slope, memory, params)
        if o.kl:
            factor = jnp.where(kl > 2 * o.kl, 1 / 1.5, jnp.where(kl < o.kl / 2, 1.5, 1))
            rate = jnp.clip(rate * factor, 1e-5, 1e-2)
        params = jax.tree.map(lambda p, d: p - rate * d, params, change)
        return (params, memory, rate if o.kl else rate - annealed), None

    def update(state: State, b: Batch, order: Any) -> State:
        params, moments, weight = state["params"], state["moments"], b["weight"]
        sum, sums = discounted(o, b, state["sum"])
        gains = with_more(state["gains"], sums, weight)
        reward = jnp.clip(b["reward"] / jnp.sqrt(gains[1] + 1e-8), -10, 10)
        x = scaled(moments, b["x"])
        values = apply(params["value"], x)[..., 0]
        gain, x = advantages(o, b, reward, values), x[:-1]
        log_prob = kind.log_prob(params, apply(params["policy"], x), b["action"])
        samples = dict(x=x, action=b["action"], weight=weight, log_prob=log_prob)
        samples |= dict(advantage=gain, target=gain + values[:-1])
        flat = {name: y.reshape(-1, *y.shape[2:]) for name, y in samples.items()}

        def epoch(learned: Any, order: Any) -> tuple[Any, None]:
            parts = jax.tree.map(lambda y: y[order].reshape(-1, o.minibatch, *y.shape[1:]), flat)
            done: tuple[Any, None] = jax.lax.scan(minibatch, learned, parts)
            return done

        learned = params, state["memory"], state["rate"]
        params, memory, rate = jax.lax.scan(epoch, learned, order)[0]
        # The moments change between updates alone, so that old and new policy see the same numbers.
        moments = with_more(moments, b["x"][:-1], weight)
        new = dict(params=params, memory=memory, rate=rate, moments=moments, gains=gains, sum=sum)
        return new

    state: State = dict(params=params, memory=optimizer.init(params), rate=jnp.array(o.rate))
    state |= dict(moments=no_moments(seen), gains=no_moments(), sum=jnp.zeros(o.envs))
    return state, jax.jit(act), jax.jit(update)
