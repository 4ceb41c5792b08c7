"""Kinds of studies, and the registry of all of them.

The kinds of this package are named here and defined where their reports and figures are; others are entry points.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from difflib import get_close_matches
from importlib import import_module
from importlib.metadata import EntryPoint
from typing import TYPE_CHECKING, Any, TypeAlias

from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.registry import Catalogue
from rockflex.foundation.shown import shown

if TYPE_CHECKING:
    import pandas as pd

    from rockflex.studies.spec import StudySpec


Row: TypeAlias = dict[str, Any]
Runs: TypeAlias = "pd.DataFrame"
Document: TypeAlias = Mapping[str, Any]
Remark: TypeAlias = Callable[[str], None]
Figures: TypeAlias = Iterator[tuple[str, Callable[[], Any]]]  # name of the file, and what returns the matplotlib Figure


@dataclass
class StudyFindings:
    """The report of a study: titled tables, fits that could not be made, and remarks."""

    tables: dict[str, list[Row]] = field(default_factory=dict[str, list[Row]])
    unfitted: list[str] = field(default_factory=list[str])
    remarks: list[str] = field(default_factory=list[str])

    def fitted(self, fit: Callable[[], Any], what: str) -> Any:
        """Return the fit, or None where the data give none; `what` then names it among the unfitted."""
        try:
            return fit()
        except (InputError, SolverError) as error:
            self.unfitted.append(f"{what}: {error}")
            return None


def _unchanged_runs(table: Runs) -> Runs:
    return table


@dataclass(frozen=True, kw_only=True)
class StudyKind:
    """One kind of study. Its functions import what they need when called, so that the registry loads at once.

    Attributes
    ----------
    name : str
        The value of the key `study` in a file.
    command : str
        The command of ``rockflex`` that runs it.
    summary : str
        What the command does, for its help.
    described_by : str
        The class of such a study, with its package.
    report : callable
        Takes a study, its table and the `StudyFindings` to fill.
    figures : callable
        Takes the study's document, its table, an intensity measure and a function for remarks. Yields the name of each
        file and a function that draws it.
    measured : bool
        Whether the intensity measure of the figures can be chosen.
    runs : callable
        Returns the study's table with one row a run, and in `structure` the name under which runs are counted.
    """

    name: str
    command: str
    summary: str
    described_by: str
    report: Callable[[Any, Runs, StudyFindings], None]
    figures: Callable[[Document, Runs, str, Remark], Figures]
    measured: bool = False
    runs: Callable[[Runs], Runs] = _unchanged_runs

    def spec(self) -> "type[StudySpec]":
        """Return the class of such a study."""
        package, _, name = self.described_by.rpartition(".")
        return getattr(import_module(package), name)


_REPORTED = "rockflex.report._study_kinds"
_OWN = {
    "cloud": f"{_REPORTED}:CLOUD",
    "incremental": f"{_REPORTED}:INCREMENTAL",
    "stripes": f"{_REPORTED}:STRIPES",
    "population": "rockflex.papers.silva_stojadinovic_2024.population._study_kind:POPULATION",
    "monte_carlo": f"{_REPORTED}:MONTE_CARLO",
    "design": f"{_REPORTED}:DESIGN",
}
KINDS = Catalogue[StudyKind]([EntryPoint(name, value, "studies") for name, value in _OWN.items()], "studies")


def study_kind_named(name: object) -> StudyKind:
    """Return the kind of a name."""
    found = KINDS.get(name) if isinstance(name, str) else None
    if found is None:
        known = ", ".join(f'"{each}"' for each in KINDS)
        near = get_close_matches(str(name), KINDS, n=1)
        hint = f' Did you mean "{near[0]}"?' if near else ""
        was = "it is missing" if name is None else f"{shown(name)} was given"
        raise InputError(f"study must be one of {known}, but {was}.{hint}")
    return found
