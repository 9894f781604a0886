"""Rollouts on Ray actors, bitwise equal to those of a single process.

    from manyworlds.ray import Rollouts

    with Rollouts("Hopper", worlds=100_000, seed=1, policy=policy) as rollouts:
        for trajectories in rollouts.iterate(200):  # the next 200 steps run meanwhile
            learn(trajectories.parts)

World i has the seed ``seed + i`` on every actor and with any number of actors. Hashes, returns and
trajectories are equal in one process (``shards=0``), on one machine and on a hundred. An actor that
dies or hangs is replaced, and the replacement repeats its steps. docs/scale.md has details.

Ray is required unless ``shards`` is 0: ``pip install "manyworlds-sim[ray]"``.
"""

from .rollouts import Rollouts
from .trajectories import Evaluation, Trajectories
from .work import Report, ShardError

__all__ = ["Evaluation", "Report", "Rollouts", "ShardError", "Trajectories"]
