"""Results of a search: every candidate with its outcome, as columns, an Arrow table or a file."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Optional

import numpy as np
from numpy.typing import NDArray

from .. import files
from ..files import File
from .space import Doubles, Space
from .strategies import needed

STATUS = ("ok", "infeasible", "lost", "not_finite")  # by the codes of Generation.status


@dataclass(frozen=True, slots=True)
class Candidate:
    """A tried candidate."""

    generation: int
    candidate: int  # index in the generation
    values: dict[str, float]  # parameters by name
    value: float  # of the objective; NaN if the world is lost or there is none
    violation: float  # of the constraints; 0: all hold
    status: str  # "ok", "infeasible", "lost", "not_finite"
    seed: int  # of its world
    hash: int  # of the final state of its world; 0 if the evaluator has none


@dataclass(frozen=True, slots=True)
class Generation:
    """Candidates that were tried together. ``str`` returns one line."""

    index: int
    space: Space
    values: Doubles  # (candidates, parameters)
    value: Doubles  # (candidates,) of the objective
    violation: Doubles
    cost: Doubles  # as passed to the strategy, finite; lower is better
    status: NDArray[np.uint8]  # index in STATUS
    seed: NDArray[np.uint64]
    hash: NDArray[np.uint64]
    seconds: float  # duration of the trials

    def __len__(self) -> int:
        return len(self.cost)

    def candidate(self, i: int) -> Candidate:
        """A candidate by index."""
        return Candidate(
            self.index,
            int(i),
            self.space.named(self.values[i]),
            float(self.value[i]) if self.status[i] < 2 else np.nan,
            float(self.violation[i]),
            STATUS[self.status[i]],
            int(self.seed[i]),
            int(self.hash[i]),
        )

    @property
    def best(self) -> Optional[Candidate]:
        """The first valid candidate with the lowest cost; None if no candidate is valid."""
        good = np.flatnonzero(self.status == 0)
        return self.candidate(good[np.argmin(self.cost[good])]) if good.size else None

    def __str__(self) -> str:
        counts = [f"{n} {STATUS[s]}" for s in (1, 2, 3) if (n := int((self.status == s).sum()))]
        good = self.value[self.status == 0]
        best = self.best
        told = [] if best is None else [f"best {best.value:.6g}, median {np.median(good):.6g}"]
        told += counts + [f"{len(self)} candidates in {self.seconds:.2f} s"]
        return f"generation {self.index}: " + "; ".join(told)


class Results:
    """All complete generations.

    Columns, with one row per candidate:

    generation, candidate  int32
    parameters, by name    float64; int64 for integers
    value, violation       float64; value is null if the world was lost or the value is NaN
    cost                   float64, as passed to the strategy
    status                 "ok", "infeasible", "lost", "not_finite"
    seed, hash             uint64
    """

    def __init__(self, space: Space, goal: str, about: dict[str, Any]) -> None:
        self.space = space
        self.goal = goal
        self.about = about  # what the table's metadata say
        self.generations: list[Generation] = []

    def __len__(self) -> int:
        return sum(map(len, self.generations))

    def __repr__(self) -> str:
        return f"<manyworlds.search.Results: {len(self)} candidates of {len(self.generations)} generations>"

    @property
    def best(self) -> Candidate:
        """The first of the best valid candidates. Raises ValueError if no candidate is valid."""
        found = [g.best for g in self.generations]
        ok = [c for c in found if c is not None]
        if not ok:
            statuses = [STATUS[s] for g in self.generations for s in g.status]
            counts = [f"{statuses.count(s)} {s}" for s in STATUS[1:] if s in statuses]
            raise ValueError(
                f"no candidate of {len(self)} is ok: {', '.join(counts) or 'none was tried'}"
            )
        choose = min if self.goal == "minimize" else max
        return choose(ok, key=lambda c: c.value)  # the first of equals

    def columns(self) -> dict[str, NDArray[Any]]:
        """The columns as NumPy arrays (candidates,). A null value becomes NaN."""

        def joined(name: str, dtype: Any) -> NDArray[Any]:
            parts = [np.asarray(getattr(g, name), dtype) for g in self.generations]
            return np.concatenate(parts) if parts else np.zeros(0, dtype)

        sizes = [len(g) for g in self.generations]
        out: dict[str, NDArray[Any]] = {
            "generation": np.repeat(np.array([g.index for g in self.generations], np.int32), sizes),
            "candidate": np.concatenate(
                [np.arange(n, dtype=np.int32) for n in sizes] or [np.zeros(0, np.int32)]
            ),
        }
        for i, p in enumerate(self.space.parameters):
            parts = [g.values[:, i] for g in self.generations]
            column = np.concatenate(parts) if parts else np.zeros(0)
            out[p.name] = column.astype(np.int64) if p.integer else column
        status = joined("status", np.uint8)
        value = joined("value", np.float64)
        out["value"] = np.where(status < 2, value, np.nan)
        out["violation"] = joined("violation", np.float64)
        out["cost"] = joined("cost", np.float64)
        out["status"] = np.array(STATUS)[status]
        out["seed"] = joined("seed", np.uint64)
        out["hash"] = joined("hash", np.uint64)
        return out

    def table(self) -> Any:
        """The columns as a pyarrow.Table, status as a dictionary. ImportError without pyarrow."""
        pa = needed("pyarrow", "search.Results.table")
        columns = self.columns()
        arrays = {}
        for name, column in columns.items():
            if name == "status":
                codes = np.concatenate(
                    [g.status for g in self.generations] or [np.zeros(0, np.uint8)]
                )
                arrays[name] = pa.DictionaryArray.from_arrays(codes.astype(np.int8), list(STATUS))
            else:
                mask = np.isnan(column) if name == "value" else None
                arrays[name] = pa.array(column, mask=mask)
        table = pa.table(arrays)
        return table.replace_schema_metadata({"manyworlds.search": json.dumps(self.about)})

    def save(self, file: File) -> Path:
        """Writes the table: Parquet for ".parquet", Arrow's IPC format for ".arrow" and ".feather".

        The file appears only when it is complete. Raises ValueError for other names, ImportError.
        """
        path = checked_file(file)
        table = self.table()
        part = path.with_name(f"{path.name}.part-{os.getpid()}")
        try:
            if path.suffix == ".parquet":
                needed("pyarrow.parquet", "search.Results.save").write_table(table, part)
            else:
                needed("pyarrow.feather", "search.Results.save").write_feather(
                    table, str(part), compression="uncompressed"
                )
            os.replace(part, path)
        finally:
            part.unlink(missing_ok=True)
        return path


def checked_file(file: File) -> Path:
    """The path of a table. ValueError, TypeError, ImportError without pyarrow."""
    path = files.path(file, "file")
    if path.suffix not in (".parquet", ".arrow", ".feather"):
        raise ValueError(
            f"file is {str(path)!r}; expected a name that ends with .parquet, .arrow or .feather"
        )
    needed("pyarrow", "search.Results.save")
    return path
