"""Robots: trees in joint coordinates, written by hand."""

import numpy as np
import pytest

import manyworlds as mw
from conftest import crates
from manyworlds import _core, rotations

ABOUT_Y = (0.5**0.5, -(0.5**0.5), 0, 0)  # hinges turn about z of their frames


def arm():
    """A base on a slider, an arm on two hinges one after the other, a motor by name; a free ball."""
    scene = mw.Scene(name="arm")
    scene.options.solver.method = "newton"
    scene.options.dt, scene.options.substeps = 0.005, 1
    box = mw.Shape(geometry=mw.Box((0.1, 0.1, 0.1)))
    base = scene.add(mw.Body(name="base", position=(0, 0, 1), shapes=[box]))
    hand = scene.add(mw.Body(name="hand", position=(1, 0, 1), shapes=[box]))
    rail = scene.joint_at(-1, base, mw.Frame((0, 0, 1)), mw.SliderJoint(limit=mw.Limit(-2, 2)))
    lift = scene.joint_at(base, hand, mw.Frame((0.5, 0, 1), ABOUT_Y), mw.HingeJoint())
    rail.name, lift.name = "rail", "lift"
    lift.dynamics = mw.JointDynamics(armature=0.1, damping=0.2)
    scene.add(rail)
    scene.add(lift)
    place = mw.Frame((-0.5, 0, 0))  # in the frame of the hand, which "lift" moves
    scene.add(
        mw.Joint(
            name="turn", body_a="base", body_b="hand", frame_a=place, frame_b=place, after="lift"
        )
    )
    scene.add(
        mw.Control(kind="joint_force", joint="turn", low=-np.inf, actuator=mw.Actuator(gear=3))
    )
    ball = mw.Body(name="ball", position=(0, 3, 1), jitter=mw.Jitter(position=(0.5, 0, 0)))
    ball.shapes.append(mw.Shape(geometry=mw.Sphere(0.2)))
    ball.shapes[0].material.soft = mw.SoftContact(compliance=mw.Compliance(time_constant=0.05))
    scene.add(ball)
    scene.add(mw.Exclusion(body_a="ball", body_b="hand"))
    return scene


def test_members_go_to_the_library_and_back():
    scene = arm()
    assert scene.validate() == []
    back = _core.round_trip(scene)
    assert back.joints[2].after == 1 and back.joints[1].dynamics.damping == 0.2
    assert back.controls[0].joint == 2 and back.controls[0].actuator == mw.Actuator(gear=3)
    assert back.controls[0].low == -np.inf
    assert back.exclusions == [mw.Exclusion(body_a=2, body_b=1)]
    assert back.bodies[2].shapes[0].material.soft.compliance.time_constant == 0.05
    scene.joints[2].after = scene.joint("lift")
    assert _core.round_trip(scene) == back
    scene.joints[2].after = "lft"
    with pytest.raises(ValueError, match=r"scene.joints\[2\].after: .*nearest: 'lift'"):
        scene.validate()
    scene.joints[2].after = mw.BodyId(1)
    with pytest.raises(TypeError, match="expected a JointId"):
        scene.validate()


def test_json_keeps_robots():
    record = pytest.importorskip("manyworlds.record", exc_type=ImportError)
    back = record.scene_from_json(record.scene_to_json(arm()))
    assert back == _core.round_trip(arm())


@pytest.mark.parametrize("precision", ["f32", "f64"])
def test_coordinates_are_fields(precision):
    batch = mw.Batch(arm(), worlds=5, threads=1, precision=precision)
    q, v = batch.fields["generalized_position"], batch.fields["generalized_velocity"]
    assert (q.group, q.item, q.items, q.components) == ("state", "coordinate", 3 + 7, 1)
    assert (v.item, v.items, v.unit) == ("dof", 3 + 6, "m/s or rad/s")
    assert batch.get("generalized_position").dtype == batch.dtype
    start = batch.get("generalized_position")[..., 0]
    np.testing.assert_array_equal(start[:, :3], 0)
    np.testing.assert_allclose(start[:, 3:6], batch.get("position")[:, 2], rtol=1e-6)
    assert len(np.unique(start[:, 3])) == 5
    angle = np.linspace(-1, 1, 5)
    start[:, 1] = angle
    batch.set("generalized_position", start[..., None])
    hand = batch.get("position")[:, 1]
    want = np.stack([0.5 + 0.5 * np.cos(angle), 0 * angle, 1 - 0.5 * np.sin(angle)], 1)
    np.testing.assert_allclose(hand, want, atol=1e-6)
    view = batch.view("generalized_velocity")
    assert view.shape[1:3] == (9, 1) and not view[:].any()
    batch.randomize("generalized_velocity", -0.5, 0.5, items=[0, 1])
    assert batch.get("linear_velocity")[:, 0, 0].any()
    batch.set_controls(0.5)
    batch.step(3)
    assert batch.get("generalized_acceleration").shape == (5, 9, 1)
    assert (batch.get("generalized_velocity")[:, 2] > 0).all()
    with pytest.raises(ValueError, match="set generalized_position .* to move them"):
        batch.set("position", 0)
    with pytest.raises(ValueError, match="is residual: the scene .arm. does not support it"):
        mw.Batch(arm(), observe=["residual"])


def test_joints_are_observed():
    batch = mw.Batch(arm(), worlds=5, observe=["joints", "joint_loads"])
    batch.step(3)
    angle = batch.get("joint_position")
    assert angle.shape == (5, 3, 1) and batch.get("joint_force").shape == (5, 3, 3)
    q = batch.get("generalized_position")
    first = {name: batch.plan.first_coordinate(name) for name in ("rail", "lift", "turn")}
    for name, at in first.items():
        np.testing.assert_array_equal(angle[:, batch.plan.first_observed(name)], q[:, at])
    # Hinges in series carry the same.
    force = batch.get("joint_force")
    np.testing.assert_array_equal(force[:, 1], force[:, 2])


def test_other_worlds_have_none():
    batch = mw.Batch(crates(), worlds=2)
    assert batch.get("generalized_position").shape == (2, 0, 1)
    batch.set("generalized_position", np.zeros((2, 0, 1)))
    with pytest.raises(ValueError, match="no coordinate has any"):
        batch.view("generalized_position")
    scene = arm()
    scene.options.solver.method = "tgs-soft"
    assert {issue.message for issue in scene.validate()} == {
        "is given, which requires the newton solver, not tgs-soft",
        "is joint_force, which requires the newton solver, not tgs-soft",
    }


def test_cones_media_and_implicit_steps():
    scene = arm()
    scene.options.solver.cone = "elliptic"
    still = mw.Batch(scene, worlds=1)
    scene.options.medium = mw.Medium(density=50, viscosity=0.1)
    wet = mw.Batch(scene, worlds=1)
    scene.options.integrator = "implicit_fast"
    with pytest.raises(mw.SceneError, match="none with implicit-fast yet"):
        mw.Batch(scene, worlds=1)
    scene.options.medium = mw.Medium()
    implicit = mw.Batch(scene, worlds=1)
    speeds = []
    for batch in (still, wet, implicit):
        batch.set("generalized_velocity", 1.0)
        batch.step(20)
        assert np.isfinite(batch.get("position")).all()
        speeds.append(np.abs(batch.get("generalized_velocity")).sum())
    assert speeds[1] < speeds[0]


def test_ball_joints_have_limits_and_springs():
    scene = mw.Scene()
    scene.options.solver.method = "newton"
    scene.options.dt, scene.options.substeps = 0.005, 1
    box = mw.Shape(geometry=mw.Box((0.1, 0.1, 0.1)), position=(0, 0, -0.3))
    body = scene.add(mw.Body(name="bob", position=(0, 0, 1), shapes=[box]))
    joint = scene.joint_at(-1, body, mw.Frame((0, 0, 1)), mw.BallJoint(limit=mw.Limit(0, 0.3)))
    joint.dynamics = mw.JointDynamics(damping=0.5, stiffness=0.1)
    scene.add(joint)
    assert _core.round_trip(scene).joints[0].type.limit.high == 0.3
    batch = mw.Batch(scene, worlds=3)
    for _ in range(400):
        batch.add_force((60, 0, 0))
        batch.step()
    angle = 2 * np.arccos(batch.get("generalized_position")[:, 0, 0])
    assert angle == pytest.approx([0.3] * 3, abs=0.01)
    scene.joints[0].type.limit.low = 0.1
    assert [str(issue) for issue in scene.validate()] == [
        "joint 0: limit.low is 0.1 rad, must be 0: the angle of a rotation has no sign"
    ]


def keyed_arm():
    scene = arm()
    position = np.arange(10) / 8
    scene.add(mw.Keyframe(name="reach", generalized_position=position, controls=[0.5]))
    last = scene.add(mw.Keyframe(name="fly", generalized_velocity=[0] * 8 + [3]))
    assert last == scene.keyframe("fly") == 1 and type(last) is mw.KeyframeId
    return scene


def test_worlds_are_reset_to_keyframes():
    scene = keyed_arm()
    assert scene.validate() == []
    assert _core.round_trip(scene).keyframes[0].controls == [0.5]
    batch = mw.Batch(scene, worlds=4)
    assert batch.keyframe("reach") == batch.plan.keyframe("reach") == mw.KeyframeId(0)
    batch.step(5)
    batch.reset(keyframe="reach")
    assert batch.steps == 0
    assert (batch.get("generalized_position")[:, :, 0] == np.arange(10) / 8).all()
    assert (batch.get_controls() == 0.5).all()
    batch.step(3)
    hashes = batch.hashes()
    batch.reset([1, 3], keyframe=mw.KeyframeId(0))
    batch.step(3)
    assert (batch.hashes() == hashes).tolist() == [False, True, False, True]
    batch.reset([2], keyframe=1)
    assert batch.get("generalized_velocity")[2, 8, 0] == 3
    with pytest.raises(ValueError, match="no keyframe is named 'fli'"):
        batch.reset(keyframe="fli")
    with pytest.raises(IndexError, match="keyframe is 2, must be 0 to 1"):
        batch.reset(keyframe=2)
    with pytest.raises(TypeError, match="expected a KeyframeId, a name or an index"):
        batch.reset(keyframe=batch.body("base"))
    with pytest.raises(ValueError, match="seeds and keyframe are both given"):
        batch.reset([1], seeds=3, keyframe="fly")
    mixed = mw.Batch([(scene, 2), (arm(), 2)])
    mixed.reset([0, 1], keyframe="reach")
    before = mixed.hashes()
    with pytest.raises(ValueError, match="has none"):
        mixed.reset([1, 2], keyframe="reach")
    assert (mixed.hashes() == before).all()


def test_keyframes_fit_their_scene():
    scene = keyed_arm()
    scene.keyframes[0].generalized_position = [0.0]
    scene.keyframes[1].name = "reach"
    assert [str(issue) for issue in scene.validate()] == [
        "keyframe 0 'reach': generalized_position has 1 values, must have 10, or none",
        "keyframe 1 'reach': name is also that of keyframe 0, must be unique or empty",
    ]
    scene.keyframes[0].controls = "none"
    with pytest.raises(TypeError, match=r"scene.keyframes\[0\].controls"):
        scene.validate()


def test_numbers_of_joints_and_controls_vary():
    scene = arm()
    scene.controls[0].name = "motor"
    scene.add(mw.vary("armature", 0.05, 0.2))
    scene.add(mw.vary("damping", 0.1, 1, "log_uniform", joint="lift"))
    scene.add(mw.vary("gain", 0.5, 2, control="motor", together=True))
    scene.add(mw.Variation(parameter="size", shape=mw.ShapeId(1, 0), low=[0.05] * 3, high=[0.2] * 3))
    back = _core.round_trip(scene)
    assert back.variations[1].joint == 1 and back.variations[2].control == 0
    batch = mw.Batch(scene, worlds=6, seed=3)
    assert batch.fields["armature"].item == "joint" and batch.fields["gain"].item == "control"
    armature, damping, gain = (batch.get(name) for name in ("armature", "damping", "gain"))
    assert armature.shape == (6, 3, 1) and gain.shape == (6, 1, 3)
    assert len(np.unique(armature)) == 18 and (armature >= 0.05).all() and (armature <= 0.2).all()
    assert len(np.unique(damping[:, 1])) == 6 and (damping[:, [0, 2]] == 0).all()
    batch.set("armature", 0.1, ids=[2])
    batch.randomize("damping", 0.2, 0.3, items=[1])
    assert (batch.get("armature", ids=[2]) == 0.1).all()
    batch.step(10)
    batch.reset([2])
    assert not (batch.get("armature", ids=[2]) == 0.1).any()
    with pytest.raises(ValueError, match="damping of joint 0 is 1, must be 0: it does not vary"):
        batch.set("damping", 1)
    scene.variations[2].control = "mtor"
    with pytest.raises(ValueError, match=r"variations\[2\].control: .*nearest: 'motor'"):
        scene.validate()


def test_how_soft_limits_and_contacts_are_varies():
    scene = arm()
    low, high = (0.02, 0.8, 0), (0.04, 1.2, 0)
    scene.add(mw.Variation(parameter="limit_solref", joint="rail", low=low, high=high))
    low, high = (0.8, 0.9, 1e-3), (0.9, 0.95, 2e-3)
    scene.add(mw.Variation(parameter="contact_solimp", low=low, high=high))
    scene.add(mw.vary("gear", 0.5, 2))
    back = _core.round_trip(scene)
    assert back.variations[0].parameter == "limit_solref" and back.variations[0].joint == 0
    batch = mw.Batch(scene, worlds=6, seed=3)
    solref, solimp = batch.get("limit_solref"), batch.get("contact_solimp")
    assert solref.shape == (6, 3, 2) and solimp.shape[2] == 3
    assert len(np.unique(solref[:, 0])) == 12 and batch.get("gear").shape == (6, 1, 1)
    assert (solimp[..., 1] >= 0.9).all() and (solimp[..., 1] <= 0.95).all()
    batch.step(10)


def test_a_keyframe_without_a_rotation_is_refused():
    scene = arm()
    scene.add(mw.Keyframe(name="lost", generalized_position=[0] * 10))
    (issue,) = scene.validate()
    assert issue.place == "keyframe 0 'lost': generalized_position of body 2 'ball'"
    assert issue.message == "is a quaternion of length 0, must not be zero"


def test_quaternions_of_coordinates_are_not_of_length_0():
    batch = mw.Batch(arm(), worlds=3)
    good = batch.get("generalized_position")
    found = rotations.among_coordinates(batch.plan, good.shape[1])
    assert found and np.allclose([np.linalg.norm(good[:, q : q + 4, 0], axis=1) for q in found], 1)
    before = batch.hashes()
    for first in found:
        for value in (0, np.nan, np.inf):
            wrong = good.copy()
            wrong[1, first : first + 4] = value
            match = f"of coordinates {first} to {first + 3} in world 1 is .*expected a quaternion"
            with pytest.raises(ValueError, match=match):
                batch.set("generalized_position", wrong)
            with pytest.raises(ValueError, match=match):
                batch.set("generalized_position", wrong[[1]], ids=[1])
    assert (batch.hashes() == before).all()
    batch.set("generalized_position", good)
