"""Rollouts on the actors of Ray: as many worlds as there are machines for, with the bits of one.

    from manyworlds.ray import Rollouts

    with Rollouts("Hopper", worlds=100_000, seed=1, policy=policy) as rollouts:
        for trajectories in rollouts.iterate(200):  # the next 200 steps run meanwhile
            learn(trajectories.parts)

World i has the seed ``seed + i`` whatever actor steps it, and how many of them there are: hashes, returns and
trajectories are the same in one process (``shards=0``), on one machine and on a hundred. An actor that dies,
or hangs, is replaced, and its worlds catch up. docs/scale.md explains the rest.

Ray is needed where ``shards`` is not 0: ``pip install "manyworlds-sim[ray]"``.
"""

from .rollouts import Rollouts
from .trajectories import Evaluation, Trajectories
from .work import Report, ShardError

__all__ = ["Evaluation", "Report", "Rollouts", "ShardError", "Trajectories"]
