"""Alternatives under the same records, side by side."""

from collections.abc import Iterable, Mapping
from string import ascii_uppercase
from typing import Any, Literal, SupportsIndex, TypeAlias, TypeVar

import numpy as np

from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.shown import number_with_noun, shown
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._impact import ImpactLaw
from rockflex.models._label import Model
from rockflex.response._comparison import Comparison
from rockflex.response._record_set import floor_peaks
from rockflex.structure._rocking import RockingProperties
from rockflex.studies._arguments import (
    GroundChoice,
    InitialState,
    Motions,
    RockingStructure,
    checked_motions,
    checked_structures,
)
from rockflex.studies._simulate import simulate_many
from rockflex.studies.progress import ProgressChoice, reporting_progress
from rockflex.studies.running import WorkLimit

T = TypeVar("T")
Alternative: TypeAlias = RockingStructure | RockingProperties

MAX_ALTERNATIVES = 6  # that a figure tells apart


def compare(
    alternatives: Mapping[str, Alternative] | Iterable[Alternative],
    motions: Motions,
    model: str | Model | Mapping[str, str | Model] = "MDOF-S",
    *,
    scale: float = 1.0,
    free_vibration: float | Literal["settle"] = 0.0,
    bouc_wen: BoucWen | Mapping[str, BoucWen] | None = None,
    impact: ImpactLaw | Mapping[str, ImpactLaw] | None = None,
    initial: InitialState | Mapping[str, InitialState] | None = None,
    ground: GroundChoice | Mapping[str, GroundChoice] = None,
    workers: SupportsIndex | None = None,
    work_limit: WorkLimit = "default",
    progress: ProgressChoice = None,
) -> Comparison:
    """Run alternatives under the same records, and compare their demands with those of the first.

    Parameters
    ----------
    alternatives
        2 to 6 structures by their names, or in a sequence: A, B, C.
    motions
        One record, a sequence such as a suite, a mapping from names, or a `Selection`, whose scaled records are used.
    model
        A label or model for all. This and the options that follow may be mappings from the names of alternatives:
        ``model={"tied": "MDOF-S", "fixed": "fixed"}``. Options are the default for those that a mapping leaves out.
    scale
        Factor on the acceleration.
    free_vibration, bouc_wen, impact, initial, ground, workers, work_limit, progress
        As in `simulate_many`.

    Returns
    -------
    Comparison
        All runs, tables of demands and of differences, and responses to the governing record. `plot_comparison` draws
        it, and `write_report` writes it on one sheet.

    Raises
    ------
    InputError
        If there are too few or too many alternatives, a mapping has an unknown name, or as `simulate_many`.
    SolverError
        If a run cannot be solved.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> tied = rf.Restrained(frame, rf.Tendon(initial_force=100e3, stiffness=5e6))
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> both = rf.compare({"free": frame, "tied": tied}, pulse, "2DOF-S")
    >>> both.demands().loc["max_rotation"].round(4).to_dict()
    {'free': 0.0198, 'tied': 0.0239}
    """
    structures, given = checked_structures(alternatives)
    if not 2 <= len(structures) <= MAX_ALTERNATIVES:
        raise InputError(
            f"alternatives must be 2 to {MAX_ALTERNATIVES} structures, but "
            f"{number_with_noun(len(structures), 'structure was', 'structures were')} given. "
            f"{'Choose those that matter.' if structures[1:] else 'Give another one to compare it with.'}",
            field="alternatives",
        )
    names = tuple(ascii_uppercase[: len(structures)] if given is None else given)
    records = checked_motions(motions)
    own = {
        "models": _for_each("model", model, names),
        "bouc_wen": _for_each("bouc_wen", bouc_wen, names),
        "impact": _for_each("impact", impact, names),
        "initial": _for_each("initial", initial, names),
        "ground": _for_each("ground", ground, names),
    }
    if None in own["models"]:
        lacks = names[own["models"].index(None)]
        raise InputError(f"model has none for {shown(lacks)}. Give a label for each alternative.", field="model")

    import pandas as pd

    tables: list[pd.DataFrame] = []
    with reporting_progress(progress, len(names) * len(records), "runs") as advance:
        for place, (name, structure) in enumerate(zip(names, structures, strict=True)):
            table = simulate_many(
                {name: structure}, records, output="history", scales=scale, free_vibration=free_vibration,
                workers=workers, work_limit=work_limit, **{key: each[place] for key, each in own.items()}
            )  # fmt: skip
            failed = table["error"].notna()
            if failed.any():
                row = table[failed].iloc[0]
                raise SolverError(f"{name} under {row['motion']}, {row['model']}: {row['error']}")
            if free_vibration != "settle":
                table["residual_rotation"] = np.nan
            no_balance = table["balance_ratio"].eq(0.0) & table["max_rotation"].gt(0.0)  # tendons leave no α
            table.loc[no_balance, "balance_ratio"] = np.nan
            tables.append(_with_floors(table))
            advance(len(records))
    first = tables[0]
    size = first["max_rotation"] if first["max_rotation"].gt(0.0).any() else first["max_base_moment"]
    governing = int(np.argmax(size.to_numpy(float)))
    responses = tuple(table["response"].iloc[governing] for table in tables)
    runs = pd.concat([table.astype({"structure": str}).drop(columns="response") for table in tables], ignore_index=True)
    return Comparison(names, tuple(structures), runs, records[governing].scaled(scale), responses)


def _with_floors(table: Any) -> Any:
    """Return a table of responses with the largest drift and acceleration of all floors; NaN if there are none."""
    peaks = [floor_peaks(run) for run in table["response"]]
    names = ("max_story_drift", "max_floor_acceleration")
    return table.assign(**{name: [each.get(name, np.nan) for each in peaks] for name in names})


def _for_each(option: str, given: Any, names: tuple[str, ...]) -> list[Any]:
    """Return the option of each alternative; None where a mapping has none."""
    if not isinstance(given, Mapping):
        return [given] * len(names)
    unknown = [name for name in given if name not in names]
    if unknown:
        raise InputError(
            f"{option} has {shown(unknown[0])}, which is no alternative; these are {', '.join(names)}.", field=option
        )
    return [given.get(name) for name in names]
