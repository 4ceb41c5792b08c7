"""The record of one kind of study."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, field
from importlib import import_module
from typing import TYPE_CHECKING, Any, TypeAlias

from rockflex._errors import InputError, SolverError

if TYPE_CHECKING:
    import pandas as pd

    from rockflex.study.plan import Spec

Row: TypeAlias = dict[str, Any]
Runs: TypeAlias = "pd.DataFrame"
Document: TypeAlias = Mapping[str, Any]
Remark: TypeAlias = Callable[[str], None]
Figures: TypeAlias = Iterator[tuple[str, Callable[[], Any]]]  # name of the file, and what returns the matplotlib Figure


@dataclass
class Findings:
    """What is reported of a study: titled tables, fits that could not be made, and remarks."""

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


def _as_they_are(table: Runs) -> Runs:
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
        Takes a study, its table and the `Findings` to fill.
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
    report: Callable[[Any, Runs, Findings], None]
    figures: Callable[[Document, Runs, str, Remark], Figures]
    measured: bool = False
    runs: Callable[[Runs], Runs] = _as_they_are

    def spec(self) -> "type[Spec]":
        """Return the class of such a study."""
        package, _, name = self.described_by.rpartition(".")
        return getattr(import_module(package), name)
