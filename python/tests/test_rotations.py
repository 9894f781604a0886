"""What setters of states and of numbers of the scene refuse."""

import numpy as np
import pytest

import manyworlds as mw


@pytest.mark.parametrize("space", ["planar", "spatial"])
def test_an_orientation_is_of_length_1(space):
    scene = mw.scenes.load("lunar-lander" if space == "planar" else "stack10")
    batch = mw.Batch(scene, worlds=3)
    width = 2 if space == "planar" else 4
    before = batch.hashes()
    unit = np.eye(width)[0]
    infinite = np.where(unit == 1, np.inf, 0)
    for wrong in (0, unit * 0, unit * 2, unit * 1.01, unit * np.nan, infinite):
        for call in (
            lambda: batch.set("orientation", wrong),
            lambda: batch.set("orientation", wrong, ids=[1]),
            lambda: batch.rollout({"orientation": wrong}, steps=1),
        ):
            with pytest.raises(ValueError, match=r"orientation of row 0 in world . is .* of length 1:"):
                call()
    with pytest.raises(ValueError, match=r"orientation of row . in world ."):
        batch.randomize("orientation", -2, 2)
    assert (batch.hashes() == before).all()
    batch.set("orientation", unit * (1 + 1e-4))
    turned = batch.get("orientation")
    batch.set("orientation", turned)
    assert (batch.get("orientation") == turned).all()
    body = batch.body_in_row(0)
    for wrong in (0, unit * np.nan):
        with pytest.raises(ValueError, match="orientation is .*; expected finite numbers, not of length"):
            batch.spawn(body, 1.0, orientation=wrong)


def test_numbers_of_the_scene_that_are_not_finite_are_refused():
    scene = mw.scenes.load("stack10")
    scene.add(mw.vary("density", 100, 1000))
    batch = mw.Batch(scene, worlds=2)
    for wrong in (np.nan, np.inf, -1, 0):
        with pytest.raises(ValueError, match="density"):
            batch.set("density", wrong)
