"""``rockflex figures``: the figures of a study that is stored in a folder."""

from pathlib import Path
from typing import Annotated, Any

import typer

from rockflex._errors import InputError, SolverError
from rockflex._shown import shown
from rockflex.cli import _options as options
from rockflex.kinds import KINDS, kind_named

EPILOG = """[bold]Examples[/bold]

rockflex cloud study.toml --out results

rockflex figures results

rockflex figures results --measure sa_t1 --format pdf --out manuscript"""

FORMATS = ("png", "svg", "pdf")
*OTHERS, LAST = (kind.name for kind in KINDS.values() if kind.measured)


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
            metavar="NAME",
            help=f"Intensity measure of {', '.join(OTHERS)} or {LAST} studies, such as sa_t1_5. Default: pgv.",
        ),
    ] = None,
    form: Annotated[str, typer.Option("--format", metavar="|".join(FORMATS), help="Format of the files.")] = "png",
    force: options.Force = False,
) -> None:
    """Draw the results of a study: fragility curves, clouds, capacities, designs, or the agreement of models."""
    if form not in FORMATS:
        raise InputError(f"--format must be one of {', '.join(FORMATS)}, but {shown(form)} was given.")
    from rockflex.cli._console import note
    from rockflex.cli._output import check_folder, staged, versions
    from rockflex.store import StudyFolder

    target = folder / "figures" if out is None else out
    check_folder(target, force=force)
    study = StudyFolder.load(folder)
    kind = kind_named(study.spec.get("study"))
    if measure is not None and not kind.measured:
        raise InputError(
            f"--measure is for {', '.join(OTHERS)} and {LAST} studies, but the study in {folder} is of kind "
            f"{kind.name}. Leave it out."
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
        for stem, draw in kind.figures(study.spec, table, measure or "pgv", note):
            try:
                save_figure(draw(), stage / f"{stem}.{form}")
            except (InputError, SolverError) as error:
                undrawn.append(f"{stem}: {error}")
        if not any(stage.iterdir()):
            raise InputError(f"No figure of {folder} can be drawn. {' '.join(undrawn)}")
    for reason in undrawn:
        note(f"No figure {reason}")
    note(f"Written to {target}")
