"""A trained policy as a file: the normalisation of observations, a perceptron and the range of actions.

    from policy import Policy, score
    returns, lengths = score("Hopper-v5", Policy.load("hopper.npz"), worlds=1000)

NumPy alone, so that whoever has the file can play it anywhere: ppo.py writes them, and
bench/python/transfer.py plays one file here and in Gymnasium's own environment.
"""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np
from numpy.typing import NDArray

import manyworlds as mw

Array = NDArray[Any]


def task_of_module(name: str) -> mw.Task:
    """What "module:function" returns. The module is looked for where Python does, and in the current
    directory. Raises ValueError where there is none, or where it returns no Task."""
    of, _, function = name.partition(":")
    if (here := str(Path.cwd())) not in sys.path:
        sys.path.append(here)
    try:
        module = importlib.import_module(of)
    except ModuleNotFoundError as error:
        if error.name is None or not (of + ".").startswith(error.name + "."):
            raise  # a module that it imports
        raise ValueError(f"the task '{name}': there is no module '{of}'") from None
    make = getattr(module, function, None)
    if not callable(make):
        raise ValueError(f"the task '{name}': the module '{of}' has no function '{function}'")
    task = make()
    if not isinstance(task, mw.Task):
        found = type(task).__name__
        raise ValueError(f"the task '{name}': it returns a {found}; expected a manyworlds.Task")
    return task


def load_task(name: str) -> mw.Task:
    """A task of ours ("LunarLander"), one of Gymnasium's MuJoCo tasks ("Hopper-v5"), or what a function
    returns ("module:function")."""
    if ":" in name:
        return task_of_module(name)
    if not name.endswith("-v5"):
        return mw.tasks.load(name)
    from manyworlds.gym import mujoco

    return mujoco.task(name)


@dataclass
class Policy:
    """What is best by a perceptron with tanh, without noise.

    mean, scale    of observations: the network sees (observations - mean) / scale, within +-10
    weights, biases  of its layers: (inputs, outputs) and (outputs,)
    low, high      of actions, (numbers,); none where the action is the choice of the largest output
    """

    mean: Array
    scale: Array
    weights: list[Array]
    biases: list[Array]
    low: Array
    high: Array

    def __call__(self, observations: Array) -> Array:
        """Actions, (worlds, numbers) float32 or (worlds,) int64, of observations (worlds, observed)."""
        x = np.clip((observations - self.mean) / self.scale, -10, 10).astype(np.float32)
        for i, (w, b) in enumerate(zip(self.weights, self.biases)):
            x = x @ w + b
            if i + 1 < len(self.weights):
                x = np.tanh(x)
        return np.clip(x, self.low, self.high) if len(self.low) else np.argmax(x, -1)

    def save(self, file: Union[str, Path]) -> None:
        """Writes an .npz of float32."""
        parts = dict(mean=self.mean, scale=self.scale, low=self.low, high=self.high)
        parts |= {f"weights{i}": w for i, w in enumerate(self.weights)}
        parts |= {f"biases{i}": b for i, b in enumerate(self.biases)}
        arrays: dict[str, Any] = {name: np.asarray(x, np.float32) for name, x in parts.items()}
        np.savez(file, **arrays)

    @classmethod
    def load(cls, file: Union[str, Path]) -> Policy:
        """Reads what ``save`` wrote."""
        with np.load(file) as f:
            layers = range(sum(name.startswith("weights") for name in f.files))
            weights, biases = ([f[f"{what}{i}"] for i in layers] for what in ("weights", "biases"))
            return cls(f["mean"], f["scale"], weights, biases, f["low"], f["high"])


def first_episodes(
    step: Callable[[Array], Any], policy: Callable[[Array], Array], observations: Array
) -> tuple[Array, Array]:
    """Returns and lengths, (worlds,), of the episodes that begin with these observations. ``step``
    takes actions and gives (observations, rewards, terminated, truncated, ...)."""
    worlds = len(observations)
    returns, lengths, alive = np.zeros(worlds), np.zeros(worlds, int), np.ones(worlds, bool)
    while alive.any():
        observations, rewards, terminated, truncated = step(policy(observations))[:4]
        returns += np.where(alive, rewards, 0)
        lengths += alive
        alive &= ~(terminated | truncated)
    return returns, lengths


def score(
    task: Union[mw.Task, str],
    policy: Callable[[Array], Array],
    worlds: int = 256,
    seed: int = 10**6,
    threads: Optional[int] = None,
) -> tuple[Array, Array]:
    """Returns and lengths, (worlds,), of the first episode of fresh worlds; world i has the seed
    seed + i."""
    task = load_task(task) if isinstance(task, str) else task
    with mw.Environment(task, worlds, threads, seed) as env:
        return first_episodes(env.step, policy, env.observations)
