"""A launcher: the least counterweight with which a trebuchet hits a mark, by CMA-ES.

    pip install "manyworlds-sim[search]"
    python launcher.py --mark 60 --page launcher.html

One world is one candidate: a counterweight, a ball and the step in which the sling lets go of it. The beam falls, the
ball flies, and where it first comes down is what counts: within a metre of the mark.
"""

import argparse
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

import manyworlds as mw
from manyworlds import search

PIVOT = 4.0  # m, height
SHORT, LONG = 1.0, 4.0  # m, arms of the beam
SLING = 2.5  # m
RADIUS = 0.15  # m, of the ball
TILT = np.radians(50)  # of the beam as it begins, the long arm down
STEPS, DT = 420, 1 / 60
Array = NDArray[Any]


def make_scene() -> mw.Scene:
    """The ball begins under the beam, on the ground, with its sling straight."""
    scene = mw.Scene(name="launcher", space="planar")
    scene.options = mw.Options(gravity=(0, -9.81, 0), dt=DT, substeps=8)
    ground = mw.Shape(geometry=mw.HalfPlane())
    scene.add(mw.Body(motion="fixed", shapes=[ground]))
    ghost = mw.Filter(mask=0)
    axis = np.array([np.cos(TILT), np.sin(TILT)])  # from the tip of the long arm to the short one's

    def add(name: str, at: Array, shape: mw.Shape, angle: float = 0.0) -> None:
        turn = np.cos(angle / 2), 0, 0, np.sin(angle / 2)
        scene.add(mw.Body(name=name, position=(*at, 0), rotation=turn, shapes=[shape]))

    pivot = np.array([0, PIVOT])
    tip, end = pivot - LONG * axis, pivot + SHORT * axis
    beam = mw.Polygon.box((SHORT + LONG) / 2, 0.08)
    add("beam", (tip + end) / 2, mw.Shape(geometry=beam, density=50, filter=ghost), TILT)
    box = mw.Shape(geometry=mw.Polygon.box(0.4, 0.4), density=1000, filter=ghost)
    add("counterweight", end - [0, 0.6], box)
    drop = tip[1] - RADIUS
    ball = np.array([tip[0] + np.sqrt(SLING**2 - drop**2), RADIUS])
    add("ball", ball, mw.Shape(geometry=mw.Circle(RADIUS), density=10 / (np.pi * RADIUS**2)))
    hinge = mw.HingeJoint()
    scene.add(scene.joint_at(-1, "beam", mw.Frame((*pivot, 0)), hinge))
    scene.add(scene.joint_at("beam", "counterweight", mw.Frame((*end, 0)), hinge))
    half = (SHORT + LONG) / 2
    rope = mw.Joint(name="sling", type=mw.DistanceJoint(limit=mw.Limit(0, SLING)))
    rope.body_a, rope.body_b, rope.frame_a = "beam", "ball", mw.Frame((-half, 0, 0))
    scene.add(rope)
    return scene


def make_space() -> search.Space:
    weight = search.Number("mass", "counterweight")
    return search.Space(
        search.Parameter("counterweight", 50, 5000, "log", sets=weight),  # kg
        search.Parameter("release", 10, 180, integer=True),  # step
    )


def throw(run: search.Run) -> dict[str, Array]:
    """Steps all worlds and lets go of each ball in its own step; where each one came down, m."""
    batch, row = run.batch, run.batch.row("ball")
    landed = np.full(batch.worlds, np.nan)
    for step in range(STEPS):
        now = run["release"] == step
        if now.any():
            batch.set_joints_enabled(False, "sling", ids=now)
        batch.step()
        x, y = batch.get("position")[:, row].astype(float).T
        down = np.isnan(landed) & (run["release"] < step) & (y < RADIUS + 0.01)
        landed[down] = x[down]
    return {"landed": landed}


def main(argv: Sequence[str] | None = None) -> search.Results:
    p = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    p.add_argument("--mark", type=float, default=60, help="m from the pivot")
    p.add_argument("--candidates", type=int, default=1000, help="of a generation")
    p.add_argument("--generations", type=int, default=15)
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("--threads", type=int)
    p.add_argument("--table", help="a Parquet file of all candidates")
    p.add_argument("--page", help="an HTML file that shows the best throw")
    o = p.parse_args(argv)

    def weight_and_miss(run: search.Run) -> search.Score:
        """kg, and how far from the metre around the mark the ball came down; what flies on is lost."""
        return search.Score(run["counterweight"], np.abs(run.fields["landed"] - o.mark) - 1)

    trial = search.Trial(
        make_scene(), make_space(), weight_and_miss, drive=throw, threads=o.threads
    )
    hunt = search.Search(trial, search.CmaEs(o.candidates), seed=o.seed)
    found = hunt.run(o.generations, file=o.table, on_generation=print)
    weight, release = found.best.values.values()
    print(f"{weight:.1f} kg, and {release * DT:.2f} s until the sling lets go")
    if o.page:
        with hunt.record(f"{o.page}.h5") as recording:
            mw.write_page([recording], o.page, title=f"{weight:.1f} kg throw 10 kg to {o.mark:g} m")
    return found


if __name__ == "__main__":
    main()
