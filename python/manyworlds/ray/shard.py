"""A shard: some blocks of worlds, in this process or in an actor."""

from __future__ import annotations

import os
import pickle
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any, NamedTuple, Optional, Union

import numpy as np

from .. import search
from ..batch import Batch
from ..environment import Environment
from .policies import actions_of
from .work import Arrays, Policy, Report, Work


# Names of a task's trajectories.
OF_A_TASK = ("observations", "actions", "rewards", "terminated", "truncated")


class Act(NamedTuple):
    """An entry of the history: a number of steps, or a new policy."""

    steps: int = 0
    policy: Any = None  # policy of an entry without steps, or a reference to it in Ray's store


class Shard:
    """Blocks of worlds that step under a policy. Results do not depend on where it runs."""

    def __init__(self, work: Work, blocks: Sequence[int], saved: Optional[Mapping[int, Any]] = None):
        self._work = work
        self._blocks: dict[int, Union[Environment, Batch]] = {}
        self._policy: Optional[Policy] = None
        self._trial: tuple[int, Any] = (-1, None)
        for block in blocks:
            held = self._blocks[block] = work.make(block)
            if saved is not None:
                held.restore(saved[block])

    @property
    def process(self) -> int:
        """The id of its process."""
        return os.getpid()

    def use(self, policy: Optional[Policy]) -> None:
        """Sets the policy."""
        self._policy = policy

    def run(
        self, steps: int, every: int = 1, keep: Sequence[str] = OF_A_TASK
    ) -> tuple[list[Report], list[Arrays]]:
        """Steps all blocks. Returns reports and arrays by block.

        For a task, ``keep`` names the arrays of every step: ``observations`` before the action (steps,
        worlds, observations), ``actions``, ``rewards``, ``terminated``, ``truncated``. For a scene, the
        arrays are its fields after every ``every`` steps (frames, worlds, ...).
        """
        reports, arrays = [], []
        for held in self._blocks.values():
            if isinstance(held, Environment):
                report, filled = self._play(held, steps, keep)
            else:
                report, filled = self._roll(held, steps, every)
            reports.append(report)
            arrays.append(filled)
        return reports, arrays

    def _play(self, e: Environment, steps: int, keep: Sequence[str]) -> tuple[Report, Arrays]:
        kinds: dict[str, Any] = {
            "observations": (e.observations.shape, e.observations.dtype),
            "actions": (e.action_shape, np.int64 if e.discrete else np.float32),
            "rewards": (e.rewards.shape, np.float64),
            "terminated": (e.terminated.shape, np.bool_),
            "truncated": (e.truncated.shape, np.bool_),
        }
        out: Arrays = {n: np.empty((steps, *kinds[n][0]), kinds[n][1]) for n in kinds if n in keep}
        returns = np.zeros(e.worlds)
        episodes = np.zeros(e.worlds, np.int32)
        for i in range(steps):
            if "observations" in out:
                out["observations"][i] = e.observations
            actions = actions_of(self._policy, e)
            if "actions" in out:
                out["actions"][i] = actions
            e.step(actions)
            for name in ("rewards", "terminated", "truncated"):
                if name in out:
                    out[name][i] = getattr(e, name)
            returns += e.rewards
            episodes += e.terminated | e.truncated
        return Report(e.batch.hashes(), e.lost(), returns, episodes), out

    def _roll(self, batch: Batch, steps: int, every: int) -> tuple[Report, Arrays]:
        fields = self._work.fields
        if self._policy is None:
            out = batch.rollout(steps=steps, fields=fields, every=every)
        else:
            frames: list[Arrays] = []
            for i in range(1, steps + 1):
                batch.step(controls=self._policy(batch))
                if i % every == 0:
                    frames.append({name: batch.get(name) for name in fields})
            out = {name: np.stack([f[name] for f in frames]) for name in fields if frames}
        none = np.zeros(batch.worlds)
        return Report(batch.hashes(), batch.lost(), none, none.astype(np.int32)), out

    def repeat(self, acts: Sequence[Act]) -> None:
        """Repeats the history since these worlds were saved, without results."""
        for act in acts:
            if act.steps == 0:
                self.use(act.policy)
            for held in self._blocks.values():
                for _ in range(act.steps):
                    if isinstance(held, Environment):
                        held.step(actions_of(self._policy, held))
                    else:
                        held.step(controls=self._policy(held) if self._policy else None)

    def save(self, folder: Optional[str] = None, name: str = "") -> dict[int, Any]:
        """Snapshots by block; with a folder, paths of files, which ``load`` reads."""
        saved = {block: held.save() for block, held in self._blocks.items()}
        if folder is None:
            return saved
        paths: dict[int, Any] = {}
        for block, snapshot in saved.items():
            path = Path(folder) / f"block{block}_{name}.pickle"
            part = path.with_suffix(".part")  # a partial file never has the final name
            part.write_bytes(pickle.dumps(snapshot))
            part.replace(path)
            paths[block] = str(path)
        return paths

    @staticmethod
    def load(saved: Mapping[int, Any]) -> dict[int, Any]:
        """Snapshots from the result of ``save``."""
        return {
            block: pickle.loads(Path(one).read_bytes()) if isinstance(one, str) else one
            for block, one in saved.items()
        }

    def evaluate(self, policy: Optional[Policy], first: int, episodes: int) -> Arrays:
        """The first episodes of worlds first, first + 1, ... under a policy, in separate worlds."""
        environment = self._work.make_worlds(episodes, (self._work.seed + first) % 2**64)
        assert isinstance(environment, Environment)
        with environment as e:
            playing = np.ones(episodes, np.bool_)
            out: Arrays = {
                "returns": np.zeros(episodes),
                "lengths": np.zeros(episodes, np.int64),
                "lost": np.zeros(episodes, np.bool_),
            }
            while playing.any():
                e.step(actions_of(policy, e))
                out["returns"][playing] += e.rewards[playing]
                out["lengths"][playing] += 1
                ended = playing & (e.terminated | e.truncated)
                out["lost"][ended] = e.lost()[ended]
                playing &= ~ended
        return out

    def try_out(self, trial: tuple[int, Any], values: Any, seeds: Any) -> search.Outcome:
        """Tries candidates of a search. ``trial``: its number and the function that makes it, called once."""
        number, make = trial
        if self._trial[0] != number:
            self._trial = number, make()
        outcome: search.Outcome = self._trial[1].evaluate(values, seeds)
        return outcome
