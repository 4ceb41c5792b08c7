"""Tables of results: the same columns in every chunk, with missing values where a run could not be solved."""

from collections.abc import Iterable, Mapping, Sequence
from functools import cache
from operator import attrgetter
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from rockflex._cases import runs_by_case
from rockflex.modal import RockingProperties, Tendon
from rockflex.response import NAMES, Response, complete_of, leaves_range
from rockflex.study._prepared_case import RunPeaks

if TYPE_CHECKING:
    import pandas as pd


ArrowTable: TypeAlias = Any  # a pyarrow.Table: pyarrow has no type annotations

# The type of a column, or for a column of names the names that its codes refer to.
Columns = Mapping[str, type | Sequence[str]]
Row = dict[str, Any]

TYPES = {float: "float64", int: "int64", bool: "bool", str: "string"}


def columns_of_kind(names: str, kind: type) -> dict[str, type]:
    """Return columns of one kind; blanks separate their names."""
    return dict.fromkeys(names.split(), kind)


def table_of_rows(rows: Sequence[Row], columns: Columns) -> ArrowTable:
    """Return a table of rows; NaN and the columns that a row lacks are missing values."""
    import pyarrow as pa

    return pa.table({name: _arrow_column([row.get(name) for row in rows], kind) for name, kind in columns.items()})


def _arrow_column(values: list[Any], kind: type | Sequence[str]) -> Any:
    import pyarrow as pa

    if isinstance(kind, type):
        return pa.array(values, TYPES[kind], from_pandas=True)
    # All chunks list all names, so that their tables have one schema and can be joined directly.
    return pa.DictionaryArray.from_arrays(pa.array(values, pa.int32()), pa.array(kind, pa.string()))


class ResultColumns:
    """Results of some runs, column by column, for a table in memory.

    Parameters
    ----------
    peaks
        The results of the runs.
    columns
        Columns of results; those without values stay missing. `error` is a text for each row that has none.
    """

    def __init__(self, peaks: RunPeaks, columns: Columns) -> None:
        self._columns, self.size = columns, peaks.count
        kinds = {
            name: kind if isinstance(kind, type) else np.int32 for name, kind in columns.items() if kind is not str
        }
        none = np.zeros(self.size)
        self._values = {name: peaks.columns.get(name, none).astype(kind, copy=False) for name, kind in kinds.items()}
        self._missing = np.full(self.size, not peaks.columns)
        self._missing[list(peaks.failures)] = True
        self._errors = [
            None if place not in peaks.failures else str(peaks.failures[place]) for place in range(self.size)
        ]

    @staticmethod
    def joined(sheets: "Sequence[ResultColumns]") -> dict[str, Any]:
        """Return the columns of all sheets, one after another, for a DataFrame as `tables_to_dataframe` gives it."""
        import pandas as pd

        missing = np.concatenate([sheet._missing for sheet in sheets])
        errors = [error for sheet in sheets for error in sheet._errors]
        found = dict[str, Any]()
        for name, kind in sheets[0]._columns.items():
            if kind is str:
                found[name] = pd.array(errors, dtype=pd.StringDtype())
                continue
            values: NDArray[Any] = np.concatenate([sheet._values[name] for sheet in sheets])
            if kind is float:
                found[name] = np.where(missing, np.nan, values)
            elif kind is int:
                found[name] = pd.arrays.IntegerArray(values, missing.copy())
            elif kind is bool:
                found[name] = pd.arrays.BooleanArray(values, missing.copy())
            elif not isinstance(kind, type):
                codes = np.where(missing, -1, values)
                found[name] = pd.Categorical.from_codes(codes, dtype=pd.CategoricalDtype(list(kind)))
        return found


def tables_to_dataframe(*tables: ArrowTable) -> "pd.DataFrame":
    """Join tables into a DataFrame: names become categories; integers, flags and text get types that allow NA."""
    import pandas as pd
    import pyarrow as pa

    kinds = {pa.int64(): pd.Int64Dtype(), pa.bool_(): pd.BooleanDtype(), pa.string(): pd.StringDtype()}
    return pa.concat_tables(tables).to_pandas(types_mapper=kinds.get)


# Every number and flag of a Response, by its name.
RESULTS: dict[str, type] = {name: Response.__annotations__[name] for name in NAMES if name != "status"}
OF_ELEMENTS = ("tendon_yield", "tendon_overload", "residual_rotation")
OF_GROUND = ("max_slip", "residual_slip", "max_edge_uplift", "max_edge_settlement")


def result_row(response: Response, suffix: str = "") -> dict[str, Any]:
    """Return the status of a response, and every number and flag by its name; `suffix` is added to each name."""
    return dict(zip(_suffixed_result_names(suffix), _values_of(response), strict=True))


_values_of = attrgetter("status", *RESULTS)


@cache
def _suffixed_result_names(suffix: str) -> tuple[str, ...]:
    return tuple(name + suffix for name in ("status", *RESULTS))


def result_columns(
    structures: Iterable[RockingProperties] = (), suffix: str = "", *, with_ground: bool = False
) -> dict[str, type]:
    """Return the kinds of the columns that `result_row` fills in a study of these structures.

    Without elements other than elastic tendons the columns of `OF_ELEMENTS` would say nothing, and are left out; so are
    those of `OF_GROUND` on rigid ground on which no base slides, unless the study is `with_ground`.
    """
    left_out: tuple[str, ...] = () if with_ground else OF_GROUND
    if not any(map(_has_dissipating_elements, structures)):
        left_out += OF_ELEMENTS
    kinds = {"status": str, **RESULTS}
    return {name + suffix: kind for name, kind in kinds.items() if name not in left_out}


def _has_dissipating_elements(properties: RockingProperties) -> bool:
    return any(not isinstance(each, Tendon) or each.post_yield_ratio is not None for each in properties.elements)


REACTION = "min_vertical_reaction"


class PivotLifts(NamedTuple):
    """Numbers of runs that rock and stand, of those whose pivot would lift, and of those beyond α, of one case."""

    structure: str
    model: str
    rocking: int
    lifting: int
    beyond: int = 0

    def __str__(self) -> str:
        return " ".join(self.warnings)

    @property
    def warnings(self) -> list[str]:
        """Warnings about these runs, one text each."""
        found: list[str] = []
        if self.lifting:
            found.append(
                f"{self.structure}, {self.model}: in {self.lifting} of {self.rocking} runs that rock and stand the "
                f"model pulls the base down ({REACTION} below zero), which no ground can: the pivot would lift. Read "
                "what follows in such a run with care."
            )
        if self.beyond:
            found.append(
                f"{self.structure}, {self.model}: in {self.beyond} of {self.rocking} runs that rock and stand θ passes "
                "α, at which the static moment vanishes (balance_ratio above one). The model is for small rotations: "
                f"whether these overturn is to be decided by a complete model on rigid ground, such as "
                f"{complete_of(self.model)}."
            )
        return found


def count_pivot_lifts(runs: "pd.DataFrame") -> list[PivotLifts]:
    """Count the runs in which the vertical reaction falls below zero or a simplified θ passes α, by case.

    Parameters
    ----------
    runs
        A table with one row a run.
    """
    standing = runs[runs["status"] == "rocking"]
    found: list[PivotLifts] = []
    for structure, model, each in runs_by_case(standing):
        past = 0  # where a table of an earlier version does not tell
        if "balance_ratio" in each:
            past = int(leaves_range(each["model"], each["balance_ratio"], each["max_rotation"]).sum())
        found.append(PivotLifts(structure, model, len(each), int((each[REACTION] < 0.0).sum()), past))
    return found
