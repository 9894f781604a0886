"""The actors of the shards, and their replacement when one dies or hangs.

A replacement restores the last snapshots and repeats the history of calls since then. Steps are
deterministic, so the replacement returns the results of the lost actor.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Optional

import ray

from .shard import Act, Shard
from .work import Arrays, Report, ShardError, Work


@dataclass
class Options:
    """Options of actors and of their supervision."""

    cpus: float
    resources: Mapping[str, float]
    timeout: Optional[float]
    max_restarts: int
    checkpoint_every: int
    folder: Optional[str]


@dataclass
class Call:
    """A call sent to a shard, with references to its results."""

    method: str
    arguments: tuple[Any, ...]
    results: list[Any]
    act: Optional[Act] = None  # its entry of the history
    saves: bool = False


@dataclass
class Member:
    """A shard and its actor."""

    blocks: range
    actor: Any = None
    ready: Any = None  # a reference that resolves once the actor has started and repeated the history
    # References to saved snapshots of its blocks; empty: the shard starts from the seed.
    saved: tuple[Any, ...] = ()
    files: list[str] = field(default_factory=list)  # files of these snapshots
    done: int = 0  # entries of the history that its worlds have completed
    saved_at: int = 0  # entries completed in ``saved``
    since: int = 0  # steps sent since the last call that saves
    sent: deque[Call] = field(default_factory=deque)


class Crew:
    """Members, each with a share of the blocks. Calls go to all of them and return in order."""

    def __init__(self, work: Work, shares: Sequence[range], options: Options) -> None:
        self._options = options
        self._work = ray.put(work)
        self.history: list[Act] = []
        self._dropped = 0  # number of removed entries, and the last policy in them
        self._policy_then: list[Act] = []
        self._divided_at = 0  # position in the history, and the files from which members started there
        self._shared_files: list[str] = []
        self.restarts = 0
        self.members = [Member(blocks) for blocks in shares]
        for member in self.members:
            self._start(member)

    def _start(self, member: Member) -> None:
        """Starts an actor that restores the saved snapshots and repeats the history since then."""
        o = self._options
        kind = ray.remote(_Actor).options(
            num_cpus=o.cpus,
            resources=dict(o.resources) or None,
            scheduling_strategy="SPREAD",
            max_restarts=0,
        )
        member.actor = kind.remote(self._work, list(member.blocks), list(member.saved))
        saved_at, done = member.saved_at - self._dropped, member.done - self._dropped
        acts = self.history[saved_at:done]
        policies = self._policy_then + [a for a in self.history[:saved_at] if a.steps == 0]
        if acts := _fewer([*policies[-1:], *acts]):
            member.actor.repeat.remote(acts)
        member.ready = member.actor.process.remote()

    # -- calls

    def send(
        self,
        member: Member,
        method: str,
        *arguments: Any,
        returns: int = 1,
        act: Optional[Act] = None,
        saves: bool = False,
    ) -> None:
        """Sends a call to one member's shard; ``act``: its entry of the history."""
        call = Call(method, arguments, [None] * returns, act, saves)
        self._submit(member, call)
        member.sent.append(call)

    def _submit(self, member: Member, call: Call) -> None:
        remote = getattr(member.actor, call.method)
        found = remote.options(num_returns=len(call.results)).remote(*call.arguments)
        call.results = found if isinstance(found, list) else [found]

    def receive(self, member: Member) -> list[Any]:
        """Results of the member's oldest call: the first as a value, the others as references.

        Replaces an actor that is dead or exceeds ``timeout``, and sends the call again.
        Raises what the call raised, and ShardError.
        """
        call = member.sent[0]
        for attempt in range(self._options.max_restarts + 1):
            try:
                ray.get(member.ready)  # starting and repeating may take longer than a call
                first = ray.get(call.results[0], timeout=self._options.timeout)
                break
            except (ray.exceptions.RayActorError, ray.exceptions.GetTimeoutError) as error:
                if attempt == self._options.max_restarts:
                    raise ShardError(
                        f"the shard of blocks {member.blocks.start} to {member.blocks.stop - 1} was lost "
                        f"{attempt + 1} times in one call ({type(error).__name__}); expected at most "
                        f"max_restarts={self._options.max_restarts} times"
                    ) from error
                self._replace(member)
            except ray.exceptions.RayTaskError as error:
                cause = getattr(error, "cause", None)
                raise (cause if isinstance(cause, Exception) else error) from None
        member.sent.popleft()
        if call.act is not None:
            member.done += 1
        if call.saves:
            _remove(set(member.files) - set(first))  # equal if nothing was done since
            member.saved, member.files, member.saved_at = (call.results[1],), first, member.done
            self._forget()
        while call.act is not None and member.sent and member.sent[0].saves:
            self.receive(member)
        return [first, *call.results[1:]]

    def _replace(self, member: Member) -> None:
        self.restarts += 1
        self.stop(member)
        if not all(self._still_there(one) for one in member.saved):
            # Lost with its node: start from the seed.
            member.saved, member.saved_at = (), 0
        self._start(member)
        for call in member.sent:
            self._submit(member, call)

    @staticmethod
    def _still_there(saved: Any) -> bool:
        try:
            ray.get(saved, timeout=60)
        except (ray.exceptions.ObjectLostError, ray.exceptions.GetTimeoutError):
            return False
        return True

    def stop(self, member: Member) -> None:
        """Kills the member's actor."""
        try:
            ray.kill(member.actor, no_restart=True)
        except ray.exceptions.RayError:  # already dead
            pass

    # -- history

    def act(self, act: Act, method: str, *arguments: Any, returns: int = 1) -> None:
        """Sends an entry of the history to all members, and a call that saves if one is due."""
        self.history.append(act)
        due = self._options.checkpoint_every
        for member in self.members:
            self.send(member, method, *arguments, returns=returns, act=act)
            member.since += act.steps
            if 0 < due <= member.since:
                self._send_save(member)

    def _forget(self) -> None:
        """Removes entries of the history, and policies, that all saved files contain."""
        if self._options.folder is None:
            return
        oldest = min(member.saved_at for member in self.members)
        if oldest > self._divided_at:  # each member has separate files by now
            _remove(self._shared_files)
            self._shared_files = []
        count = oldest - self._dropped
        policies = [act for act in self.history[:count] if act.steps == 0]
        self._policy_then = policies[-1:] or self._policy_then
        del self.history[:count]
        self._dropped += count

    def _send_save(self, member: Member) -> None:
        member.since = 0
        name = str(self._dropped + len(self.history))
        self.send(member, "save", self._options.folder, name, returns=2, saves=True)

    def divide(self, shares: Sequence[range]) -> None:
        """Moves the current worlds to new members with these blocks."""
        for member in self.members:
            self._send_save(member)
        before = self.members
        for member in before:
            while member.sent:
                self.receive(member)
            self.stop(member)
        done = self._dropped + len(self.history)
        self.members = []
        for blocks in shares:
            saved = [m.saved[0] for m in before if set(m.blocks) & set(blocks)]
            self.members.append(Member(blocks, saved=tuple(saved), done=done, saved_at=done))
            self._start(self.members[-1])
        self._divided_at = done
        self._shared_files += [path for member in before for path in member.files]

    def close(self) -> None:
        """Kills all actors."""
        for member in self.members:
            self.stop(member)
        self.members = []


class _Actor:
    """A shard in a Ray actor."""

    def __init__(self, work: Work, blocks: Sequence[int], saved: Sequence[Any]) -> None:
        found: dict[int, Any] = {}
        for part in ray.get(list(saved)):
            found.update({block: one for block, one in part.items() if block in blocks})
        # Saved snapshots are read-only in Ray's store; restoring copies them.
        self._shard = Shard(work, blocks, Shard.load(found) if saved else None)

    def process(self) -> int:
        return self._shard.process

    def use(self, policy: Any) -> None:
        self._shard.use(policy)

    def run(self, steps: int, every: int, keep: Sequence[str]) -> tuple[Report, list[Arrays]]:
        reports, arrays = self._shard.run(steps, every, keep)
        return Report.joined(reports), arrays

    def repeat(self, acts: Sequence[Act]) -> None:
        self._shard.repeat(
            [act if act.steps else Act(policy=ray.get(act.policy)) for act in acts]
        )

    def save(self, folder: Optional[str], name: str) -> tuple[list[str], dict[int, Any]]:
        saved = self._shard.save(folder, name)
        return [one for one in saved.values() if isinstance(one, str)], saved

    def evaluate(self, policy: Any, parts: Sequence[tuple[int, int]]) -> list[Arrays]:
        return [self._shard.evaluate(policy, *part) for part in parts]

    def try_out(self, trial: Any, values: Sequence[Any], seeds: Sequence[Any]) -> list[Any]:
        return [self._shard.try_out(trial, v, s) for v, s in zip(values, seeds)]


def _remove(files: Iterable[str]) -> None:
    for path in files:
        Path(path).unlink(missing_ok=True)


def _fewer(acts: Sequence[Act]) -> list[Act]:
    """The entries, with consecutive steps merged into one."""
    out: list[Act] = []
    for act in acts:
        if out and out[-1].steps and act.steps:
            out[-1] = Act(out[-1].steps + act.steps)
        else:
            out.append(act)
    return out
