"""Scenes and batches that the tests share."""

from __future__ import annotations

import os

import pytest

import manyworlds as mw


@pytest.hookimpl(wrapper=True)
def pytest_runtest_call():
    """Where a build has float32 alone (the sanitizers'), what needs float64 is skipped."""
    try:
        return (yield)
    except ValueError as error:
        if os.environ.get("MW_PRECISIONS") == "f32" and "no kernels" in str(error):
            pytest.skip(str(error))
        raise


def lander(**arguments: object) -> mw.Batch:
    """Joints, controls, contacts, planar."""
    return mw.Batch("lunar-lander", **{"worlds": 5, "threads": 1, "seed": 3, **arguments})


def crates(bodies: int = 3) -> mw.Scene:
    """Boxes that tumble onto a plane, with frictions and masses that vary; spatial."""
    ground = mw.Body(motion="fixed", shapes=[mw.Shape(geometry=mw.Plane())])
    scene = mw.Scene(name="crates", bodies=[ground])
    for i in range(bodies):
        scene.add(
            mw.Body(
                name=f"crate{i}",
                position=(0.2 * i, 0, 1 + 1.2 * i),
                shapes=[mw.Shape(geometry=mw.Box((0.5, 0.4, 0.3)), position=(0.1, 0, 0))],
                jitter=mw.Jitter(position=(0.2, 0.2, 0.1), any_orientation=True),
            )
        )
    scene.add(mw.vary("friction", 0.2, 0.9))
    scene.add(mw.vary("mass", 1, 5, body=1))
    return scene


@pytest.fixture
def batch() -> mw.Batch:
    return mw.Batch(crates(), worlds=6, threads=1, seed=5)
