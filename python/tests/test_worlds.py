"""Stepping: the same bits however it is run, inputs, resets, snapshots, rollouts, threads."""

import pickle
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import manyworlds as mw
from conftest import crates, lander


@pytest.mark.parametrize("precision", ["f32", "f64"])
def test_a_world_has_the_same_bits_in_any_batch(precision):
    scene = crates()
    reference = mw.Batch(scene, worlds=9, threads=1, seed=4, precision=precision)
    reference.step(40)
    for worlds, threads, isa in [(9, 3, None), (20, 2, None), (3, 1, None), (9, None, "scalar")]:
        batch = mw.Batch(scene, worlds, threads, seed=4, precision=precision, isa=isa)
        batch.step(15)
        batch.step(25)
        same = min(9, worlds)
        np.testing.assert_array_equal(batch.hashes()[:same], reference.hashes()[:same])
        np.testing.assert_array_equal(
            batch.get("position")[:same], reference.get("position")[:same]
        )
    alone = mw.Batch(scene, worlds=1, seed=4 + 7, precision=precision)
    alone.step(40)
    assert alone.hash(0) == reference.hash(7)


def test_forces_act_as_the_law_says():
    scene = mw.Scene(bodies=[mw.Body(shapes=[mw.Shape()]), mw.Body(shapes=[mw.Shape()])])
    scene.bodies[1].position = (5, 0, 0)
    scene.options.gravity = (0, 0, 0)
    batch = mw.Batch(scene, worlds=4, precision="f64")
    mass = scene.mass_properties(0).mass
    batch.add_impulse((mass, 0, 0), bodies=1, ids=[1, 3])
    speed = batch.get("linear_velocity")
    np.testing.assert_allclose(speed[[1, 3], 1], [[1, 0, 0]] * 2)
    assert not speed[[0, 2]].any() and not speed[:, 0].any()
    force = np.zeros((4, 2, 3))
    force[:, 0, 2] = mass
    batch.add_force(force)
    batch.step(60)
    np.testing.assert_allclose(batch.get("linear_velocity")[:, 0, 2], 1, rtol=1e-9)
    batch.step(60)
    np.testing.assert_allclose(batch.get("linear_velocity")[:, 0, 2], 1, rtol=1e-9)


def test_planar_forces_and_torques():
    scene = mw.Scene(
        space="planar", bodies=[mw.Body(shapes=[mw.Shape(geometry=mw.Polygon.box(1, 1))])]
    )
    scene.options.gravity = (0, 0, 0)
    batch = mw.Batch(scene, worlds=2, precision="f64")
    own = scene.mass_properties(0)
    batch.add_impulse([own.mass, 0], points=[0, 1])
    np.testing.assert_allclose(batch.get("linear_velocity")[:, 0], [[1, 0]] * 2)
    spin = -own.mass / own.inertia[2][2]
    np.testing.assert_allclose(batch.get("angular_velocity")[:, 0], [[spin]] * 2)
    batch.add_angular_impulse([own.mass])
    np.testing.assert_allclose(batch.get("angular_velocity")[:, 0], [[0]] * 2, atol=1e-12)
    batch.spawn(0, (3, 4), orientation=(0, 1), angular_velocity=[2], ids=1)
    np.testing.assert_allclose(batch.get("position")[1, 0], [3, 4])
    np.testing.assert_allclose(batch.get("orientation")[1, 0], [0, 1], atol=1e-12)
    assert batch.get("angular_velocity")[1, 0, 0] == 2


def test_bodies_and_joints_come_and_go():
    batch = lander(sleep=True)
    batch.set_enabled(False, bodies=[4, 5], ids=[0, 2])
    assert batch.get_enabled().tolist()[0] == [True, True, True, False, False]
    assert batch.get_enabled()[1].all()
    batch.spawn(4, (0, 50), ids=[0])
    assert batch.get_enabled()[0].tolist() == [True, True, True, True, False]
    batch.set_joints_enabled([[True, False]], ids=[4])
    assert batch.get_joints_enabled()[4].tolist() == [True, False]
    assert batch.get_joints_enabled()[:4].all()
    batch.step(5)
    batch.wake(1)
    assert not batch.asleep()[1].any()


def test_resets():
    batch = lander()
    first = batch.hashes()
    batch.step(10)
    batch.reset([1, 3])
    assert batch.steps == 10 and batch.time == pytest.approx(10 / 60)
    later = batch.hashes()
    batch.reset(np.array([False, False, True, False, False]))
    assert (batch.hashes() == later).tolist() == [True, True, False, True, True]
    batch.reset()
    np.testing.assert_array_equal(batch.hashes(), first)
    assert batch.steps == 0


def test_snapshots(tmp_path):
    batch = mw.Batch(crates(), worlds=6, threads=1, seed=5)
    batch.step(20)
    snapshot = batch.save()
    batch.step(20)
    end = batch.hashes()
    file = tmp_path / "worlds.snapshot"
    snapshot.save(file)
    other = mw.Batch(crates(), worlds=6, threads=2, isa="scalar")
    for copy in (
        snapshot,
        mw.Snapshot.from_bytes(snapshot.bytes()),
        mw.Snapshot.load(file),
        pickle.loads(pickle.dumps(snapshot)),
    ):
        assert copy == snapshot and copy.worlds == 6 and copy.steps == 20
        assert copy.nbytes == len(copy.bytes()) and "6 worlds" in repr(copy)
        other.reset()
        other.restore(copy)
        other.step(20)
        np.testing.assert_array_equal(other.hashes(), end)
    few = batch.save(ids=[4, 2])
    assert few.worlds == 2 and few != snapshot
    other.restore(few, source=[0, 1], ids=[0, 5])
    np.testing.assert_array_equal(other.hashes()[[0, 5]], end[[4, 2]])
    other.restore(few, source=1, ids=[1, 2, 3])
    np.testing.assert_array_equal(other.hashes()[1:4], [end[2]] * 3)
    other.copy_world(0, 4)
    assert other.hash(4) == other.hash(0)


@pytest.mark.parametrize("precision", ["f32", "f64"])
def test_a_rollout_is_stepping_by_hand(precision):
    fields = ["position", "angular_velocity", "kinetic_energy", "friction"]
    made = {"precision": precision, "observe": ["motion"]}
    hand, rolled = lander(**made), lander(**made)
    controls = np.random.default_rng(2).uniform(-1, 1, (13, 5, hand._controls))
    got = rolled.rollout(controls=controls, fields=fields, every=3)
    frames = {name: [] for name in fields}
    for step in range(13):
        hand.step(controls=controls[step])
        if step % 3 == 2:
            for name in fields:
                frames[name].append(hand.get(name))
    for name in fields:
        assert got[name].shape[0] == 4 and got[name].dtype == hand.fields[name].dtype
        np.testing.assert_array_equal(got[name], frames[name])
    assert rolled.hash() == hand.hash() and rolled.steps == hand.steps == 13


def test_rollouts_begin_where_they_are_told_and_fill_what_they_are_given():
    batch = mw.Batch(crates(), worlds=6, threads=1)
    snapshot = batch.save()
    one = batch.rollout(snapshot, steps=12, every=4)["position"]
    out = {"position": np.empty((3, 6, 3, 3), np.float32)}
    again = batch.rollout(snapshot, steps=12, every=4, out=out)
    assert again["position"] is out["position"]
    np.testing.assert_array_equal(again["position"], one)
    np.testing.assert_array_equal(batch.get("position"), one[-1])
    high = np.zeros((6, 3, 3)) + (0, 0, 50)
    batch.rollout({"position": high, "linear_velocity": np.zeros((6, 3, 3))}, steps=1)
    assert (batch.get("position")[:, :, 2] > 49).all()
    assert batch.rollout(steps=0)["position"].shape == (0, 6, 3, 3)
    assert batch.rollout(steps=2, fields=[]) == {}


def test_worlds_that_step_alone_go_the_way_of_all():
    every, some = (mw.Batch(crates(), worlds=20, seed=3) for _ in range(2))
    every.step(12)
    some.step(5, ids=[4, 17])
    some.step(7, ids=np.arange(20) % 13 == 4)
    own = [4, 17]
    np.testing.assert_array_equal(some.hashes()[own], every.hashes()[own])
    fresh = mw.Batch(crates(), worlds=20, seed=3)
    others = np.setdiff1d(np.arange(20), own)
    np.testing.assert_array_equal(some.hashes()[others], fresh.hashes()[others])
    assert some.steps == 0 and some.time == 0
    some.step(3, ids=[])
    np.testing.assert_array_equal(some.hashes()[others], fresh.hashes()[others])
    with pytest.raises(IndexError, match="must be 0 to 19"):
        some.step(ids=[20])

    landers = lander(worlds=6)
    thrust = np.full((2, landers.get_controls().shape[1]), 1.0)
    landers.step(4, thrust, ids=[1, 5])
    assert landers.get_controls()[[1, 5], 0].tolist() == [1, 1]
    assert not landers.get_controls()[[0, 2, 3, 4]].any()
    with pytest.raises(ValueError, match="controls has shape"):
        landers.step(1, np.zeros((6, thrust.shape[1])), ids=[1, 5])


def test_worlds_begin_anew_with_seeds_of_their_own():
    batch = mw.Batch(crates(), worlds=7, seed=3)
    first = batch.hashes()
    batch.step(4)
    batch.reset([2, 5], seeds=[3, 4])
    assert batch.hashes()[[2, 5]].tolist() == first[:2].tolist()
    assert batch.steps == 4
    batch.reset(seeds=3)
    assert batch.hashes().tolist() == first.tolist()
    batch.reset([6, 1], seeds=[3, 4])  # in this order
    assert batch.hashes()[[6, 1]].tolist() == first[:2].tolist()
    with pytest.raises(ValueError, match="one for each of 2 worlds"):
        batch.reset([0, 1], seeds=[1])
    with pytest.raises(ValueError, match="more than once"):
        batch.reset([1, 1], seeds=[1, 2])


def test_a_rollout_that_is_refused_changes_nothing():
    batch = mw.Batch(crates(), worlds=4, seed=3)
    before = batch.hashes().tolist()
    initial = {"position": batch.get("position") + 1, "linear_velocity": np.zeros((4, 1))}
    with pytest.raises(ValueError, match="linear_velocity has shape"):
        batch.rollout(initial, steps=3)
    assert batch.hashes().tolist() == before
    friction = batch.get("friction")
    beyond = {"position": batch.get("position") + 1, "friction": friction + 1e6}
    with pytest.raises(ValueError, match="friction"):
        batch.rollout(beyond, steps=3)
    assert batch.hashes().tolist() == before and (batch.get("friction") == friction).all()


def test_lost_worlds_are_named():
    batch = mw.Batch(crates(), worlds=3)
    speed = batch.get("linear_velocity")
    speed[1] = np.nan
    batch.set("linear_velocity", speed)
    batch.step()
    assert batch.status().tolist() == [0, mw.Status.non_finite, 0]
    assert batch.status_names(1) == ["non_finite"] and batch.status_names(0) == []
    assert batch.lost().tolist() == [False, True, False]


def test_energy_from_nothing_is_told():
    scene = mw.Scene(space="planar")
    scene.options.gravity = (0, 0, 0)
    scene.options.integrator = "explicit_euler"
    ball = scene.add(mw.Body(shapes=[mw.Shape(geometry=mw.Circle(0.1))], position=(1, 0, 0)))
    spring = mw.TargetJoint(spring=mw.Spring(stiffness=3e4))
    scene.add(mw.Joint(type=spring, body_b=ball))
    for every, status in ((1, mw.Status.diverged), (16, mw.Status.diverged), (0, mw.Status.ok)):
        batch = mw.Batch(scene, worlds=2, audit_every=every, precision="f64")
        batch.step(60)
        assert batch.status().tolist() == [status, status]
    assert not batch.lost().any()
    for wrong in (-1, 256):
        with pytest.raises(ValueError, match="audit_every"):
            mw.Batch(scene, audit_every=wrong)


def test_a_long_step_lets_other_threads_work():
    batch = mw.Batch("bin-boxes", worlds=256, threads=1)
    batch.step(5)
    done = threading.Event()

    def work():
        while batch_is_busy():
            pass
        done.set()

    def batch_is_busy():
        try:
            batch.step(150)
        except RuntimeError:  # the other thread was in the middle of a call
            return True
        return False

    worker = threading.Thread(target=work)
    worker.start()
    beats = refused = 0
    while not done.is_set():
        beats += 1
        time.sleep(0.001)
        try:
            batch.get("position")
        except RuntimeError as error:
            assert "in use by another thread" in str(error)
            refused += 1
    worker.join()
    assert beats > 10 and refused > 10
    assert batch.steps == 155


def test_importing_starts_no_thread():
    code = (
        "import os, numpy; before = len(os.listdir('/proc/self/task'));"
        "import manyworlds; assert len(os.listdir('/proc/self/task')) == before;"
        "import sys; assert not {'gymnasium', 'mujoco', 'h5py', 'matplotlib'} & set(sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True)
