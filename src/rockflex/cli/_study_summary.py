"""What is printed of a study: its outcomes and its fits."""

import math
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import typer

from rockflex._errors import InputError, SolverError
from rockflex.cli._console import duration, grid, note, number, output, show
from rockflex.cli._output import to_json, versions
from rockflex.motion import MEASURES

if TYPE_CHECKING:
    import pandas as pd

    from rockflex.fragility import CloudFit, LognormalFragility
    from rockflex.study.plans import Study

Rows = list[dict[str, Any]]
PEAK_VELOCITY, PEAK_ACCELERATION = MEASURES["pgv"], MEASURES["pga"]


def summarise(study: "Study", table: "pd.DataFrame", seconds: float, *, json: bool) -> tuple[int, int]:
    """Print what a study found; return how many runs could not be solved, and how many fits could not be made."""
    from rockflex.study.plans import pivot_lifts

    findings: dict[str, Callable[[Any, pd.DataFrame, list[str]], Iterator[tuple[str, Rows]]]] = {
        "cloud": _cloud,
        "incremental": _incremental,
        "stripes": _stripes,
        "population": _population,
        "design": _design,
    }
    tables: dict[str, Rows] = {}
    unfitted: list[str] = []
    try:
        for title, rows in findings[study.study](study, table, unfitted):
            tables[title] = rows
    except (InputError, SolverError) as error:  # the runs are there, whatever can be made of them
        unfitted.append(str(error))
    lifts = pivot_lifts(table)
    failed = int(table["error"].notna().sum())
    document = {"versions": versions(), "study": study.document(), "rows": len(table), "failed": failed}
    document |= {"elapsed": seconds, "unfitted": unfitted}
    document |= {"pivot_lifts": [each._asdict() for each in lifts], **tables}
    if json:
        typer.echo(to_json(document))
    else:
        _print(tables)
        for each in lifts:
            if each.lifting:
                typer.echo(f"\n{each}")
        typer.echo(f"\n{len(table)} rows in {duration(seconds)}")
    for reason in dict.fromkeys(unfitted):
        note(f"No fit: {reason}")
    if failed:
        first = table.loc[table["error"].notna(), "error"].iloc[0]
        note(f"{failed} rows have an error, the first: {first}")
    return failed, len(unfitted)


def _print(tables: dict[str, Rows]) -> None:
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
    return str(int(value)) if isinstance(value, int | np.integer) else number(float(value))


def _cloud(_: "Study", runs: "pd.DataFrame", unfitted: list[str]) -> Iterator[tuple[str, Rows]]:
    from rockflex.fragility import OVERTURNING, ROCKED, ROCKING, LogisticFit, fit_each_cloud

    found, reasons = fit_each_cloud(runs, PEAK_VELOCITY.name, threshold=ROCKED)
    unfitted += [f"{structure} with {model}: {reason}" for (structure, model), reason in reasons.items()]
    fits_of = {(fits.structure, fits.model): fits for fits in found}
    outcomes: Rows = []
    lines: Rows = []
    for (structure, model), group in runs.groupby(["structure", "model"], observed=True, sort=False):
        name = {"structure": str(structure), "model": str(model)}
        solved = group["status"].notna()
        fallen = OVERTURNING.exceeded(group)
        rocked = solved & ~fallen & (group["max_rotation"] > ROCKED)
        fits = fits_of.get((str(structure), str(model)))
        curve = fits and fits.outcomes.initiation
        fitted = isinstance(curve, LogisticFit)
        outcomes.append(
            {
                **name,
                "no rocking": int((solved & ~fallen & ~rocked).sum()),
                "rocking": int(rocked.sum()),
                "overturned": int(fallen.sum()),
                "failed": int((~solved).sum()),
                PEAK_VELOCITY.with_unit(f"{PEAK_VELOCITY.label} of P(rocking)=½"): curve.median if fitted else None,
                "spread [-]": curve.dispersion if fitted else None,
                "fit": curve.method if fitted else "all alike" if curve else "none",
            }
        )
        rotation = fits.outcomes.rotation if fits else None
        relative, total = (fits.top_displacement, fits.total_top_displacement) if fits else (None, None)
        quantities = (("θ_max", rotation), ("u_top relative to the base", relative), ("u_top in total", total))
        lines += [{**name, "y": quantity, **_line(fit)} for quantity, fit in quantities]
    yield (
        f"Outcomes, and P({ROCKING.label}) by logistic regression on log {PEAK_VELOCITY.label}",
        _words_first(outcomes),
    )
    yield (
        f"log y = c1 + c2 log {PEAK_VELOCITY.label} of runs that rocked and stand (rad, m, {PEAK_VELOCITY.unit})",
        lines,
    )


def _line(fit: "CloudFit | None") -> dict[str, Any]:
    values = (None,) * 4 if fit is None else (fit.c1, fit.c2, fit.dispersion, fit.r2)
    return dict(zip(("c1", "c2", "spread", "R²"), values, strict=True))


def _words_first(rows: Rows) -> Rows:
    return [dict(sorted(row.items(), key=lambda item: not isinstance(item[1], str))) for row in rows]


def _incremental(study: Any, runs: "pd.DataFrame", unfitted: list[str]) -> Iterator[tuple[str, Rows]]:
    from rockflex.fragility import LIMIT_STATES, fit_capacities
    from rockflex.study.plans import incremental_capacities

    rows: Rows = []
    for measure in (PEAK_ACCELERATION, PEAK_VELOCITY):
        capacities = incremental_capacities(runs, measure.name).dropna(subset=["capacity"])
        for (structure, model), each in capacities.groupby(["structure", "model"], observed=True, sort=False):
            what = f"{structure} with {model}, {measure.label}"
            fit = _fitted(lambda each=each: fit_capacities(each["capacity"], each["censored"]), what, unfitted)
            rows.append(
                {
                    "structure": str(structure),
                    "model": str(model),
                    "measure": measure.label,
                    "records": len(each),
                    "never overturned": int(each["censored"].sum()),
                    "resurrections": int(each["resurrections"].sum()),
                    "median [SI]": fit and fit.median,
                    "β": fit and fit.beta,
                }
            )
    yield f"Capacities to {LIMIT_STATES[study.limit].rotation}, lognormal", rows


def _stripes(study: Any, runs: "pd.DataFrame", unfitted: list[str]) -> Iterator[tuple[str, Rows]]:
    from rockflex.fragility import NOMINAL, OVERTURNING, UPLIFT, fit_stripes
    from rockflex.study.plans import stripe_counts

    fits: Rows = []
    counts: Rows = []
    for limit in (UPLIFT, NOMINAL, OVERTURNING):
        counted = stripe_counts(runs, limit.name)  # pyright: ignore[reportArgumentType]
        for (structure, model), each in counted.groupby(["structure", "model"], observed=True, sort=False):
            what = f"{structure} with {model}, {limit.label}"
            fit = _fitted(
                lambda each=each: fit_stripes(each["level"], each["n_exceeding"], each["n_total"]), what, unfitted
            )
            name = {"limit": limit.label, "structure": str(structure), "model": str(model)}
            fits.append({**name, "median": fit and fit.median, "β": fit and fit.beta})
            levels = zip(each["level"], each["n_exceeding"], each["n_total"], strict=True)
            counts.append({**name, **{f"{level:g}": f"{n}/{total}" for level, n, total in levels}})
    yield f"Runs beyond the limit at each level of {study.measure}", counts
    yield f"Fragility by maximum likelihood, lognormal in {study.measure}", fits


def _fitted(fit: "Callable[[], LognormalFragility]", what: str, unfitted: list[str]) -> "LognormalFragility | None":
    """The fit, or None where the data give none."""
    try:
        return fit()
    except (InputError, SolverError) as error:
        unfitted.append(f"{what}: {error}")
        return None


def _population(_: "Study", pairs: "pd.DataFrame", _unfitted: list[str]) -> Iterator[tuple[str, Rows]]:
    from rockflex.study.plans import population_statistics

    found = population_statistics(pairs)
    outcomes = found.outcomes.reset_index(names="MDOF-S \\ 2DOF-S")
    yield "Pairs by outcome", [_named(row) for row in outcomes.to_dict("records")]
    columns = ["n", "r2", "r2_low", "r2_high", "slope", "slope_low", "slope_high", "r2_line"]
    for title, frame, words in (
        ("MDOF-S against 2DOF-S (Section 3.3), 90 % intervals", found.agreement, ["group", "quantity", "behaviour"]),
        ("Modal combination (Section 3.4), 90 % intervals", found.combination, ["quantity", "estimate"]),
    ):
        yield title, [_named(row) for row in frame[[*words, *columns]].to_dict("records")]
    shown = ["pair", "n_stories", "behaviour", "aspect_ratio", "period", "motion", "pgv"]
    shown += ["max_rotation_mdof", "max_rotation_2dof", "share"]
    rows: Sequence[dict[Any, Any]] = found.outliers[shown].to_dict("records")
    yield "Largest disagreements in rotation", _words_first([_named(row) for row in rows])


def _design(study: Any, runs: "pd.DataFrame", unfitted: list[str]) -> Iterator[tuple[str, Rows]]:
    from rockflex.fragility import limit_label
    from rockflex.study.plans import design_tables, smallest_width

    asked = "annual rate" if study.hazard else f"P at {study.measure} = {study.level:g}"
    value = "rate" if study.hazard else "probability"
    designs: dict[tuple[str, str, float], dict[str, Any]] = {}
    widths: Rows = []
    for limit, table in design_tables(runs, study.document()):
        word = limit_label(limit)
        for reason, lost in table[table[value].isna()].groupby("note"):
            unfitted.append(f"{word}: no {value} of {len(lost)} of {len(table)} designs. {reason}")
        for each in table.to_dict("records"):
            words = {"tendon": each["tendon"], "model": each["model"]}
            row = designs.setdefault(
                (each["model"], each["tendon"], each["half_width"]),
                {
                    **words,
                    "B [m]": each["half_width"],
                    "h*/B": each["aspect_ratio"],
                    "M_r [N m]": each["resisting_moment"],
                    "M_b [N m]": each["median_base_moment"],
                    "utilisation": each["median_tendon_utilisation"],
                    "failed": each["n_failed"],
                },
            )
            row |= {word: each[value], f"{word}, low": each["low"], f"{word}, high": each["high"]}
        if study.target is None:
            continue
        for each in smallest_width(table, study.target).to_dict("records"):
            widths.append(
                {
                    "limit": word,
                    "tendon": each["tendon"],
                    "model": each["model"],
                    "outcome": each["outcome"],
                    "B [m]": each["half_width"],
                    "B, upper limit [m]": each["half_width_upper"],
                }
            )
            if each["note"]:
                note(f"{word}, {each['tendon']}, {each['model']}: {each['note']}")
    yield (
        f"Designs, and the {asked} of exceeding each limit; medians of all runs",
        [_named(r) for r in designs.values()],
    )
    if widths:
        yield f"Least half width from which on the {asked} is at most {study.target:g}", [_named(r) for r in widths]


def _named(row: dict[Any, Any]) -> dict[str, Any]:
    plain: dict[str, Any] = {}
    for key, value in row.items():
        missing = value is None or (isinstance(value, float) and math.isnan(value))
        plain[str(key)] = None if missing else value if isinstance(value, int | float) else str(value)
    return plain
