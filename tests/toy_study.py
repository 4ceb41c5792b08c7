"""A plan without physics for the tests of stored studies, and the loop that fills a folder with it."""

import contextlib
import os
import sys
import time
from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import pandas as pd
import pyarrow as pa

from rockflex.studies.folders import StudyFolder
from rockflex.studies.parallel import map_chunks_on_dask, map_threads

VERSIONS = {"rockflex": "0.1.0", "numpy": "2.0"}
SPEC = {"seed": 7, "structure": {"period": 1.0, "stiffness_ratio": float("inf")}, "scales": [0.5, 1.0]}


@dataclass(frozen=True)
class ToyPlan:
    """Chunks of random numbers with every kind of column that a study has."""

    n_chunks: int = 8
    rows: int = 50
    delay: float = 0.0
    ballast: bytes = field(default=b"", repr=False)

    def frame(self, number: int) -> pd.DataFrame:
        random = np.random.default_rng([7, number])
        gaps = random.random(self.rows) < 0.2
        kinds = pd.CategoricalDtype(["no_uplift", "rocking", "overturned"])
        error = pd.array(np.where(gaps, "too stiff: π", None), dtype="string")
        return pd.DataFrame(
            {
                "structure": np.arange(self.rows, dtype=np.int32) + number * self.rows,
                "status": pd.Categorical.from_codes(np.where(gaps, -1, random.integers(0, 2, self.rows)), dtype=kinds),
                "error": error,
                "max_rotation": np.where(gaps, np.nan, random.standard_normal(self.rows)),
                "n_impacts": pd.arrays.IntegerArray(random.integers(0, 9, self.rows), gaps),
                "overturned": pd.arrays.BooleanArray(random.random(self.rows) < 0.5, gaps),
            }
        )

    def chunk(self, number: int) -> pa.Table:
        time.sleep(self.delay)
        return pa.Table.from_pandas(self.frame(number), preserve_index=False)

    def whole(self) -> pd.DataFrame:
        return pd.concat([self.frame(number) for number in range(self.n_chunks)], ignore_index=True)


@dataclass(frozen=True)
class FailingPlan(ToyPlan):
    """One whose chunks from 2 on raise, that one last."""

    def chunk(self, number: int) -> pa.Table:
        if number >= 2:
            time.sleep(0.5 * (number == 2))
            message = f"chunk {number} is beyond repair"
            raise ArithmeticError(message)
        return super().chunk(number)


@dataclass(frozen=True)
class FlakyPlan(ToyPlan):
    """One whose every chunk raises at the first attempt."""

    folder: str = ""

    def chunk(self, number: int) -> pa.Table:
        attempt = Path(self.folder) / f"attempt-{number}"
        if not attempt.exists():
            attempt.touch()
            raise OSError(5, "the network is down")
        return super().chunk(number)


@dataclass(frozen=True)
class DeadlyPlan(ToyPlan):
    """One whose chunk 2 takes its process along."""

    def chunk(self, number: int) -> pa.Table:
        if number == 2:
            os._exit(1)
        return super().chunk(number)


def opened(path: str, plan: ToyPlan) -> StudyFolder:
    return StudyFolder.open(path, SPEC, plan.n_chunks, VERSIONS, {"record": "abc"})


def run_study(path: str, plan: ToyPlan, address: str | None = None) -> list[int]:
    """Fill the folder; returns the chunks that were computed."""
    computed: list[int] = []
    with opened(path, plan) as folder:
        numbers = folder.missing()
        with contextlib.closing(_mapped(plan, numbers, address)) as results:
            for number, table in results:
                folder.write(number, table)
                computed.append(number)
    return computed


def _mapped(plan: ToyPlan, numbers: Iterable[int], address: str | None):
    if address is not None:
        return map_chunks_on_dask(plan, numbers, address)
    return map_threads(lambda number: (number, plan.chunk(number)), numbers, 2)


if __name__ == "__main__":
    run_study(sys.argv[1], ToyPlan(n_chunks=int(sys.argv[2]), delay=float(sys.argv[3])))
