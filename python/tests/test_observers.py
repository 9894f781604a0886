"""Observers as fields: accelerations and points, what is refused, and the docs' table of all."""

from pathlib import Path

import numpy as np
import pytest

import manyworlds as mw

DOCS = Path(__file__).parents[2] / "docs" / "observers.md"


def falling() -> mw.Scene:
    box = mw.Body(
        name="box", position=(0, 0, 5), angular_velocity=(0, 0, 2),
        shapes=[mw.Shape(geometry=mw.Box((0.5, 0.5, 0.5)))],
    )  # fmt: skip
    ground = mw.Body(name="ground", motion="fixed", shapes=[mw.Shape(geometry=mw.Plane())])
    return mw.Scene(bodies=[ground, box], options=mw.Options(gravity=(0, 0, -10)))


def test_what_an_imu_and_a_tracker_read():
    points = [mw.Point(position=(0.5, 0, 0), body="box"), mw.Point(body=1)]
    batch = mw.Batch(falling(), 3, 1, observe=["acceleration"], points=points)
    batch.step(4)
    np.testing.assert_allclose(batch.get("linear_acceleration"), [[[0, 0, -10]]] * 3, atol=1e-3)
    np.testing.assert_allclose(batch.get("proper_acceleration"), np.zeros((3, 1, 3)), atol=1e-3)
    np.testing.assert_allclose(batch.get("angular_acceleration"), np.zeros((3, 1, 3)), atol=1e-3)
    assert batch.fields["point_velocity"].item == "point"
    velocity, position = batch.get("point_velocity"), batch.get("point_position")
    assert velocity.shape == position.shape == (3, 2, 3)
    np.testing.assert_allclose(position[:, 1], batch.get("position")[:, 0], atol=1e-6)
    np.testing.assert_allclose(
        np.linalg.norm(velocity[:, 0] - velocity[:, 1], axis=-1), [1.0] * 3, atol=1e-3
    )
    batch.step(600)
    np.testing.assert_allclose(batch.get("proper_acceleration")[:, 0], [[0, 0, 10]] * 3, atol=0.05)


def test_points_that_make_no_sense():
    with pytest.raises(
        ValueError, match="points\\[0\\].body is body 0 'ground', must be a body that"
    ):
        mw.Batch(falling(), points=[mw.Point(body="ground")])
    with pytest.raises(ValueError, match="observe.what\\[0\\] is points"):
        mw.Batch(falling(), observe=["points"])
    with pytest.raises(ValueError, match=r"make the Batch with points=\[\.\.\.\]"):
        mw.Batch(falling()).get("point_velocity")


def test_terms():
    task = mw.Task(name="fall", scene=falling(), points=[mw.Point(position=(0, 0.5, 0), body="box")])
    t = task.terms
    task.observe("imu", t.proper_acceleration("box", "z"))
    task.observe("down", t.linear_acceleration("box", "z"))
    task.observe("turn", t.angular_acceleration("box"))
    task.observe("tip", t.point_velocity(0, "z"))
    task.observe("height", t.point_position(0, "z"))
    assert task.validate() == []
    environment = mw.Environment(task, worlds=2)
    assert environment.observations[0].tolist() == [10, 0, 0, 0, 5]  # a state is at rest
    environment.step(np.zeros((2, 0), np.float32))
    np.testing.assert_allclose(environment.observations[0, :3], [0, -10, 0], atol=1e-3)
    np.testing.assert_allclose(environment.batch.get("point_velocity")[:, 0, 2], -1 / 6, atol=1e-3)


def test_the_docs_list_every_observer():
    rows = [line for line in DOCS.read_text().splitlines() if line.startswith("| ")]
    fields = mw.Batch(falling(), 1, 1).fields.values()
    for field in fields:
        if field.group == "observed":
            row = [line for line in rows if line.startswith(f"| {field.observer} |")]
            assert any(field.name in line for line in row), field.name
