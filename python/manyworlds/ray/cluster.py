"""The nodes of a cluster, and the number of cores of a shard."""

from __future__ import annotations

from collections.abc import Sequence

import ray


def cpus_of_nodes() -> list[float]:
    """Number of cores of each live node. Starts Ray on this machine if it is not running."""
    if not ray.is_initialized():
        ray.init(include_dashboard=False, log_to_driver=False)
    nodes = [n["Resources"].get("CPU", 0.0) for n in ray.nodes() if n["Alive"]]
    return [cpus for cpus in nodes if cpus > 0]


def share_of(nodes: Sequence[float], shards: int) -> float:
    """Cores per shard: those of the smallest node divided by the number of shards per node."""
    on_each = -(-shards // len(nodes))
    share = min(nodes) / on_each
    return float(int(share)) if share >= 1 else share
