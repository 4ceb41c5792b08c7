"""The files of ``rockflex run --out``."""

from collections.abc import Iterator, Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

from rockflex.cli._console import note
from rockflex.cli._output import file_stems, staged
from rockflex.cli._simulations import Batch, Run
from rockflex.motion import MEASURES
from rockflex.response import Response, history_columns

if TYPE_CHECKING:
    import pandas as pd

UNITS = {
    "dt": "s",
    "duration": "s",
    "pga": MEASURES["pga"].unit,
    "elapsed": "s",
    "run_time": "s",
    "end_time": "s",
    "time_of_max_*": "s",
    "max_rotation": "rad",
    "time_of_min_*": "s",
    "max_top_displacement": "m",
    "max_total_top_displacement": "m",
    "max_base_moment": "N m",
    "max_base_shear": "N",
    "max_horizontal_reaction": "N",
    "min_vertical_reaction": "N",
    "max_tendon_force": "N",
    "max_element_force_*": "N",
    "max_element_elongation_*": "m",
    "element_energy_*": "J",
    "residual_rotation": "rad",
    "max_slip": "m",
    "residual_slip": "m",
    "max_edge_uplift": "m",
    "max_edge_settlement": "m",
    "sliding_time": "s",
    "impact.shortest_excursion": "s",
    "bouc_wen.yield_displacement": "m",
    "initial_rotation": "rad",
    "ground.base_inertia": "kg m²",
    "ground.mat_mass": "kg",
    "ground.springs.positions": "m",
    "ground.springs.stiffness": "N/m",
    "ground.springs.damping": "N s/m",
    "ground.bed.breadth": "m",
    "ground.bed.subgrade_modulus": "N/m³",
    "ground.bed.shear_modulus": "N/m²",
    "ground.bed.damping": "N s/m",
    "ground.bed.end_zone": "m",
}


def write_runs(
    folder: Path, document: dict[str, Any], batch: Batch, runs: Sequence[Run], *, figures: int, force: bool
) -> None:
    """Write results.csv, summary.json and, of up to `figures` motions, one CSV file and one figure for each motion.

    Raises
    ------
    InputError
        If the folder cannot be written to, or is not empty and `force` is not set.
    """
    import pandas as pd

    histories = batch.history and len(batch.motions) * len(batch.scales) <= figures
    with staged(folder, document, force=force) as stage:
        pd.DataFrame([run.row() for run in runs]).to_csv(stage / "results.csv", index=False, lineterminator="\n")
        if histories:
            _write_histories(stage, batch, runs)
    note(f"Written to {folder}" + ("" if histories else "; no histories and figures of more than --figures motions"))


def _write_histories(stage: Path, batch: Batch, runs: Sequence[Run]) -> None:
    import pandas as pd

    from rockflex.plot import plot_history, save_figure

    groups = [(place, list(members)) for place, members in groupby(runs, key=lambda run: (run.motion, run.scale))]
    several = len({scale for (_, scale), _ in groups}) > 1
    names = [f"history-{motion}-x{scale:g}" if several else f"history-{motion}" for (motion, scale), _ in groups]
    for stem, ((motion, scale), members) in zip(file_stems(names), groups, strict=True):
        responses = [run.response for run in members if run.response is not None]
        if not responses:
            continue
        table = pd.concat(list(_series(batch, responses)))
        table.to_csv(stage / f"{stem}.csv", index=False, lineterminator="\n")
        title = None if scale == 1.0 else f"{motion} × {scale:g}"
        labels = [response.model for response in responses]
        save_figure(plot_history(responses, labels=labels, title=title), stage / f"{stem}.png")


def _series(batch: Batch, responses: Sequence[Response]) -> "Iterator[pd.DataFrame]":
    """Histories as tables, one model below the other; an event is two rows at the same time."""
    import pandas as pd

    names = list[str]()
    if batch.assumptions.bouc_wen is not None:
        names.append("yielding")
    if batch.friction is not None:
        names.append("friction_demand")
    for response in responses:
        assert response.history is not None
        yield pd.DataFrame({"model": response.model, **history_columns(response.history, names)})
