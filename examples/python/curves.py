"""Learning curves of ppo.py as an SVG: mean return over wall time, one line per run.

pip install matplotlib
python curves.py lander1.json lander2.json --out curves.svg
"""

import argparse
import json
from collections.abc import Sequence
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402  (the back end is chosen first)


def main(argv: Sequence[str] | None = None) -> None:
    p = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    p.add_argument("files", nargs="+", type=Path)
    p.add_argument("--out", default="curves.svg")
    o = p.parse_args(argv)
    runs = [json.loads(file.read_text(encoding="utf-8")) for file in o.files]
    tasks = list(dict.fromkeys(run["task"] for run in runs))
    figure, all_axes = plt.subplots(
        1, len(tasks), figsize=(4.5 * len(tasks), 3.2), layout="constrained", squeeze=False
    )
    for axes, task in zip(all_axes[0], tasks):
        for run in (r for r in runs if r["task"] == task):
            points = [(c["seconds"], c["return"]) for c in run["curve"]]
            axes.plot(*zip(*points), label=f"seed {run['seed']}")
        axes.set(title=task, xlabel="wall time, s", ylabel="mean return", xlim=(0, None))
        axes.grid(alpha=0.3)
        axes.legend()
    figure.savefig(o.out)


if __name__ == "__main__":
    main()
