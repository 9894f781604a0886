"""Which worlds a call means."""

import numpy as np
import pytest

import manyworlds as mw
from conftest import crates

# Calls that take worlds, and what they need.
TAKE_WORLDS = {
    "reset": lambda b, ids: b.reset(ids),
    "reset with a seed": lambda b, ids: b.reset(ids, seed=3),
    "step": lambda b, ids: b.step(1, ids=ids),
    "get": lambda b, ids: b.get("position", ids=ids),
    "set": lambda b, ids: b.set("linear_velocity", 1, ids=ids),
    "randomize": lambda b, ids: b.randomize("linear_velocity", 0, 1, ids=ids),
    "set_controls": lambda b, ids: b.set_controls(0, ids=ids),
    "add_force": lambda b, ids: b.add_force((1, 0, 0), ids=ids),
    "add_torque": lambda b, ids: b.add_torque((1, 0, 0), ids=ids),
    "add_impulse": lambda b, ids: b.add_impulse((1, 0, 0), ids=ids),
    "add_angular_impulse": lambda b, ids: b.add_angular_impulse((1, 0, 0), ids=ids),
    "set_enabled": lambda b, ids: b.set_enabled(True, ids=ids),
    "set_joints_enabled": lambda b, ids: b.set_joints_enabled(True, ids=ids),
    "spawn": lambda b, ids: b.spawn(1, (0, 0, 9), ids=ids),
    "wake": lambda b, ids: b.wake(ids),
    "save": lambda b, ids: b.save(ids),
    "restore": lambda b, ids: b.restore(b.save([0]), source=0, ids=ids),
}


@pytest.mark.parametrize("name", TAKE_WORLDS)
def test_bools_are_masks_and_integers_are_ids_without_repeats(name):
    call = TAKE_WORLDS[name]
    for good in ([1, 3], np.array([3, 1]), np.array([False, True, False, True]), 2, range(2)):
        call(mw.Batch(crates(), worlds=4), good)
    if name != "save":  # of which there must be some
        call(mw.Batch(crates(), worlds=4), [])
    # A mask of integers names worlds 0 and 1 twice.
    wrong = [
        (np.array([0, 0, 1, 1]), ValueError, "name world 0 more than once.*a mask is an array of bools"),
        ([2, 1, 2], ValueError, "name world 2 more than once"),
        ([True, 2], TypeError, "mix bools and integers"),
        (np.array([0.0, 1.0]), TypeError, "float64; expected integers, or a mask of bools"),
        (np.array([True, False]), IndexError, r"shape \(2,\); expected \(4,\)"),
        (np.ones((4, 1), bool), IndexError, "expected"),
        ([0, 4], IndexError, "hold 4, must be 0 to 3"),
        ([-1], IndexError, "hold -1"),
        (np.array([2**63], np.uint64), IndexError, "hold 9223372036854775808"),
        ("0", TypeError, "expected integers"),
    ]
    batch = mw.Batch(crates(), worlds=4)
    before = batch.hashes()
    for ids, error, match in wrong:
        with pytest.raises(error, match=match):
            call(batch, ids)
    assert (batch.hashes() == before).all() and batch.steps == 0


def test_a_source_may_be_named_more_than_once():
    batch = mw.Batch(crates(), worlds=4)
    first = batch.hashes()
    batch.restore(batch.save(), source=[0, 0, 1, 1], ids=range(4))
    assert batch.hashes().tolist() == first[[0, 0, 1, 1]].tolist()
