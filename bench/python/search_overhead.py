"""What a search costs beside stepping: processor time of a generation of 10,000 candidates.

    python bench/python/search_overhead.py [--candidates 10000] [--json FILE]

Asking and telling by strategy and number of parameters; what trying costs beside the steps (resets, numbers written,
hashes) and the steps themselves for the examples; the table and its Parquet file. One thread.
"""

import argparse
import importlib.util
import json
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np

import manyworlds as mw
from manyworlds import search

EXAMPLES = Path(__file__).parents[2] / "examples" / "python"


def example(name: str) -> Any:
    spec = importlib.util.spec_from_file_location(name, EXAMPLES / f"{name}.py")
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def spent(call: Callable[[], Any], repeats: int = 3) -> float:
    """Processor seconds of a call, the least of some."""
    times = []
    for _ in range(repeats):
        began = time.process_time()
        call()
        times.append(time.process_time() - began)
    return min(times)


def strategies(n: int) -> dict[str, float]:
    """Seconds of a generation by strategy and parameters."""
    out = {}
    for dimensions in (2, 8, 32):
        space = search.Space(*(search.Parameter(f"p{i}", 0, 1) for i in range(dimensions)))
        for strategy in (search.Random(n), search.Sobol(n), search.CmaEs(n)):
            hunt = search.Search(space, strategy, seed=1)

            def generation(hunt: search.Search = hunt) -> None:
                hunt.tell(((hunt.ask().values - 0.3) ** 2).sum(axis=1))

            out[f"{type(strategy).__name__}, {dimensions} parameters"] = spent(generation)
    return out


def trials(n: int) -> dict[str, dict[str, float]]:
    """Seconds of a generation: until worlds can step, of steps and what is called in them, and of judging."""
    bridge, launcher = example("bridge"), example("launcher")
    task = mw.tasks.load("BirdSling")
    shots = search.Space(*(search.Parameter(a.name, a.low, a.high) for a in task.actions))
    truss = bridge.make_scene(), bridge.make_space(), bridge.mass_and_load, bridge.STEPS
    sling = launcher.make_scene(), launcher.make_space(), lambda run: run["counterweight"]
    made = {
        "bridge": search.Trial(*truss, threads=1, observe=["joint_loads"]),
        "launcher": search.Trial(*sling, drive=launcher.throw, threads=1),
        "BirdSling": search.TaskTrial(task, shots, threads=1),
    }
    out = {}
    for name, trial in made.items():
        values = trial.space.values(np.random.default_rng(1).random((n, len(trial.space))))
        seeds = np.ones(n, np.uint64)
        held = trial._make(n)
        run = trial._begin(held, values, seeds)
        out[name] = {
            "begin": spent(lambda: trial._begin(held, values, seeds)),
            "step": spent(lambda: trial._play(run), 1),
            "judge": spent(lambda: trial._judge(run)),
        }
        held.close()
    return out


def table(n: int) -> tuple[float, float]:
    """Seconds of a table of 10 generations, and of its file."""
    space = search.Space(*(search.Parameter(f"p{i}", 0, 1) for i in range(8)))
    hunt = search.Search(space, search.Random(n), seed=1)
    for _ in range(10):
        hunt.tell(hunt.ask().values.sum(axis=1))
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "found.parquet"
        return spent(hunt.results.table), spent(lambda: hunt.results.save(file))


def main(argv: Sequence[str] | None = None) -> dict[str, Any]:
    p = argparse.ArgumentParser(description=(__doc__ or "").split("\n")[0])
    p.add_argument("--candidates", type=int, default=10_000)
    p.add_argument("--json", help="a file for the numbers")
    o = p.parse_args(argv)
    found = {"strategies": strategies(o.candidates), "trials": trials(o.candidates)}
    for name, seconds in found["strategies"].items():
        print(f"{name:28} {1000 * seconds:8.1f} ms a generation")
    for name, parts in found["trials"].items():
        told = ", ".join(f"{part} {1000 * seconds:.0f}" for part, seconds in parts.items())
        print(f"{name:28} {told} ms a generation")
    found["table"] = table(o.candidates)
    print(
        f"{'table, file of 10':28} {1000 * found['table'][0]:8.1f} ms, {1000 * found['table'][1]:.1f} ms"
    )
    if o.json:
        Path(o.json).write_text(json.dumps(found, indent=1))
    return found


if __name__ == "__main__":
    main()
