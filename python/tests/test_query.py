"""Queries on single shapes against closed forms."""

from __future__ import annotations

from math import cos, hypot, pi, sin, sqrt

import numpy as np
import pytest

import manyworlds as mw
from manyworlds import query
from manyworlds.query import Pose


def turned(angle, axis=2):
    out = [cos(angle / 2), 0, 0, 0]
    out[1 + axis] = sin(angle / 2)
    return tuple(out)


def test_two_balls():
    s = query.distance(mw.Sphere(0.5), Pose((1, 2, 3)), mw.Sphere(0.25), Pose((4, 6, 3)))
    assert s.distance == pytest.approx(5 - 0.75)
    assert s.normal == pytest.approx([0.6, 0.8, 0])
    assert s.point_a == pytest.approx([1.3, 2.4, 3])
    assert s.point_b == pytest.approx(s.point_a + s.distance * s.normal)
    assert not query.overlap(mw.Sphere(0.5), Pose((1, 2, 3)), mw.Sphere(0.25), Pose((4, 6, 3)))
    deep = query.distance(mw.Sphere(0.5), Pose(), mw.Sphere(0.25), Pose((0, 0, 0.6)))
    assert deep.distance == pytest.approx(-0.15) and deep.normal == pytest.approx([0, 0, 1])
    assert query.overlap(mw.Sphere(0.5), Pose(), mw.Sphere(0.25), Pose((0, 0, 0.6)))


def test_a_turned_box_over_a_plane():
    box = mw.Box((1, 0.5, 0.25))
    lean = pi / 6
    s = query.distance(mw.Plane(), Pose(), box, Pose((0, 0, 3), turned(lean, axis=1)))
    assert s.distance == pytest.approx(3 - sin(lean) - 0.25 * cos(lean))
    assert s.normal == pytest.approx([0, 0, 1])


def test_the_place_of_a_shape_on_its_body_counts():
    shape = mw.Shape(geometry=mw.Sphere(0.1), position=(1, 0, 0))
    s = query.distance(shape, Pose((0, 0, 1), turned(pi / 2)), mw.Sphere(0.1))
    assert s.distance == pytest.approx(sqrt(2) - 0.2)
    assert s.point_b == pytest.approx(np.array([0, 1, 1]) * 0.1 / sqrt(2))


def test_in_the_plane():
    box = mw.Polygon.box(1, 0.5)
    s = query.distance(box, Pose(), mw.Circle(0.5), Pose((4, 4.5, 0)))
    assert s.distance == pytest.approx(hypot(3, 4) - 0.5)
    assert s.normal == pytest.approx([0.6, 0.8, 0])
    capsule = mw.Capsule(0.25, 1)  # along y in the plane, along z in space
    far = [query.distance(capsule, Pose(), capsule, Pose((0, 4, 0)), space) for space in SPACES]
    assert [s.distance for s in far] == pytest.approx([4 - 2 - 0.5, 4 - 0.5])


SPACES = ("planar", "spatial")


def test_a_box_stands_on_four_points():
    box = mw.Box((1, 0.5, 0.25))
    points = query.manifold(mw.Plane(), Pose(), box, Pose((3, 4, 0.24)))
    assert points.dtype == query.MANIFOLD_POINT and len(points) == 4
    assert points["separation"] == pytest.approx(-0.01, abs=1e-6)
    assert (points["normal"] == [0, 0, 1]).all()
    corners = {(round(x, 4), round(y, 4)) for x, y, _ in points["point"]}
    assert corners == {(2, 3.5), (4, 3.5), (2, 4.5), (4, 4.5)}
    assert len(set(points["feature"])) == 4
    apart = Pose((3, 4, 0.30))
    assert len(query.manifold(mw.Plane(), Pose(), box, apart)) == 0
    near = query.manifold(mw.Plane(), Pose(), box, apart, margin=0.1)
    assert near["separation"] == pytest.approx(0.05, abs=1e-6)


def test_rays():
    ball = mw.Sphere(0.5)
    ray = mw.Ray(origin=(-3, 0.3, 0), direction=(2, 0, 0))
    hit = query.ray_cast(ball, Pose(), ray)
    assert hit.distance == pytest.approx(3 - 0.4, abs=1e-6)
    assert hit.normal == pytest.approx([-0.8, 0.6, 0], abs=1e-6)
    assert query.ray_cast(ball, Pose((0, 1, 0)), ray) is None
    assert query.ray_cast(ball, Pose(), mw.Ray(origin=(-3, 0, 0), length=2)) is None
    assert query.ray_cast(ball, Pose((-3, 0, 0)), mw.Ray(origin=(-3, 0, 0))).distance == 0
    hit = query.ray_cast(mw.Circle(1), Pose((0, 5, 0)), mw.Ray(direction=(0, 1, 0)))
    assert hit.distance == pytest.approx(4, abs=1e-6)


def test_what_is_wrong_is_said_with_its_place():
    with pytest.raises(mw.SceneError, match="body 0 'a', shape 0: radius is -1") as caught:
        query.distance(mw.Sphere(-1), Pose(), mw.Sphere())
    assert caught.value.issues[0].message.startswith("is -1")
    with pytest.raises(ValueError, match="both shapes are planes"):
        query.distance(mw.Plane(), Pose(), mw.Plane())
    with pytest.raises(ValueError, match="neither shape can belong to a body that moves"):
        query.manifold(mw.Plane(), Pose(), mw.Plane())
    with pytest.raises(TypeError, match="pose_a.*Pose"):
        query.overlap(mw.Sphere(), (0, 0, 0), mw.Sphere())
    with pytest.raises(TypeError, match="a is of type int.*Shape"):
        query.overlap(1, Pose(), mw.Sphere())
    with pytest.raises(ValueError, match="space.*'spatal'.*'spatial'"):
        query.overlap(mw.Capsule(), Pose(), mw.Capsule(), space="spatal")
    with pytest.raises(mw.SceneError, match="rotation"):
        query.overlap(mw.Sphere(), Pose(rotation=(0, 0, 0, 0)), mw.Sphere())
    with pytest.raises(TypeError, match="margin"):
        query.manifold(mw.Plane(), Pose(), mw.Sphere(), margin="much")
    with pytest.raises(ValueError, match="direction not zero"):
        query.ray_cast(mw.Sphere(), Pose(), mw.Ray(direction=(0, 0, 0)))
