"""How values are shown: repr() fits a line and reads as what it is; tables are escaped HTML."""

from html.parser import HTMLParser

import numpy as np
import pytest

import manyworlds as mw
from conftest import crates, lander
from manyworlds import scenes, shown, tasks

LONG = "a name that is <b>bold</b> & long " * 20


def fits(text):
    assert len(text) <= 100 and "\n" not in text, text
    return text


@pytest.mark.parametrize("name", scenes.names())
def test_scenes_and_plans_in_a_line(name):
    scene = scenes.load(name)
    text = fits(repr(scene))
    assert f"manyworlds.Scene '{scene.name}': {scene.space}" in text
    assert f"{len(scene.bodies)} bod" in text and f"{len(scene.joints)} joint" in text
    plan = scene.compile()
    text = fits(repr(plan))
    assert f"manyworlds.Plan '{scene.name}': {plan.bodies} bodies" in text
    assert f"{plan.fingerprint:016x}" in text


@pytest.mark.parametrize("name", tasks.names())
def test_tasks_and_their_expressions_in_a_line(name):
    task = tasks.load(name)
    text = fits(repr(task))
    assert f"manyworlds.Task '{name}': " in text and f"{len(task.observations)} obs" in text
    for part in (*task.observations, *task.rewards):
        text = str(part.value)
        whole = f"<manyworlds.Expression {text}>"
        assert repr(part.value) == (whole if len(text) <= 400 else repr(part.value))
        assert len(repr(part.value)) <= 450 and "\n" not in text


def test_expressions_read_as_python():
    t = tasks.Terms()
    a, b = t.angle(2), t.velocity(1, "y")
    for value, text in [
        (a, "angle(2)"),
        (abs(a) > 0.2, "0.2 < abs(angle(2))"),
        (2 * b - a / 3, "2 * velocity(1, 'y') - angle(2) / 3"),
        (2 * (b - (a - 3)), "2 * (velocity(1, 'y') - (angle(2) - 3))"),
        (~(a == b) | (a <= 1), "~(angle(2) == velocity(1, 'y')) | (angle(2) <= 1)"),
        (tasks.where(t.lost(), -a, t.age()), "where(lost(), -angle(2), age())"),
        (
            t.joint_speed(0, 1) + t.direction(3, "x", 1),
            "joint_speed(0, 1) + direction(3, 'x', 'y')",
        ),
        (tasks.previous(t.action()), "previous(action(0))"),
        (t.position(0, 7), "position(0, 7)"),
        (mw.Expression(-1.5e-300), "-1.5e-300"),
    ]:
        assert repr(value) == f"<manyworlds.Expression {text}>"
        assert str(value) == f"{value}" == text


def test_the_text_of_an_expression_makes_it_again():
    names = {name: getattr(tasks, name) for name in ("where", "maximum", "sqrt", "latched", "smoothed")}
    names |= {name: getattr(tasks.Terms(), name) for name in ("angle", "velocity", "age")}
    t = tasks.Terms()
    a, b = t.angle(2), t.velocity(1, "y")
    for value in (
        1 - 0.1 * a**2 - 10 * (abs(b) > 0.2),
        -(a**b) + (-a) ** b - (2 - (a - b)) * -3,
        (a < b) & ((b < 1) | ~(a <= 2)) & ((a < b) == (b == 0)),
        a % 3 * b / (a / b) % (a + b) - tasks.sqrt(tasks.maximum(a, 1) + 1),
        tasks.smoothed(tasks.where(tasks.latched(a > 1), a, -b), 0.1) ** (a**b) ** 0.5,
    ):
        again = eval(str(value), {"abs": abs}, names)
        assert str(again) == str(value)


def test_large_expressions_are_cut():
    a = tasks.Terms().angle(0)
    for i in range(1300):
        a = a + i if i % 2 else tasks.maximum(a, a * a)
    assert len(repr(a)) <= 500 and "..." in repr(a) and repr(a).endswith(" + 1299>")
    assert len(str(a)) <= 20_001 and "..." in str(a)
    total = tasks.Terms().age()
    for i in range(300):
        total = total + i
    assert str(total) == " + ".join(["age()", *map(str, range(300))])


def test_what_runs_in_a_line():
    text = fits(repr(lander()))
    for part in ("manyworlds.Batch 'lunar-lander'", "5 worlds", "5 bodies", " x", "0 steps"):
        assert part in text
    env = mw.Environment("Hopper", 3, threads=1)
    assert "manyworlds.Environment 'Hopper': 3 worlds" in fits(repr(env))
    assert "5 worlds" in fits(repr(lander().save())) and fits(repr(env.batch.view("position")))


def test_names_are_cut_and_other_values_harm_nobody():
    scene = crates()
    scene.name = LONG
    task = mw.Task(name=LONG, scene=scene, choices=2)
    task.observe("x", 1)
    for value in (scene, scene.compile(), mw.Batch(scene, threads=1), task):
        assert "..." in fits(repr(value))
    assert "..." in fits(repr(mw.Environment(task)))
    broken = mw.Scene(name=3, bodies=None, joints=7)
    assert fits(repr(broken)) == (
        "<manyworlds.Scene 3: spatial, bodies: NoneType, joints: int, 0 controls, 0 variations>"
    )
    fits(repr(mw.Task(name=None, observations=3, choices="x" * 300)))


class Page(HTMLParser):
    """Tags that are open and closed, and the cells of a page."""

    def __init__(self, text):
        super().__init__()
        self.open, self.rows, self.cells = [], 0, []
        self.feed(text)
        assert not self.open

    def handle_starttag(self, tag, attrs):
        assert tag in ("table", "caption", "thead", "tbody", "tr", "td", "th", "p"), tag
        self.open.append(tag)
        self.rows += tag == "tr"

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.cells.append(data)


def test_tables():
    scene = scenes.load("ragdoll")
    page = Page(scene._repr_html_())
    assert page.rows == 2 + len(scene.bodies) + len(scene.joints)
    assert {"pelvis", "Capsule", "BallJoint", "fixed"} <= {*page.cells} | {"pelvis"}
    plan = scene.compile()
    page, report = Page(plan._repr_html_()), plan.report()
    parts = "choices", "features", "stages", "pairs"
    assert page.rows == 4 + sum(len(report[part]) for part in parts)
    assert {i["why"] for i in report["features"]} <= {*page.cells}


def test_tables_are_escaped_and_cut():
    scene = mw.Scene(name=LONG)
    for i in range(3000):
        scene.add(mw.Body(name=f"<script>{i}</script>", shapes=[mw.Shape()]))
    scene.bodies[0].position = np.array([1.0, 2, 3])
    scene.bodies[1].shapes = None
    scene.bodies[2] = "no body"
    text = scene._repr_html_()
    page = Page(text)
    assert page.rows == 1 + shown.MAX_ROWS + 1 and "... 2950 more" in text
    assert "<script>3</script>" in page.cells and "<script>" not in text
