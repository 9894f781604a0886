"""What links and dofs of trees tell is what MuJoCo has after its step."""

import importlib.util
import pathlib

import numpy as np
import pytest

if importlib.util.find_spec("manyworlds._mjcf") is None:
    pytest.skip("built without MuJoCo", allow_module_level=True)
gymnasium = pytest.importorskip("gymnasium")
mujoco = pytest.importorskip("mujoco")

import manyworlds as mw  # noqa: E402

ASSETS = pathlib.Path(gymnasium.__file__).parent / "envs" / "mujoco" / "assets"
OBSERVE = ["links", "link_inertias", "link_velocities", "link_forces", "dof_forces"]
# A trunk that floats, an arm of hinges with a welded hand without mass, a drawer, what is fixed; sites
# on all of them and in the world, and tendons with a limit and without. Capsules would meet in their
# middles, where no normal is better than another.
MARKED = """<mujoco><compiler angle="radian" autolimits="true"/>
  <option timestep="0.004" integrator="{integrator}"><flag contact="disable"/></option>
  <default><geom type="capsule" size="0.04 0.1"/><joint damping="0.2" armature="0.01"/></default>
  <worldbody><geom type="plane" size="5 5 1"/><site name="mark" pos="1 2 3"/>
    <body name="post" pos="0 2 1" euler="0.1 0.2 0.3"><geom/><site name="top" pos="0 0.1 0.2"/></body>
    <body name="pivot" pos="0 3 1" euler="0.3 0 0.3"><site pos="0.1 0.1 0.2"/></body>
    <body name="trunk" pos="0 0 1"><freejoint/><geom/><site name="chest" pos="0.1 0.02 0.1"/>
      <body pos="0.2 0 0" euler="0 0.4 0"><joint name="a" axis="0 1 0" ref="0.1"/><geom/>
        <site name="elbow" pos="0 0 0.2" euler="0.3 0.2 0.1"/>
        <body pos="0.2 0 0"><joint name="b" axis="1 0 0"/><geom/>
          <body name="hand" pos="0 0.1 0.2" euler="0.5 0 0"><site name="tip" pos="0 0 0.1"/></body></body></body>
      <body pos="-0.2 0 0"><joint name="c" type="slide" axis="1 0 0"/>
        <joint name="d" axis="0 0 1"/><geom/></body></body></worldbody>
  <tendon><fixed name="cord"><joint joint="a" coef="-1"/><joint joint="b" coef="0.5"/></fixed>
    <fixed name="held" range="-0.1 0.1"><joint joint="c" coef="2"/><joint joint="d" coef="1"/></fixed>
    <fixed><joint joint="d" coef="3"/></fixed></tendon></mujoco>"""


@pytest.fixture(autouse=True)
def log_elsewhere(monkeypatch, tmp_path):
    """MuJoCo leaves its warnings in a file where it is."""
    monkeypatch.chdir(tmp_path)


def told(batch):
    """As MuJoCo has them, of world 0."""

    def get(*names):
        return np.concatenate([batch.get(name)[0] for name in names], axis=1)

    return {
        "xpos": get("link_position"),
        "xipos": get("link_center"),
        "cinert": get("link_inertia", "link_product", "link_moment", "link_mass"),
        "cvel": get("link_angular_velocity", "link_velocity"),
        "cfrc_ext": get("external_torque", "external_force"),
        "qfrc_actuator": get("actuator_force")[:, 0],
        "qfrc_constraint": get("constraint_force")[:, 0],
    }


def pair(model, steps, pushed):
    """A batch and MuJoCo's data after as many steps from the same start, under the same forces."""
    path = ASSETS / model
    m = mujoco.MjModel.from_xml_path(str(path))
    m.opt.solver, m.opt.tolerance, m.opt.iterations = mujoco.mjtSolver.mjSOL_NEWTON, 1e-12, 100
    d = mujoco.MjData(m)
    rng = np.random.default_rng(5)
    mujoco.mj_integratePos(m, d.qpos, rng.normal(size=m.nv), 0.1)
    d.qpos[2 if m.nq > m.nv else 1] -= 0.1  # into the ground
    d.qvel[:] = rng.normal(size=m.nv)
    d.ctrl[:] = rng.uniform(-0.4, 0.4, m.nu)
    scene = mw.mjcf.load(path)
    scene.options.solver.tolerance, scene.options.solver.iterations = 1e-12, 100
    batch = mw.Batch(scene, worlds=2, threads=1, precision="f64", observe=OBSERVE)
    batch.set("generalized_position", np.tile(d.qpos, (2, 1))[..., None])
    batch.set("generalized_velocity", np.tile(d.qvel, (2, 1))[..., None])
    batch.set_controls(np.tile(d.ctrl, (2, 1)))
    if steps == 0:
        mujoco.mj_forward(m, d)
        batch.look()
        return batch, m, d
    if pushed:
        force, torque = [3.0, -2.0, 1.0], [0.1, 0.2, -0.3]
        d.xfrc_applied[m.nbody - 1] = force + torque
        body = m.body(m.nbody - 1).name
        batch.add_force(force, body)
        batch.add_torque(torque, body)
    batch.step(steps)
    mujoco.mj_step(m, d, nstep=steps)
    mujoco.mj_rnePostConstraint(m, d)
    return batch, m, d


@pytest.mark.parametrize("pushed", [False, True])
@pytest.mark.parametrize("steps", [1, 4])
@pytest.mark.parametrize("model", ["half_cheetah.xml", "hopper.xml", "humanoid.xml"])
def test_links_are_mujocos_after_a_step(model, steps, pushed):
    batch, m, d = pair(model, steps, pushed)
    assert d.nefc > 0 and d.ncon > 0
    for name, found in told(batch).items():
        wanted = getattr(d, name)
        wanted = wanted[1:] if name[:4] != "qfrc" else wanted
        np.testing.assert_allclose(found, wanted, rtol=1e-7, atol=1e-7, err_msg=name)


@pytest.mark.parametrize("model", ["half_cheetah.xml", "humanoid.xml"])
def test_a_state_without_a_step(model):
    batch, m, d = pair(model, 0, False)
    found = told(batch)
    for name in ("xpos", "xipos", "cinert", "cvel"):
        np.testing.assert_allclose(found[name], getattr(d, name)[1:], rtol=1e-10, atol=1e-10)
    for name in ("cfrc_ext", "qfrc_actuator", "qfrc_constraint"):
        assert not found[name].any()


def test_other_solvers_serve_forces_and_refuse_what_only_trees_have():
    scene = mw.scenes.load("stack10")
    with pytest.raises(ValueError, match="link_inertias.*only newton has trees of links"):
        mw.Batch(scene, worlds=2, observe=OBSERVE)
    batch = mw.Batch(scene, worlds=2, observe=["links", "link_forces"])
    batch.step(3)
    assert batch.get("link_position").any() and batch.get("external_force").any()


@pytest.mark.parametrize("steps", [0, 1, 4])
@pytest.mark.parametrize("integrator", ["Euler", "RK4", "implicitfast"])
def test_tendons_and_sites_are_mujocos(integrator, steps):
    text = MARKED.format(integrator=integrator)
    m = mujoco.MjModel.from_xml_string(text)
    m.opt.solver, m.opt.tolerance, m.opt.iterations = mujoco.mjtSolver.mjSOL_NEWTON, 1e-14, 100
    d = mujoco.MjData(m)
    rng = np.random.default_rng(3)
    scene = mw.mjcf.load_string(text)
    scene.options.solver.tolerance, scene.options.solver.iterations = 1e-14, 100
    count = 8
    batch = mw.Batch(scene, worlds=count, threads=1, precision="f64", observe=["tendons", "sites"])
    assert [s.name for s in scene.sites] == [m.site(i).name for i in range(m.nsite)]
    assert [t.name for t in scene.tendons] == [m.tendon(i).name for i in range(m.ntendon)]
    assert [t.limit is None for t in scene.tendons] == [True, False, True]
    states = []
    for _ in range(count):
        qpos = d.qpos.copy()
        mujoco.mj_integratePos(m, qpos, rng.normal(size=m.nv), 0.3)
        states.append((qpos, rng.normal(size=m.nv)))
    batch.set("generalized_position", np.array([q for q, _ in states])[..., None])
    batch.set("generalized_velocity", np.array([v for _, v in states])[..., None])
    if steps:
        batch.step(steps)
    else:
        batch.look()
    found = {k: batch.get(k) for k in ("site_position", "tendon_length", "tendon_velocity")}
    for world, (qpos, qvel) in enumerate(states):
        mujoco.mj_resetData(m, d)
        d.qpos[:], d.qvel[:] = qpos, qvel
        if steps:
            mujoco.mj_step(m, d, nstep=steps)
        else:
            mujoco.mj_forward(m, d)
        near = dict(rtol=1e-9, atol=1e-9)
        np.testing.assert_allclose(found["site_position"][world], d.site_xpos, **near)
        np.testing.assert_allclose(found["tendon_length"][world, :, 0], d.ten_length, **near)
        np.testing.assert_allclose(found["tendon_velocity"][world, :, 0], d.ten_velocity, **near)


def test_tendons_and_sites_by_name():
    scene = mw.mjcf.load_string(MARKED.format(integrator="Euler"))
    assert scene.site("tip") == 5 and type(scene.site("tip")) is mw.SiteId
    assert scene.tendon("held") == 1 and type(scene.tendon("held")) is mw.TendonId
    bodies = [scene.bodies[s.body].name if s.body >= 0 else None for s in scene.sites]
    # The hand has no mass and is part of what it is on; the pivot has no geoms and is no body here.
    assert bodies == ["world", "post", None, "trunk", "", ""]
    terms = mw.tasks.Terms(scene)
    assert repr(terms.site_position("tip", "z")).endswith("site_position(5, 'z')>")
    assert repr(terms.tendon_velocity("cord")).endswith("tendon_velocity(0)>")
    with pytest.raises(ValueError, match="no site is named 'tops'.*nearest: 'top'"):
        terms.site_position("tops", 0)
    with pytest.raises(TypeError, match="expected a TendonId, a name or an index"):
        terms.tendon_length(mw.SiteId(0))
    batch = mw.Batch(scene, worlds=2, observe=["sites"])
    assert batch.site("tip") == batch.plan.site("tip") == 5
    assert batch.tendon("cord") == 0
