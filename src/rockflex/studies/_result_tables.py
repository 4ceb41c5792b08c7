"""Tables of results: the same columns in every chunk, with missing values where a run could not be solved."""

from collections.abc import Collection, Iterable, Mapping, Sequence
from functools import cache, lru_cache
from operator import attrgetter
from typing import TYPE_CHECKING, Any, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.cases import runs_by_case
from rockflex.foundation.language import translated
from rockflex.response._outputs import outputs_of
from rockflex.response._respond import BY_STORY, MAX_OF_STORIES, NAMES
from rockflex.response._response import Response, complete_model_label, is_for_small_rotations, leaves_range
from rockflex.structure._rocking import RockingProperties

if TYPE_CHECKING:
    import pandas as pd


ArrowTable: TypeAlias = Any  # a pyarrow.Table: pyarrow has no type annotations

# The type of a column, or for a column of names the names that its codes refer to.
Columns = Mapping[str, type | Sequence[str]]
Row = dict[str, Any]
Table = Mapping[str, Sequence[Any] | NDArray[Any]]  # columns by name, of the same length

TYPES = {float: "float64", int: "int64", bool: "bool", str: "string"}


def columns_of_kind(names: str, kind: type) -> dict[str, type]:
    """Return columns of one kind; blanks separate their names."""
    return dict.fromkeys(names.split(), kind)


def arrow_table(values: Table, columns: Columns, missing: "NDArray[np.bool_] | None" = None) -> ArrowTable:
    """Return a table of these columns; NaN, None, columns without values and rows of `missing` are missing values.

    Values are lists or, with `missing`, arrays.
    """
    import pyarrow as pa

    absent = [None] * len(next(iter(values.values()), ()))

    def column(given: Any, kind: type | Sequence[str]) -> Any:
        mask = missing if isinstance(given, np.ndarray) else None
        if isinstance(kind, type):
            return pa.array(given, TYPES[kind], mask=mask, from_pandas=True)
        # All chunks list all names, so that their tables have one schema and can be joined directly.
        return pa.DictionaryArray.from_arrays(pa.array(given, pa.int32(), mask=mask), pa.array(kind, pa.string()))

    return pa.table({name: column(values.get(name, absent), kind) for name, kind in columns.items()})


def joined_tables(tables: Sequence[Table]) -> dict[str, list[Any]]:
    """Return the columns of tables, one after another; None where a table lacks a column, as of stories that yield."""
    rows = [len(next(iter(each.values()), ())) for each in tables]
    names = dict.fromkeys(name for each in tables for name in each)
    return {
        name: [value for each, count in zip(tables, rows, strict=True) for value in each.get(name, [None] * count)]
        for name in names
    }


def tables_to_dataframe(*tables: ArrowTable) -> "pd.DataFrame":
    """Join tables into a DataFrame: names become categories; integers, flags and text get types that allow NA."""
    import pandas as pd
    import pyarrow as pa

    kinds = {pa.int64(): pd.Int64Dtype(), pa.bool_(): pd.BooleanDtype(), pa.string(): pd.StringDtype()}
    return pa.concat_tables(tables).to_pandas(types_mapper=kinds.get)


def pandas_columns(values: Table, columns: Columns, missing: "NDArray[np.bool_]") -> dict[str, Any]:
    """Return columns from arrays, and lists of texts, of the types that `tables_to_dataframe` gives them.

    Columns without values and rows of `missing` are missing values. By way of Arrow it takes twice as long.
    """
    import pandas as pd

    everywhere, some = np.ones_like(missing), missing.any()

    def column(name: str, kind: type | Sequence[str]) -> Any:
        given: Any = values.get(name)
        absent = missing if given is not None else everywhere
        known = np.zeros(missing.size) if given is None else given
        if kind is str:
            return pd.array([None] * missing.size if given is None else given, dtype=pd.StringDtype())
        if kind is float:
            return np.where(absent, np.nan, known) if some or given is None else known.astype(float, copy=False)
        if kind is int:
            return pd.arrays.IntegerArray(known.astype(np.int64), absent.copy())
        if kind is bool:
            return pd.arrays.BooleanArray(known.astype(np.bool_), absent.copy())
        assert not isinstance(kind, type)
        codes = np.where(absent, -1, known).astype(np.int64)
        return pd.Categorical.from_codes(codes, dtype=categories_of(tuple(kind)))

    return {name: column(name, kind) for name, kind in columns.items()}


@lru_cache(maxsize=64)
def categories_of(names: tuple[str, ...]) -> "pd.CategoricalDtype":
    """Return the type of a column of names, of which pandas checks that they differ."""
    import pandas as pd

    return pd.CategoricalDtype(list(names))


# Every number and flag of a Response, by its name.
RESULTS: dict[str, type] = {name: Response.__annotations__[name] for name in NAMES if name != "status"}
OF_ELEMENTS = outputs_of("dissipating elements")
OF_GROUND = outputs_of("sliding", "springs")


def result_row(response: Response, suffix: str = "") -> dict[str, Any]:
    """Return the status of a response, and every number and flag by its name; `suffix` is added to each name."""
    return dict(zip(_suffixed_result_names(suffix), _values_of(response), strict=True))


_values_of = attrgetter("status", *RESULTS)


@cache
def _suffixed_result_names(suffix: str) -> tuple[str, ...]:
    return tuple(name + suffix for name in ("status", *RESULTS))


def story_columns(structures: Iterable[RockingProperties]) -> dict[str, type]:
    """Return the columns of stories that yield, up to the most that a structure has; none if none can yield."""
    most = max((p.floors.heights.size for p in structures if p.stories and p.floors is not None), default=0)
    by_story = [f"{name}_{k}" for name in BY_STORY for k in range(1, most + 1)]
    return dict.fromkeys((*MAX_OF_STORIES, *by_story) if most else (), float)


def result_columns(
    structures: Collection[RockingProperties] = (), suffix: str = "", *, with_ground: bool = False
) -> dict[str, type]:
    """Return the kinds of the columns that `result_row` fills in a study of these structures.

    Without elements other than elastic tendons the columns of `OF_ELEMENTS` would say nothing, and are left out; so are
    those of `OF_GROUND` on rigid ground on which no base slides, unless the study is `with_ground`. The
    `story_columns` follow.
    """
    left_out = () if with_ground else OF_GROUND
    if not any(map(_has_dissipating_elements, structures)):
        left_out += OF_ELEMENTS
    kinds = {"status": str, **RESULTS}
    kinds |= story_columns(structures)
    return {name + suffix: kind for name, kind in kinds.items() if name not in left_out}


def _has_dissipating_elements(properties: RockingProperties) -> bool:
    return any(each.dissipates or not each.prestressed for each in properties.elements)


REACTION, JOINT_FORCE = "min_vertical_reaction", "min_joint_force"


class PivotLifts(NamedTuple):
    """Numbers of runs of a case that rock and stand: all, whose pivot would lift, beyond α, and that may fall.

    The last numbers are those of runs that overturn by a model for small rotations, and in which a joint above the base
    would lift off.
    """

    structure: str
    model: str
    rocking: int
    lifting: int
    beyond: int = 0
    falling: int = 0
    overturned: int = 0
    joints: int = 0

    def __str__(self) -> str:
        return " ".join(self.warnings)

    @property
    def warnings(self) -> list[str]:
        """Warnings about these runs, one text each."""
        found: list[str] = []
        if self.lifting:
            found.append(
                translated(
                    "{structure}, {model}: in {k} of {n} runs that rock and stand the model pulls the base down "
                    "({column} below zero), which no ground can: the pivot would lift. Read what follows in such a run "
                    "with care.",
                    structure=self.structure,
                    model=self.model,
                    k=self.lifting,
                    n=self.rocking,
                    column=REACTION,
                )
            )
        if self.joints:
            found.append(
                translated(
                    "{structure}, {model}: in {k} of {n} runs that rock and stand a joint above the base would lift "
                    "off (min_joint_force below zero). Read what follows in such a run with care.",
                    structure=self.structure,
                    model=self.model,
                    k=self.joints,
                    n=self.rocking,
                )
            )
        if self.beyond:
            found.append(
                translated(
                    "{structure}, {model}: in {k} of {n} runs that rock and stand θ passes α, at which the static "
                    "moment vanishes (balance_ratio above one). The model is for small rotations: whether these "
                    "overturn is to be decided by a complete model on rigid ground, such as {complete}.",
                    structure=self.structure,
                    model=self.model,
                    k=self.beyond,
                    n=self.rocking,
                    complete=complete_model_label(self.model),
                )
            )
        if self.falling:
            found.append(
                translated(
                    "{structure}, {model}: {k} of {n} runs that rock and stand end while the base may still fall "
                    '(may_fall). Continue them with free_vibration = "settle".',
                    structure=self.structure,
                    model=self.model,
                    k=self.falling,
                    n=self.rocking,
                )
            )
        if self.overturned:
            found.append(
                translated(
                    "{structure}, {model}: {k} runs overturn by a model for small rotations. Let a complete model on "
                    "rigid ground decide, such as {complete}.",
                    structure=self.structure,
                    model=self.model,
                    k=self.overturned,
                    complete=complete_model_label(self.model),
                )
            )
        return found


def count_pivot_lifts(runs: "pd.DataFrame") -> list[PivotLifts]:
    """Count the runs in which the vertical reaction falls below zero, a simplified θ passes α, or more, by case.

    Parameters
    ----------
    runs
        A table with one row a run.
    """
    found: list[PivotLifts] = []
    for structure, model, every in runs_by_case(runs[runs["status"].isin(("rocking", "overturned"))]):
        each = every[every["status"] == "rocking"]
        fell = len(every) - len(each) if is_for_small_rotations(model) else 0
        past = 0  # where a table of an earlier version does not tell
        if "balance_ratio" in each:
            past = int(leaves_range(each["model"], each["balance_ratio"], each["max_rotation"]).sum())
        falling = int(each["may_fall"].sum()) if "may_fall" in each else 0
        joints = int((each[JOINT_FORCE] < 0.0).sum()) if JOINT_FORCE in each else 0
        lifting = int((each[REACTION] < 0.0).sum())
        found.append(PivotLifts(structure, model, len(each), lifting, past, falling, fell, joints))
    return found
