"""Pictures: what is where it is, in which colour, and in front of what."""

import numpy as np
import pytest

import manyworlds as mw

pytest.importorskip("matplotlib")
import manyworlds.plot as plot  # noqa: E402
from manyworlds.plot import pieces, solids  # noqa: E402


def color(index):
    return np.array(pieces.rgb(solids.PALETTE[index])) * 255


def planar_ball(**ball):
    scene = mw.Scene(space="planar", options=mw.Options(gravity=(0, -10, 0)))
    scene.add(mw.Body(motion="fixed", shapes=[mw.Shape(geometry=mw.HalfPlane())]))
    scene.add(mw.Body(shapes=[mw.Shape(geometry=mw.Circle(0.5))], **ball))
    return scene


def test_a_ball_is_drawn_where_it_is():
    batch = mw.Batch(planar_ball(position=(1, 2, 0)), worlds=3)
    batch.set("position", [[[3.0, 1.0]]], ids=[2])
    made = plot.Picture(batch.plan.scene, size=(400, 300), view=((0, 4), (-0.5, 2.5)))

    def at(frame, x, y):
        return frame[int((2.5 - y) * 100), int(x * 100)].astype(float)

    for world, (x, y) in ((0, (1, 2)), (2, (3, 1))):
        frame = made.frame(batch, world)
        assert frame.shape == (300, 400, 3) and frame.dtype == np.uint8
        np.testing.assert_allclose(at(frame, x - 0.2, y), color(1), atol=2)
        np.testing.assert_allclose(at(frame, x - 0.4, y + 0.2), color(1), atol=2)
        np.testing.assert_array_equal(at(frame, x - 0.45, y + 0.45), 255)  # beside it
        assert (at(frame, 2, -0.25) < 230).all()  # the ground
        other = (3, 1) if world == 0 else (1, 2)
        np.testing.assert_array_equal(at(frame, *other), 255)


def test_what_is_not_there_is_not_drawn():
    batch = mw.Batch(planar_ball(position=(0, 1, 0)), worlds=2)
    made = plot.Picture(batch.plan.scene)
    there = made.frame(batch)
    batch.set_enabled(False, bodies=1)
    gone = made.frame(batch)
    assert (there != gone).any(axis=2).sum() > 1000
    # A world that was lost in the meantime has no pose to draw.
    batch.set_enabled(True, bodies=1)
    batch.set("position", [[[np.nan, 1.0]]], ids=[1])
    np.testing.assert_array_equal(made.frame(batch, 1), gone)


def test_sizes_that_vary_are_seen():
    scene = planar_ball(position=(0, 1, 0))
    scene.add(mw.vary("size", 0.25, 0.9, body=1))
    batch = mw.Batch(scene, worlds=2)
    for radius in (0.25, 0.9):
        sizes = batch.get("size")
        sizes[:, 1, 0] = radius
        batch.set("size", sizes)
        made = plot.Picture(scene, size=(800, 800), view=((-2, 2), (-1, 3)))
        with_ball = made.frame(batch)
        batch.set_enabled(False, bodies=1)
        area = (with_ball != made.frame(batch)).any(axis=2).sum() / 200**2  # m^2
        batch.set_enabled(True, bodies=1)
        assert area == pytest.approx(np.pi * radius**2, rel=0.07)


def test_the_nearer_one_hides_the_farther_one():
    scene = mw.Scene()
    for x in (-2, 0):
        scene.add(mw.Body(position=(x, 0, 0), shapes=[mw.Shape(geometry=mw.Sphere(0.5))]))
    batch = mw.Batch(scene)
    for azimuth, nearest in ((0, 1), (180, 0)):  # from +x, from -x
        camera = plot.Camera(azimuth=azimuth, elevation=0)
        made = plot.Picture(scene, size=(200, 200), view=((-1, 1), (-1, 1)), camera=camera)
        np.testing.assert_allclose(made.frame(batch)[80, 100], color(nearest), atol=2)


@pytest.mark.parametrize("name", ["Pendulum", "Acrobot"])
def test_what_swings_stays_in_view(name):
    scene = mw.tasks.load(name).scene
    made = plot.Picture(scene)
    (left, right), (bottom, top) = made.view
    tip = sum(2.0 * s.geometry.vertices[2][1] for b in scene.bodies for s in b.shapes[:1])
    assert tip > 0.5  # m, how far all links reach from the pivot, which is the origin
    assert left < -tip and right > tip and bottom < -tip and top > tip
    assert top - bottom < 4 * tip


def test_corners_outlines_and_faces():
    box = mw.surface(mw.Box((1, 2, 3)))
    faces = solids.patches_of(box)
    assert sorted(map(len, faces)) == [4] * 6
    for face in faces:
        a, b, c = box.points[face[:3]]
        assert np.cross(b - a, c - a) @ box.points[face].mean(axis=0) > 0  # seen from outside
    cylinder = mw.surface(mw.Cylinder(1, 2))
    assert sorted(map(len, solids.patches_of(cylinder))) == [3] * 48 + [24] * 2
    hull = mw.make_hull(np.random.default_rng(3).normal(size=(30, 3)))
    look = mw.surface(hull)
    faces = solids.patches_of(look)
    edges = sum(map(len, faces)) / 2
    assert len(look.lines) == edges
    assert len(hull.vertices) - edges + len(faces) == 2  # Euler
    circle = solids.outline_of(mw.surface(mw.Circle(2.0), "planar").points[:, :2])
    np.testing.assert_allclose(np.hypot(*circle.T), 2)
    x, y = solids.outline_of(np.array([[0.0, 0], [3, 0], [1, 0], [3, 2], [0, 2]])).T
    assert 0.5 * abs(np.dot(x, np.roll(y, 1)) - np.dot(y, np.roll(x, 1))) == pytest.approx(6)


@pytest.mark.parametrize("name", mw.scenes.names())
def test_every_scene_has_a_picture(name):
    batch = mw.Batch(name, worlds=2)
    frame = plot.Picture(batch.plan.scene, size=(150, 100)).frame(batch, 1)
    assert frame.shape == (100, 150, 3) and frame.std() > 1
    axes = plot.draw(batch, 1, size=(150, 100))
    assert axes.figure.get_size_inches().tolist() == [1.5, 1.0]


def test_environments_render():
    gymnasium = pytest.importorskip("gymnasium")
    import manyworlds.gym

    env = gymnasium.make("manyworlds/LunarLander-v0", render_mode="rgb_array")
    assert env.metadata["render_fps"] > 10
    env.reset(seed=1)
    first = env.render()
    for _ in range(20):
        env.step(2)
    assert (first != env.render()).any()

    envs = gymnasium.make_vec("manyworlds/BallBalance-v0", num_envs=3, render_mode="rgb_array")
    envs.reset(seed=1)
    frames = envs.render()
    assert len(frames) == 3 and frames[0].shape == first.shape
    assert (frames[0] != frames[1]).any()
    alone = manyworlds.gym.Env("BallBalance", render_mode="rgb_array")
    alone.reset(seed=3)  # of world 2
    np.testing.assert_array_equal(alone.render(), frames[2])
    quiet = gymnasium.make_vec("manyworlds/CartPole-v0", num_envs=2)
    assert quiet.unwrapped.render() is None


def test_wrong_arguments_are_errors():
    batch = mw.Batch(planar_ball())
    made = plot.Picture(batch.plan.scene)
    with pytest.raises(IndexError, match="world is 1"):
        made.draw(batch, 1)
    other = planar_ball()
    other.bodies[1].shapes[0].geometry = mw.Circle(0.6)
    for another in ("stack10", "ball3d", other):
        with pytest.raises(ValueError, match="another scene"):
            made.draw(mw.Batch(another))
    scene = batch.plan.scene
    for arguments, error, words in (
        (dict(size=(0, 10)), ValueError, "size is 0"),
        (dict(size=(5, 5.5)), TypeError, "size is of type float"),
        (dict(size=5), ValueError, "size has shape"),
        (dict(size=(5, 5, 5)), ValueError, "size has shape"),
        (dict(view=(1, 2)), ValueError, "view has shape"),
        (dict(view=((1, 0), (0, 1))), ValueError, "lower values first"),
        (dict(view=((0, np.nan), (0, 1))), ValueError, "lower values first"),
        (dict(camera=None), TypeError, "expected a Camera"),
    ):
        with pytest.raises(error, match=words):
            plot.Picture(scene, **arguments)
    with pytest.raises(ValueError, match="angles must be finite"):
        plot.Camera(azimuth=np.nan)
    with pytest.raises(TypeError, match="expected a Scene"):
        plot.Picture("stack10")
    with pytest.raises(TypeError, match="expected a Batch"):
        plot.draw(mw.Environment("CartPole"))


def test_worlds_that_fly_apart_have_pictures(recwarn):
    batch = mw.Batch("stack10", worlds=3)
    x = batch.get("position")
    x[0, 0], x[1, 0], x[2] = 1e20, 1e7, np.inf
    batch.set("position", x)
    made = plot.Picture(batch.plan.scene)
    for world in range(3):
        assert made.frame(batch, world).std() > 1
    assert not recwarn.list
