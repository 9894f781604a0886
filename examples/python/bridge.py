"""A bridge that carries a load with least mass: CMA-ES over the thickness of a truss's bars.

    pip install "manyworlds-sim[search]"
    python bridge.py --page bridge.html

A Warren truss of timber: bars hinged to iron nodes, on a pin and a roller, and a crate that hangs from each inner
node of the deck. One world is one candidate. It hangs until it is still; then no bar may be torn, crushed or buckled by
what its hinges bear. Bars left and right of the middle are alike.
"""

import argparse
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

import manyworlds as mw
from manyworlds import search

PANELS, PANEL, HEIGHT = 4, 2.0, 1.6  # of the deck, m; up to the upper chord, m
DEPTH = 0.2  # m, of bars, out of the plane
DENSITY, IRON = 500.0, 4000.0  # kg/m^3, of bars and nodes
NODE = 0.1  # m, radius of nodes
STRENGTH, STIFFNESS = 12e6, 1e10  # Pa: what timber bears, and Young's modulus
CRATE = 500.0  # kg
GRAVITY = 9.81
STEPS = 120  # 2 s
Array = NDArray[Any]


def nodes() -> Array:
    """(nodes, 2), m: those of the deck, then those of the upper chord."""
    deck = [(PANEL * i, 0.0) for i in range(PANELS + 1)]
    return np.array(deck + [(PANEL * (i + 0.5), HEIGHT) for i in range(PANELS)])


def bars() -> list[tuple[int, int]]:
    """Which nodes each one joins: the deck, the upper chord, the diagonals."""
    top = PANELS + 1
    deck = [(i, i + 1) for i in range(PANELS)]
    upper = [(top + i, top + i + 1) for i in range(PANELS - 1)]
    return deck + upper + [(i + j, top + i) for i in range(PANELS) for j in range(2)]


def groups() -> list[str]:
    """Of each bar the name that it shares with its mirror image."""
    out = []
    for a, b in bars():
        kind = "deck" if b <= PANELS else "upper" if a > PANELS else "diagonal"
        off = abs(nodes()[[a, b], 0].mean() - PANEL * PANELS / 2)
        out.append(f"{kind} {off:g} m off")
    return out


def make_scene() -> mw.Scene:
    scene = mw.Scene(name="bridge", space="planar")
    scene.options = mw.Options(gravity=(0, -GRAVITY, 0), substeps=16)
    ghost = mw.Filter(mask=0)

    def add(name: str, at: Sequence[float], shape: mw.Shape, angle: float = 0.0) -> None:
        turn = np.cos(angle / 2), 0, 0, np.sin(angle / 2)
        body = mw.Body(name=name, position=(*at, 0), rotation=turn, shapes=[shape])
        body.linear_drag = body.angular_drag = 5  # 1/s: it is still within 2 s
        scene.add(body)

    def join(a: int | str, b: str, at: Sequence[float], type: mw.JointType) -> None:
        scene.add(scene.joint_at(a, b, mw.Frame((*at, 0)), type))

    for i, at in enumerate(nodes()):
        disc = mw.Circle(NODE)
        add(f"node{i}", at, mw.Shape(geometry=disc, density=IRON * DEPTH, filter=ghost))
    for i, (a, b) in enumerate(bars()):
        ends = nodes()[[a, b]]
        x, y = ends[1] - ends[0]
        beam = mw.Polygon.box(np.hypot(x, y) / 2, 0.05)
        shape = mw.Shape(geometry=beam, density=DENSITY * DEPTH, filter=ghost)
        add(f"bar{i}", ends.mean(axis=0), shape, np.arctan2(y, x))
        for node, at in zip((a, b), ends):
            join(f"node{node}", f"bar{i}", at, mw.HingeJoint())
    for i in range(1, PANELS):
        x, y = nodes()[i]
        box = mw.Shape(geometry=mw.Polygon.box(0.4, 0.4), density=CRATE / 0.64, filter=ghost)
        add(f"crate{i}", (x, y - 0.8), box)
        join(f"node{i}", f"crate{i}", (x, y), mw.HingeJoint())
    join(-1, "node0", nodes()[0], mw.FixedJoint())
    join(-1, f"node{PANELS}", nodes()[PANELS], mw.SliderJoint())
    return scene


def make_space() -> search.Space:
    """How thick the bars of each group are, m."""

    def sets(group: str) -> list[search.Number]:
        mine = [i for i, g in enumerate(groups()) if g == group]
        return [search.Number("size", f"bar{i}", 0, component=1, factor=0.5) for i in mine]

    names = list(dict.fromkeys(groups()))
    return search.Space(*(search.Parameter(g, 0.003, 0.2, "log", sets=sets(g)) for g in names))


def mass_and_load(run: search.Run) -> search.Score:
    """kg of the bars, and by how much each has more to bear than it can."""
    thick = np.stack([run[g] for g in groups()], axis=1)  # (worlds, bars)
    along = np.diff(nodes()[np.array(bars())], axis=1)[:, 0]
    length = np.hypot(*along.T)
    hinges = run.batch.get("joint_force")[:, : 2 * len(length)].reshape(len(thick), -1, 2, 2)
    pulls = (hinges.astype(float) * (along / length[:, None])[:, None]).sum(axis=-1) * [-1, 1]
    area, second_moment = thick * DEPTH, thick**3 * DEPTH / 12
    torn = pulls.max(axis=2) / (STRENGTH * area) - 1
    crushed = -pulls.min(axis=2) / (STRENGTH * area) - 1
    buckled = -pulls.min(axis=2) / (np.pi**2 * STIFFNESS * second_moment / length**2) - 1
    mass = (area * length * DENSITY).sum(axis=1)
    return search.Score(mass, np.concatenate([torn, crushed, buckled], axis=1))


def main(argv: Sequence[str] | None = None) -> search.Results:
    p = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    p.add_argument("--candidates", type=int, default=1000, help="of a generation")
    p.add_argument("--generations", type=int, default=25)
    p.add_argument("--seed", type=int, default=1)
    p.add_argument("--threads", type=int)
    p.add_argument("--table", help="a Parquet file of all candidates")
    p.add_argument("--page", help="an HTML file that shows the best bridge")
    o = p.parse_args(argv)

    trial = search.Trial(
        make_scene(), make_space(), mass_and_load, STEPS, threads=o.threads, observe=["joint_loads"]
    )
    hunt = search.Search(trial, search.CmaEs(o.candidates), seed=o.seed)
    found = hunt.run(o.generations, file=o.table, on_generation=print)
    best = found.best
    print(f"{best.value:.1f} kg carry {CRATE * (PANELS - 1):.0f} kg, with bars of")
    for name, thick in best.values.items():
        print(f"  {1000 * thick:5.1f} mm  {name} the middle")
    if o.page:
        with hunt.record(f"{o.page}.h5") as recording:
            mw.write_page([recording], o.page, title=f"A bridge of {best.value:.1f} kg")
    return found


if __name__ == "__main__":
    main()
