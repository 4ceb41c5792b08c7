"""The printed summary of a study: what its kind reports, and what failed."""

import math
from numbers import Integral, Number
from typing import TYPE_CHECKING, Any

import typer

from rockflex._errors import InputError, SolverError
from rockflex._shown import counted
from rockflex.cli._console import grid, note, number, output, show
from rockflex.cli._output import to_json, versions
from rockflex.kinds import Findings, StudyKind
from rockflex.progress import duration

if TYPE_CHECKING:
    import pandas as pd

    from rockflex.study.plan import Spec

Tables = dict[str, list[dict[str, Any]]]


def summarise(kind: StudyKind, study: "Spec", table: "pd.DataFrame", seconds: float, *, json: bool) -> tuple[int, int]:
    """Print the summary of a study; return the number of failed runs and of failed fits."""
    from rockflex.study.plan import pivot_lifts

    found = Findings()
    try:
        kind.report(study, table, found)
    except (InputError, SolverError) as error:  # the runs are stored, whatever can be derived from them
        found.unfitted.append(str(error))
    tables: Tables = {
        title: [{str(key): _plain(value) for key, value in row.items()} for row in rows]
        for title, rows in found.tables.items()
    }
    lifts = pivot_lifts(kind.runs(table))
    failed = int(table["error"].notna().sum())
    if json:
        document = {"versions": versions(), "study": study.document(), "rows": len(table), "failed": failed}
        document |= {"elapsed": seconds, "unfitted": found.unfitted}
        typer.echo(to_json(document | {"pivot_lifts": [each._asdict() for each in lifts], **tables}))
    else:
        _print(tables)
        for text in (text for each in lifts for text in each.warnings):
            typer.echo(f"\n{text}")
        typer.echo(f"\n{counted(len(table), 'row')} in {duration(seconds)}")
    for remark in found.remarks:
        note(remark)
    for reason in dict.fromkeys(found.unfitted):
        note(f"No fit: {reason}")
    if failed:
        first = table.loc[table["error"].notna(), "error"].iloc[0]
        note(f"{counted(failed, 'row has', 'rows have')} an error, the first: {first}")
    return failed, len(found.unfitted)


def _plain(value: Any) -> Any:
    """A number or a text; None for what is missing."""
    if isinstance(value, Number):
        return None if isinstance(value, float) and math.isnan(value) else value
    return None if value is None else str(value)


def _print(tables: Tables) -> None:
    console = output()
    for place, (title, rows) in enumerate(tables.items()):
        if not rows:
            continue
        console.print(("\n" if place else "") + title, style="bold", markup=False)
        words = sum(isinstance(value, str) for value in rows[0].values())
        show(console, grid(list(rows[0]), ([_cell(value) for value in row.values()] for row in rows), n_left=words))


def _cell(value: Any) -> str:
    if isinstance(value, str):
        return value
    if value is None:
        return "-"
    return str(int(value)) if isinstance(value, Integral) else number(float(value))
