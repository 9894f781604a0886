"""Batches of several kinds of world: each is what it is in a batch of its own."""

from __future__ import annotations

import numpy as np
import pytest

import manyworlds as mw
from conftest import crates

SEED = 11


def both(**arguments):
    return mw.Batch([(crates(3), 5), ("stack10", 3)], **{"threads": 1, "seed": SEED, **arguments})


def alone(**arguments):
    """The same worlds in batches of their own: world i draws from seed + i."""
    first = mw.Batch(crates(3), 5, **{"threads": 1, "seed": SEED, **arguments})
    return first, mw.Batch("stack10", 3, **{"threads": 1, "seed": SEED + 5, **arguments})


def same(batch, apart):
    assert batch.hashes().tolist() == [h for other in apart for h in other.hashes()]
    for kind, other in zip(batch.kinds, apart):
        for name, field in other.fields.items():
            if not field.observer:
                assert (kind.get(name) == other.get(name)).all(), name


def test_kinds_are_what_they_are_alone():
    batch, apart = both(), alone()
    assert [k.worlds for k in batch.kinds] == [5, 3] and [k.bodies for k in batch.kinds] == [3, 10]
    assert batch.worlds == 8 and batch.kinds[1].first == 5
    assert batch.kinds[1].get("position").shape == (3, 10, 3)
    same(batch, apart)
    batch.step(30)
    for other in apart:
        other.step(30)
    same(batch, apart)
    assert batch.energy()[batch.kinds[1].slice].tolist() == apart[1].energy().tolist()
    assert (batch.contacts(6) == apart[1].contacts(1)).all()


def test_inputs_go_to_the_worlds_of_a_kind():
    batch, apart = both(sleep=True, observe=["touching", "contacts"]), alone(
        sleep=True, observe=["touching", "contacts"]
    )
    rng = np.random.default_rng(3)
    for kind, other in zip(batch.kinds, apart):
        v = rng.normal(size=(kind.worlds, kind.bodies, 3)).astype(np.float32)
        some = [2, 0]
        for one in (kind, other):
            one.set("linear_velocity", v)
            one.set("angular_velocity", v[some] / 2, ids=some)
            one.add_force((1, 2, 3), bodies=[2], ids=[1])
            one.add_impulse((0, 0, 1), bodies=[1], ids=[2])
            one.add_torque((0, 1, 0))
            one.set_enabled(False, bodies=[3], ids=[0])
            one.spawn(3, (5, 5, 5), ids=[0])
            one.randomize("position", 0, 0.1, ids=[1], items=[0])
            one.wake([1])
        assert (kind.get("linear_velocity", ids=some) == other.get("linear_velocity")[some]).all()
        assert (kind.get_enabled() == other.get_enabled()).all()
    batch.kinds[0].set("friction", 0.5), apart[0].set("friction", 0.5)
    for one in (batch, *apart):
        one.step(20)
    same(batch, apart)
    for kind, other in zip(batch.kinds, apart):
        assert (kind.get("touching") == other.get("touching")).all()
        assert (kind.asleep() == other.asleep()).all()
        assert len(kind.lane_indices()) == kind.worlds
    first = batch.kinds[1].view("position")
    assert first.shape[1:3] == (10, 3)


def test_controls_are_a_kinds():
    lander = mw.scenes.load("lunar-lander")
    car = mw.scenes.load("car2d")
    car.options.dt = lander.options.dt
    batch = mw.Batch([(lander, 4), (car, 3)], threads=1)
    flown, driven = batch.kinds
    shape = driven.get_controls().shape
    assert flown.get_controls().shape == (4, 3) and shape[0] == 3 and shape[1] > 0
    driven.set_controls(np.ones(shape), ids=None)
    flown.set_controls([[2, 0, 0]], ids=[3])
    assert (driven.get_controls() != 0).all()
    assert flown.get_controls()[:, 0].tolist() == [0, 0, 0, 2]


def test_steps_resets_and_snapshots_are_the_batchs():
    batch, apart = both(), alone()
    batch.step(10), batch.step(5, ids=[1, 6])
    for other, ids in zip(apart, ([1], [1])):
        other.step(10), other.step(5, ids=ids)
    same(batch, apart)
    saved = batch.save()
    batch.reset([0, 7])
    apart[0].reset([0]), apart[1].reset([2])
    same(batch, apart)
    batch.step(10)
    batch.restore(saved)
    assert batch.steps == 10
    batch.copy_world(5, 7)
    assert batch.hash(5) == batch.hash(7)
    with pytest.raises(mw.SnapshotError):
        batch.restore(saved, source=0, ids=[6])  # another kind
    with pytest.raises((ValueError, mw.SnapshotError)):
        batch.copy_world(0, 6)


def test_what_wants_one_kind_says_so():
    batch = both()
    for call in (
        lambda: batch.get("position"),
        lambda: batch.set("position", 0),
        lambda: batch.fields,
        lambda: batch.plan,
        lambda: batch.bodies,
        lambda: batch.view("position"),
        lambda: batch.get_controls(),
        lambda: batch.add_force((0, 0, 1)),
        lambda: batch.rollout(steps=3),
        lambda: batch.step(controls=np.zeros((8, 0))),
    ):
        with pytest.raises(ValueError, match=r"2 kinds of worlds.*batch\.kinds\[0\]"):
            call()
    assert "8 worlds, 2 kinds" in repr(batch) and "'stack10': 3 worlds" in repr(batch.kinds[1])
    assert len(mw.Batch("stack10", 4).kinds) == 1
    with pytest.raises(AttributeError):
        batch.nonsense


@pytest.mark.parametrize(
    "kinds, arguments, error, words",
    [
        ([], {}, ValueError, "scene is empty"),
        ([("stack10", 3)], {"worlds": 4}, ValueError, "worlds is set for each kind"),
        (["stack10"], {}, TypeError, "kind 0 is 'stack10'"),
        ([("stack10", 0)], {}, ValueError, "worlds of kind 0 is 0"),
        ([("stack10", 1), (3, 1)], {}, TypeError, "the scene of kind 1 is of type int"),
        ([("stack10", 1), ("bin2d", 1)], {}, ValueError, "all planar or all spatial"),
        ([("stack10", 1), ("stak10", 1)], {}, ValueError, "stack10"),
    ],
)
def test_kinds_that_are_wrong(kinds, arguments, error, words):
    with pytest.raises(error, match=words):
        mw.Batch(kinds, **arguments)


def test_kinds_of_closed_batches():
    batch = both()
    kind = batch.kinds[0]
    batch.close()
    with pytest.raises(ValueError, match="closed"):
        kind.get("position")
