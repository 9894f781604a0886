"""Arrays in and out: get, set, view, controls."""

import gc

import numpy as np
import pytest

import manyworlds as mw
from conftest import crates, lander
from manyworlds import draws

STATE = ["position", "orientation", "linear_velocity", "angular_velocity"]


def fresh(precision="f32", **more):
    return mw.Batch(crates(), worlds=6, threads=1, seed=5, precision=precision, **more)


@pytest.mark.parametrize("precision, dtype", [("f32", np.float32), ("f64", np.float64)])
@pytest.mark.parametrize("name", STATE)
def test_state_has_the_batchs_dtype(precision, dtype, name):
    batch = fresh(precision)
    array = batch.get(name)
    assert array.dtype == dtype == batch.dtype
    assert array.shape == (6, 3, 4 if name == "orientation" else 3)
    assert array.flags.c_contiguous and array.flags.owndata or array.base is not None


@pytest.mark.parametrize("dtype", ["f2", "f4", "f8", "g", ">f4", ">f8", "i1", "i4", "u8", "?"])
@pytest.mark.parametrize("layout", ["C", "F", "strided", "reversed", "list"])
def test_every_dtype_and_order_goes_in(dtype, layout):
    batch = fresh()
    values = np.random.default_rng(1).integers(0, 2, (6, 3, 3)).astype(dtype)
    given = {
        "C": np.ascontiguousarray(values),
        "F": np.asfortranarray(values),
        "strided": np.repeat(values, 2, axis=1)[:, ::2],
        "reversed": values[::-1].copy()[::-1],
        "list": values.tolist(),
    }[layout]
    batch.set("linear_velocity", given)
    np.testing.assert_array_equal(batch.get("linear_velocity"), values.astype(np.float32))
    batch.set("linear_velocity", np.zeros((6, 3, 3)))
    batch.set("linear_velocity", given[2:4], ids=[4, 1])
    np.testing.assert_array_equal(batch.get("linear_velocity")[[4, 1]], values[2:4])
    assert not batch.get("linear_velocity")[[0, 2, 3, 5]].any()


def test_a_round_trip_keeps_the_bits_of_velocities():
    for precision in ("f32", "f64"):
        batch = fresh(precision)
        batch.step(20)
        before = batch.get("angular_velocity")
        batch.set("angular_velocity", before)
        np.testing.assert_array_equal(batch.get("angular_velocity"), before)


def test_parameters_vary_in_float64():
    batch = fresh()
    friction = batch.get("friction")
    assert friction.dtype == np.float64 and friction.shape == (6, 4, 1)
    assert (friction >= 0.2).all() and (friction <= 0.9).all() and len(np.unique(friction)) > 10
    batch.set("friction", np.full((1, 4, 1), 0.5), ids=3)
    assert (batch.get("friction")[3] == 0.5).all()
    before = batch.get("friction")
    wrong = np.full((2, 4, 1), 0.4)
    wrong[1] = 7
    with pytest.raises(ValueError):
        batch.set("friction", wrong, ids=[0, 1])
    np.testing.assert_array_equal(batch.get("friction"), before)
    assert batch.get("gravity").shape == (6, 1, 3)


def test_observed_fields():
    batch = fresh(
        observe=["motion", "touching", "contacts"], rays=[mw.Ray(direction=(0, 0, -1))] * 2
    )
    batch.step(30)
    energy = batch.energy()
    assert energy.shape == (6, 2) and energy.dtype == np.float64
    np.testing.assert_allclose(batch.get("kinetic_energy")[:, 0, 0], energy[:, 0], rtol=1e-4)
    assert batch.get("touching").shape == (6, 3, 1)
    assert batch.get("ray_normal").shape == (6, 2, 3)
    count = batch.get("contact_count")
    for world in range(6):
        contacts = batch.step_contacts(world)
        assert contacts.dtype == mw.STEP_CONTACT and len(contacts) == count[world, 0, 0]
        assert batch.contacts(world).dtype == mw.CONTACT
        np.testing.assert_allclose(np.linalg.norm(contacts["normal"], axis=1), 1, rtol=1e-5)
    with pytest.raises(ValueError, match=r"make the Batch with observe=\['penetration'\]"):
        batch.get("penetration")
    batch.set_rays([mw.Ray(direction=(1, 0, 0))] * 2)
    batch.look()
    assert batch.measure_contacts()["points_per_world"] >= 0


@pytest.mark.parametrize("field", ["position", "friction"])
def test_out_is_filled_in_place(batch, field):
    out = np.full(batch.get(field).shape, np.nan, batch.fields[field].dtype)
    assert batch.get(field, out=out) is out
    np.testing.assert_array_equal(out, batch.get(field))
    whole = np.zeros((2, *out.shape), out.dtype)
    batch.get(field, out=whole[1])
    np.testing.assert_array_equal(whole[1], out)
    assert not whole[0].any()


def test_other_outs_are_filled_too():
    batch = lander(sleep=True)
    for call, shape, dtype in [
        (batch.get_controls, (5, 2), np.float32),
        (batch.status, (5,), np.uint32),
        (batch.hashes, (5,), np.uint64),
        (batch.energy, (5, 2), np.float64),
        (batch.lane_indices, (5,), np.int32),
        (batch.get_enabled, (5, 5), np.bool_),
        (batch.get_joints_enabled, (5, 2), np.bool_),
        (batch.asleep, (5, 5), np.bool_),
    ]:
        shape = (5, batch._controls) if call == batch.get_controls else shape
        out = np.ones(shape, dtype)
        assert call(out=out) is out
        np.testing.assert_array_equal(out, call())


@pytest.mark.parametrize("precision", ["f32", "f64"])
def test_views_are_the_storage(precision):
    scene = crates()
    for body in scene.bodies[1:]:
        body.shapes[0].position = (0, 0, 0)
    # A body's own frame is then that of its centre of mass and, here, of its principal axes.
    batch = mw.Batch(scene, worlds=11, threads=1, precision=precision)
    batch.step(5)
    for name in STATE:
        view = batch.view(name)
        groups, bodies, components, lanes = view.shape
        assert (bodies, components) == batch.get(name).shape[1:] and lanes == batch.lanes
        assert groups == -(-11 // lanes) and view.dtype == batch.dtype
        slots = batch.lane_indices()
        mine = view[slots // lanes, :, :, slots % lanes]
        if name in ("position", "linear_velocity", "angular_velocity"):
            np.testing.assert_array_equal(mine, batch.get(name))
    array = np.asarray(batch.view("linear_velocity"))
    before = batch.hash()
    batch.view("linear_velocity")[:] = 2
    assert (array == 2).all() and (batch.get("linear_velocity") == 2).all()
    assert batch.hash() != before
    batch.step()
    assert not (array == 2).all()
    assert np.shares_memory(np.from_dlpack(batch.view("position")), batch.view("position")[:])


def test_views_refuse_after_close(batch):
    view, array = batch.view("position"), np.asarray(batch.view("position"))
    kept = array.copy()
    batch.close()
    batch.close()
    for use in (
        lambda: view.shape,
        lambda: view[0],
        lambda: view.__setitem__(0, 0),
        lambda: np.asarray(view),
        lambda: np.from_dlpack(view),
        lambda: len(view),
        lambda: batch.view("position"),
        lambda: batch.step(),
        lambda: batch.get("position"),
        lambda: batch.hash(),
        lambda: batch.time,
    ):
        with pytest.raises(ValueError, match="closed"):
            use()
    assert "closed" in repr(view) and "closed" in repr(batch) and batch.closed
    del batch, view
    gc.collect()
    np.testing.assert_array_equal(array, kept)  # its memory lives on


def test_a_view_keeps_the_batch_alive():
    view = fresh().view("position")
    gc.collect()
    assert view.shape[1] == 3 and np.isfinite(view[:]).all()
    with fresh() as batch:
        assert batch.worlds == 6
    assert batch.closed


def test_a_plan_without_orientation_has_no_view_of_it():
    scene = mw.Scene(bodies=[mw.Body(shapes=[mw.Shape()])])
    batch = mw.Batch(scene, worlds=2)
    with pytest.raises(ValueError, match="the plan has no orientation"):
        batch.view("orientation")
    np.testing.assert_array_equal(batch.get("orientation"), [[[1, 0, 0, 0]]] * 2)


def test_arrays_speak_dlpack(batch):
    array = batch.get("position")
    np.testing.assert_array_equal(np.from_dlpack(array), array)


def test_controls():
    batch = lander()
    shape = (5, batch._controls)
    values = np.random.default_rng(0).uniform(0, 1, shape)
    batch.set_controls(values)
    got = batch.get_controls()
    assert got.dtype == np.float32 and got.shape == shape
    np.testing.assert_allclose(got, values, rtol=1e-6)
    batch.set_controls(values[:2], ids=[True, False, False, False, True])
    np.testing.assert_allclose(batch.get_controls()[[0, 4]], values[:2], rtol=1e-6)
    other = lander()
    other.step(3, controls=batch.get_controls())
    batch.step(3)
    assert other.hash() == batch.hash()


def test_randomized_numbers_depend_on_the_world_s_seed_alone():
    few, many = (mw.Batch(crates(), worlds=n, seed=s) for n, s in ((3, 14), (40, 10)))
    for batch in (few, many):
        batch.randomize("linear_velocity", [-1, -2, 0], [1, 2, 0.5])
        batch.randomize("friction", 0.3, 0.8, ids=[0, 2])
        batch.randomize("mass", 2, 4, items=0)  # of scene body 1, which varies
    v = many.get("linear_velocity")
    np.testing.assert_array_equal(v[4:7], few.get("linear_velocity"))
    for c, (low, high) in enumerate(((-1, 1), (-2, 2), (0, 0.5))):
        drawn = v[..., c].ravel()
        assert low <= drawn.min() and drawn.max() < high
        assert abs(drawn.mean() - (low + high) / 2) < 4 * (high - low) / np.sqrt(12 * drawn.size)
    assert len(np.unique(v)) == v.size
    mass = many.get("mass")
    assert len(np.unique(mass[:, 0])) == 40 and len(np.unique(mass[:, 1])) == 1
    before = many.get("friction").copy()
    many.randomize("friction", 0.3, 0.8, ids=[0, 2])
    np.testing.assert_array_equal(many.get("friction"), before)  # the same call, the same draw
    many.randomize("friction", 0.3, 0.8, ids=[0, 2], seed=77)
    changed = (many.get("friction") != before).any(axis=(1, 2))
    np.testing.assert_array_equal(np.flatnonzero(changed), [0, 2])

    before = many.hash()
    for nothing in ([], np.zeros(3, bool)):
        many.randomize("linear_velocity", 5, 6, items=nothing)
    many.randomize("linear_velocity", 5, 6, ids=[])
    assert many.hash() == before
    with pytest.raises(ValueError, match="low has shape .2,.; expected .bodies=3, components=3."):
        many.randomize("linear_velocity", [1, 2], 3)
    for low, high in ((5, -5), (np.nan, 1), (0, np.inf)):
        with pytest.raises(ValueError, match="finite numbers with low <= high"):
            many.randomize("linear_velocity", low, high)
    with pytest.raises(IndexError, match="items hold 3"):
        many.randomize("linear_velocity", 0, 1, items=3)
    with pytest.raises(ValueError, match="does not vary"):
        many.randomize("linear_drag", 0, 1)


def test_draws_are_uniform_and_independent():
    numbers = draws.uniform(np.array([0, 1, 2**64 - 1], np.uint64), "x", 100_000)
    assert numbers.min() >= 0 and numbers.max() < 1
    counts = np.histogram(numbers, 100, (0, 1))[0]
    assert ((counts - 3000) ** 2 / 3000).sum() < 160  # chi squared of 99: 4.3 sigma
    assert np.abs(np.corrcoef(numbers) - np.eye(3)).max() < 0.02
