"""Every term and observer in every type of scene: the right number, or an error that says what to use.

The table of observed fields is the library's own (``enumerations()["Observed"]``), so a new field fails
here until it is known what it is in each scene.
"""

import numpy as np
import pytest

import manyworlds as mw
from manyworlds import tasks

OBSERVED = mw.enumerations()["Observed"]
MASS, SIDE, GRAVITY = 2.0, 0.4, 10.0
# What worlds of other solvers than newton do not have, with a word of what to use instead.
OF_NEWTON = {
    "link_inertia": "parameter mass",
    "link_product": "parameter mass",
    "link_moment": "parameter mass",
    "link_mass": "parameter mass",
    "link_angular_velocity": "angular_velocity",
    "link_velocity": "linear velocity",
    "actuator_force": "drive_force",
    "constraint_force": "joint_force and joint_torque",
    "tendon_length": "joint_position",
    "tendon_velocity": "joint_speed",
}
# What worlds of newton do not have.
OF_OTHERS = {"residual": "tolerance"}


def box(name, position, **more):
    half = SIDE / 2
    shape = mw.Shape(geometry=mw.Box((half, half, half)), density=MASS / SIDE**3)
    return mw.Body(name=name, position=position, shapes=[shape], **more)


def scene(kind):
    """A box on the ground, and an arm that a drive or an actuator holds up, but in an empty scene."""
    out = mw.Scene(name=kind)
    out.options.gravity = (0, 0, -GRAVITY)
    if kind == "newton":
        out.options.solver.method = "newton"
        out.options.dt = 0.002
    if kind == "empty":
        return out
    ground = mw.Body(name="ground", motion="fixed", shapes=[mw.Shape(geometry=mw.Plane())])
    out.add(ground)
    out.add(box("box", (0, 0, SIDE / 2)))
    if kind == "no joints":
        return out
    arm = out.add(box("arm", (0.5, 0, 3)))
    arm_frames = dict(frame_a=mw.Frame((0, 0, 3), UP), frame_b=mw.Frame((-0.5, 0, 0), UP))
    hinge = mw.HingeJoint()
    if kind != "newton":
        hinge.drive = mw.Drive(spring=mw.Spring(stiffness=2000.0, damping=200.0))
    out.add(mw.Joint(name="hinge", type=hinge, body_a=-1, body_b=arm, **arm_frames))
    if kind == "newton":
        actuator = mw.Actuator(gain=(1.0, 0.0, 0.0), bias=(0.0, 0.0, 0.0))
        out.add(mw.Control(kind="joint_force", joint="hinge", low=-100, high=100, actuator=actuator))
        out.add(mw.Tendon(name="cord", terms=[mw.TendonTerm(joint="hinge")]))
    if kind == "trees":
        out.options.joint.method = "tree"
    out.add(mw.Site(name="tip", body=arm, position=(0.2, 0, 0)))
    return out


UP = (0.5**0.5, 0.5**0.5, 0, 0)  # z of the frames along -y of the world: the hinge's axis
TORQUE = MASS * GRAVITY * 0.5  # N m, that holds the arm up


def item_of(what, of):
    """An item of the scene that has it; None: there is none."""
    item = mw._core.item_of(what)
    there = {
        "world": 0,
        "body": "box" if of.bodies else None,
        "joint": "hinge" if of.joints else None,
        "coordinate": "hinge" if of.joints else None,
        "tendon": "cord" if of.tendons else None,
        "site": "tip" if of.sites else None,
        "dof": 0 if of.options.solver.method == "newton" else None,
        "ray": 0,
        "point": 0 if of.bodies else None,
    }
    return there[item]


def task_of(what, of, item, component):
    task = mw.Task(name="one", scene=of, actions=[mw.Action("a", -1, 1)])
    task.controls = [TORQUE] * len(of.controls)  # about -y, as the hinge
    task.rays = [mw.Ray(origin=(0, 0, 5), direction=(0, 0, -1), length=20)]
    task.points = [mw.Point(position=(0, 0, 0.1), body=of.body("box"))] if of.bodies else []
    task.observe("seen", task.terms.observed(what, 0 if item is None else item, component))
    return task


def refused(kind):
    return OF_OTHERS if kind == "newton" else OF_NEWTON


@pytest.mark.parametrize("kind", ["no joints", "sweep", "trees", "newton", "empty"])
@pytest.mark.parametrize("what", OBSERVED)
def test_every_term_is_right_or_refused_with_a_reason(what, kind):
    of = scene(kind)
    item = item_of(what, of)
    spin = what in ("joint_torque", "external_torque", "angular_momentum", "angular_acceleration")
    task = task_of(what, of, item, 1 if spin else 0)
    issues = task.validate()
    if what in refused(kind):
        assert len(issues) == 1, issues
        text = issues[0].message
        assert what.replace("_", " ") in text.replace("_", " ")
        assert f"the scene '{kind}' does not support it" in text
        assert ("newton" in text) and refused(kind)[what] in text
        return
    if item is None:
        assert issues and "none" in issues[0].message  # "but there are none"
        return
    assert issues == []
    env = mw.Environment(task, 3, autoreset="disabled")
    for _ in range(30):
        seen = env.step(np.zeros((3, 1)))[0]
    assert np.isfinite(seen).all() and (seen == seen[0]).all()


@pytest.mark.parametrize("kind", ["no joints", "sweep", "trees", "newton", "empty"])
def test_every_observer_is_served_or_refused_with_a_reason(kind):
    of = scene(kind)
    wanted = refused(kind)
    for observer in mw.enumerations()["Observer"]:
        if observer in ("rays", "points"):
            continue
        fields = [f for f in mw.Batch(of).fields.values() if f.observer == observer]
        if any(f.name in wanted for f in fields):
            assert all(f.name in wanted for f in fields)
            with pytest.raises(ValueError, match=f"observe.* is {observer}: the scene '{kind}' does not"):
                mw.Batch(of, observe=["motion", observer])
            continue
        batch = mw.Batch(of, 2, observe=[observer])
        batch.step(3)
        for f in fields:
            assert batch.get(f.name).shape == (2, f.items, f.components)
            assert np.isfinite(batch.get(f.name)).all()


def settled(kind, observe, steps=400, **options):
    batch = mw.Batch(scene(kind), 2, observe=observe, **options)
    if batch.plan.scene.controls:
        batch.set_controls(TORQUE)
    batch.step(steps)
    return batch


@pytest.mark.parametrize("kind", ["no joints", "sweep", "trees", "newton"])
def test_the_ground_carries_the_weight(kind):
    batch = settled(kind, ["link_forces"])
    weight = MASS * GRAVITY
    force, torque = (batch.get(f"external_{x}")[:, 0] for x in ("force", "torque"))
    np.testing.assert_allclose(force, [[0, 0, weight]] * 2, atol=2e-3 * weight)
    np.testing.assert_allclose(torque, 0, atol=2e-2)
    batch.add_force((3, 0, -4), bodies="box")
    batch.add_torque((0, 0, 0.5), bodies="box")
    batch.step()
    seen = batch.get("external_force")[0, 0]
    # Friction carries the first, the ground the second, but for the give of one step.
    assert seen[0] == pytest.approx(0, abs=0.5) and seen[2] == pytest.approx(weight, abs=0.5)


@pytest.mark.parametrize("kind", ["sweep", "trees", "newton"])
def test_a_joint_and_its_drive_hold_an_arm_up(kind):
    batch = settled(kind, ["joint_loads", "drives", "link_forces", "links"], 600)
    if kind == "newton":  # whose actuator pushes alone
        batch.set("generalized_velocity", 0)
        batch.step()
    row = batch.row("arm")
    np.testing.assert_allclose(batch.get("joint_force")[0, 0], [0, 0, MASS * GRAVITY], atol=0.3)
    drive = batch.get("drive_force")[0, 0, 0]
    torque = batch.get("joint_torque")[0, 0]
    assert abs(drive) == pytest.approx(TORQUE, rel=0.03)
    if kind != "newton":  # of which all that passes through the joint
        np.testing.assert_allclose(torque, [0, -drive, 0], atol=0.05 * TORQUE)
    np.testing.assert_allclose(batch.get("external_force")[0, row], 0, atol=1e-9)


def test_links_are_where_the_state_has_them():
    of = scene("sweep")
    arm = of.bodies[of.body("arm")]
    arm.shapes[0].position = (0.1, 0.05, 0)  # its mass centre is not where its frame is
    of.bodies[of.body("arm")] = arm
    batch = mw.Batch(of, 2, observe=["links"])
    batch.step(20)
    np.testing.assert_allclose(batch.get("link_position"), batch.get("position"), atol=1e-6)
    away = batch.get("link_center") - batch.get("link_position")
    row = batch.row("arm")
    np.testing.assert_allclose(np.linalg.norm(away[:, row], axis=1), np.hypot(0.1, 0.05), rtol=1e-5)
    np.testing.assert_allclose(np.delete(away, row, axis=1), 0, atol=1e-6)


@pytest.mark.parametrize("solver", ["tgs_soft", "sequential_impulse", "sor", "nncg", "penalty"])
@pytest.mark.parametrize("space", ["planar", "spatial"])
def test_forces_of_contacts_change_momenta(solver, space):
    """m dv = (contacts + gravity) dt, and I dw = torque dt, of two bodies that meet off centre."""
    planar = space == "planar"
    of = mw.Scene(space=space)
    of.options.gravity = (0, 0, 0)
    of.options.solver.method = solver
    ball = mw.Circle(0.3) if planar else mw.Sphere(0.3)
    side = (0.3, 0.3) if planar else (0.3, 0.3, 0.3)
    block = mw.Polygon.box(*side) if planar else mw.Box(side)
    for geometry, x, y in ((ball, 0, 0.13), (block, 0.62, 0)):
        shape = mw.Shape(geometry=geometry, density=100)
        of.add(mw.Body(position=(x, y, 0), linear_velocity=(3 if x == 0 else 0, 0, 0), shapes=[shape]))
    batch = mw.Batch(of, 1, observe=["link_forces", "acceleration", "touching"])
    mass = batch.get("mass")[0, :, 0]
    hit = 0
    for _ in range(12):
        before = batch.get("linear_velocity")[0]
        batch.step()
        change = (batch.get("linear_velocity")[0] - before) * mass[:, None] / of.options.dt
        force = batch.get("external_force")[0]
        np.testing.assert_allclose(force, change, atol=1e-3 * (1 + np.abs(change).max()))
        np.testing.assert_allclose(force[0], -force[1], atol=1e-5 * (1 + np.abs(force).max()))
        torque = batch.get("external_torque")[0, :, -1]
        spin = batch.get("angular_acceleration")[0, :, -1]
        hit += bool(batch.get("touching").any())
        assert (np.abs(torque) > 0).tolist() == (np.abs(spin) > 0).tolist()
        if torque.any():
            inertia = torque / spin
            expected = [mass[0] * 0.3**2 * (0.5 if planar else 0.4), mass[1] * 0.06]
            np.testing.assert_allclose(inertia, expected, rtol=1e-2)
    assert hit > 0


def test_inputs_are_external_forces_in_free_motion_too():
    of = mw.Scene()
    of.add(box("box", (0, 0, 9)))
    batch = mw.Batch(of, 2, observe=["link_forces"])
    batch.add_force((1, 2, 3), ids=[1])
    batch.add_torque((0, 0.5, 0), ids=[1])
    batch.step(3)
    assert batch.get("external_force")[:, 0].tolist() == [[0, 0, 0], [1, 2, 3]]
    assert batch.get("external_torque")[:, 0].tolist() == [[0, 0, 0], [0, 0.5, 0]]
    batch.step()
    assert not batch.get("external_force").any()


def test_generalised_coordinates_are_refused_by_name():
    task = mw.Task(name="one", scene=scene("sweep"))
    task.observe("q", task.terms.generalized_position(0))
    task.observe("v", task.terms.generalized_velocity(0))
    first, second = (issue.message for issue in task.validate())
    assert "the scene 'sweep'" in first and "use joint_position of a joint" in first
    assert "its solver is tgs-soft" in second and "use joint_speed of a joint" in second


def test_a_spring_of_flight_has_a_force():
    of = mw.Scene()
    of.options.gravity, of.options.integrator = (0, 0, 0), "velocity_verlet"
    ball = mw.Shape(geometry=mw.Sphere(0.1), density=MASS / (4 / 3 * np.pi * 0.001))
    of.add(mw.Body(position=(1.2, 0, 0), shapes=[ball]))
    spring = mw.DistanceJoint(length=1.0, spring=mw.Spring(stiffness=50.0))
    of.add(mw.Joint(name="spring", type=spring, body_a=-1, body_b=0))
    batch = mw.Batch(of, observe=["drives", "joint_loads"])
    batch.step()
    stretch = np.linalg.norm(batch.get("position")[0, 0]) - 1
    assert batch.get("drive_force")[0, 0, 0] == pytest.approx(-50 * stretch, rel=1e-4)
    assert batch.get("joint_force")[0, 0, 0] == pytest.approx(-50 * stretch, rel=1e-4)


def test_terms_have_the_names_of_what_they_read():
    t = tasks.Terms(scene("sweep"))
    assert "joint_force(0, 'z')" in repr(t.joint_force("hinge", "z"))
    assert "drive_force(0, 0)" in repr(t.drive_force("hinge"))
    assert repr(t.observed("joint_force", "hinge", "z")) == repr(t.joint_force("hinge", "z"))
    with pytest.raises(ValueError, match="'joint_forc'.*nearest: 'joint_force'"):
        t.observed("joint_forc", "hinge")
