"""Searches for the best parameters, with thousands of candidates at once, one per world.

    from manyworlds import search

    space = search.Space(
        search.Parameter("speed", 2, 20),
        search.Parameter("mass", 0.1, 10, "log", sets=search.Number("mass", body="ball")),
    )
    trial = search.Trial(scene, space, distance, steps=240, begin=throw)
    found = search.Search(trial, search.CmaEs(candidates=10_000), goal="maximize", seed=1)
    found.run(20, on_generation=print)
    mw.show(found.record("best.h5"))

docs/search.md has examples. CmaEs requires the package cma, Sobol SciPy, tables pyarrow:
``pip install "manyworlds-sim[search]"``.
"""

from .loop import Asked, Search
from .outcome import Evaluator, Outcome, Run, Score
from .results import Candidate, Generation, Results
from .space import Number, Parameter, Space
from .strategies import CmaEs, Grid, Random, Sobol, Strategy
from .task_trial import TaskTrial
from .trial import Trial

__all__ = [
    "Asked",
    "Candidate",
    "CmaEs",
    "Evaluator",
    "Generation",
    "Grid",
    "Number",
    "Outcome",
    "Parameter",
    "Random",
    "Results",
    "Run",
    "Score",
    "Search",
    "Sobol",
    "Space",
    "Strategy",
    "TaskTrial",
    "Trial",
]
