"""manyworlds.search: numbers of a scene that candidates differ by."""

import numpy as np

import manyworlds as mw
from manyworlds import search
from manyworlds.search import Number, Parameter, Space


def height(run: search.Run) -> np.ndarray:
    return run.batch.get("position")[:, 0, 2].astype(float)


def test_where_shapes_and_attractors_are_is_searched():
    planets = mw.Scene(name="planets")
    ball = mw.Shape(geometry=mw.Sphere(0.1))
    planets.add(mw.Body(name="ball", position=(0, 0, 1), shapes=[ball]))
    planets.attractors = [mw.Attractor(position=(3, 0, 0), strength=1.0), mw.Attractor()]
    space = Space(
        Parameter("pull", 1, 5, sets=Number("attractor_strength", attractor=0)),
        Parameter("out", 0, 0.2, sets=Number("shape_position", "ball", component=0)),
    )
    values = space.values(np.random.default_rng(1).random((5, 2)))
    seen = {}

    def look(run):
        names = "attractor_strength", "shape_position"
        seen.update({name: run.batch.get(name) for name in names})

    with search.Trial(planets, space, height, 5, begin=look, threads=1) as tried:
        tried.evaluate(values, np.arange(5, dtype=np.uint64))
    assert (seen["attractor_strength"][:, 0, 0] == values[:, 0]).all()
    assert (seen["attractor_strength"][:, 1, 0] == 0).all()
    assert (seen["shape_position"][:, 0, 0] == values[:, 1]).all()
    assert (seen["shape_position"][:, 0, 1:] == 0).all()
