"""Scenes: dataclasses that are the library's structs, member by member."""

import copy
import dataclasses
import pickle

import numpy as np
import pytest

import manyworlds as mw
from conftest import crates
from manyworlds import _core, names


def test_every_default_is_the_librarys():
    for name, value in _core.default_values().items():
        assert getattr(mw, name)() == value


@pytest.mark.parametrize("name", mw.scenes.names())
def test_scenes_come_back_as_they_went(name):
    scene = mw.scenes.load(name)
    assert scene.validate() == []
    assert _core.round_trip(scene) == scene
    assert pickle.loads(pickle.dumps(scene)) == copy.deepcopy(scene) == scene


def test_names_are_those_of_the_type_hints():
    for kind, known in mw.enumerations().items():
        if kind != "Status":
            assert getattr(names, kind).__args__ == known
    assert tuple(mw.Status.__members__) == mw.enumerations()["Status"]
    for value, name in enumerate(mw.enumerations()["Status"][1:]):
        assert mw.Status[name] == 1 << value


def test_sized_scenes_and_unknown_names():
    assert len(mw.scenes.load("pyramid2d:3").bodies) == 7
    with pytest.raises(ValueError, match="nearest: 'stack10'"):
        mw.scenes.load("stack1")
    assert mw.scenes.summaries()["stack10"]


def test_arrays_and_lists_are_vectors():
    body = mw.Body(position=np.array([1, 2, 3]), rotation=[1, 0, 0, 0])
    hull = mw.Hull(np.random.default_rng(0).normal(size=(6, 3)))
    body.shapes = [mw.Shape(geometry=hull)]
    scene = _core.round_trip(mw.Scene(bodies=[body]))
    assert scene.bodies[0].position == (1.0, 2.0, 3.0)
    np.testing.assert_array_equal(scene.bodies[0].shapes[0].geometry.vertices, hull.vertices)


def test_issues_and_the_error_that_lists_them():
    scene = crates()
    scene.bodies[1].shapes[0].geometry.half_extents = (0.5, -1, 0.3)
    scene.options.dt = 0
    issues = scene.validate()
    assert [i.place for i in issues] == ["body 1 'crate0', shape 0: half_extents.y", "options.dt"]
    with pytest.raises(mw.SceneError, match="the scene has 2 issues") as error:
        mw.Batch(scene)
    assert error.value.issues == issues
    assert str(issues[0]) == "body 1 'crate0', shape 0: half_extents.y is -1 m, must be > 0"
    assert pickle.loads(pickle.dumps(error.value)).issues == issues


@pytest.mark.parametrize(
    "change, error, match",
    [
        (lambda s: setattr(s, "space", "planr"), ValueError, "scene.space is 'planr'.*'planar'"),
        (
            lambda s: setattr(s, "bodies", 3),
            TypeError,
            "scene.bodies is of type int; expected a list",
        ),
        (lambda s: setattr(s, "bodies", [3]), TypeError, r"scene.bodies\[0\] is of type int"),
        (
            lambda s: setattr(s.bodies[1], "position", (1, 2)),
            ValueError,
            "has 2 elements; expected 3",
        ),
        (lambda s: setattr(s.bodies[1], "position", "abc"), TypeError, r"bodies\[1\].position"),
        (lambda s: setattr(s.bodies[1], "position", (1, 2, "x")), TypeError, r"position\[2\]"),
        (lambda s: setattr(s.bodies[1], "position", None), TypeError, "NoneType"),
        (lambda s: setattr(s.bodies[1], "enabled", 1), TypeError, "expected a bool"),
        (lambda s: setattr(s.bodies[1], "name", b"x"), TypeError, "expected a str"),
        (lambda s: setattr(s.bodies[1], "motion", 1), TypeError, "motion is of type int"),
        (
            lambda s: setattr(s.bodies[1].shapes[0], "geometry", mw.Body()),
            TypeError,
            "one of Sphere",
        ),
        (lambda s: setattr(s.options, "substeps", 2.0), TypeError, "expected an integer"),
        (lambda s: setattr(s.options, "substeps", 2**40), ValueError, "must be -2147483648 to"),
        (lambda s: setattr(s.options, "dt", 10**400), ValueError, "float64"),
        (lambda s: setattr(s.options, "bounds", ((0, 0, 0),)), ValueError, "expected 2 corners"),
        (lambda s: setattr(s.bodies[1].shapes[0].filter, "mask", -1), ValueError, "must be 0 to"),
    ],
)
def test_wrong_values_are_named_by_their_place(change, error, match):
    scene = crates()
    change(scene)
    with pytest.raises(error, match=match):
        scene.validate()


def test_members_that_do_not_exist():
    with pytest.raises(TypeError, match="positon"):
        mw.Body(positon=(0, 0, 0))
    with pytest.raises(AttributeError):
        mw.Options().gravty = (0, 0, 0)
    with pytest.raises(TypeError, match="cannot add a Sphere"):
        mw.Scene().add(mw.Sphere())
    assert all(hasattr(getattr(mw, n), "__slots__") for n in _core.default_values())


def test_derived_values():
    scene = crates()
    assert scene.mass_properties(1).mass == pytest.approx(8 * 0.5 * 0.4 * 0.3 * 1000)
    joint = scene.joint_at(1, 2, mw.Frame((0, 0, 2)), mw.BallJoint(cone=1))
    assert joint.frame_a.position == (0, 0, 1) and joint.type == mw.BallJoint(cone=1)
    assert scene.joints == []
    with pytest.raises(IndexError, match="body_b is 9, must be -1 to 3"):
        scene.joint_at(1, 9, mw.Frame(), mw.FixedJoint())
    corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    assert sorted(mw.make_hull(corners + [(0.5, 0.5, 0.5)]).vertices) == sorted(corners)
    with pytest.raises(ValueError, match="lie in a plane"):
        mw.make_hull([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0)])
    faces = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
    tetrahedron = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    assert mw.mesh_mass_properties(tetrahedron, faces, 6).mass == pytest.approx(1)
    with pytest.raises(ValueError, match="must be >= 0 and < 4"):
        mw.mesh_mass_properties(tetrahedron, [(0, 2, 9)], 6)


def test_plans():
    plan = crates().compile(keep=["restitution"])
    assert plan.bodies == 3 and plan.scene.name == "crates"
    assert [plan.row(i) for i in range(1, 4)] == [0, 1, 2]
    assert plan.body_in_row(2) == 3 and plan.row("crate1") == 1
    assert plan.has("friction") and plan.has("restitution")
    assert not crates().compile().has("restitution")
    assert plan.fingerprint != crates(2).compile().fingerprint
    assert {a["name"] for a in plan.report()["arrays"]} >= {"position", "orientation"}
    chosen = {c["option"]: c["value"] for c in plan.report()["choices"]}
    assert plan.scene.options.substeps is None and plan.resolved.substeps == chosen["substeps"] == 13
    assert plan.resolved.contact.slop == chosen["contact.slop"] > 0 and "substeps" in plan.text()
    assert "friction" in plan.text() and "3 bodies" in repr(plan)
    with pytest.raises(ValueError, match="nearest: 'crate1'"):
        plan.row("crat1")
    with pytest.raises(IndexError, match="row is 3, must be 0 to 2"):
        plan.body_in_row(3)
    with pytest.raises(ValueError, match="broad_phase is 'x'"):
        crates().compile(broad_phase="x")


def test_fields_of_dataclasses_have_types():
    for name in _core.default_values():
        assert all(f.type for f in dataclasses.fields(getattr(mw, name)))
