"""The nodes of a cluster, and how many of their cores a shard gets."""

from __future__ import annotations

from collections.abc import Sequence

import ray


def cpus_of_nodes() -> list[float]:
    """Of each node that is alive. Starts Ray on this machine where it is not running."""
    if not ray.is_initialized():
        ray.init(include_dashboard=False, log_to_driver=False)
    nodes = [n["Resources"].get("CPU", 0.0) for n in ray.nodes() if n["Alive"]]
    return [cpus for cpus in nodes if cpus > 0]


def share_of(nodes: Sequence[float], shards: int) -> float:
    """Cores of each of so many shards: of the smallest node, all or an equal share."""
    on_each = -(-shards // len(nodes))
    share = min(nodes) / on_each
    return float(int(share)) if share >= 1 else share
