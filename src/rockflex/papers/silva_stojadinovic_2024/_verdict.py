"""Whether a number reproduces: all rules are here.

1. *Reproduced.* A value must round to the printed digits; words such as "about" widen nothing. Where a table cuts
   digits off (Table 3 does so with some), a value that is cut off to the printed digits passes too, and the line says
   so. A bound must hold. A statement in words is turned into a criterion on a number; the line shows both.
2. *Reproduced with other records.* The records of the paper cannot be had. A statistic passes if its 90 % bootstrap
   interval meets what rounds to the printed digits; a statement of sign or order, if its criterion holds.
3. *Equivalent specimen.* As 1, of structures that meet the published ratios of a tested specimen and are not it.
4. *Does not reproduce.* Everything else. Nothing is adjusted to pass.
"""

import math
from dataclasses import dataclass
from enum import StrEnum

from rockflex.papers.silva_stojadinovic_2024._printed import Range, range_of

__all__ = ["Number", "Verdict", "compared", "stated", "statistic"]


class Verdict(StrEnum):
    """How a number of ours stands to the printed one."""

    REPRODUCED = "reproduced"
    OTHER_RECORDS = "reproduced with other records"
    EQUIVALENT = "equivalent specimen"
    NOT = "does not reproduce"

    @property
    def meaning(self) -> str:
        """The rule in one sentence."""
        return _MEANINGS[self]


_MEANINGS = {
    Verdict.REPRODUCED: "It rounds to the printed digits (or is cut off to them, and says so), or the criterion holds.",
    Verdict.OTHER_RECORDS: (
        "A statistic of records in place of the paper's: its 90 % bootstrap interval meets what rounds to the printed "
        "digits, or the criterion of sign or order holds."
    ),
    Verdict.EQUIVALENT: (
        "As the first, of a structure that meets the published ratios of a tested specimen and is not the specimen."
    ),
    Verdict.NOT: "None of these. Nothing is adjusted to pass; the difference is shown.",
}


@dataclass(frozen=True)
class Number:
    """One number of the paper beside ours.

    Attributes
    ----------
    name, place : str
        What it is, and where the paper has it.
    printed : str
        As printed, or the statement in words.
    ours : float
        In `unit`; not finite where a quantity has no bound.
    unit : str
        Empty for a ratio.
    criterion : str
        What `ours` had to meet.
    verdict : Verdict
        Whether it does, and on what ground.
    difference : float or None
        Ours less the printed value in `unit`; None of a statement, and of a bound that holds.
    relative : float or None
        The same over the printed value.
    digits : int
        Decimals with which `ours` is shown.
    note : str
        What to know of it.
    """

    name: str
    place: str
    printed: str
    ours: float
    unit: str
    criterion: str
    verdict: Verdict
    difference: float | None
    relative: float | None
    digits: int
    note: str

    @property
    def ours_as_text(self) -> str:
        """Our value with two decimals more than the printed one has."""
        return _shown(self.ours, self.digits)

    @property
    def difference_as_text(self) -> str:
        """The difference with its sign, and in per cent; empty where there is none."""
        if self.difference is None:
            return ""
        shown = f"{self.difference:+.{self.digits}f}"
        if float(shown) == 0.0:
            return "0"
        return (shown if self.relative is None else f"{shown} ({_percent(self.relative)})").replace("-", "−")


def compared(
    name: str,
    place: str,
    printed: str,
    ours: float,
    unit: str = "",
    *,
    ground: Verdict = Verdict.REPRODUCED,
    truncated: bool = False,
    note: str = "",
) -> Number:
    """Compare a value, or a bound, that is printed.

    Parameters
    ----------
    name, place, printed, ours, unit, note
        As in `Number`; `ours` in the unit of the print.
    ground
        Verdict of a value that agrees.
    truncated
        Whether the print may have cut digits off (rule 1).
    """
    wanted, value = range_of(printed, truncated=truncated), float(ours)
    criterion = "must hold" if wanted.is_bound else "must round to it"
    if truncated and value in wanted and value not in range_of(printed):
        criterion = "cut off, not rounded, to it"
    verdict = ground if value in wanted else Verdict.NOT
    return _number(name, place, printed, value, unit, criterion, verdict, wanted, note)


def statistic(
    name: str, place: str, printed: str, ours: float, low: float, high: float, unit: str = "", *, note: str = ""
) -> Number:
    """Compare a statistic of other records, by its 90 % bootstrap interval from `low` to `high` (rule 2)."""
    wanted, value = range_of(printed), float(ours)
    digits = _digits(wanted, value)
    criterion = f"90 % interval {_shown(low, digits)} to {_shown(high, digits)} must meet it"
    verdict = Verdict.OTHER_RECORDS if wanted.meets(low, high) else Verdict.NOT
    return _number(name, place, printed, value, unit, criterion, verdict, wanted, note)


def stated(
    name: str,
    place: str,
    printed: str,
    ours: float,
    criterion: str,
    unit: str = "",
    *,
    ground: Verdict = Verdict.REPRODUCED,
    note: str = "",
) -> Number:
    """Check a statement in words by a bound, such as ``"> 1"``, on a number."""
    wanted, value = range_of(criterion), float(ours)
    verdict = ground if value in wanted else Verdict.NOT
    digits = 0 if value.is_integer() else max(_digits(wanted, value), 3)
    return Number(name, place, printed, value, unit, criterion, verdict, None, None, digits, note)


def _number(
    name: str, place: str, printed: str, ours: float, unit: str, criterion: str, verdict: Verdict, wanted: Range,
    note: str,
) -> Number:  # fmt: skip
    away = ours - wanted.value
    silent = not math.isfinite(away) or (wanted.is_bound and verdict is not Verdict.NOT)
    relative = None if silent or wanted.value == 0.0 else away / abs(wanted.value)
    digits = _digits(wanted, ours)
    return Number(
        name, place, printed, ours, unit, criterion, verdict, None if silent else away, relative, digits, note
    )


def _digits(wanted: Range, ours: float) -> int:
    """Two decimals more than are printed; none of whole numbers beside a whole number."""
    decimals = max(0, round(-math.log10(wanted.step)))
    return 0 if decimals == 0 and ours.is_integer() else decimals + 2


def _percent(relative: float) -> str:
    percent = 100.0 * relative
    return f"{percent:+.0f} %" if abs(percent) >= 10.0 else f"{percent:+.2g} %"


def _shown(value: float, digits: int) -> str:
    if not math.isfinite(value):
        return "∞" if value > 0.0 else "−∞" if value < 0.0 else "none"
    if value != 0.0 and abs(value) < 0.5 * 10.0**-digits:
        return f"{value:.1e}".replace("-", "−")
    return f"{value:.{digits}f}".replace("-", "−")
