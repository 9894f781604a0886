"""get(ids=...), set of numbers and rows, out= of other kinds of memory, step_to."""

import array

import numpy as np
import pytest

import manyworlds as mw
from conftest import crates, lander


def batch_of(precision="f32"):
    batch = mw.Batch(crates(), 6, 1, precision, seed=5, observe=["motion", "touching"])
    batch.step(10)
    return batch


# -- ids


@pytest.mark.parametrize("precision", ["f32", "f64"])
@pytest.mark.parametrize("name", ["position", "orientation", "friction", "mass", "kinetic_energy", "touching"])  # fmt: skip
def test_get_of_some_worlds_is_what_get_has_of_them(precision, name):
    batch = batch_of(precision)
    all_of_them = batch.get(name)
    mask = np.arange(6) % 2 == 0
    for ids in ([3], [5, 0, 2], mask, np.arange(6), 4, range(2)):
        found = batch.get(name, ids=ids)
        wanted = all_of_them[np.atleast_1d(ids)]
        assert found.dtype == all_of_them.dtype and found.tobytes() == wanted.tobytes()
        assert found.shape == wanted.shape
    assert batch.get(name, ids=[]).shape == (0, *all_of_them.shape[1:])
    out = np.empty((2, *all_of_them.shape[1:]), all_of_them.dtype)
    assert batch.get(name, out, [4, 1]) is out
    assert out.tobytes() == all_of_them[[4, 1]].tobytes()


def test_ids_and_out_of_get_are_checked():
    batch = batch_of()
    for ids, error, words in [
        ([6], IndexError, "ids hold 6, must be 0 to 5"),
        (-1, IndexError, "ids hold -1"),
        ([True], IndexError, "the mask of ids"),
        (1.5, TypeError, "expected integers"),
    ]:
        with pytest.raises(error, match=words):
            batch.get("position", ids=ids)
    with pytest.raises(ValueError, match=r"shape \(6, 3, 3\); expected \(ids=2, bodies=3"):
        batch.get("position", out=np.zeros((6, 3, 3), np.float32), ids=[0, 1])


# -- what is set broadcasts


@pytest.mark.parametrize("ids", [None, [4, 1], np.arange(6) < 3])
@pytest.mark.parametrize(
    "value",
    [
        2,
        -0.5,
        np.float32(0.25),
        [1, 2, 3],
        np.arange(9.0).reshape(3, 3),
        np.arange(3)[:, None],
        np.arange(9.0).reshape(1, 3, 3),
    ],
)
def test_numbers_and_rows_are_set_in_every_world(ids, value):
    batch = batch_of()
    before = batch.get("linear_velocity")
    batch.set("linear_velocity", value, ids)
    chosen = np.arange(6) if ids is None else np.arange(6)[ids]
    wanted = before.copy()
    wanted[chosen] = value
    assert batch.get("linear_velocity").tobytes() == wanted.tobytes()


def test_a_row_for_each_world_broadcasts_over_bodies():
    batch = batch_of()
    rows = np.random.default_rng(0).normal(size=(6, 1, 3)).astype(np.float32)
    batch.set("linear_velocity", rows)
    assert (batch.get("linear_velocity") == rows).all()
    batch.set("friction", 0.5)
    assert (batch.get("friction") == 0.5).all()
    batch.set("friction", 0.25, ids=[0, 5])
    assert (batch.get("friction")[:, 0, 0] == [0.25, 0.5, 0.5, 0.5, 0.5, 0.25]).all()
    with pytest.raises(ValueError, match=r"\(6,\); expected \(worlds=6, bodies=3, comp.*, or"):
        batch.set("linear_velocity", np.zeros(6))
    with pytest.raises(ValueError, match="friction"):
        batch.set("friction", 7)  # beyond its range
    assert batch.get("friction").max() == 0.5


@pytest.mark.parametrize("ids", [None, [4, 1], np.arange(5) < 2])
@pytest.mark.parametrize(
    "value",
    [0.5, np.float32(0.25), [0.5], [0.25, 0.5, 0.75], [[0.5], [0.25]], np.zeros((1, 3)), np.ones(3, "f4")],
)  # fmt: skip
def test_controls_broadcast_as_what_is_set_does(ids, value):
    if ids is None and np.shape(value) == (2, 1):
        value = np.linspace(0, 1, 5)[:, None]  # a number for each world
    batch, other = lander(), lander()
    start = np.full((5, 3), 0.125, np.float32)
    batch.set_controls(start), other.set_controls(start)
    wanted = start.copy()
    chosen = np.arange(5) if ids is None else np.arange(5)[ids]
    wanted[chosen] = value
    batch.set_controls(value, ids)
    assert batch.get_controls().tobytes() == wanted.tobytes()
    batch.set_controls(start)
    batch.step(3, controls=value, ids=ids)
    other.set_controls(wanted), other.step(3, ids=ids)
    assert (batch.hashes() == other.hashes()).all()


def test_controls_of_a_kind_and_of_a_rollout_broadcast():
    car = mw.scenes.load("car2d")
    scene = mw.scenes.load("lunar-lander")
    car.options.dt = scene.options.dt
    flown, _ = mw.Batch([(scene, 4), (car, 3)], threads=1).kinds
    flown.set_controls(0.5)
    flown.set_controls([1, 0, 0], ids=[3])
    assert (flown.get_controls() == [[0.5] * 3] * 3 + [[1, 0, 0]]).all()
    rolled, whole = lander(), lander()
    plan = np.random.default_rng(0).uniform(0, 1, (7, 1, 3))
    path = rolled.rollout(controls=plan)["position"]
    assert path.tobytes() == whole.rollout(controls=np.repeat(plan, 5, 1))["position"].tobytes()


def test_what_does_not_broadcast_to_controls_is_refused():
    batch = lander()
    for value, ids, words in [
        (np.zeros(5), None, r"controls has shape \(5,\); expected \(worlds=5, controls=3\), or"),
        (np.zeros((2, 3)), None, r"\(2, 3\); expected \(worlds=5, controls=3\)"),
        (np.zeros((5, 3)), [0, 1], r"\(5, 3\); expected \(ids=2, controls=3\)"),
        (np.zeros((1, 5, 3)), None, r"\(1, 5, 3\); expected"),
    ]:
        with pytest.raises(ValueError, match=words):
            batch.set_controls(value, ids)
    with pytest.raises(ValueError, match=r"\(7, 2, 3\); expected \(steps=7, worlds=5, controls=3"):
        batch.rollout(controls=np.zeros((7, 2, 3)))
    assert not batch.get_controls().any()


def test_a_rollout_begins_with_what_set_takes():
    a, b = batch_of(), batch_of()
    found = a.rollout({"linear_velocity": [0, 0, 1]}, steps=3)["position"]
    b.set("linear_velocity", [0, 0, 1])
    assert found.tobytes() == b.rollout(steps=3)["position"].tobytes()


# -- out


class Tensor:
    """What a library with DLPack has: of its version 1, or of an older one."""

    def __init__(self, numbers, versioned=True, readable=True):
        self.numbers, self.versioned, self.device = numbers, versioned, (1, 0)
        if readable:
            self.__class__ = type("Tensor", (Tensor,), {"__array__": Tensor.array})

    def array(self, dtype=None, copy=None):
        return self.numbers

    def __dlpack__(self, **more):
        if not self.versioned:
            if "max_version" in more:
                raise TypeError("unexpected keyword argument 'max_version'")
            more = {}
        return self.numbers.__dlpack__(**more)

    def __dlpack_device__(self):
        return self.device


@pytest.mark.parametrize("versioned", [True, False])
def test_out_is_filled_through_dlpack(versioned):
    batch = batch_of()
    numbers = np.zeros((6, 3, 3), np.float32)
    found = batch.get("position", out=Tensor(numbers, versioned))
    assert np.shares_memory(found, numbers)
    assert numbers.tobytes() == batch.get("position").tobytes()
    status = np.ones(6, np.uint32)
    batch.status(out=Tensor(status, versioned))
    assert not status.any()


def test_out_is_filled_in_a_torch_tensor():
    torch = pytest.importorskip("torch")
    batch = batch_of()
    tensor = torch.zeros((6, 3, 3))
    batch.get("position", out=tensor)
    assert tensor.numpy().tobytes() == batch.get("position").tobytes()


@pytest.mark.parametrize(
    "make, values",
    [
        (lambda n: bytearray(4 * n), lambda b: np.frombuffer(b, np.float32)),
        (lambda n: array.array("f", [0] * n), np.asarray),
        (lambda n: memoryview(bytearray(4 * n)), lambda b: np.frombuffer(b, np.float32)),
        (lambda n: memoryview(bytearray(4 * n)).cast("f"), np.asarray),
        (lambda n: memoryview(bytearray(4 * n)).cast("f", [6, 3, 3]), np.asarray),
        (lambda n: memoryview(bytearray(4 * n + 8))[4:-4], lambda b: np.frombuffer(b, np.float32)),
    ],
)
def test_out_is_filled_in_buffers(make, values):
    batch = batch_of()
    buffer = make(54)
    found = batch.get("position", out=buffer)
    assert found.shape == (6, 3, 3) and np.shares_memory(found, values(buffer))
    assert values(buffer).tobytes() == batch.get("position").tobytes()


def test_buffers_of_other_types_of_number():
    batch = lander(sleep=True)
    for call, code in [
        (batch.status, "I"),
        (batch.hashes, "L"),
        (batch.lane_indices, "i"),
        (batch.energy, "d"),
        (batch.get_enabled, "B"),
    ]:
        wanted = call()
        if code != "B":
            buffer = array.array(code, bytes(wanted.nbytes))
            call(out=buffer)
            assert buffer.tobytes() == wanted.tobytes()
        raw = bytearray(wanted.nbytes)
        if wanted.dtype == np.bool_:
            raw = memoryview(raw).cast("?")
        call(out=raw)
        assert bytes(raw) == wanted.tobytes()


def test_environments_and_rollouts_fill_them_too():
    env, twin = (mw.Environment("CartPole", 4, threads=1, reward_terms=True) for _ in range(2))
    observations, rewards = bytearray(4 * 4 * 4), array.array("d", [0] * 4)
    ended, terms = Tensor(np.ones(4, bool)), bytearray(8 * 4)
    found = env.step([0] * 4, observations, rewards, ended, reward_terms=terms)
    wanted = twin.step([0] * 4)
    assert [a.tobytes() for a in found] == [a.tobytes() for a in wanted]
    assert bytes(observations) == wanted[0].tobytes() and list(rewards) == [1] * 4
    assert not ended.numbers.any() and bytes(terms) == twin.reward_terms.tobytes()
    assert env.save().observations.tobytes() == bytes(observations)
    batch = batch_of()
    paths = bytearray(2 * 6 * 3 * 3 * 4)
    found = batch.rollout(steps=2, out={"position": paths})["position"]
    assert found.shape == (2, 6, 3, 3) and found[1].tobytes() == batch.get("position").tobytes()


def frozen(numbers):
    numbers.flags.writeable = False
    return numbers


def jax_array():
    jax = pytest.importorskip("jax")
    return jax.numpy.zeros((6, 3, 3))


def elsewhere():
    tensor = Tensor(np.zeros((6, 3, 3), np.float32))
    tensor.device = (2, 0)
    return tensor


WRONG = [
    (lambda: bytes(216), ValueError, "out is read-only"),
    (lambda: memoryview(bytes(216)), ValueError, "out is read-only"),
    (lambda: bytearray(215), ValueError, r"out has 215 bytes; expected 216 bytes for \(worlds=6"),
    (lambda: array.array("f", [0] * 53), ValueError, "out has 53 values; expected 54 values"),
    (lambda: array.array("d", [0] * 54), TypeError, "out is of dtype float64; expected float32"),
    (lambda: array.array("i", [0] * 54), TypeError, "out is of dtype int32; expected float32"),
    (lambda: memoryview(bytearray(432))[::2], ValueError, "out is not C-contiguous"),
    (lambda: memoryview(bytearray(217))[1:], ValueError, "not a multiple of 4"),
    (lambda: memoryview(bytearray(216)).cast("f", [3, 6, 3]), ValueError, r"shape \(3, 6, 3\)"),
    (lambda: np.zeros(54, np.float32), ValueError, r"shape \(54,\); expected"),
    (lambda: Tensor(np.zeros((6, 3), np.float32)), ValueError, r"shape \(6, 3\); expected"),
    (lambda: Tensor(np.zeros((6, 3, 3))), TypeError, "float64; expected float32"),
    (lambda: Tensor(np.zeros((3, 3, 6), np.float32).T), ValueError, "not C-contiguous"),
    (lambda: Tensor(frozen(np.zeros((6, 3, 3), np.float32))), ValueError, "read-only"),
    (lambda: Tensor(np.zeros((6, 3, 3), np.float32), False, False), ValueError, "read-only"),
    (elsewhere, TypeError, "cannot be imported through DLPack: its memory is on the dev"),
    (jax_array, ValueError, "read-only"),
    (
        lambda: [0.0] * 54,
        TypeError,
        "out is of type list; expected a numpy.ndarray, or an object with",
    ),
    (lambda: 3, TypeError, "out is of type int"),
    (lambda: "x" * 216, TypeError, "out is of type str"),
]


@pytest.mark.parametrize("make, error, words", WRONG)
def test_what_cannot_be_filled_is_refused(make, error, words):
    batch = batch_of()
    out = make()
    with pytest.raises(error, match=words):
        batch.get("position", out=out)


# -- step_to


def test_step_to_takes_whole_steps_up_to_a_time():
    batch, twin = lander(), lander()
    assert [batch.step_to(t) for t in (0, 0.01, 0.05, 0.05, 0.1)] == [0, 0, 3, 0, 3]
    twin.step(6)
    assert batch.hash() == twin.hash() and batch.steps == 6
    assert batch.step_to(10.0) == 8  # and the rest is dropped
    assert batch.step_to(10.0) == 0 and batch.step_to(10.02, max_steps=3) == 1
    assert batch.step_to(12.0, 100) == 100 and batch.step_to(20.0, 0) == 0


@pytest.mark.parametrize(
    "arguments, error, words",
    [
        ((np.nan,), ValueError, "clock is nan, must be finite"),
        ((np.inf,), ValueError, "clock is inf"),
        (("1",), TypeError, "clock is of type str"),
        ((True,), TypeError, "clock is of type bool"),
        ((1.0, -1), ValueError, "max_steps is -1, must be 0 to"),
        ((1.0, 1.5), TypeError, "max_steps is of type float"),
    ],
)
def test_step_to_says_what_is_wrong(arguments, error, words):
    batch = lander()
    with pytest.raises(error, match=words):
        batch.step_to(*arguments)
    assert batch.steps == 0
