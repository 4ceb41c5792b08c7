"""The rules by which a printed number reproduces.

1. *Reproduced.* A value must round to the printed digits. A word such as "about" does not widen the range: of one
   digit rounding alone would allow 25 % and more, so such a value must also lie within 20 % of the printed one (our
   reading of the word). Where a table cuts digits off (Table 3 does so for some), a value that is cut off to the
   printed digits also passes, and its line says so. A bound must hold. A statement in words becomes a criterion on a
   number; the line shows both.
2. *Compatible*, or *cannot tell*. The paper's records and random draws are not available. Values from ours have a 90 %
   interval. It must overlap what rounds to the printed digits, or meet its criterion throughout. The result is *cannot
   tell* if the interval is wider than half the printed value, or only a part of it meets the criterion.
3. *Equivalent specimen.* Rule 1 for a structure that meets the published ratios of a tested specimen but is not the
   specimen itself.
4. *Cannot be compared.* A count of outcomes under other records than the paper's, whatever it is.
5. *Does not reproduce.* Everything else. Nothing is adjusted to pass.

A printed value counts once, even if it is repeated. Anything that follows from the way the library or an equivalent
specimen is built is a `ConstructionCheck`, not a number; additional computations are `Remark`s.
"""

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import rockflex as rf
from rockflex.foundation.arrays import Array
from rockflex.report._document import ConstructionCheck, PublishedNumber, decimal_text

MAX_INTERVAL_WIDTH = 0.5  # over the printed value, above which the interval decides nothing
APPROXIMATE = 0.2  # largest relative difference from a value that is printed as "about" so much
_WORDS = r"(?P<word>about|approximately|≈|≅)\s*"
_NUMBER = r"[-+−]?\d[\d' ]*(?:\.\d+)?"
_VALUE = re.compile(rf"(?:{_WORDS})?(?P<value>{_NUMBER})(?:\s*/\s*(?P<divisor>{_NUMBER}))?")
_BOUND = re.compile(rf"(?P<sign>[<>≤≥])\s*(?P<value>{_NUMBER})")
_SLACK = 1e-14  # relative, for the binary image of a decimal edge
MUST_ROUND = "must round to it"


class _ExplainedName(StrEnum):
    meaning: str

    def __new__(cls, name: str, meaning: str) -> "_ExplainedName":
        """Make a member whose value is the name."""
        member = str.__new__(cls, name)
        member._value_, member.meaning = name, meaning
        return member


class Verdict(_ExplainedName):
    """How our number compares with the printed one; `meaning` is the rule in a sentence.

    The rules are in `_compared_number_of_verdict`.
    """

    REPRODUCED = (
        "reproduced",
        "From the input in the paper: it rounds to the printed digits (or is cut off to them, as noted), and is within "
        f'{100.0 * APPROXIMATE:g} % of a value printed as "about" or "approximately" so much, which is our reading; or '
        "the criterion holds.",
    )
    COMPATIBLE = (
        "compatible",
        "With other records or random draws: the 90 % interval overlaps what rounds to the printed digits "
        "and is at most half as wide as the printed value; or the criterion holds over the whole interval. "
        "This does not contradict the paper, but does not prove it.",
    )
    EQUIVALENT = (
        "equivalent specimen",
        'As "reproduced", for a structure that meets the published ratios of a tested specimen but is not the '
        "specimen.",
    )
    UNDECIDED = (
        "cannot tell",
        "With other records or draws: the 90 % interval overlaps the printed value but is wider than half of "
        "it, or the criterion holds over only a part of the interval.",
    )
    INCOMPARABLE = (
        "cannot be compared",
        "A count of outcomes: it depends on how strong the records are, and the paper's are not available. Both counts "
        "are shown; neither agreement nor difference would tell anything.",
    )
    NOT = "does not reproduce", "None of these. Nothing is adjusted to pass; the difference is shown."


class RemarkKind(_ExplainedName):
    """The kind of a remark, with its `meaning`."""

    AFTERWARDS = (
        "chosen after the fact",
        "An interpretation or a value that was chosen to match the printed one. It shows what would have to be the "
        "case, but is not evidence that the authors did this.",
    )
    BESIDE = "beside the paper", "Computed in addition to the printed numbers, to show what one of them depends on."


@dataclass(frozen=True)
class PrintedRange:
    """The values that a printed number can represent.

    Attributes
    ----------
    low, high : float
        Ends of the interval; infinite for a bound.
    open : bool
        Whether the ends themselves are excluded.
    value : float
        The printed number.
    step : float
        Unit of its last digit.
    is_bound : bool
        Whether a bound was printed, not a value.
    rough : bool
        Whether a word such as "about" was printed before the value.
    """

    low: float
    high: float
    open: bool
    value: float
    step: float
    is_bound: bool
    rough: bool = False

    def __contains__(self, found: object) -> bool:
        if not isinstance(found, float) or math.isnan(found):
            return False
        if self.is_bound:
            outside = found in (self.low, self.high) and not math.isinf(found)
            return self.low <= found <= self.high and not (self.open and outside)
        slack = _SLACK * max(abs(self.low), abs(self.high))
        return self.low - slack <= found <= self.high + slack

    def meets(self, low: float, high: float) -> bool:
        """Return whether the range overlaps an interval."""
        return low <= self.high and high >= self.low


def printed_range(printed: str, *, truncated: bool = False) -> PrintedRange:
    """Read a printed number.

    Parameters
    ----------
    printed
        ``"1.66"``, ``"−0.24"``, ``"24'178'750"``, ``"580000/3"``, ``"about 44"``, or a bound such as ``"≤ 3.2"``. A
        value represents all that rounds to its digits, and with a word before it, of that what is within 20 % of it.
    truncated
        Whether digits may have been cut off instead of rounded: up to a unit of the last digit away from zero.
    """
    bound = _BOUND.fullmatch(printed.strip())
    if bound:
        value, sign = _parsed_printed_number(bound["value"]), bound["sign"]
        below, above = (-math.inf, value), (value, math.inf)
        low, high = below if sign in "<≤" else above
        return PrintedRange(low, high, sign in "<>", value, _step_of_last_printed_digit(bound["value"]), is_bound=True)
    match = _VALUE.fullmatch(printed.strip())
    if not match:
        raise rf.InputError(
            f"A printed number must read like '1.66', 'about 44', '580000/3' or '≤ 3.2', but {printed!r} was given. "
            "Give what is no number as a statement, with a criterion."
        )
    divisor = _parsed_printed_number(match["divisor"]) if match["divisor"] else 1.0
    value = _parsed_printed_number(match["value"]) / divisor
    step = _step_of_last_printed_digit(match["value"]) / divisor
    low, high = value - 0.5 * step, value + 0.5 * step
    if truncated:
        low, high = (value - step, high) if value < 0.0 else (low, value + step)
    rough = match["word"] is not None
    if rough:
        low, high = max(low, value - APPROXIMATE * abs(value)), min(high, value + APPROXIMATE * abs(value))
    return PrintedRange(low, high, open=False, value=value, step=step, is_bound=False, rough=rough)


def _parsed_printed_number(text: str) -> float:
    return float(re.sub("[' ]", "", text).replace("−", "-"))


def _step_of_last_printed_digit(text: str) -> float:
    return 10.0 ** -len(text.partition(".")[2])


class ResampledInterval(NamedTuple):
    """An estimate and its 90 % interval over resampled recordings or random draws; NaN if it does not exist."""

    estimate: float
    low: float
    high: float

    def times(self, factor: float) -> "ResampledInterval":
        """Return the interval in another unit, such as per cent."""
        return ResampledInterval(*(factor * value for value in self))


def bootstrap_intervals(
    fit: Callable[[Array, Array], Array], x: Array, y: NDArray[Any], groups: NDArray[Any], size: int, n: int
) -> list[ResampledInterval]:
    """Return the interval of each of the `size` values of a fit, over `n` draws of whole groups."""
    band = rf.bootstrap_band(fit, x, y, groups, at=np.arange(size), n=n, curve=lambda values, _: values)
    three = zip(band.estimate.tolist(), band.low.tolist(), band.high.tolist(), strict=True)
    return [ResampledInterval(*each) for each in three]


def number(
    name: str,
    place: str,
    printed: str,
    ours: float,
    unit: str = "",
    *,
    agreed: Verdict = Verdict.REPRODUCED,
    truncated: bool = False,
    note: str = "",
) -> PublishedNumber:
    """Compare a printed value or bound with ours (rules 1 and 3).

    Parameters
    ----------
    name, place, printed, ours, unit, note
        As in `PublishedNumber`; `ours` in the unit in print.
    agreed
        Verdict if the value agrees.
    truncated
        Whether digits may have been cut off in print (rule 1).
    """
    wanted, value = printed_range(printed, truncated=truncated), float(ours)
    criterion = "must hold" if wanted.is_bound else MUST_ROUND
    if wanted.rough:
        criterion += f", and be within {100.0 * APPROXIMATE:g} % of it"
    if truncated and value in wanted and value not in printed_range(printed):
        criterion = "cut off, not rounded, to it"
    verdict = agreed if value in wanted else Verdict.NOT
    return _compared_number_of_verdict(name, place, printed, value, unit, criterion, verdict, wanted, note)


def statement(
    name: str,
    place: str,
    printed: str,
    ours: float,
    criterion: str,
    unit: str = "",
    *,
    agreed: Verdict = Verdict.REPRODUCED,
    note: str = "",
) -> PublishedNumber:
    """Check a statement in words by a bound, such as ``"> 1"``, on a number (rules 1 and 3)."""
    wanted, value = printed_range(criterion), float(ours)
    verdict = agreed if value in wanted else Verdict.NOT
    return PublishedNumber(
        name, place, printed, value, unit, criterion, _digits_beside_bound(wanted, value), note, verdict, None, None
    )


def statistic(
    name: str, place: str, printed: str, ours: ResampledInterval, unit: str = "", *, note: str = ""
) -> PublishedNumber:
    """Compare a printed value with the interval of ours, from other records or draws (rule 2)."""
    wanted = printed_range(printed)
    digits = _digits_beyond_print(wanted, ours.estimate)
    known = math.isfinite(ours.low) and math.isfinite(ours.high)
    wide = ours.high - ours.low > MAX_INTERVAL_WIDTH * abs(wanted.value)
    interval = f"90 % interval {decimal_text(ours.low, digits)} to {decimal_text(ours.high, digits)}"
    if not known:
        verdict, criterion = Verdict.UNDECIDED, "too few runs for an interval"
    elif not wanted.meets(ours.low, ours.high):
        verdict, criterion = Verdict.NOT, f"{interval} must meet it"
    elif wide:
        verdict, criterion = Verdict.UNDECIDED, f"{interval} meets it, and is wider than half of it"
    else:
        verdict, criterion = Verdict.COMPATIBLE, f"{interval} must meet it"
    return _compared_number_of_verdict(
        name, place, printed, float(ours.estimate), unit, criterion, verdict, wanted, note
    )


def count(name: str, place: str, printed: str, ours: ResampledInterval) -> PublishedNumber:
    """Show a count of outcomes, which depends on how strong the records are, next to the printed one (rule 4)."""
    criterion = f"none; 90 % interval {decimal_text(ours.low, 0)} to {decimal_text(ours.high, 0)}"
    wanted, note = printed_range(printed), "depends on how strong the records are"
    return _compared_number_of_verdict(
        name, place, printed, float(ours.estimate), "", criterion, Verdict.INCOMPARABLE, wanted, note
    )


def tendency(
    name: str, place: str, printed: str, ours: ResampledInterval, criterion: str, unit: str = "", *, note: str = ""
) -> PublishedNumber:
    """Check a bound or a statement in words on the interval of a number from other records or draws (rule 2)."""
    wanted, value = printed_range(criterion), float(ours.estimate)
    digits = _digits_beside_bound(wanted, value)
    holds = [float(end) in wanted for end in (ours.low, ours.high)]
    verdict = Verdict.COMPATIBLE if all(holds) else Verdict.UNDECIDED if any(holds) else Verdict.NOT
    if math.isnan(ours.low) or math.isnan(ours.high):
        verdict = Verdict.UNDECIDED
    text = f"{criterion} over the 90 % interval {decimal_text(ours.low, digits)} to {decimal_text(ours.high, digits)}"
    return PublishedNumber(name, place, printed, value, unit, text, digits, note, verdict, None, None)


def check(
    name: str, place: str, printed: str, ours: float, criterion: str = "", unit: str = "", *, note: str = ""
) -> ConstructionCheck:
    """Check a value against a bound, such as ``"< 1"``, or by default against the printed number."""
    wanted, value = printed_range(criterion or printed), float(ours)
    digits, words = _digits_beyond_print(wanted, value), criterion or MUST_ROUND
    return ConstructionCheck(name, place, printed, value, unit, words, digits, note, value in wanted)


def _compared_number_of_verdict(
    name: str, place: str, printed: str, ours: float, unit: str, criterion: str, verdict: Verdict, wanted: PrintedRange,
    note: str,
) -> PublishedNumber:  # fmt: skip
    away = ours - wanted.value
    silent = not math.isfinite(away) or (wanted.is_bound and verdict is not Verdict.NOT)
    relative = None if silent or wanted.value == 0.0 else away / abs(wanted.value)
    digits, difference = _digits_beyond_print(wanted, ours), None if silent else away
    return PublishedNumber(name, place, printed, ours, unit, criterion, digits, note, verdict, difference, relative)


def _digits_beyond_print(wanted: PrintedRange, ours: float) -> int:
    """Return two decimals more than printed, or none if both are integers."""
    decimals = max(0, round(-math.log10(wanted.step)))
    return 0 if decimals == 0 and ours.is_integer() else decimals + 2


def _digits_beside_bound(wanted: PrintedRange, ours: float) -> int:
    """Return the decimals of a number that is compared with a bound: at least three, or none for an integer."""
    return 0 if ours.is_integer() else max(_digits_beyond_print(wanted, ours), 3)
