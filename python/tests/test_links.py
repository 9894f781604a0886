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


def test_other_solvers_have_none():
    batch = mw.Batch(mw.scenes.load("stack10"), worlds=2, observe=OBSERVE)
    batch.step(3)
    for name in ("link_position", "link_mass", "external_force"):
        assert not batch.get(name).any()
    assert batch.get("actuator_force").shape == (2, 0, 1)
