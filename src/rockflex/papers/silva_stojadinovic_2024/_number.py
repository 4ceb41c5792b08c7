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
specimen is built is a `Check`, not a number; additional computations are `Remark`s.
"""

import math
from typing import NamedTuple

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._printed import Range, range_of
from rockflex.papers.silva_stojadinovic_2024._verdict import ROUGH, WIDEST, Verdict
from rockflex.report import Check, Number
from rockflex.report._line import as_text

MUST_ROUND = "must round to it"


class Interval(NamedTuple):
    """An estimate and its 90 % interval over resampled recordings or random draws; NaN if it does not exist."""

    estimate: float
    low: float
    high: float

    def times(self, factor: float) -> "Interval":
        """Return the interval in another unit, such as per cent."""
        return Interval(*(factor * value for value in self))


def intervals_of(band: rf.BootstrapBand) -> list[Interval]:
    """Return the interval of each value of a bootstrap."""
    three = zip(band.estimate.tolist(), band.low.tolist(), band.high.tolist(), strict=True)
    return [Interval(*each) for each in three]


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
    """Compare a printed value or bound with ours (rules 1 and 3).

    Parameters
    ----------
    name, place, printed, ours, unit, note
        As in `Number`; `ours` in the unit in print.
    ground
        Verdict if the value agrees.
    truncated
        Whether digits may have been cut off in print (rule 1).
    """
    wanted, value = range_of(printed, truncated=truncated), float(ours)
    criterion = "must hold" if wanted.is_bound else MUST_ROUND
    if wanted.rough:
        criterion += f", and be within {100.0 * ROUGH:g} % of it"
    if truncated and value in wanted and value not in range_of(printed):
        criterion = "cut off, not rounded, to it"
    verdict = ground if value in wanted else Verdict.NOT
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
    """Check a statement in words by a bound, such as ``"> 1"``, on a number (rules 1 and 3)."""
    wanted, value = range_of(criterion), float(ours)
    verdict = ground if value in wanted else Verdict.NOT
    return Number(name, place, printed, value, unit, criterion, _digits(wanted, value), note, verdict, None, None)


def statistic(name: str, place: str, printed: str, ours: Interval, unit: str = "", *, note: str = "") -> Number:
    """Compare a printed value with the interval of ours, from other records or draws (rule 2)."""
    wanted = range_of(printed)
    digits = _digits_of(wanted, ours.estimate)
    known = math.isfinite(ours.low) and math.isfinite(ours.high)
    wide = ours.high - ours.low > WIDEST * abs(wanted.value)
    interval = f"90 % interval {as_text(ours.low, digits)} to {as_text(ours.high, digits)}"
    if not known:
        verdict, criterion = Verdict.UNDECIDED, "too few runs for an interval"
    elif not wanted.meets(ours.low, ours.high):
        verdict, criterion = Verdict.NOT, f"{interval} must meet it"
    elif wide:
        verdict, criterion = Verdict.UNDECIDED, f"{interval} meets it, and is wider than half of it"
    else:
        verdict, criterion = Verdict.COMPATIBLE, f"{interval} must meet it"
    return _number(name, place, printed, float(ours.estimate), unit, criterion, verdict, wanted, note)


def count_of(name: str, place: str, printed: str, ours: Interval) -> Number:
    """Show a count of outcomes, which depends on how strong the records are, next to the printed one (rule 4)."""
    criterion = f"none; 90 % interval {as_text(ours.low, 0)} to {as_text(ours.high, 0)}"
    wanted, note = range_of(printed), "depends on how strong the records are"
    return _number(name, place, printed, float(ours.estimate), "", criterion, Verdict.INCOMPARABLE, wanted, note)


def tendency(
    name: str, place: str, printed: str, ours: Interval, criterion: str, unit: str = "", *, note: str = ""
) -> Number:
    """Check a bound or a statement in words on the interval of a number from other records or draws (rule 2)."""
    wanted, value = range_of(criterion), float(ours.estimate)
    digits = _digits(wanted, value)
    holds = [float(end) in wanted for end in (ours.low, ours.high)]
    verdict = Verdict.COMPATIBLE if all(holds) else Verdict.UNDECIDED if any(holds) else Verdict.NOT
    if math.isnan(ours.low) or math.isnan(ours.high):
        verdict = Verdict.UNDECIDED
    text = f"{criterion} over the 90 % interval {as_text(ours.low, digits)} to {as_text(ours.high, digits)}"
    return Number(name, place, printed, value, unit, text, digits, note, verdict, None, None)


def check(
    name: str, place: str, printed: str, ours: float, criterion: str = "", unit: str = "", *, note: str = ""
) -> Check:
    """Check a value against a bound, such as ``"< 1"``, or by default against the printed number."""
    wanted, value = range_of(criterion or printed), float(ours)
    digits, words = _digits_of(wanted, value), criterion or MUST_ROUND
    return Check(name, place, printed, value, unit, words, digits, note, value in wanted)


def _number(
    name: str, place: str, printed: str, ours: float, unit: str, criterion: str, verdict: Verdict, wanted: Range,
    note: str,
) -> Number:  # fmt: skip
    away = ours - wanted.value
    silent = not math.isfinite(away) or (wanted.is_bound and verdict is not Verdict.NOT)
    relative = None if silent or wanted.value == 0.0 else away / abs(wanted.value)
    digits, difference = _digits_of(wanted, ours), None if silent else away
    return Number(name, place, printed, ours, unit, criterion, digits, note, verdict, difference, relative)


def _digits_of(wanted: Range, ours: float) -> int:
    """Return two decimals more than printed, or none if both are integers."""
    decimals = max(0, round(-math.log10(wanted.step)))
    return 0 if decimals == 0 and ours.is_integer() else decimals + 2


def _digits(wanted: Range, ours: float) -> int:
    """Return the decimals of a number that is compared with a bound: at least three, or none for an integer."""
    return 0 if ours.is_integer() else max(_digits_of(wanted, ours), 3)
