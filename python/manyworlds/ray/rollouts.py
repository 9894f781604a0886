"""Rollouts of worlds that are spread over shards."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from .. import arrays, search
from .._distribution import needs
from ..files import File
from ..in_memory import InMemory
from ..kinds import MAX_WORLDS, AnyScene, plans_of
from ..names import FieldName, Isa, Precision
from ..plan import Plan
from ..rollout import MAX_STEPS
from ..search.loop import Goal, SeedsBy
from ..search.outcome import Objective
from ..tasks import Task, TaskError
from .shard import OF_A_TASK, Act, Shard
from .trajectories import Evaluation, Trajectories
from .trials import Trials
from .work import Policy, Report, Work, default_block, shares, task_of

if TYPE_CHECKING:
    from .crew import Crew

_AHEAD = 64  # calls that may wait at most
_HISTORY = 2**31 - 1


class Rollouts(InMemory):
    """Worlds of a task or a scene on Ray actors, or in this process.

    what        a Task, a Scene or a Plan, or the name of a task or a scene
    worlds      number of worlds
    seed        world i draws from seed + i
    policy      for a task: function of observations (worlds of a block, observations) that returns
                actions for each step; NumPy, JAX or a torch.nn.Module; None: zeros, or choice 0.
                For a scene: function of a Batch that returns its controls. It must depend only on
                its argument
    shards      number of actors; 0: this process, without Ray; None: one per node of the cluster
    cpus        cores per actor; None: the cores of the smallest node, divided by the actors per
                node
    resources   Ray resources of each actor
    block       number of worlds that are stored, stepped and moved together. It changes results if
                the rounding of a policy depends on the number of its rows. None: a 64th, 16 to 4096
    fields      fields of trajectories, for a scene
    threads     threads per shard; None: its cpus, or in this process all that it may use
    timeout     maximum duration of a call in s, without the start and recovery of its actor. Then
                the actor counts as hung and is replaced. Earlier pending calls count, too
    max_restarts  maximum number of replacements of a shard in one call
    checkpoint_every  worlds are saved at the end of a call after this number of steps; 0: never
    folder      folder of the saved worlds, visible to all nodes; None: Ray's object store. With a
                folder, unused policies are freed, for callers that change the policy often

    Worlds of a dead or hung actor continue from the last saved state, or from the start if that was
    lost with its node. Results are bitwise equal. An exception of a policy is raised here; the
    shards may then have stopped at different steps, and ``closed`` is True. Not thread-safe.
    Raises ValueError, TypeError, TaskError, SceneError, ShardError.
    """

    _instead = "pickle its task or scene and the arguments that it was made with"

    def __init__(
        self,
        what: Union[Task, AnyScene],
        worlds: int,
        seed: int = 0,
        policy: Optional[Policy] = None,
        shards: Optional[int] = None,
        *,
        cpus: Optional[float] = None,
        resources: Optional[Mapping[str, float]] = None,
        block: Optional[int] = None,
        fields: tuple[FieldName, ...] = (),
        threads: Optional[int] = None,
        precision: Precision = "f32",
        isa: Optional[Isa] = None,
        timeout: Optional[float] = None,
        max_restarts: int = 3,
        checkpoint_every: int = 1000,
        folder: Optional[File] = None,
    ) -> None:
        what = task_of(what)
        if isinstance(what, Task):
            if issues := what.validate():
                raise TaskError(issues)
            if fields:
                raise ValueError(f"fields are {list(fields)}; expected none for a task")
        elif not isinstance(what, Plan):
            what = plans_of(what, 1)[0][0].scene
        worlds = arrays.integer(worlds, "worlds", 1, MAX_WORLDS * 1024)
        size = default_block(worlds) if block is None else arrays.integer(block, "block", 1, MAX_WORLDS)
        seed = arrays.integer(seed, "seed", 0, 2**64 - 1)
        if policy is not None and not callable(policy):
            raise TypeError(f"policy is of type {type(policy).__name__}; expected a callable, or None")
        if timeout is not None and not timeout > 0:
            raise ValueError(f"timeout is {timeout}; expected seconds > 0, or None")
        work = Work(what, worlds, seed, size, threads, precision, isa, tuple(fields))
        work.make_worlds(1, seed).close()  # raises errors of the scene or task here
        self._work = work
        self._trials = 0
        self._closed = False
        self._crew: Optional[Crew] = None
        self._shard: Optional[Shard] = None
        self._policy = policy
        if shards is None or arrays.integer(shards, "shards", 0, MAX_WORLDS) > 0:
            self._crew = self._make_crew(
                shards,
                cpus,
                resources or {},
                timeout,
                arrays.integer(max_restarts, "max_restarts", 0, 1000),
                arrays.integer(checkpoint_every, "checkpoint_every", 0, MAX_STEPS),
                folder,
            )
        else:
            self._shard = Shard(work, range(work.blocks))
        self.use(policy)

    def _make_crew(
        self,
        shards: Optional[int],
        cpus: Optional[float],
        resources: Mapping[str, float],
        timeout: Optional[float],
        max_restarts: int,
        checkpoint_every: int,
        folder: Optional[File],
    ) -> Crew:
        with needs("ray", extra="ray", what="Rollouts with shards other than 0"):
            from . import cluster
            from .crew import Crew, Options

        nodes = cluster.cpus_of_nodes()
        count = self._shards(len(nodes) if shards is None else shards)
        if cpus is None:
            cpus = cluster.share_of(nodes, count)
        if self._work.threads is None:
            threads = max(1, int(cpus))
            self._work = replace(self._work, threads=threads)
        if folder is not None:
            Path(folder).mkdir(parents=True, exist_ok=True)
        where = None if folder is None else str(Path(folder).resolve())
        options = Options(cpus, resources, timeout, max_restarts, checkpoint_every, where)
        return Crew(self._work, shares(self._work.blocks, count), options)

    def _shards(self, count: int) -> int:
        most = self._work.blocks
        if count > most:
            raise ValueError(
                f"shards is {count}, but {self._work.worlds} worlds are {most} blocks of "
                f"{self._work.block}; expected at most {most} (a smaller block gives more)"
            )
        return count

    # -- properties

    @property
    def worlds(self) -> int:
        """Number of worlds."""
        return self._work.worlds

    @property
    def block(self) -> int:
        """Number of worlds in a block."""
        return self._work.block

    @property
    def shards(self) -> int:
        """Number of actors; 0: none."""
        return 0 if self._crew is None else len(self._crew.members)

    @property
    def restarts(self) -> int:
        """Number of replaced actors."""
        return 0 if self._crew is None else self._crew.restarts

    @property
    def processes(self) -> list[int]:
        """Ids of the processes of the shards."""
        self._check()
        if self._crew is None:
            assert self._shard is not None
            return [self._shard.process]
        for member in self._crew.members:
            self._crew.send(member, "process")
        return [self._crew.receive(member)[0] for member in self._crew.members]

    def __repr__(self) -> str:
        if self._closed:
            return "<manyworlds.ray.Rollouts: closed>"
        name = self._work.what.name if isinstance(self._work.what, Task) else "a scene"
        return f"<manyworlds.ray.Rollouts: {name}, {self.worlds} worlds, {self.shards} shards>"

    def _check(self) -> None:
        if self._closed:
            raise ValueError("the rollouts are closed")

    # -- what worlds do

    def use(self, policy: Optional[Policy]) -> None:
        """Sets the policy of the following steps."""
        self._check()
        if self._shard is not None:
            self._shard.use(policy)
            return
        import ray

        assert self._crew is not None
        kept = ray.put(policy)
        self._crew.act(Act(policy=kept), "use", kept)
        for member in self._crew.members:
            self._receive(member)

    def _receive(self, member: Any) -> list[Any]:
        assert self._crew is not None
        try:
            return self._crew.receive(member)
        except BaseException:
            self.close()
            raise

    def run(
        self, steps: int, every: int = 1, keep: Sequence[str] = OF_A_TASK
    ) -> Trajectories:
        """Takes ``steps`` steps of all worlds. Returns Trajectories.

        ``every``: steps per frame, for a scene. ``keep``: arrays of a task's trajectories,
        "observations", "actions", "rewards", "terminated", "truncated". Other arrays are not sent.
        """
        steps = arrays.integer(steps, "steps", 1, MAX_STEPS)
        every = arrays.integer(every, "every", 1, MAX_STEPS)
        kept = self._kept(keep)
        self._check()
        if self._crew is None:
            return self._run_here(steps, every, kept)
        self._send_run(steps, every, kept)
        return self._receive_run()

    @staticmethod
    def _kept(keep: Sequence[str]) -> tuple[str, ...]:
        if isinstance(keep, str):
            raise TypeError(f"keep is a str; expected a list of names, such as ['{keep}']")
        for name in keep:
            if name not in OF_A_TASK:
                raise ValueError(f"keep has {name!r}; expected some of {', '.join(OF_A_TASK)}")
        return tuple(keep)

    def _run_here(self, steps: int, every: int, keep: tuple[str, ...]) -> Trajectories:
        assert self._shard is not None
        try:
            reports, held = self._shard.run(steps, every, keep)
        except BaseException:
            self.close()
            raise
        return Trajectories(Report.joined(reports), [held])

    def _send_run(self, steps: int, every: int, keep: tuple[str, ...]) -> None:
        assert self._crew is not None
        self._crew.act(Act(steps), "run", steps, every, keep, returns=2)

    def _receive_run(self) -> Trajectories:
        assert self._crew is not None
        found = [self._receive(member) for member in self._crew.members]
        return Trajectories(Report.joined([one[0] for one in found]), [one[1] for one in found])

    def iterate(
        self,
        steps: int,
        calls: Optional[int] = None,
        every: int = 1,
        ahead: int = 1,
        keep: Sequence[str] = OF_A_TASK,
    ) -> Iterator[Trajectories]:
        """Yields the Trajectories of ``run(steps)`` repeatedly, while the next ones run.

        At most ``ahead`` calls run in advance, which bounds the number of waiting results. If the
        caller stops early or sets another policy, the worlds are up to ``ahead`` calls further. A
        new policy applies from the first call that has not been sent.
        """
        steps = arrays.integer(steps, "steps", 1, MAX_STEPS)
        every = arrays.integer(every, "every", 1, MAX_STEPS)
        ahead = arrays.integer(ahead, "ahead", 0, _AHEAD)
        left = _HISTORY if calls is None else arrays.integer(calls, "calls", 0, _HISTORY)
        return self._iterate(steps, left, every, ahead, self._kept(keep))

    def _iterate(
        self, steps: int, left: int, every: int, ahead: int, keep: tuple[str, ...]
    ) -> Iterator[Trajectories]:
        waiting = 0
        try:
            while left > 0 or waiting > 0:
                self._check()
                if self._crew is None:
                    left -= 1
                    yield self._run_here(steps, every, keep)
                    continue
                while left > 0 and waiting <= ahead:
                    self._send_run(steps, every, keep)
                    left, waiting = left - 1, waiting + 1
                waiting -= 1
                yield self._receive_run()
        finally:
            while waiting > 0 and not self._closed:
                self._receive_run()
                waiting -= 1

    def evaluate(self, policy: Optional[Policy] = None, episodes: int = 100) -> Evaluation:
        """The first episodes of ``episodes`` separate worlds, with seeds ``seed`` + i, under a
        policy.

        None: the current policy. The worlds of the rollouts do not change. ValueError for a scene.
        """
        self._check()
        if not isinstance(self._work.what, Task):
            raise ValueError("a scene has no episodes; expected a task")
        episodes = arrays.integer(episodes, "episodes", 1, MAX_WORLDS * 1024)
        chosen = self._policy if policy is None else policy
        ranges = replace(self._work, worlds=episodes)
        parts = [(r.start, len(r)) for r in map(ranges.range, range(ranges.blocks))]
        if self._crew is None:
            assert self._shard is not None
            found = [self._shard.evaluate(chosen, *part) for part in parts]
        else:
            import ray

            kept = ray.put(chosen)
            found = self._spread("evaluate", lambda r: (kept, [parts[i] for i in r]), len(parts))
        joined = {name: np.concatenate([one[name] for one in found]) for name in found[0]}
        return Evaluation(**joined)

    def _spread(self, method: str, arguments: Any, count: int) -> list[Any]:
        """Results of ``count`` items, divided over the shards."""
        assert self._crew is not None
        members = [m for m in zip(self._crew.members, shares(count, self.shards)) if m[1]]
        for member, some in members:
            self._crew.send(member, method, *arguments(some))
        return [one for member, _ in members for one in self._receive(member)[0]]

    def search(
        self,
        space: search.Space,
        strategy: search.Strategy,
        objective: Optional[Objective] = None,
        generations: Optional[int] = None,
        *,
        goal: Goal = "minimize",
        seeds: SeedsBy = "search",
        **trial: Any,
    ) -> search.Search:
        """Searches parameters of the task or scene; the shards try the candidates.

        ``objective`` and ``trial`` are those of search.TaskTrial, or of search.Trial for a scene.
        Other arguments are those of search.Search, whose seed is that of the rollouts. Returns the
        Search after ``generations``; its ``run`` continues it. An outcome depends only on its
        candidate's values and seed.
        """
        self._check()
        self._trials += 1
        trials = Trials(self, self._trials, space, objective, trial)
        found = search.Search(trials, strategy, goal, self._work.seed, seeds)
        if generations is None or generations > 0:
            found.run(generations)
        return found

    # -- who does it

    def resize(self, shards: int) -> None:
        """Moves the worlds, unchanged, to this number of actors. Not without actors."""
        self._check()
        if self._crew is None:
            raise ValueError("the rollouts have no actors (shards=0), so none can be added")
        count = self._shards(arrays.integer(shards, "shards", 1, MAX_WORLDS))
        self._crew.divide(shares(self._work.blocks, count))

    @property
    def closed(self) -> bool:
        """Whether ``close`` was called, or a call has failed."""
        return self._closed

    def close(self) -> None:
        """Ends the actors. A second call has no effect."""
        self._closed = True
        if self._crew is not None:
            self._crew.close()
        self._shard = None

    def __enter__(self) -> Rollouts:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
