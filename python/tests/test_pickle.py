"""Pickles and deep copies: the same values, the same bits elsewhere, and errors for other versions."""

import copy
import copyreg
import functools
import multiprocessing
import pickle
from pickle import UnpicklingError

import numpy as np
import pytest

import manyworlds as mw
from conftest import crates, lander
from manyworlds import pickling, scenes, tasks
from test_environment import actions_of

PROTOCOLS = range(2, pickle.HIGHEST_PROTOCOL + 1)
COPIES = [copy.deepcopy] + [
    functools.partial(lambda p, value: pickle.loads(pickle.dumps(value, p)), p) for p in PROTOCOLS
]


def fingerprint(task):
    return mw.Environment(task, threads=1).save().task


def written(task):
    """Everything of a task as plain values."""
    members = pickling._reduce_task(task)[1]
    return repr(members)


@pytest.mark.parametrize("name", tasks.names())
def test_tasks_keep_their_fingerprint(name):
    task = tasks.load(name)
    for copied in COPIES:
        found = copied(task)
        assert type(found) is mw.Task and found is not task and found.scene == task.scene
        assert written(found) == written(task)
    assert fingerprint(copy.deepcopy(task)) == fingerprint(pickle.loads(pickle.dumps(task)))
    assert fingerprint(copy.deepcopy(task)) == fingerprint(task)


def test_what_expressions_share_stays_shared():
    t = tasks.Terms()
    a = t.position(0, 0)
    for _ in range(60):  # 2^60 nodes if they were not
        a = a * a + 1
    assert len(pickle.dumps(a)) < 5000
    back = pickle.loads(pickle.dumps(a))
    assert pickle.dumps(back) == pickle.dumps(a)
    task = mw.Task(name="shared", terminated=a)
    task.observe("a", a)
    task.reward("a", 2 * a)
    nodes = mw._core.expression_graph([o.value for o in (*task.observations, *task.rewards)])[0]
    assert len(nodes) == 1 + 3 * 60 + 2
    assert len(pickle.dumps(task)) < 10_000
    assert written(copy.deepcopy(task)) == written(task)


def test_every_kind_of_expression_goes_through():
    t = tasks.Terms()
    leaves = [t.position(1, "y"), t.velocity(2, 0), t.angular_velocity(3), t.angle(4)]
    leaves += [t.direction(1, "x", "z"), t.joint_position(5, 1), t.joint_speed(6), t.touching(7)]
    leaves += [t.ray_distance(8), t.action(9), t.control(10), t.age(), t.lost()]
    leaves += [mw.Expression(x) for x in (0.1, -0.0, 1e300, np.inf, np.nan)]
    a, b, c = leaves[:3]
    both = [a + b, a - b, a * b, a / b, a < b, a <= b, a > b, a >= b, a == b, a != b, a & b, a | b]
    one = [-a, ~a, abs(a), a**0.5, a**3, tasks.sin(a), tasks.cos(a), tasks.exp(a), tasks.floor(a)]
    some = [tasks.minimum(a, b), tasks.maximum(a, b), tasks.clip(a, b, c), tasks.where(a, b, c)]
    some += [tasks.arctan2(a, b), tasks.previous(a), tasks.held(a), tasks.largest(a)]
    for e in leaves + both + one + some:
        nodes = mw._core.expression_graph([e])
        for copied in COPIES[1:]:
            assert repr(mw._core.expression_graph([copied(e)])) == repr(nodes)
        assert copy.deepcopy(e) is e and copy.copy(e) is e


@pytest.mark.parametrize("name", ["ragdoll", "lunar-lander", "hills", "bin2d", "crane"])
def test_scenes_and_plans(name):
    scene = scenes.load(name)
    plan = scene.compile(broad_phase="sort_and_sweep", keep=["restitution"])
    for copied in COPIES:
        assert copied(scene) == scene and copied(scene) is not scene
        found = copied(plan)
        assert found.fingerprint == plan.fingerprint and found.scene == scene
        assert (found.broad_phase, found.keep) == ("sort_and_sweep", ("restitution",))
        assert found.report() == plan.report()


def values():
    """One of everything else that is a value."""
    batch = mw.Batch(crates(), worlds=4, threads=1)
    batch.step(3)
    env = mw.Environment("Stacking", 3, threads=1)
    return [
        *(kind() for name, kind in vars(mw).items() if name in mw._core.default_values()),
        mw.Filter(2, 3), mw.Limit(-1, 1, mw.Spring(frequency=3)), mw.Ray(body=1), mw.Status.lost(),
        mw.Observation("o", 2.5), mw.Reward("r", 1), mw.Action("a"), mw.vary("mass", 1, 2),
        mw.HeightField(np.arange(4.0), 2), batch.plan.report(), batch.save([1, 2]),
        batch.fields["mass"], batch.contacts(0), batch.measure_contacts(), env.save(),
        mw.Issue("here", "is wrong"), mw.SceneError([mw.Issue("here", "is wrong")]),
        mw.TaskError([mw.Issue("here", "is wrong")]), scenes.load("stack10").mass_properties(1),
    ]  # fmt: skip


def same(a, b):
    if isinstance(a, np.ndarray):
        return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()
    if isinstance(a, mw.SceneError):
        return type(a) is type(b) and str(a) == str(b) and a.issues == b.issues
    if hasattr(a, "__dataclass_fields__"):
        return type(a) is type(b) and all(
            same(getattr(a, n), getattr(b, n)) for n in a.__dataclass_fields__
        )
    return type(a) is type(b) and bool(a == b)


def test_all_other_values():
    all_of_them = values()
    assert len(all_of_them) > 50
    for value in all_of_them:
        for copied in COPIES:
            assert same(copied(value), value), value
        assert isinstance(copy.copy(value), type(value))


def test_results_of_replays(tmp_path):
    record = pytest.importorskip("manyworlds.record")
    batch = lander()
    with record.Recorder(batch, tmp_path / "a.h5") as recorder:
        batch.step(2)
    recording = record.Recording(tmp_path / "a.h5")
    result = recording.replay()
    for copied in COPIES:
        assert copied(result) == result
    for held in (recorder, recording):
        with pytest.raises(TypeError, match="pickle the path of its file"):
            pickle.dumps(held)


@pytest.mark.parametrize(
    "make, words",
    [
        (lambda: lander(), r"Batch objects own .* pickle its scene or plan, the arg.*save\(\)"),
        (lambda: mw.Environment("CartPole"), r"Environment objects .* pickle its task, .*save\(\)"),
        (lambda: mw.Environment("CartPole").batch, "Batch objects own .* pickle its scene"),
        (lambda: lander().view("position"), r"View objects .* pickle numpy.array\(view\)"),
    ],
)
def test_what_is_in_memory_says_what_to_pickle_instead(make, words):
    held = make()
    dumps = [functools.partial(pickle.dumps, protocol=p) for p in range(6)]
    for call in (copy.copy, copy.deepcopy, *dumps):
        with pytest.raises(TypeError, match=words):
            call(held)


def test_other_versions_and_changed_bytes_are_refused():
    scene, task = crates(), tasks.load("LunarLander")
    for value in (scene, task, task.terminated, scene.compile()):
        restore, (form, version, *rest) = copyreg.dispatch_table[type(value)](value)
        assert form == pickling.FORMAT and version == mw.__version__
        with pytest.raises(UnpicklingError, match=f"manyworlds 9.1, in format {form + 1}; this is"):
            restore(form + 1, "9.1", *rest)
    value = pickling.restore_value
    with pytest.raises(UnpicklingError, match="of manyworlds 9.1, has spin, which a Box of"):
        value(1, "9.1", "Box", {"half_extents": (1, 1, 1), "spin": 3})
    with pytest.raises(UnpicklingError, match="has a system, which does not exist in this version"):
        value(1, "9.1", "system", {})
    with pytest.raises(UnpicklingError, match="a Box is damaged: its members are of type list"):
        value(1, "9.1", "Box", [1])
    with pytest.raises(UnpicklingError, match="it has 0 roots"):
        pickling.restore_expression(1, "9.1", [], [])
    with pytest.raises(UnpicklingError, match="the pickle of a Field is incomplete"):
        value(1, "9.1", "Field", {"name": "x"})
    assert value(1, "0.1", "Box", {}) == mw.Box()  # what it did not have yet has its default
    plan = scene.compile()
    with pytest.raises(UnpicklingError, match="made another plan of this scene"):
        pickling.restore_plan(1, "0.1", scene, "automatic", (), plan.fingerprint + 1)


DAMAGED = [
    ([("sine", 0)], [0], "'sine', which is not an expression"),
    ([("sin", 0)], [0], r"nodes\[0\] uses node 0, which does not come before it"),
    ([("sin", -1)], [0], "uses node -1, which does not come before it"),
    ([("number", "x")], [0], "is of type str; expected a number"),
    ([("number",)], [0], "has 0 values, 'number' must have 1"),
    ([("add", 0)], [0], "'add' must have 2"),
    ([()], [0], "is empty"),
    ([("age",)], [1], r"roots\[0\] is 1, must be 0 to 0"),
    ([], [0], "must be 0 to -1"),
    (3, [0], "nodes is of type int"),
    ([("position", 2**40, 0)], [0], "must be -2147483648 to"),
    ([("age",)] + [("abs", i) for i in range(3000)], [0], "nested"),
]


@pytest.mark.parametrize("nodes, roots, words", DAMAGED)
def test_damaged_graphs_are_refused(nodes, roots, words):
    with pytest.raises(UnpicklingError, match=words):
        pickling.restore_expression(1, "0.2", nodes, roots)
    members = pickling._reduce_task(mw.Task())[1][2]
    with pytest.raises(UnpicklingError, match=words):
        pickling.restore_task(1, "0.2", members, nodes, roots)


def test_cut_pickles_are_errors_of_python_or_ours():
    data = pickle.dumps(tasks.load("Pendulum"))
    for end in range(0, len(data), 97):
        with pytest.raises((EOFError, UnpicklingError, ValueError, TypeError, IndexError)):
            pickle.loads(data[:end])


JUNK = [None, -1, 0, 3, 2**70, 1.5, np.nan, "", "sin", "Box", b"x", [], {}, [0], {"x": 1}, object()]


def changed(value, random):
    """A copy with one thing in it replaced by another."""
    if isinstance(value, (list, tuple)) and len(value) and random.random() < 0.9:
        out, at = list(value), random.integers(len(value))
        out[at] = changed(out[at], random)
        return type(value)(out) if type(value) in (list, tuple) else value
    if isinstance(value, dict) and value and random.random() < 0.9:
        key = list(value)[random.integers(len(value))]
        rest = {k: v for k, v in value.items() if k != key}
        return rest | {("y" if random.random() < 0.1 else key): changed(value[key], random)}
    return JUNK[random.integers(len(JUNK))]


@pytest.mark.parametrize("which", range(4))
def test_pickles_that_were_changed_harm_nobody(which):
    task = mw.Task(scene=crates(1))
    task.observe("a", 3 * task.terms.position(0, 0) + tasks.sin(task.terms.age()))
    values = task, task.observations[0].value, crates(2).compile(), crates(1)
    restore, state = copyreg.dispatch_table[type(values[which])](values[which])
    random, outcomes = np.random.default_rng(which), {True: 0, False: 0}
    for _ in range(1500):
        try:
            found = restore(*changed(state, random))
            assert len(repr(found)) <= 100
            if isinstance(found, (mw.Task, mw.Scene)):
                found.validate()
            outcomes[True] += 1
        except (TypeError, UnpicklingError, ValueError):
            outcomes[False] += 1
    assert outcomes[False] > 500, outcomes


class Mine(mw.Task):
    """A class of somebody else's, with a member of its own."""


def test_classes_made_from_ours_keep_what_is_theirs():
    task = Mine(name="mine", scene=crates(1), terminated=tasks.Terms().age() > 3)
    task.note = "to be kept"
    for copied in COPIES:
        found = copied(task)
        assert type(found) is Mine and found.note == "to be kept" and found.scene == task.scene
        assert repr(found.terminated) == repr(task.terminated)


# -- elsewhere


def play(make, steps):
    """What an environment that is made here does, as bytes."""
    with make() as env:
        random = np.random.default_rng(3)
        for _ in range(steps):
            env.step(actions_of(env, random))
        return env.observations.tobytes(), env.rewards.tobytes(), env.batch.hash()


def go_on(make, saved, steps):
    with make() as env:
        env.restore(saved)
        random = np.random.default_rng(4)
        for _ in range(steps):
            env.step(actions_of(env, random))
        return env.batch.hash()


def test_a_spawned_process_builds_the_environment_and_gets_the_same_bits():
    task = tasks.load("LunarLander")
    task.reward("bonus", tasks.exp(-abs(task.terms.angle("lander"))))
    made = functools.partial(mw.Environment, task, 9, threads=1, seed=5, autoreset="same_step")
    with made() as env:
        play_here = play(made, 40)
        env.step(np.zeros(9, int))
        saved = env.save()
    hash_of_plan = functools.partial(plan_hash, crates().compile())
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        assert pool.apply(play, (made, 40)) == play_here
        assert pool.apply(go_on, (made, saved, 20)) == go_on(made, saved, 20)
        assert pool.apply(hash_of_plan) == hash_of_plan()


def plan_hash(plan):
    with mw.Batch(plan, 5, threads=1) as batch:
        batch.step(20)
        return batch.hash()


def test_cloudpickle_as_ray_uses_it():
    cloudpickle = pytest.importorskip("cloudpickle")
    task = tasks.load("Hopper")
    assert written(cloudpickle.loads(cloudpickle.dumps(task))) == written(task)
    make = cloudpickle.loads(cloudpickle.dumps(lambda: mw.Environment(task, 2, threads=1)))
    assert play(make, 5) == play(lambda: mw.Environment(task, 2, threads=1), 5)
