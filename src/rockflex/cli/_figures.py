"""``rockflex figures``: the figures of a study that is kept in a folder."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rockflex._errors import InputError, SolverError
from rockflex._shown import shown
from rockflex.cli import _options as options

if TYPE_CHECKING:
    import pandas as pd

EPILOG = """[bold]Examples[/bold]

rockflex cloud study.toml --out results

rockflex figures results

rockflex figures results --measure sa_t1 --format pdf --out manuscript"""

FORMATS = ("png", "svg", "pdf")
MEASURED = ("cloud", "incremental")


def figures(
    folder: Annotated[
        Path, typer.Argument(metavar="FOLDER", help="Folder of a study, finished or not.", show_default=False)
    ],
    out: Annotated[
        Path | None, typer.Option("--out", "-o", metavar="DIR", help="Where to. Default: FOLDER/figures.")
    ] = None,
    measure: Annotated[
        str | None,
        typer.Option(
            metavar="NAME", help="Intensity measure of a cloud or an incremental study, such as sa_t1. Default: pgv."
        ),
    ] = None,
    kind: Annotated[str, typer.Option("--format", metavar="|".join(FORMATS), help="Kind of the files.")] = "png",
    force: options.Force = False,
) -> None:
    """Draw what a study found: fragility curves, clouds, capacities, designs, or the agreement of models."""
    if kind not in FORMATS:
        raise InputError(f"--format must be one of {', '.join(FORMATS)}, but {shown(kind)} was given.")
    from rockflex.cli._console import note
    from rockflex.cli._output import check_folder, staged, versions
    from rockflex.store import StudyFolder

    target = folder / "figures" if out is None else out
    check_folder(target, force=force)
    study = StudyFolder.load(folder)
    name = str(study.spec.get("study"))
    if measure is not None and name not in MEASURED:
        raise InputError(
            f"--measure is for cloud and incremental studies, but {folder} holds one of {name}. Leave it out."
        )
    missing = len(study.missing())
    table = study.frame(partial=True)
    if missing:
        note(f"{missing} of {study.n_chunks} parts are missing: the figures show the others")
    document: dict[str, Any] = {
        "versions": versions(),
        "study": study.spec,
        "parts": study.n_chunks,
        "missing_parts": missing,
    }
    from rockflex.plot import save_figure

    undrawn: list[str] = []
    with staged(target, document, force=force) as stage:
        for stem, draw in _figures(name, study.spec, table, measure or "pgv"):
            try:
                save_figure(draw(), stage / f"{stem}.{kind}")
            except (InputError, SolverError) as error:
                undrawn.append(f"{stem}: {error}")
        if not any(stage.iterdir()):
            raise InputError(f"{folder} gives no figure. {' '.join(undrawn)}")
    for reason in undrawn:
        note(f"No figure {reason}")
    note(f"Written to {target}")


def _figures(
    study: str, spec: dict[str, Any], table: "pd.DataFrame", measure: str
) -> "Iterator[tuple[str, Callable[[], Any]]]":
    """What draws each figure of a study, with the stem of its file."""
    from rockflex import plot

    if study == "cloud":
        fitted = _fitted(table, measure)
        if len(fitted):
            yield "fragility", lambda: plot.plot_fragility(fitted, measure)
        yield "rotation", lambda: plot.plot_clouds(table, "max_rotation", measure)
        yield "top_displacement", lambda: plot.plot_clouds(table, "max_top_displacement", measure)
        if table["max_total_top_displacement"].notna().any():
            yield "total_top_displacement", lambda: plot.plot_clouds(table, "max_total_top_displacement", measure)
    elif study == "incremental":
        yield "capacities", lambda: plot.plot_ida(table, measure)
    elif study == "stripes":
        yield "stripes", lambda: plot.plot_stripes(table, measure=spec["measure"])
    elif study == "population":
        yield "population", lambda: plot.plot_population(table)
        yield "agreement", lambda: plot.plot_agreement(table)
        yield "modal_combination", lambda: plot.plot_modal_combination(table)
    elif study == "design":
        from rockflex.fragility import limit_label
        from rockflex.study.plans import design_tables

        for limit, designs in design_tables(table, spec):
            word = limit_label(limit)
            target = spec.get("target")
            yield f"design_{'_'.join(word.split())}", lambda each=designs, target=target: plot.plot_design(each, target)
    else:
        raise InputError(f"There are no figures of a study of the kind {shown(study)}.")


def _fitted(runs: "pd.DataFrame", measure: str) -> "pd.DataFrame":
    """Runs of a cloud without those of the structures and models that cannot be fitted, which are told."""
    from rockflex.cli._console import note
    from rockflex.fragility import fit_each_cloud

    fits, reasons = fit_each_cloud(runs, measure)
    for (structure, model), reason in reasons.items():
        note(f"No fit: {structure} with {model}: {reason}")
    if not fits:
        note("No figure fragility, and clouds without lines: add records or scales to the study, and run it again")
    left_out = [pair in reasons for pair in zip(runs["structure"].astype(str), runs["model"].astype(str), strict=True)]
    return runs[[not out for out in left_out]]
