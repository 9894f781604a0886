"""Surfaces as arrays; what they are is tested in C++."""

import numpy as np
import pytest

import manyworlds as mw


def test_arrays_of_a_surface():
    look = mw.surface(mw.Box((1, 2, 3)))
    assert look.points.shape == look.normals.shape == (24, 3) and look.points.dtype == np.float64
    assert look.triangles.shape == (12, 3) and look.faces.tolist()[1] == [4, 4]
    np.testing.assert_array_equal(np.abs(look.points), np.tile([1.0, 2, 3], (24, 1)))
    a, b, c = np.moveaxis(look.points[look.triangles], 1, 0)
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    assert area.sum() == pytest.approx(8 * (2 + 3 + 6))
    assert len(look.lines) == 6 and look.marks == []
    capsule = mw.surface(mw.Capsule(), "planar", around=8)
    assert (capsule.points[:, 2] == 0).all() and (capsule.normals == (0, 0, 1)).all()
    assert mw.surface(mw.Segment((0, 0), (1, 0))).triangles.shape == (0, 3)


def test_ground_ends_where_it_is_told_to():
    ground = mw.surface(mw.Plane(), low=(-1, -2, -1), high=(1, 2, 1))
    np.testing.assert_allclose(ground.points.min(axis=0), (-1, -2, 0))
    np.testing.assert_allclose(ground.points.max(axis=0), (1, 2, 0))


def test_what_is_refused():
    with pytest.raises(ValueError, match="around is 3, must be 8 to 1024"):
        mw.surface(mw.Sphere(), around=3)
    with pytest.raises(mw.SceneError, match="radius is -1 m"):
        mw.surface(mw.Sphere(-1))
    with pytest.raises(TypeError, match="geometry"):
        mw.surface(3)
    with pytest.raises(ValueError, match="flat"):
        mw.surface(mw.Sphere(), "flat")
