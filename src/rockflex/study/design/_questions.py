"""What a stored study asks of its designs."""

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

from rockflex.fragility import HazardCurve
from rockflex.study.design._table import design_table
from rockflex.study.design.search import DesignCost, Requirement, check_requirements

if TYPE_CHECKING:
    import pandas as pd


def design_tables(
    runs: "pd.DataFrame", spec: Mapping[str, Any], confidence: float | None = 0.9
) -> "Iterator[tuple[float | str, pd.DataFrame]]":
    """Yield each limit of a study with its `design_table`.

    Parameters
    ----------
    runs
        The table of the study.
    spec
        The study as returned by its `document()`.
    confidence
        As in `design_table`.
    """
    for limit, at, _, hazard in questions_of(spec):
        yield limit, design_table(runs, limit, measure=spec["measure"], at=at, hazard=hazard, confidence=confidence)


def questions_of(
    spec: Mapping[str, Any],
) -> "Iterator[tuple[float | str, float | None, float | None, HazardCurve | None]]":
    """Yield limit, level, target and hazard curve of each limit of a study, from its document."""
    hazard = None if spec.get("hazard") is None else HazardCurve(**spec["hazard"])
    limits: list[float | str] = spec["limits"]
    levels, targets = (
        given if isinstance(given, list) else [given] * len(limits) for given in (spec.get("level"), spec.get("target"))
    )
    for limit, level, target in zip(limits, levels, targets, strict=True):
        yield limit, level, target, hazard


def search_of(spec: Mapping[str, Any]) -> tuple[list[Requirement], DesignCost]:
    """Return the requirements and the unit costs of a study with a search, from its document.

    Raises
    ------
    InputError
        If two limits are the same at the same level.
    """
    found = [
        Requirement(limit, target, at, hazard, spec["measure"])  # pyright: ignore[reportArgumentType]
        for limit, at, target, hazard in questions_of(spec)
    ]
    return check_requirements(found), DesignCost(**spec["search"]["cost"])
