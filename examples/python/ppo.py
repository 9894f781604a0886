"""PPO: many worlds on the CPU, the network in JAX on the same CPU (learner.py).

    pip install "manyworlds-sim[gym,mjcf]" jax optax
    python ppo.py --task LunarLander --seed 1 --seconds 300 --json lander.json
    python ppo.py --task HalfCheetah-v5 --seed 1 --json cheetah.json --policy cheetah.npz
    python ppo.py --task compose:make_task

Where an episode has ended the next transition is a reset (autoreset "next_step"), and takes no part in
the loss; the observation before it is where the episode ended, from which a truncated one is bootstrapped.
"""

import argparse
import json
import time
from collections.abc import Sequence
from typing import Any

import jax
import numpy as np

import manyworlds as mw
from learner import Categorical, Gaussian, State, make_learner
from policy import Policy, load_task, score

ROBOT = dict(
    envs=1024, steps=32, updates=2000, minibatch=8192, gamma=0.99, entropy=0, kl=0.01, stagger=True,
    seconds=1800,
)  # fmt: skip
# What differs from the defaults below, by task.
TUNED: dict[str, dict[str, float]] = {
    "CartPole": dict(envs=256, steps=32, updates=300, gamma=0.98, lam=0.9, rate=2e-3),
    "LunarLander": dict(updates=90, gamma=0.999, lam=0.98, entropy=0.002, goal=220),
    "HalfCheetah-v5": ROBOT | dict(goal=5000),
    "Hopper-v5": ROBOT | dict(goal=2500),
    "Ant-v5": ROBOT | dict(goal=4000),
}


def arguments(argv: Sequence[str] | None = None) -> argparse.Namespace:
    p = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    p.add_argument(
        "--task",
        default="LunarLander",
        help="a task's name (LunarLander, Hopper-v5, ...), or module:function, a function without "
        "arguments that returns a manyworlds.Task, of a module in the current directory or where "
        "Python looks; its episodes need a time limit (Task.max_steps)",
    )
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("--envs", type=int, default=512)
    p.add_argument("--steps", type=int, default=128, help="of a world between two updates")
    p.add_argument("--updates", type=int, default=250, help="at most")
    p.add_argument("--epochs", type=int, default=4)
    p.add_argument("--minibatch", type=int, default=4096)
    p.add_argument("--rate", type=float, default=1e-3, help="of Adam, annealed to a tenth")
    p.add_argument("--kl", type=float, default=0, help="not 0: the rate follows it instead")
    p.add_argument("--gamma", type=float, default=0.995)
    p.add_argument("--lam", type=float, default=0.95)
    p.add_argument("--clip", type=float, default=0.2)
    p.add_argument("--entropy", type=float, default=0.01)
    p.add_argument("--stagger", action="store_true", help="first episodes end at all times")
    p.add_argument("--hidden", type=int, nargs="+", default=[64, 64], help="of each layer")
    p.add_argument(
        "--seconds", type=float, default=300, help="stop after so many, compiling included"
    )
    p.add_argument("--goal", type=float, help="stop at this mean return; default: the task's")
    p.add_argument("--threads", type=int, help="that step the worlds")
    p.add_argument("--json", help="write the learning curve here")
    p.add_argument("--policy", help="write the policy here, an .npz that policy.py loads")
    name = p.parse_known_args(argv)[0].task
    p.set_defaults(**TUNED.get(name, {}))
    o = p.parse_args(argv)
    try:
        task = load_task(o.task)
    except ValueError as error:
        p.error(str(error))
    if task.max_steps == 0:
        p.error(f"the task '{o.task}' has no time limit: its max_steps is 0, must be 1 or more")
    return o


class Clock:
    """Seconds since it was made: of the wall, and of the processor (of all its cores) by what was done."""

    def __init__(self) -> None:
        self.began, self.last = time.perf_counter(), time.process_time()
        self.spent = dict(stepping=0.0, acting=0.0, learning=0.0)

    def was(self, what: str) -> None:
        """The time since the last call was for this."""
        now = time.process_time()
        self.spent[what] += now - self.last
        self.last = now

    def wall(self) -> float:
        return time.perf_counter() - self.began


class Episodes:
    """Returns and lengths: of the episodes that go on, and of the last that ended."""

    def __init__(self, worlds: int) -> None:
        self.returns, self.lengths = np.zeros(worlds), np.zeros(worlds, int)
        self.ended: list[tuple[float, float]] = []
        self.most = max(200, worlds)

    def add(self, rewards: Any, counts: Any, ended: Any) -> None:
        self.returns += rewards
        self.lengths += counts
        self.ended += zip(self.returns[ended], self.lengths[ended])
        self.ended = self.ended[-self.most :]
        self.forget(ended)

    def forget(self, worlds: Any) -> None:
        self.returns[worlds] = self.lengths[worlds] = 0

    def means(self) -> tuple[float, float]:
        """Return and length; NaN before one has ended."""
        mean, length = np.mean(self.ended or [(np.nan, np.nan)], 0)
        return float(mean), float(length)

    def reached(self, goal: float) -> bool:
        return len(self.ended) == self.most and self.means()[0] >= goal


def policy_of(state: State, task: mw.Task) -> Policy:
    """What has been learnt, without its noise."""
    mean, var, _ = (np.asarray(x) for x in state["moments"])
    weights, biases = (
        [np.asarray(x) for x in of_layers] for of_layers in zip(*state["params"]["policy"])
    )
    low, high = (
        np.array([getattr(action, end) for action in task.actions], np.float32)
        for end in ("low", "high")
    )
    return Policy(mean, np.sqrt(var + 1e-8), weights, biases, low, high)


def train(o: argparse.Namespace) -> tuple[dict[str, Any], Policy]:
    """The learning curve, and what was learnt."""
    clock, task, n = Clock(), load_task(o.task), o.envs
    env = mw.Environment(task, n, o.threads, seed=1000 * o.seed)
    kind = Categorical(task.choices) if env.discrete else Gaussian(len(task.actions))
    goal = task.solved_at if o.goal is None else o.goal
    o.minibatch = min(o.minibatch, n * o.steps // 4)
    state, act, update = make_learner(o, kind, len(task.observations))
    shape = (o.steps, n)
    batch = {
        "x": np.zeros((o.steps + 1, n, len(task.observations)), np.float32),
        "action": np.zeros((*shape, *kind.shape), kind.dtype),
        "reward": np.zeros(shape, np.float32),
        "weight": np.zeros(shape, np.float32),
        "terminated": np.zeros(shape, bool),
        "ended": np.zeros(shape, bool),
    }
    rng, episodes = np.random.default_rng(o.seed), Episodes(n)
    batch["x"][0] = env.observations
    begins = np.zeros(n, bool)  # the next step is a reset
    rounds = task.max_steps // o.steps  # updates in an episode
    curve, total = [], 0
    for number in range(1, o.updates + 1):
        for t in range(o.steps):
            action = np.asarray(act(state, batch["x"][t], number * o.steps + t))
            clock.was("acting")
            _, rewards, terminated, truncated = env.step(action, observations=batch["x"][t + 1])
            clock.was("stepping")
            ended = terminated | truncated
            batch["action"][t], batch["reward"][t], batch["weight"][t] = action, rewards, ~begins
            batch["terminated"][t], batch["ended"][t] = terminated, ended
            episodes.add(rewards, ~begins, ended)
            begins = ended
        total += int(batch["weight"].sum())
        order = np.array([rng.permutation(n * o.steps) for _ in range(o.epochs)])
        order = order[:, : n * o.steps // o.minibatch * o.minibatch]
        clock.was("acting")
        state = jax.block_until_ready(update(state, batch, order))
        clock.was("learning")
        batch["x"][0] = batch["x"][-1]
        if o.stagger and number < rounds:
            some = np.arange(n) % rounds == number
            env.reset(some, observations=batch["x"][0])
            begins[some] = False
            episodes.forget(some)
        mean, length = episodes.means()
        row = {"seconds": clock.wall(), "steps": total, "return": mean, "length": length}
        row = {name: round(value, 2) for name, value in (row | clock.spent).items()}
        curve.append({name: None if value != value else value for name, value in row.items()})
        if number % 10 == 1:
            print(
                f"{row['seconds']:7.1f} s {total:10d} steps  return {mean:8.1f}  length {length:6.0f}",
                flush=True,
            )
        if clock.wall() > o.seconds or episodes.reached(goal):
            break
    env.close()
    options = {name: value for name, value in vars(o).items() if name not in ("json", "policy")}
    result = {"task": o.task, "seed": o.seed, "options": options, "curve": curve}
    return result, policy_of(state, task)


def main(argv: Sequence[str] | None = None) -> dict[str, Any]:
    o = arguments(argv)
    result, policy = train(o)
    returns, lengths = score(o.task, policy, threads=o.threads)
    result["evaluation"] = float(returns.mean())
    last = result["curve"][-1]
    shares = ", ".join(f"{last[x]:.0f} s {x}" for x in ("stepping", "acting", "learning"))
    print(
        f"{last['seconds']:7.1f} s {last['steps']:10d} steps  return {returns.mean():8.1f}  "
        f"length {lengths.mean():6.0f}  of fresh worlds, best actions\nof the processor: {shares}"
    )
    if o.json:
        with open(o.json, "w") as file:
            json.dump(result, file)
    if o.policy:
        policy.save(o.policy)
    return result


if __name__ == "__main__":
    main()
