"""Learning curves of ppo.py as a picture: mean return over time or steps, one line per run.

pip install matplotlib
python curves.py lander1.json lander2.json --out curves.svg
"""

import argparse
import json
from collections.abc import Callable, Sequence
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402  (the back end is chosen first)

# What the horizontal axis may be, of a row of a curve.
AXES: dict[str, tuple[str, Callable[[dict[str, float]], float]]] = {
    "seconds": ("wall time, s", lambda row: row["seconds"]),
    "processor": (
        "processor time, s",
        lambda row: row["stepping"] + row["acting"] + row["learning"],
    ),
    "steps": ("environment steps, millions", lambda row: row["steps"] / 1e6),
}


def main(argv: Sequence[str] | None = None) -> None:
    p = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    p.add_argument("files", nargs="+", type=Path)
    p.add_argument("--over", choices=list(AXES), default="seconds")
    p.add_argument("--out", default="curves.svg")
    o = p.parse_args(argv)
    runs = [json.loads(file.read_text(encoding="utf-8")) for file in o.files]
    tasks = list(dict.fromkeys(run["task"] for run in runs))
    figure, all_axes = plt.subplots(
        1, len(tasks), figsize=(4.5 * len(tasks), 3.2), layout="constrained", squeeze=False
    )
    label, over = AXES[o.over]
    for axes, task in zip(all_axes[0], tasks):
        for run in (r for r in runs if r["task"] == task):
            points = [(over(row), row["return"]) for row in run["curve"]]
            axes.plot(*zip(*points), label=f"seed {run['seed']}")
        axes.set(title=task, xlabel=label, ylabel="mean return", xlim=(0, None))
        axes.grid(alpha=0.3)
        axes.legend()
    figure.savefig(o.out, dpi=110)


if __name__ == "__main__":
    main()
