"""The parts of the page: facts, and tables with a row for each run."""

from collections.abc import Sequence
from dataclasses import dataclass

from rockflex.report.run._numbers import rounded


@dataclass(frozen=True)
class Cell:
    """A text of the page, and the value that it shows, if it shows one.

    Attributes
    ----------
    text : str
        As printed.
    value : float or None
        In SI units, with all digits.
    of : str
        Name of the value, as in `Response` or `RockingProperties`.
    wrong : bool
        Whether it is to be noticed.
    """

    text: str
    value: float | None = None
    of: str = ""
    wrong: bool = False


@dataclass(frozen=True)
class Fact:
    """A named value: "T_1", with its cell and its unit."""

    name: str
    cell: Cell
    unit: str = ""


@dataclass(frozen=True)
class Table:
    """Headings, each with its unit, and rows of cells; the first column has names."""

    heads: Sequence[tuple[str, str]]
    rows: Sequence[Sequence[Cell]]


def shows(value: float | None, of: str, size: float = 1.0, digits: int = 3, *, wrong: bool = False) -> Cell:
    """Return the cell of a value in units of `size`."""
    return Cell(rounded(None if value is None else value / size, digits), value, of, wrong)


def fact(name: str, value: float, unit: str, of: str, size: float = 1.0, digits: int = 3) -> Fact:
    """Return a fact with a value in units of `size`, whose name is `unit`."""
    return Fact(name, shows(value, of, size, digits), unit)
