"""What resets draw."""

import numpy as np
import pytest

import manyworlds as mw
from conftest import crates


def test_reset_repeats_and_redraw_or_a_seed_draws_anew():
    batch = mw.Batch(crates(), worlds=5, seed=3)
    first = batch.hashes()
    assert batch.seeds().tolist() == [3, 4, 5, 6, 7]
    batch.step(7)
    batch.reset()
    assert (batch.hashes() == first).all() and batch.steps == 0 and batch.time == 0
    batch.reset(redraw=False)
    assert (batch.hashes() == first).all()
    batch.reset(redraw=True)
    second = batch.hashes()
    assert (second != first).all()
    batch.reset(redraw=True)
    third = batch.hashes()
    assert (third != second).all() and (third != first).all()
    # Again the same after a repeat, and as the next episodes of single worlds.
    batch.reset()
    batch.reset(np.array([True] * 5))
    assert (batch.hashes() == second).all()
    batch.reset([1, 4], redraw=False)
    assert (batch.hashes() == np.where([0, 1, 0, 0, 1], first, second)).all()
    # From other seeds, which later resets repeat, too.
    batch.reset(seed=4)
    assert batch.hashes()[:-1].tolist() == first[1:].tolist()
    assert batch.seeds().tolist() == [4, 5, 6, 7, 8]
    batch.step(2)
    batch.reset()
    assert batch.hashes()[:-1].tolist() == first[1:].tolist()
    batch.reset(seeds=4)
    assert batch.hashes()[:-1].tolist() == first[1:].tolist()
    for wrong, error, match in (
        (dict(seed=1, seeds=2), ValueError, "seed and seeds are both given"),
        (dict(seed=1, redraw=False), ValueError, "redraw is False and a seed is given"),
        (dict(seed=-1), ValueError, "seed is -1"),
        (dict(seed=1.5), TypeError, "expected an integer"),
        (dict(seed=[1] * 5), TypeError, "expected an integer"),
        (dict(redraw=1), TypeError, "redraw is of type int; expected a bool"),
    ):
        with pytest.raises(error, match=match):
            batch.reset(**wrong)
