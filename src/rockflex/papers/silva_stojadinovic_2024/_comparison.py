"""The rules by which a printed number reproduces: the meanings of `Verdict`, which the report prints.

The line of a number has its criterion. A statement in words becomes a criterion on a number; the line shows both. A
value or a claim counts once, even if it is printed twice or is about several models. Anything that follows from the way
the library or an equivalent specimen is built is a `ConstructionCheck`, not a number; additional computations are
`Remark`s.
"""

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from enum import StrEnum
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

import rockflex as rf
from rockflex.foundation.arrays import Array
from rockflex.report._document import ConstructionCheck, PublishedNumber, decimal_text

MAX_INTERVAL_WIDTH = 0.5  # over the printed value, above which the interval decides nothing
APPROXIMATE = 0.2  # largest relative difference from a value that is printed as "about" so much
WEAKER = 0.6  # times all records, for which about as many random pairs uplift as in the paper
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
    """How our number compares with the printed one; `meaning` is the rule, best first."""

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
        "With other records, draws or unpublished values: the interval overlaps the printed value but is wider than "
        "half of it, or the criterion holds over only a part of the interval. Or the records decide: it misses with "
        f"ours, but not with all of them times {WEAKER:g}, with which about as many random pairs uplift as in the "
        "paper.",
    )
    INCOMPARABLE = (
        "cannot be compared",
        "A count of outcomes: it depends on how strong the records are, and the paper's are not available. Both counts "
        "are shown; neither agreement nor difference would tell anything.",
    )
    NOT_GIVEN = (
        "parameter not given",
        "Follows from a parameter that the paper chose and does not give. Ours is for a value that we assume, which "
        "makes it agree or not; so neither counts for or against the paper.",
    )
    JUDGEMENT = (
        "authors' judgement",
        'A statement of degree without a number, such as "about 1" or "likely satisfactory", that misses the limit '
        "which is our reading of it: no number of the paper is contradicted, and its authors may read it otherwise. "
        "One that meets our limit is reproduced.",
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
    """Compare a printed value or bound with ours.

    Parameters
    ----------
    name, place, printed, ours, unit, note
        As in `PublishedNumber`; `ours` in the unit in print.
    agreed
        Verdict if the value agrees.
    truncated
        Whether digits may have been cut off in print.
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
    missed: Verdict = Verdict.NOT,
    note: str = "",
) -> PublishedNumber:
    """Check a statement in words by a bound, such as ``"> 1"``, on a number.

    `agreed` and `missed` are the verdicts if the bound holds, and if it does not.
    """
    wanted, value = printed_range(criterion), float(ours)
    verdict = agreed if value in wanted else missed
    return PublishedNumber(
        name, place, printed, value, unit, criterion, _digits_beside_bound(wanted, value), note, verdict, None, None
    )


def judgement(
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
    """Check a statement of degree by a bound that is our reading of it, as the line says."""
    reading = _with_reading(note, criterion, unit)
    return statement(name, place, printed, ours, criterion, unit, agreed=agreed, missed=Verdict.JUDGEMENT, note=reading)


def _with_reading(note: str, criterion: str, unit: str) -> str:
    """Begin a note with whose limit the criterion is."""
    reading = f"{criterion.lstrip('<>≤≥ ')}{f' {unit}' if unit else ''} is our reading"
    return f"{reading}; {note}" if note else reading


def assumed(line: PublishedNumber, parameter: str) -> PublishedNumber:
    """Return a line that follows from an assumed parameter, which its note names."""
    note = "; ".join(part for part in (f"{parameter} is assumed", line.note) if part)
    return replace(line, verdict=Verdict.NOT_GIVEN, note=note)


def statistic(
    name: str,
    place: str,
    printed: str,
    ours: ResampledInterval,
    unit: str = "",
    *,
    weaker: ResampledInterval | None = None,
    note: str = "",
) -> PublishedNumber:
    """Compare a printed value with the interval of ours, from other records or draws, and weaker ones."""
    wanted = printed_range(printed)
    verdict, ends = _interval_verdict(wanted, ours), _ends_in_words(wanted, ours)
    criterion = {
        Verdict.COMPATIBLE: f"{ends} must meet it",
        Verdict.UNDECIDED: f"{ends} meets it, and is wider than half of it",
        Verdict.NOT: f"{ends} must meet it",
    }[verdict]
    if not _is_known(ours):
        criterion = "too few runs for an interval"
    if verdict is Verdict.NOT and weaker is not None and _interval_verdict(wanted, weaker) is not Verdict.NOT:
        verdict, criterion = Verdict.UNDECIDED, f"{criterion}; {_weaker_in_words(wanted, weaker)}"
    return _compared_number_of_verdict(
        name, place, printed, float(ours.estimate), unit, criterion, verdict, wanted, note
    )


def swept(
    name: str, place: str, printed: str, ours: float, values: Array, unit: str = "", *, note: str = ""
) -> PublishedNumber:
    """Compare a printed value with the interval of ours over all combinations of unpublished values."""
    wanted = printed_range(printed)
    interval = ResampledInterval(float(ours), float(values.min()), float(values.max()))
    verdict = _interval_verdict(wanted, interval)
    low, high = (decimal_text(end, _digits_beyond_print(wanted, end)) for end in interval[1:])
    criterion = f"{values.size} combinations of unpublished values, {low} to {high}, must meet it"
    if verdict is Verdict.UNDECIDED:
        criterion = criterion.replace("must meet it", "meet it, and are wider apart than half of it")
    return _compared_number_of_verdict(name, place, printed, float(ours), unit, criterion, verdict, wanted, note)


def _is_known(interval: ResampledInterval) -> bool:
    return math.isfinite(interval.low) and math.isfinite(interval.high)


def _interval_verdict(wanted: PrintedRange, interval: ResampledInterval) -> Verdict:
    if not _is_known(interval):
        return Verdict.UNDECIDED
    if not wanted.meets(interval.low, interval.high):
        return Verdict.NOT
    wide = interval.high - interval.low > MAX_INTERVAL_WIDTH * abs(wanted.value)
    return Verdict.UNDECIDED if wide else Verdict.COMPATIBLE


def _ends_in_words(wanted: PrintedRange, interval: ResampledInterval) -> str:
    digits = _digits_beyond_print(wanted, interval.estimate)
    return f"90 % interval {decimal_text(interval.low, digits)} to {decimal_text(interval.high, digits)}"


def _weaker_in_words(wanted: PrintedRange, weaker: ResampledInterval) -> str:
    digits = _digits_beside_bound(wanted, float(weaker.estimate))
    low, high = (decimal_text(end, digits) for end in weaker[1:])
    return f"records times {WEAKER:g} decide: {low} to {high}"


def count(name: str, place: str, printed: str, ours: ResampledInterval) -> PublishedNumber:
    """Show a count of outcomes, which depends on how strong the records are, next to the printed one."""
    criterion = f"none; 90 % interval {decimal_text(ours.low, 0)} to {decimal_text(ours.high, 0)}"
    wanted, note = printed_range(printed), "depends on how strong the records are"
    return _compared_number_of_verdict(
        name, place, printed, float(ours.estimate), "", criterion, Verdict.INCOMPARABLE, wanted, note
    )


def tendency(
    name: str,
    place: str,
    printed: str,
    ours: ResampledInterval,
    criterion: str,
    unit: str = "",
    *,
    reading: bool = False,
    weaker: ResampledInterval | None = None,
    note: str = "",
) -> PublishedNumber:
    """Check a bound or a statement in words on the interval of a number from other records, and from weaker ones.

    The bound may be our `reading` of words of degree, as in `judgement`.
    """
    wanted, value = printed_range(criterion), float(ours.estimate)
    digits, verdict = _digits_beside_bound(wanted, value), _verdict_over(wanted, ours)
    text = f"{criterion} over the 90 % interval {decimal_text(ours.low, digits)} to {decimal_text(ours.high, digits)}"
    if verdict is Verdict.NOT and weaker is not None and _verdict_over(wanted, weaker) is not Verdict.NOT:
        verdict, text = Verdict.UNDECIDED, f"{text}; {_weaker_in_words(wanted, weaker)}"
    if reading:
        note, verdict = _with_reading(note, criterion, unit), Verdict.JUDGEMENT if verdict is Verdict.NOT else verdict
    return PublishedNumber(name, place, printed, value, unit, text, digits, note, verdict, None, None)


def _verdict_over(wanted: PrintedRange, interval: ResampledInterval) -> Verdict:
    """Return whether a bound holds over an interval: throughout, in part, or nowhere."""
    if math.isnan(interval.low) or math.isnan(interval.high):
        return Verdict.UNDECIDED
    holds = [float(end) in wanted for end in (interval.low, interval.high)]
    return Verdict.COMPATIBLE if all(holds) else Verdict.UNDECIDED if any(holds) else Verdict.NOT


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
