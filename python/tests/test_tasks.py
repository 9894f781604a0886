"""Tasks and expressions: composed in Python, the same as in C++; what is wrong is said."""

import copy
import importlib
import math
import pickle
import sys
from pathlib import Path

import numpy as np
import pytest

import manyworlds as mw
from manyworlds import tasks

EXAMPLES = Path(__file__).parents[2] / "examples" / "python"


def example(name):
    """A module of examples/python; some import others of them."""
    if str(EXAMPLES) not in sys.path:
        sys.path.append(str(EXAMPLES))
    return importlib.import_module(name)


def falling():
    """A ball that falls freely: y = 5 - 5 t^2, exactly known."""
    scene = mw.Scene(space="planar")
    scene.options.gravity = (0, -10, 0)
    scene.add(mw.Body(name="ball", position=(1, 5, 0), shapes=[mw.Shape(geometry=mw.Circle(0.1))]))
    return mw.Task(name="falling", scene=scene, actions=[mw.Action("a", -2, 3)])


def values(make, actions, precision="f64", steps=1):
    """What expressions are after steps of `falling` with these actions."""
    task = falling()
    for i, value in enumerate(make(task.terms)):
        task.observe(f"v{i}", value)
    with mw.Environment(task, len(actions), precision=precision, threads=1) as env:
        for _ in range(steps):
            env.step(np.array(actions, np.float32)[:, None])
        return env.observations.copy()


def test_every_named_task_is_sound_and_can_be_copied():
    assert len(tasks.names()) == 11 and set(tasks.summaries()) == set(tasks.names())
    for name in tasks.names():
        task = tasks.load(name)
        assert task.name == name and task.validate() == []
        assert copy.deepcopy(task).validate() == []
    with pytest.raises(ValueError, match="the task is 'CartPol'.*nearest: 'CartPole'"):
        tasks.load("CartPol")


def test_defaults_are_those_of_the_library():
    for name, wanted in mw._core.default_task_values().items():
        found = getattr(mw, name)()
        for member in wanted.__slots__:
            a, b = getattr(found, member), getattr(wanted, member)
            if not isinstance(b, (mw.Expression, mw.Scene)):
                assert a == b, (name, member)


def test_a_task_composed_in_python_is_the_same_bits():
    task, named = example("compose").make_task(), tasks.load("CartPole")
    task.scene.name = named.scene.name
    for precision in ("f32", "f64"):
        envs = [mw.Environment(t, 37, seed=5, precision=precision) for t in (task, named)]
        random = np.random.default_rng(0)
        for _ in range(300):
            actions = random.integers(2, size=37)
            a, b = (env.step(actions) for env in envs)
            for x, y in zip(a, b):
                assert x.tobytes() == y.tobytes()
        assert envs[0].batch.hash() == envs[1].batch.hash()


def test_operators_and_functions_are_those_of_numpy():
    x = np.array([-1.5, -0.5, 0.25, 2.0, 3.0])
    functions = [
        (lambda a: a + 2, lambda a: a + 2),
        (lambda a: 2 - a, lambda a: 2 - a),
        (lambda a: np.float64(3) * a / 7, lambda a: 3 * a / 7),
        (lambda a: 1 / (a + 10), lambda a: 1 / (a + 10)),
        (lambda a: -a, lambda a: -a),
        (lambda a: abs(a) ** 0.5, lambda a: np.sqrt(abs(a))),
        (lambda a: a**3, lambda a: a**3),
        (lambda a: a**0, lambda a: a**0),
        (lambda a: (a > -1) & (a < 2), lambda a: (a > -1) & (a < 2)),
        (lambda a: (a <= -1) | (a >= 2), lambda a: (a <= -1) | (a >= 2)),
        (lambda a: ~(a == 2), lambda a: a != 2),
        (lambda a: a != 2, lambda a: a != 2),
        (tasks.sin, np.sin),
        (tasks.cos, np.cos),
        (tasks.exp, np.exp),
        (tasks.floor, np.floor),
        (tasks.square, np.square),
        (lambda a: tasks.sqrt(a + 2), lambda a: np.sqrt(a + 2)),
        (lambda a: tasks.minimum(a, 1), lambda a: np.minimum(a, 1)),
        (lambda a: tasks.maximum(0.5, a), lambda a: np.maximum(a, 0.5)),
        (lambda a: tasks.clip(a, -1, 1), lambda a: np.clip(a, -1, 1)),
        (lambda a: tasks.where(a > 0, a, -2), lambda a: np.where(a > 0, a, -2)),
        (lambda a: tasks.arctan2(a, -1), lambda a: np.arctan2(a, -1)),
        (tasks.tanh, np.tanh),
        (tasks.sign, np.sign),
        (lambda a: tasks.log(a + 2), lambda a: np.log(a + 2)),
        (lambda a: tasks.arccos(a / 4), lambda a: np.arccos(a / 4)),
        (lambda a: tasks.mod(a, 0.75), lambda a: np.mod(a, 0.75)),
        (lambda a: a % -2, lambda a: a % -2),
        (lambda a: 7 % (a + 0.1), lambda a: 7 % (a + 0.1)),
        (lambda a: (a + 2) ** 1.5, lambda a: (a + 2) ** 1.5),
        (lambda a: (a + 2) ** -2, lambda a: (a + 2) ** -2.0),
        (lambda a: (a + 2) ** a, lambda a: (a + 2) ** a),
        (lambda a: 2**a, lambda a: 2**a),
        (lambda a: tasks.power(a, 3), lambda a: a**3),
    ]
    found = values(lambda t: [f(t.action()) for f, _ in functions], x)
    for i, (_, f) in enumerate(functions):
        np.testing.assert_allclose(found[:, i], f(x).astype(float), rtol=1e-6, err_msg=str(i))


def test_terms_are_what_the_world_is():
    def make(t):
        y = t.position("ball", "y")
        return [t.position(0, 0), y, t.velocity("ball", "y"), t.angle("ball"), t.age(), t.lost(),
                tasks.previous(y), tasks.held(y < 4.99), tasks.largest(-y), t.touching("ball"),
                t.direction("ball", "x", "x"), t.angular_velocity("ball")]  # fmt: skip

    for steps in (1, 30):
        time = steps / 60
        found = values(make, [0.0], steps=steps)[0]
        assert found[0] == 1 and found[1] == pytest.approx(5 - 5 * time**2, abs=0.05)
        assert found[2] == pytest.approx(-10 * time, rel=1e-5)
        assert found[3] == 0 and found[4] == steps and found[5] == 0
        assert found[6] > found[1] and found[8] == -found[1]
        assert found[7] == pytest.approx(steps - 3, abs=2) or steps == 1
        assert list(found[9:]) == [0, 1, 0]


def test_actions_beyond_their_range_count_as_its_end():
    assert values(lambda t: [t.action()], [-9, 9, 1])[:, 0].tolist() == [-2, 3, 1]


def test_actions_that_are_not_clamped_count_as_given():
    task = tasks.load("CartPoleSwingUp")  # 15 N at an action of 1
    task.actions[0].clamped = False
    task.observe("action", task.terms.action())
    task.observe("control", task.terms.control(0))
    clamped = copy.deepcopy(task)
    clamped.actions[0].clamped = True
    with mw.Environment(task, 4, threads=1) as env, mw.Environment(clamped, 4, threads=1) as other:
        actions = np.array([[-9], [0.5], [np.inf], [np.nan]], np.float32)
        observations, rewards, *_ = env.step(actions)
        assert observations[:2, -2:].tolist() == [[-9, -15], [0.5, 7.5]]
        assert env.lost().tolist() == [False, False, True, True]
        of_the_end, less, *_ = other.step(actions)
        assert of_the_end[:3, -2:].tolist() == [[-1, -15], [0.5, 7.5], [1, 15]]
        assert other.lost().tolist() == [False, False, False, True]
        assert rewards[0] - less[0] == pytest.approx(-0.01 * (81 - 1), rel=1e-5)
        assert (observations[:2, :-2] == of_the_end[:2, :-2]).all() and rewards[1] == less[1]
        with pytest.raises(mw.SnapshotError):
            other.restore(env.save())


def test_expressions_have_no_truth_value():
    a = tasks.Terms().action()
    for wrong in (lambda: bool(a > 1), lambda: a > 1 and a < 2, lambda: 0 < a < 1, lambda: not a):
        with pytest.raises(TypeError, match="no truth value"):
            wrong()


def test_operands_that_are_no_numbers_are_type_errors():
    a = tasks.Terms().action()
    for wrong in (lambda: a + "1", lambda: [] * a, lambda: a & None, lambda: tasks.sin("x")):
        with pytest.raises(TypeError):
            wrong()
    for wrong in (lambda: a ** "2", lambda: a**None, lambda: "2" ** a, lambda: a % "2"):
        with pytest.raises(TypeError):
            wrong()
    with pytest.raises(ValueError, match="nested"):
        for _ in range(3000):
            a = a + 1


def test_random_numbers_have_names_and_are_the_same_wherever_they_stand():
    def make(t):
        goal = t.uniform("goal", -1, 1, every="episode")
        return [
            goal,
            t.uniform("goal", -2, 2, every="episode"),
            t.uniform("goal", -1, 1),
            t.normal("noise", 1, 0),
            pickle.loads(pickle.dumps(goal)),
            t.normal("noise", deviation=3),
        ]

    one, two = (values(make, np.zeros(1000), steps=n) for n in (1, 2))
    assert (one[:, 1] == 2 * one[:, 0]).all() and (one[:, 4] == one[:, 0]).all()
    assert (one[:, 3] == 1).all()
    assert (two[:, 0] == one[:, 0]).all() and (two[:, 2] != one[:, 2]).all()
    assert abs(one[:, [0, 2]]).max() <= 1 and abs(one[:, 0].mean()) < 0.1
    assert one[:, 5].std() == pytest.approx(3, rel=0.15)
    t = tasks.Terms()
    assert "uniform('goal', 'episode')" in repr(t.uniform("goal", every="episode"))
    with pytest.raises(ValueError, match="every is 'epoch'"):
        t.uniform("goal", every="epoch")
    task = falling()
    task.observe("x", t.uniform(""))
    assert task.validate()[0].message == "a random number has no name, must have one"


def test_parameters_are_those_of_the_world():
    task = falling()
    task.scene.bodies[0].shapes[0].name = "skin"
    task.scene.add(mw.vary("friction", 0.1, 0.9))
    task.scene.add(mw.vary("density", 100, 900))
    t = task.terms
    task.observe("friction", t.parameter("friction", shape="skin"))
    task.observe("the same", t.parameter("friction", shape=0, body="ball"))
    task.observe("mass", t.parameter("mass", body="ball"))
    task.observe("gravity", t.parameter("gravity", 1))
    task.observe("handle", t.parameter("density", shape=task.scene.shape("skin")))
    task = pickle.loads(pickle.dumps(task))
    with mw.Environment(task, 9, precision="f64", threads=1) as env:
        env.step(np.zeros((9, 1), np.float32))
        seen = env.observations
        for column, name in ((0, "friction"), (1, "friction"), (2, "mass"), (4, "density")):
            wanted = env.batch.get(name)[:, 0, 0].astype(np.float32)
            assert (seen[:, column] == wanted).all() and np.ptp(wanted) > 0.1, name
        assert (seen[:, 3] == -10).all()
    with pytest.raises(ValueError, match="friction belongs to a shape, not to a body"):
        t.parameter("friction", body="ball")
    with pytest.raises(ValueError, match="nearest: 'mass'"):
        t.parameter("mas", body="ball")
    with pytest.raises(ValueError, match=r"use Terms\(scene\)"):
        tasks.Terms().parameter("friction", shape="skin")
    task.observe("x", t.parameter("damping", joint=0))
    assert "damping of joint 0: the joint must be" in task.validate()[0].message


def test_names_that_there_are_not_are_said():
    t = tasks.load("LunarLander").terms
    with pytest.raises(ValueError, match="no body is named 'landr'.*nearest: 'lander'"):
        t.position("landr", "x")
    with pytest.raises(ValueError, match="axis is 'w'"):
        t.position("lander", "w")
    with pytest.raises(ValueError, match=r"use Terms\(scene\)"):
        tasks.Terms().position("lander", 0)


def test_every_issue_of_a_task_is_listed_at_once():
    task = falling()
    t = task.terms
    task.observe("far", t.position(7, 0))
    task.observe("z", t.position(0, 2), low=1, high=0)
    task.reward("ray", t.ray_distance(0))
    task.act("bad", 1, 1)
    task.controls = [1]
    task.frame_skip = 0
    with pytest.raises(mw.TaskError) as error:
        mw.Environment(task)
    places = [issue.place for issue in error.value.issues]
    assert len(places) >= 6, places
    assert isinstance(error.value, mw.SceneError) and "the task has" in str(error.value)
    for text in ("position of body 7", "frame_skip", "controls", "ray_distance"):
        assert text in str(error.value)


@pytest.mark.parametrize(
    "change, words",
    [
        (dict(choices="two"), "task.choices is of type str"),
        (dict(observations=[1]), r"task.observations\[0\] is of type int"),
        (dict(terminated="never"), "task.terminated is of type str"),
        (dict(controls=[None]), r"task.controls\[0\] is of type NoneType"),
        (dict(scene=None), "task.scene is of type NoneType"),
    ],
)
def test_members_of_wrong_types_say_where(change, words):
    task = falling()
    for name, value in change.items():
        setattr(task, name, value)
    with pytest.raises(TypeError, match=words):
        task.validate()


def test_infinite_and_nan_numbers_harm_nobody():
    def make(t):
        return [t.action() / (t.age() - 1), tasks.sqrt(-t.action()), t.position(0, 1)]

    with pytest.warns(RuntimeWarning, match="observation [01] 'v[01]' is (inf|nan) in world 0 at step 1"):
        found = values(make, [1.0, 2.0], "f32")
    assert np.isinf(found[:, 0]).all() and np.isnan(found[:, 1]).all() and found[0, 2] < 5
