"""Bodies, shapes, joints and controls by handle, by name and by index of the scene."""

import copy
import pickle

import numpy as np
import pytest

import manyworlds as mw
from manyworlds import tasks


def workshop() -> mw.Scene:
    """A fixed body comes first, and one lies between those that move."""
    scene = mw.Scene(name="workshop", options=mw.Options(gravity=(0, 0, 0)))
    scene.add(mw.Body(name="ground", motion="fixed", shapes=[mw.Shape(geometry=mw.Plane())]))
    ball = mw.Shape(geometry=mw.Sphere(0.25), name="ball")
    scene.add(mw.Body(name="crate", position=(0, 0, 5), shapes=[ball]))
    scene.add(mw.Body(name="post", motion="fixed", position=(4, 0, 5), shapes=[ball]))
    knob = mw.Shape(geometry=mw.Sphere(0.1), position=(0, 0, 0.5), name="knob")
    scene.add(mw.Body(name="lid", position=(0, 0, 8), shapes=[ball, knob]))
    hinge = scene.joint_at("crate", "lid", mw.Frame((0, 0, 6.5)), mw.BallJoint())
    hinge.name = "hinge"
    scene.add(hinge)
    scene.add(mw.Control(name="push", kind="thrust", body="lid"))
    return scene


@pytest.fixture
def batch() -> mw.Batch:
    return mw.Batch(workshop(), worlds=3, threads=1)


def moved(batch: mw.Batch) -> list[tuple[int, int]]:
    """(world, row) of what has a velocity."""
    return list(zip(*(map(int, i) for i in np.nonzero(np.abs(batch.get("linear_velocity")).sum(2)))))


def test_add_returns_handles_that_are_indices():
    scene = mw.Scene()
    ground = scene.add(mw.Body(motion="fixed", shapes=[mw.Shape(geometry=mw.Plane())]))
    crate = scene.add(mw.Body())
    joint = scene.add(mw.Joint(body_a=ground, body_b=crate))
    control = scene.add(mw.Control(body=crate))
    assert (type(crate), type(joint), type(control)) == (mw.BodyId, mw.JointId, mw.ControlId)
    assert crate == 1 and scene.bodies[crate] is scene.bodies[1]
    assert repr(crate) == "BodyId(1)" and f"{crate}" == "1"
    assert type(scene.add(mw.vary("gravity_scale", 1, 2))) is int
    for handle in (crate, joint, mw.ShapeId(crate, 0)):
        assert pickle.loads(pickle.dumps(handle)) == copy.deepcopy(handle) == handle
        assert type(pickle.loads(pickle.dumps(handle))) is type(handle)


@pytest.mark.parametrize("who", ["lid", 3, mw.BodyId(3), ["lid"], np.array([3]), np.int64(3)])
def test_a_force_moves_who_is_meant(batch, who):
    batch.add_impulse((1, 0, 0), bodies=who, ids=1)
    assert moved(batch) == [(1, 1)]  # its row


def test_forces_on_what_add_returned_although_the_ground_comes_first():
    scene = mw.Scene(options=mw.Options(gravity=(0, 0, 0)))
    scene.add(mw.Body(motion="fixed", shapes=[mw.Shape(geometry=mw.Plane())]))
    for x in range(3):
        last = scene.add(mw.Body(position=(2 * x, 0, 3), shapes=[mw.Shape()]))
    with mw.Batch(scene, worlds=2, threads=1) as batch:
        batch.add_force((1e4, 0, 0), bodies=last, ids=0)
        batch.step()
        assert moved(batch) == [(0, 2)]
        batch.add_force((1e4, 0, 0), bodies=[mw.BodyId(1), 2], ids=1)
        batch.step()
        assert moved(batch) == [(0, 2), (1, 0), (1, 1)]


def test_all_bodies_and_masks_are_rows(batch):
    batch.add_impulse([[1, 0, 0], [0, 0, 0]], ids=0)  # (bodies, 3): of every row
    assert moved(batch) == [(0, 0)]
    batch.add_impulse((1, 0, 0), bodies=np.array([False, True]), ids=2)
    assert moved(batch) == [(0, 0), (2, 1)]


@pytest.mark.parametrize("who", ["ground", 0, mw.BodyId(2), ["crate", "ground"], [1, 2]])
def test_fixed_bodies_are_refused_and_no_other_is_taken(batch, who):
    calls = (
        lambda: batch.add_force((0, 0, 0), bodies=who),
        lambda: batch.add_impulse((1, 0, 0), bodies=who),
        lambda: batch.set_enabled(False, bodies=who),
    )
    for call in calls:
        with pytest.raises(ValueError, match="body (0 'ground'|2 'post') is fixed"):
            call()
    if not isinstance(who, list):
        with pytest.raises(ValueError, match="is fixed"):
            batch.spawn(who, position=(0, 0, 9))
        with pytest.raises(ValueError, match="is fixed, it has no row"):
            batch.row(who)
    assert moved(batch) == [] and batch.get_enabled().all()


def test_names_everywhere(batch):
    batch.spawn("lid", position=(0, 0, 20), ids=2)
    assert batch.get("position")[2, batch.row("lid"), 2] == 20
    batch.set_enabled(False, bodies=["crate", batch.body("lid")], ids=0)
    np.testing.assert_array_equal(batch.get_enabled()[:, batch.row("crate")], [False, True, True])
    batch.set_joints_enabled(False, joints="hinge", ids=[1])
    np.testing.assert_array_equal(batch.get_joints_enabled()[:, 0], [True, False, True])
    batch.set_joints_enabled(True, joints=batch.joint("hinge"))
    assert batch.get_joints_enabled().all()
    assert batch.plan.first_coordinate("hinge") == 0


def test_handles_names_and_rows_lead_to_one_another(batch):
    plan, scene = batch.plan, workshop()
    for one in (scene, plan, batch):
        assert one.body("lid") == 3 and type(one.body("lid")) is mw.BodyId
        assert one.joint("hinge") == 0 and type(one.joint("hinge")) is mw.JointId
        assert one.control("push") == 0 and type(one.control("push")) is mw.ControlId
        assert one.shape("knob") == mw.ShapeId(mw.BodyId(3), 1)
        assert one.shape("ball", "crate") == mw.ShapeId(mw.BodyId(1), 0)
    assert plan.row("crate") == batch.row(1) == 0 and batch.row(mw.BodyId(3)) == 1
    assert batch.body_in_row(1) == 3 and type(batch.body_in_row(1)) is mw.BodyId
    assert plan.row(plan.shape("knob")) == 4
    assert plan.bodies == 2 and plan.scene_bodies == 4 and plan.joints == 1
    with pytest.raises(IndexError, match="body is 4, must be 0 to 3"):
        plan.row(4)
    with pytest.raises(IndexError, match="row is 2, must be 0 to 1"):
        plan.body_in_row(2)


def test_unknown_empty_and_shared_names(batch):
    scene = workshop()
    for call in (
        lambda: batch.add_force((1, 0, 0), bodies="crat"),
        lambda: batch.plan.row("crat"),
        lambda: scene.body("crat"),
        lambda: tasks.Terms(scene).touching("crat"),
    ):
        with pytest.raises(ValueError, match=r"no body is named 'crat'; there are 'ground', 'crate'"
                           r", 'post', 'lid' \(nearest: 'crate'\)"):
            call()
    with pytest.raises(ValueError, match="no joint is named 'knee'; there is 'hinge'"):
        batch.set_joints_enabled(True, joints="knee")
    with pytest.raises(ValueError, match="the name of a body is empty"):
        batch.body("")
    with pytest.raises(ValueError, match="3 shapes are named 'ball': 0 of body 1, 0 of body 2"):
        scene.shape("ball")
    scene.bodies[1].name = "lid"
    with pytest.raises(
        ValueError, match="2 bodies are named 'lid': 1, 3; give them distinct names"
    ):
        scene.body("lid")


def test_handles_of_another_kind_are_refused(batch):
    joint, shape = batch.joint("hinge"), batch.shape("knob")
    for wrong in (joint, shape, [mw.ControlId(1)]):
        with pytest.raises(TypeError, match="expected a BodyId, a name or an index"):
            batch.add_force((1, 0, 0), bodies=wrong)
    with pytest.raises(TypeError, match="expected a BodyId"):
        batch.plan.row(joint)
    with pytest.raises(TypeError, match="expected a JointId"):
        batch.set_joints_enabled(True, joints=batch.body("lid"))
    scene = workshop()
    scene.joints[0].body_a = joint
    with pytest.raises(TypeError, match=r"scene.joints\[0\].body_a is of type .*JointId; expected"):
        scene.validate()


def test_scenes_take_names_and_handles_for_indices():
    by_name, by_index = workshop(), workshop()
    lid = by_name.body("lid")
    for scene, crate, top, knob in (
        (by_name, "crate", lid, "knob"),
        (by_index, 1, 3, 1),
    ):
        scene.joints[0].body_a = crate
        scene.joints[0].body_b = top
        scene.bodies[3].jitter.with_body = crate
        scene.controls[0].body = top
        shape = dict(body=top) if scene is by_index else {}
        scene.add(mw.vary("friction", 0.1, 0.2, shape=knob, **shape))
        assert scene.validate() == []
    plan = mw.Plan(by_name)
    assert plan.scene == mw.Plan(by_index).scene
    assert plan.fingerprint == mw.Plan(by_index).fingerprint
    assert plan.scene.joints[0].body_b == 3 and plan.scene.bodies[3].jitter.with_body == 1
    assert pickle.loads(pickle.dumps(by_name)) == by_name
    by_name.joints[0].body_a = "crat"
    with pytest.raises(ValueError, match=r"scene.joints\[0\].body_a: no body is named 'crat'"):
        by_name.validate()


def test_rays_and_tasks_take_names():
    up = mw.Ray(direction=(0, 0, 1), body="crate")
    with mw.Batch(workshop(), worlds=2, threads=1, rays=[up]) as batch:
        batch.look()
        assert (batch.get("ray_body")[:, 0] == batch.body("lid")).all()
        batch.set_rays([mw.Ray(direction=(0, 0, -1), body="lid")] * 1)
        batch.look()
        assert (batch.get("ray_body")[:, 0] == 1).all()
        with pytest.raises(
            ValueError, match="rays.0..body is body 0 'ground', must be a body that"
        ):
            batch.set_rays([mw.Ray(body="ground")])
        with pytest.raises(ValueError, match=r"rays\[0\].body: no body is named 'lit'"):
            batch.set_rays([mw.Ray(body="lit")])
    task = mw.Task(name="look", scene=workshop(), rays=[up], controls=[0.0])
    task.observe("x", task.terms.position(task.scene.body("lid"), 0))
    task.observe("far", task.terms.ray_distance(0))
    assert task.validate() == []
    task.rays[0].body = "crat"
    with pytest.raises(ValueError, match=r"task.rays\[0\].body: no body is named 'crat'"):
        task.validate()


def test_kinds_have_names_of_their_own():
    other = mw.Scene(options=mw.Options(gravity=(0, 0, 0)))
    other.add(mw.Body(name="lid", shapes=[mw.Shape()]))
    with mw.Batch([(workshop(), 2), (other, 2)], threads=1) as batch:
        one, two = batch.kinds
        assert (one.body("lid"), two.body("lid")) == (3, 0) and two.row("lid") == 0
        for kind in batch.kinds:
            kind.add_impulse((9, 0, 0), bodies="lid", ids=1)
            assert moved(kind) == [(1, kind.row("lid"))]
        with pytest.raises(ValueError, match="body 0 'ground' is fixed"):
            one.add_impulse((1, 0, 0), bodies=0)
        with pytest.raises(ValueError, match="2 kinds of worlds"):
            batch.add_impulse((1, 0, 0), bodies="lid")


NO_INDICES = [-(2**31), -2, -1, 10**6, 2**31 - 1]  # of a small scene
BAD_IDS = {
    "row": lambda b, i: b.plan.row(i),
    "body_in_row": lambda b, i: b.plan.body_in_row(i),
    "first_coordinate": lambda b, i: b.plan.first_coordinate(i),
    "first_observed": lambda b, i: b.plan.first_observed(i),
    "joint handle": lambda b, i: b.plan.first_coordinate(mw.JointId(i)),
    "row of a shape": lambda b, i: b.plan.row(mw.ShapeId(mw.BodyId(1), i)),
    "row of a shape's body": lambda b, i: b.plan.row(mw.ShapeId(mw.BodyId(i), 0)),
    "hash": lambda b, i: b.hash(i),
    "contacts": lambda b, i: b.contacts(i),
    "copy_world": lambda b, i: b.copy_world(0, i),
    "spawn": lambda b, i: b.spawn(i, (0, 0, 0)),
    "add_force": lambda b, i: b.add_force((1, 0, 0), bodies=i),
    "set_joints_enabled": lambda b, i: b.set_joints_enabled(True, joints=i),
    "wake": lambda b, i: b.wake(ids=i),
}


@pytest.mark.parametrize("call", BAD_IDS)
@pytest.mark.parametrize("index", NO_INDICES)
def test_an_index_that_there_is_not_is_an_index_error_in_plain_words(batch, call, index):
    with pytest.raises(IndexError) as error:
        BAD_IDS[call](batch, index)
    text = str(error.value)
    assert str(index) in text and "must be 0 to " in text
    assert "::" not in text and "_M_" not in text


@pytest.mark.parametrize("index", [-2, 4, 2**31 - 1])
def test_a_joint_of_a_body_that_there_is_not(index):
    for bodies in ((index, 1), (1, index)):
        with pytest.raises((IndexError, ValueError), match=f"is {index}, must be -1 to 3"):
            workshop().joint_at(*bodies, mw.Frame(), mw.BallJoint())
