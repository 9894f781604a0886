"""A picture of every task that has a name, after some random actions: docs/tasks.png.

pip install "manyworlds-sim[plot]"
python gallery.py --out tasks.png
"""

import argparse
from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from numpy.typing import NDArray

import manyworlds as mw
from manyworlds.plot import Picture

COLUMNS = 4


def actions_of(env: mw.Environment, random: np.random.Generator) -> NDArray[Any]:
    if env.discrete:
        return random.integers(env.task.choices, size=env.worlds)
    low, high = np.array([(a.low, a.high) for a in env.task.actions]).T
    return random.uniform(low, high, env.action_shape)


def main(argv: Sequence[str] | None = None) -> None:
    p = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    p.add_argument("--steps", type=int, default=30)
    p.add_argument("--seed", type=int, default=3)
    p.add_argument("--out", default="tasks.png")
    o = p.parse_args(argv)

    names = mw.tasks.names()
    rows = -(-len(names) // COLUMNS)
    figure = Figure(figsize=(3 * COLUMNS, 2.2 * rows), dpi=100, layout="constrained")
    axes = figure.subplots(rows, COLUMNS).ravel()
    for ax in axes:
        ax.set_axis_off()
    random = np.random.default_rng(o.seed)
    for ax, name in zip(axes, names):
        env = mw.Environment(name, seed=o.seed, threads=1)
        for _ in range(o.steps):
            env.step(actions_of(env, random))
        Picture(env.task.scene, size=(300, 200)).draw(env.batch, ax=ax)
        ax.set_title(name)
    FigureCanvasAgg(figure).print_figure(o.out)


if __name__ == "__main__":
    main()
