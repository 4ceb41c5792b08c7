"""``rockflex run --report``: the runs of one motion at one scale on one page."""

import shlex
import sys
from collections.abc import Sequence
from pathlib import Path

from rockflex._errors import InputError
from rockflex._shown import counted, shortened
from rockflex.cli._console import note
from rockflex.cli._simulations import Batch, Run
from rockflex.cli._structures import LoadedStructure
from rockflex.report.run import MAX_RUNS, checked_path, write_report

_COMMAND, _FAILURE = 400, 200  # letters


def check_page(path: Path, *, force: bool) -> Path:
    """Return the path of a report, before anything is simulated.

    Raises
    ------
    InputError
        If it is no path of a page, or exists and `force` is not set.
    """
    page = checked_path("--report", path)
    if page.exists() and not force:
        raise InputError(f"--report {page} exists. Give another name, or --force to replace it.")
    return page


def check_runs(batch: Batch) -> None:
    """Refuse what does not fit on a page, before anything is simulated.

    Raises
    ------
    InputError
        If there are several motions or scales, or too many models.
    """
    motions, scales, models = len(batch.motions), len(batch.scales), len(batch.models)
    if motions * scales > 1:
        first = batch.motions[0].name
        raise InputError(
            f"--report is of one motion at one scale, but there are {counted(motions, 'motion')} at "
            f"{counted(scales, 'scale')}. Name one record, such as SUITE/NAME ({first}), with one --scale; a loop "
            "writes a report of each."
        )
    if models > MAX_RUNS:
        raise InputError(
            f"--report has room for {MAX_RUNS} models, but there are {models}. Choose the ones that matter with "
            "--model."
        )


def write_page(page: Path, loaded: LoadedStructure, batch: Batch, runs: Sequence[Run]) -> None:
    """Write the report of a batch of one motion at one scale."""
    motion, scale = batch.motions[0], batch.scales[0]
    times = "" if scale == 1.0 else f" × {scale:g}"
    failed = [f"{run.model} could not be solved: {shortened(run.error, _FAILURE)}" for run in runs if run.error]
    write_report(
        [run.response for run in runs if run.response is not None],
        page,
        structure=loaded.built,
        motion=motion,
        title=f"{loaded.name} under {motion.name or 'a ground motion'}{times}",
        friction=batch.friction,
        notes=[*failed[:1], *_command()],
    )
    note(f"Written to {page}; any browser prints it on one sheet of A4")


def _command() -> list[str]:
    """Return the command as typed, which repeats the page, if this is one."""
    typed = sys.argv[1:]
    return [shortened(f"Command: rockflex {shlex.join(typed)}", _COMMAND)] if typed[:1] == ["run"] else []
