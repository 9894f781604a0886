"""Counter-based random numbers, as in the library. A world's draws are equal in every batch."""

from __future__ import annotations

import zlib

import numpy as np
from numpy.typing import NDArray

_STEP = np.uint64(0x9E3779B97F4A7C15)


def _mix(z: NDArray[np.uint64]) -> NDArray[np.uint64]:
    """The finaliser of SplitMix64 (Steele, Lea, Flood 2014)."""
    z = (z ^ (z >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    z = (z ^ (z >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    mixed: NDArray[np.uint64] = z ^ (z >> np.uint64(31))
    return mixed


def uniform(seeds: NDArray[np.uint64], name: str, count: int) -> NDArray[np.float64]:
    """``count`` numbers in [0, 1) for each seed, (seeds, count). Different names give other
    numbers.
    """
    stream = np.full(1, zlib.crc32(name.encode()), np.uint64)
    with np.errstate(over="ignore"):  # overflow is intended
        key = _mix(_mix(seeds + _STEP) ^ (stream * _STEP + np.uint64(1)))
        index = np.arange(1, count + 1, dtype=np.uint64)
        bits = _mix(key[:, None] + index * _STEP) >> np.uint64(11)
    return bits * 2.0**-53
