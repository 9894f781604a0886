"""Design search: the shot that displaces most boxes, by CMA-ES over BirdSling.

    pip install "manyworlds-sim[search]"
    python design_search.py --generations 8

One world is one candidate: 10,000 shots a generation, all of them simulated at once.
"""

import argparse
from collections.abc import Sequence

import manyworlds as mw
from manyworlds import search


def main(argv: Sequence[str] | None = None) -> list[tuple[float, float]]:
    """(mean, best) of each generation."""
    p = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    p.add_argument("--candidates", type=int, default=10_000, help="of a generation")
    p.add_argument("--generations", type=int, default=8)
    p.add_argument("--threads", type=int)
    p.add_argument("--table", help="a Parquet file of all candidates")
    o = p.parse_args(argv)

    task = mw.tasks.load("BirdSling")
    space = search.Space(*(search.Parameter(a.name, a.low, a.high) for a in task.actions))
    trial = search.TaskTrial(task, space, threads=o.threads)
    # Few shots hit anything: the best twentieth says where to look.
    strategy = search.CmaEs(o.candidates, sigma=0.3, parents=o.candidates // 20)
    hunt = search.Search(trial, strategy, "maximize", seed=1)
    found = hunt.run(o.generations, file=o.table, on_generation=print)
    print(", ".join(f"{name} {x:.3f}" for name, x in found.best.values.items()))
    return [(float(g.value.mean()), float(g.value.max())) for g in found.generations]


if __name__ == "__main__":
    main()
