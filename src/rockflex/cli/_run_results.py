"""The results of ``rockflex run``: printed tables, files and the report on one page."""

import shlex
import sys
from collections.abc import Iterator, Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockflex.cli import _console as console
from rockflex.cli import _output as output
from rockflex.cli._batch import SLIDING, BatchRun, RunBatch
from rockflex.cli._run_options import lines_about_run_options
from rockflex.cli._structures import LoadedStructure, elements_table
from rockflex.foundation.descriptions import schema_keys
from rockflex.foundation.errors import InputError
from rockflex.foundation.language import translated, use_language
from rockflex.foundation.shown import number_with_noun, shortened
from rockflex.foundation.units import UnitSystem
from rockflex.fragility._limit_states import NOMINAL
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._measures import MEASURES
from rockflex.report.run._report_page import checked_report_path, write_report
from rockflex.report.run._reported_runs import MAX_RUNS
from rockflex.response._exports import to_matlab, to_netcdf
from rockflex.response._friction import IMPACT_WINDOW
from rockflex.response._outputs import ALL_RESULTS, OF_MOTION, OF_TABLES, OUTPUTS, REACTIONS, legend, outputs_of
from rockflex.response._response import Response
from rockflex.response._tables import history_columns
from rockflex.studies._arguments import ground_under_structure
from rockflex.studies._ground_tables import GroundTable, SpringBedTable, SpringsTable

if TYPE_CHECKING:
    import pandas as pd
    from rich.table import Table


MAX_LISTED = 5
PASSED = f"† θ passed {NOMINAL.label}, the nominal limit of overturning"
FRICTION = (
    "μ_req: largest |ΣF_x|/ΣF_z (Eqs. 20-22), of the whole run and without the {window:g} s after each impact; "
    "the base slides where it passes {mu:g}"
)
OF_ELEMENTS = "F, E: largest force of each element, and the energy that it takes (with --out)"
OF_STORIES = "μ: largest drift of a story over its yield drift; drift: what is left at rest"
OF_TENDONS, RESIDUAL = ("max_tendon_force", "tendon_utilisation"), "residual_rotation"
STYLES = {"overturned": "bold red", "failed": "bold magenta", "rocking": "yellow", "no_uplift": "green"}
Columns = list[tuple[str, list[str]]]


def print_run_peaks(
    title: str, batch: RunBatch, runs: Sequence[BatchRun], elapsed: float, *, times: bool, units: UnitSystem
) -> None:
    """Print the peaks of every run, and their times if requested; by motion if the terminal is narrow."""
    for line in (
        title,
        *lines_about_run_options(batch.options, batch.properties, units),
        *_vertical_component_names(batch.motions, units),
    ):
        console.print_line(line)
    elements, base = batch.properties.elements, _outputs_of_base(batch)
    peaks, ground = _peak_columns(runs, units), _columns_of_outputs(runs, (*REACTIONS, *base), units)
    tables = [(peaks + ground, 1)]
    if not console.table_fits(_table_of_all_runs(batch, runs, *tables[0])):
        tables = [(peaks, 1), (ground, 0)]
    if times:
        tables.append((_columns_of_times(runs, units), 0))
    if batch.friction is not None:
        tables.append((_sliding_columns(runs), 0))
    if elements:
        console.print_line("\nElements" if any(each.attached for each in elements) else "\nBetween base and ground")
        console.print_table(elements_table(elements, units))
    tables += [(columns, 0) for columns in _numbered_columns(runs, units) if columns]
    for columns, n_words in tables:
        _print_columns(batch, runs, columns, n_words)
    for line in _legend(batch, runs, base):
        console.print_line(line)
    each = "" if len(runs) == 1 else f", {console.number(1e3 * elapsed / len(runs), 3)} ms a run"
    console.print_line(f"{number_with_noun(len(runs), 'run')} in {console.number(elapsed, 3)} s{each}")


def _legend(batch: RunBatch, runs: Sequence[BatchRun], base: Sequence[str]) -> Iterator[str]:
    """Yield lines below the tables about what they show."""
    yield ""
    if any(run.peaks["nominal_overturning"] for run in runs):
        yield PASSED
    yield from legend([*_outputs_of_motion(runs), *REACTIONS, *base])
    if batch.properties.elements:
        yield OF_ELEMENTS
    if batch.properties.stories:
        yield OF_STORIES
    if batch.friction is not None:
        yield FRICTION.format(window=IMPACT_WINDOW, mu=batch.friction)


def _print_columns(batch: RunBatch, runs: Sequence[BatchRun], columns: Columns, n_words: int) -> None:
    """Print columns of all runs; a table for each motion and scale if they do not fit."""
    flat = _table_of_all_runs(batch, runs, columns, n_words)
    if console.table_fits(flat):
        console.print_line()
        console.print_table(flat)
        return
    rows = zip(runs, _rows_of_cells(columns), strict=True)
    for place, members in groupby(rows, key=lambda row: _motion_and_scale_cells(batch, row[0])):
        console.print_line("\n" + " × ".join(place))
        cells = [[run.model, *row] for run, row in members]
        console.print_rows(["model", *(heading for heading, _ in columns)], cells, 1 + n_words)


def print_run_warnings(runs: Sequence[BatchRun]) -> None:
    """Print warnings on stderr of demands that the ground or the tendons cannot meet."""
    found = [f"Warning: {run.motion} × {run.scale:g}: {warning}" for run in runs for warning in run.warnings]
    _print_first_lines(found, "and {} more warnings; --json lists them all")


def print_failed_runs(runs: Sequence[BatchRun]) -> int:
    """List on stderr the runs that could not be solved, and return their number."""
    failed = [run for run in runs if run.error is not None]
    if failed:
        console.print_remark(f"{len(failed)} of {len(runs)} runs could not be solved:")
    found = [f"  {run.model} under {run.motion} × {run.scale:g}: {run.error}" for run in failed]
    _print_first_lines(found, "  and {} more; --json and results.csv list them all")
    return len(failed)


def _print_first_lines(found: Sequence[str], rest: str) -> None:
    """Print the first of many lines on stderr, and how many more there are."""
    for line in found[:MAX_LISTED]:
        console.print_remark(line)
    if len(found) > MAX_LISTED:
        console.print_remark(rest.format(len(found) - MAX_LISTED))


def _outputs_of_motion(runs: Sequence[BatchRun]) -> tuple[str, ...]:
    """Return the outputs before the reactions, with those of tendons and what is left where there is any."""
    found = OF_MOTION
    if any(run.peaks["max_tendon_force"] for run in runs):
        found += OF_TENDONS
    if any(run.elements and run.peaks[RESIDUAL] for run in runs):
        found += (RESIDUAL,)
    return found


def _outputs_of_base(batch: RunBatch) -> tuple[str, ...]:
    """Return how far the base moves on a ground that lets it slide, or that gives."""
    ground = ground_under_structure(batch.properties, batch.options.ground)
    slides, gives = ground is not None and ground.slides, ground is not None and ground.springs is not None
    return (outputs_of("sliding") if slides else ()) + (outputs_of("springs") if gives else ())


def _columns_of_outputs(runs: Sequence[BatchRun], names: Sequence[str], units: UnitSystem) -> Columns:
    columns: Columns = []
    for name in names:
        values = [run.peaks[name] for run in runs]
        unit = OUTPUTS[name].unit_in(units, largest=max(abs(value or 0.0) for value in values))
        cells = [console.number(None if value is None else value / unit.size) for value in values]
        columns.append((unit.heading(OUTPUTS[name].symbol), cells))
    return columns


def _columns_of_times(runs: Sequence[BatchRun], units: UnitSystem) -> Columns:
    """The times of the peaks, and of the end."""
    times = {f"time_of_{name}": f"t({OUTPUTS[name].symbol})" for name in (*OF_MOTION, *REACTIONS)}
    size, unit = units.of("time")
    return [
        (f"{symbol} [{unit}]", [console.number(None if t is None else t / size, 5) for t in values])
        for name, symbol in (times | {"end_time": OUTPUTS["end_time"].symbol}).items()
        for values in ([run.peaks[name] for run in runs],)
    ]


def _peak_columns(runs: Sequence[BatchRun], units: UnitSystem) -> Columns:
    first, rest = len(OF_MOTION), _columns_of_outputs(runs, _outputs_of_motion(runs), units)
    impacts = ["-" if run.error else str(run.peaks["n_impacts"]) for run in runs]
    status = ("status", [_run_status_text(run) for run in runs])
    columns: Columns = [status, *rest[:first], (OUTPUTS["n_impacts"].symbol, impacts), *rest[first:]]
    times = [None if run.run_time is None else 1e3 * run.run_time for run in runs]
    return columns if set(times) == {None} else [*columns, ("time [ms]", [console.number(t, 3) for t in times])]


def _vertical_component_names(motions: Sequence[GroundMotion], units: UnitSystem) -> list[str]:
    """Name the vertical components, if any."""
    upwards = [motion for motion in motions if motion.vertical is not None]
    size, unit = units.of("acceleration", "m/s²")
    lines = [f"Vertical: {_record_source(each)}, PVA = {each.pva / size:.4g} {unit}" for each in upwards[:MAX_LISTED]]
    return lines + ([f"and {len(upwards) - MAX_LISTED} more vertical components"] if len(upwards) > MAX_LISTED else [])


def _record_source(motion: GroundMotion) -> str:
    source = None if motion.metadata is None else motion.metadata.vertical_source
    return f"{source} with {motion.name}" if source else f"of {motion.name}"


def _sliding_columns(runs: Sequence[BatchRun]) -> Columns:
    times = [run.friction["sliding_time"] for run in runs]
    moments = [
        "-" if run.error is not None else "no" if time is None else console.number(time, 5)
        for run, time in zip(runs, times, strict=True)
    ]
    required = [[console.number(run.friction[name]) for run in runs] for name in SLIDING[:2]]
    return [("μ_req", required[0]), ("μ_req [no impacts]", required[1]), ("slides at [s]", moments)]


def _numbered_columns(runs: Sequence[BatchRun], units: UnitSystem) -> Iterator[Columns]:
    """The peaks of each element and each story that yields, by its number."""
    for name in ("max_element_force", "element_energy", "ductility", "residual_drift"):
        known = OF_TABLES[f"{name}_*"]
        unit = known.unit_in(units)
        values = [run.elements.get(name) for run in runs]
        yield [
            (
                unit.heading(f"{known.symbol}_{k + 1}"),
                [console.number(None if each is None else each[k] / unit.size) for each in values],
            )
            for k in range(max((len(each) for each in values if each is not None), default=0))
        ]


def _motion_and_scale_cells(batch: RunBatch, run: BatchRun) -> list[str]:
    """Motion, and the scale unless all runs have the scale 1."""
    return [run.motion] if batch.scales == [1.0] else [run.motion, f"{run.scale:g}"]


def _rows_of_cells(columns: Columns) -> list[tuple[str, ...]]:
    return list(zip(*(values for _, values in columns), strict=True))


def _table_of_all_runs(batch: RunBatch, runs: Sequence[BatchRun], columns: Columns, n_words: int) -> "Table":
    """Return one table of all runs."""
    words = [*("motion", "scale")[: len(_motion_and_scale_cells(batch, runs[0]))], "model"]
    rows = [
        [*_motion_and_scale_cells(batch, run), run.model, *row]
        for run, row in zip(runs, _rows_of_cells(columns), strict=True)
    ]
    return console.table([*words, *(heading for heading, _ in columns)], rows, len(words) + n_words)


def _run_status_text(run: BatchRun) -> str:
    status = run.status or "failed"
    return console.StyledCell(
        status.replace("_", " ") + (" †" if run.peaks["nominal_overturning"] else ""), STYLES[status]
    )


def _units_of_keys(place: str, table: type) -> dict[str, str]:
    return {f"{place}.{name}": key.unit for name, _, key in schema_keys(table) if key.unit}


UNITS = {
    "dt": "s",
    "pga": MEASURES["pga"].unit,
    "elapsed": "s",
    "run_time": "s",
    **{name: each.si for name, each in ALL_RESULTS.items() if each.si},
    "impact.shortest_excursion": "s",
    "bouc_wen.yield_displacement": "m",
    "initial_rotation": "rad",
    **_units_of_keys("ground", GroundTable),
    **_units_of_keys("ground.springs", SpringsTable),
    **_units_of_keys("ground.bed", SpringBedTable),
}


def write_run_results(
    folder: Path,
    document: dict[str, Any],
    batch: RunBatch,
    runs: Sequence[BatchRun],
    *,
    figures: int,
    form: str,
    force: bool,
) -> None:
    """Write results.csv, summary.json and, of up to `figures` motions, histories and one figure for each motion.

    Histories are one CSV file for each motion, or one file of another format for each motion and model.
    """
    import pandas as pd

    histories = batch.history and len(batch.motions) * len(batch.scales) <= figures
    with output.staged_output_folder(folder, document, force=force) as stage:
        output.write_table(pd.DataFrame([run.row() for run in runs]), stage / "results.csv")
        if histories:
            _write_histories(stage, batch, runs, form)
    console.print_remark(
        f"Written to {folder}" + ("" if histories else "; no histories and figures of more than --figures motions")
    )


def _write_histories(stage: Path, batch: RunBatch, runs: Sequence[BatchRun], form: str) -> None:
    import pandas as pd

    from rockflex.plot._figures import save_figure
    from rockflex.plot._history import plot_history

    groups = [(place, list(members)) for place, members in groupby(runs, key=lambda run: (run.motion, run.scale))]
    several = len({scale for (_, scale), _ in groups}) > 1
    names = [f"history-{motion}-x{scale:g}" if several else f"history-{motion}" for (motion, scale), _ in groups]
    for stem, ((motion, scale), members) in zip(output.output_file_stems(names), groups, strict=True):
        responses = [run.response for run in members if run.response is not None]
        if not responses:
            continue
        if form == "csv":
            table = pd.concat(list(_history_tables(batch, responses)))
            output.write_table(table, stage / f"{stem}.csv")
        else:
            write = {"mat": to_matlab, "nc": to_netcdf}[form]
            for response in responses:
                write(response, stage / f"{stem}-{response.model}.{form}")
        title = None if scale == 1.0 else f"{motion} × {scale:g}"
        labels = [response.model for response in responses]
        save_figure(plot_history(responses, labels=labels, title=title), stage / f"{stem}.png")


def _history_tables(batch: RunBatch, responses: Sequence[Response]) -> "Iterator[pd.DataFrame]":
    """Histories as tables, one model below the other; an event is two rows at the same time."""
    import pandas as pd

    names = list[str]()
    if batch.options.bouc_wen is not None:
        names.append("yielding")
    if batch.friction is not None:
        names.append("friction_demand")
    for response in responses:
        assert response.history is not None
        yield pd.DataFrame({"model": response.model, **history_columns(response.history, names)})


_COMMAND, _FAILURE = 400, 200  # letters


def checked_path_of_report(path: Path, *, force: bool, flag: str = "--report") -> Path:
    """Return the path of a report, before anything is simulated."""
    page = checked_report_path(flag, path)
    if page.exists() and not force:
        raise InputError(f"{flag} {page} exists. Give another name, or --force to replace it.")
    return page


def check_one_run_for_report(batches: Sequence[RunBatch]) -> None:
    """Refuse more than one page holds, before anything is simulated."""
    if len(batches) > 1:
        raise InputError(
            f"--report is of one structure, but the case has {len(batches)}. rockflex compare reports several, and "
            "rockflex project each."
        )
    batch = batches[0]
    motions, scales, models = len(batch.motions), len(batch.scales), len(batch.models)
    if motions * scales > 1:
        first = batch.motions[0].name
        raise InputError(
            f"--report is of one motion at one scale, but there are {number_with_noun(motions, 'motion')} at "
            f"{number_with_noun(scales, 'scale')}. Name one record, such as SUITE/NAME ({first}), with one --scale; a "
            "loop "
            "writes a report of each."
        )
    if models > MAX_RUNS:
        raise InputError(
            f"--report has room for {MAX_RUNS} models, but there are {models}. Choose the ones that matter with "
            "--model."
        )


def write_report_of_run(
    page: Path, loaded: LoadedStructure, batch: RunBatch, runs: Sequence[BatchRun], head: dict[str, Any]
) -> None:
    """Write the report of a batch of one motion at one scale; `head` replaces what the structure file says."""
    motion, scale = batch.motions[0], batch.scales[0]
    times = "" if scale == 1.0 else f" × {scale:g}"
    with use_language(head["language"], head["decimal"]):
        record = (motion.name or translated("a ground motion")) + times
        title = translated("{structure} under {record}", structure=loaded.name, record=record)
        failed = [
            translated("{model} could not be solved: {error}", model=run.model, error=shortened(run.error, _FAILURE))
            for run in runs
            if run.error
        ]
    given: dict[str, Any] = {"title": title, **loaded.report, **head}
    told = output.written_remark(page)
    write_report(
        [run.response for run in runs if run.response is not None],
        page,
        structure=loaded.built,
        motion=motion,
        friction=batch.friction,
        notes=[*failed[:1], *_typed_command()],
        **given,
    )
    prints = "; any browser prints it on one sheet of A4" if page.suffix.lower().startswith(".htm") else ""
    console.print_remark(f"{told}{prints}")


def _typed_command() -> list[str]:
    """Return the command as typed, which repeats the page, if this is one."""
    typed = sys.argv[1:]
    return [shortened(f"Command: rockflex {shlex.join(typed)}", _COMMAND)] if typed[:1] == ["run"] else []
