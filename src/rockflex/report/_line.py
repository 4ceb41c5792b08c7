"""A line of a report: a value of a publication beside ours."""

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Line:
    """A value of a publication, or what it says in words, and ours; texts are plain.

    Attributes
    ----------
    name, place : str
        What the value is, and where it is in the publication.
    printed : str
        As printed, or the statement in words.
    ours : float
        In `unit`; not finite where a quantity has no bound.
    unit : str
        Of both values; empty for a ratio.
    criterion : str
        The criterion for `ours`.
    digits : int
        Decimals with which `ours` is shown.
    note : str
        A note for the reader, such as why a check must hold.
    """

    name: str
    place: str
    printed: str
    ours: float
    unit: str
    criterion: str
    digits: int
    note: str

    @property
    def ours_as_text(self) -> str:
        """Our value, rounded to `digits`."""
        return as_text(self.ours, self.digits)

    @property
    def remarks(self) -> str:
        """Criterion and note, as in the last column of a table."""
        return "; ".join(part for part in (self.criterion, self.note) if part)


@dataclass(frozen=True)
class Number(Line):
    """A number of a publication and ours.

    Attributes
    ----------
    verdict : str
        One of the document's verdicts.
    difference : float or None
        Ours minus the printed value in `unit`; None for a statement, and for a bound that holds.
    relative : float or None
        The difference over the printed value.
    """

    verdict: str
    difference: float | None
    relative: float | None

    @property
    def difference_as_text(self) -> str:
        """The difference with its sign, and in per cent; empty if there is none."""
        if self.difference is None:
            return ""
        text = f"{self.difference:+.{self.digits}f}"
        if float(text) == 0.0:
            return "0"
        return (text if self.relative is None else f"{text} ({_percent(self.relative)})").replace("-", "−")


@dataclass(frozen=True)
class Check(Line):
    """Something that must hold by construction, so that it is not counted; `holds` tells whether it does."""

    holds: bool


def as_text(value: float, digits: int) -> str:
    """Write a value with a number of decimals, or with an exponent if they are too few."""
    if not math.isfinite(value):
        return "∞" if value > 0.0 else "−∞" if value < 0.0 else "none"
    if value != 0.0 and abs(value) < 0.5 * 10.0**-digits:
        return f"{value:.1e}".replace("-", "−")
    return f"{value:.{digits}f}".replace("-", "−")


def _percent(relative: float) -> str:
    """Write a ratio in per cent, with its sign."""
    found = 100.0 * relative
    return f"{found:+.0f} %" if abs(found) >= 10.0 else f"{found:+.2g} %"
