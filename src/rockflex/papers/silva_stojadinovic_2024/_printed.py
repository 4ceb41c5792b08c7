"""Printed numbers, and the range of values that each of them can represent."""

import math
import re
from dataclasses import dataclass

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._verdict import ROUGH

_WORDS = r"(?P<word>about|approximately|≈|≅)\s*"
_NUMBER = r"[-+−]?\d[\d' ]*(?:\.\d+)?"
_VALUE = re.compile(rf"(?:{_WORDS})?(?P<value>{_NUMBER})(?:\s*/\s*(?P<divisor>{_NUMBER}))?")
_BOUND = re.compile(rf"(?P<sign>[<>≤≥])\s*(?P<value>{_NUMBER})")
_SLACK = 1e-14  # relative, for the binary image of a decimal edge


@dataclass(frozen=True)
class Range:
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


def range_of(printed: str, *, truncated: bool = False) -> Range:
    """Read a printed number.

    Parameters
    ----------
    printed
        ``"1.66"``, ``"−0.24"``, ``"24'178'750"``, ``"580000/3"``, ``"about 44"``, or a bound such as ``"≤ 3.2"``. A
        value represents all that rounds to its digits, and with a word before it, of that what is within 20 % of it.
    truncated
        Whether digits may have been cut off instead of rounded: up to a unit of the last digit away from zero.

    Raises
    ------
    InputError
        If it is none of these.
    """
    bound = _BOUND.fullmatch(printed.strip())
    if bound:
        value, sign = _number(bound["value"]), bound["sign"]
        below, above = (-math.inf, value), (value, math.inf)
        low, high = below if sign in "<≤" else above
        return Range(low, high, sign in "<>", value, _step(bound["value"]), is_bound=True)
    match = _VALUE.fullmatch(printed.strip())
    if not match:
        raise rf.InputError(
            f"A printed number must read like '1.66', 'about 44', '580000/3' or '≤ 3.2', but {printed!r} was given. "
            "Give what is no number as a statement, with a criterion."
        )
    divisor = _number(match["divisor"]) if match["divisor"] else 1.0
    value, step = _number(match["value"]) / divisor, _step(match["value"]) / divisor
    low, high = value - 0.5 * step, value + 0.5 * step
    if truncated:
        low, high = (value - step, high) if value < 0.0 else (low, value + step)
    rough = match["word"] is not None
    if rough:
        low, high = max(low, value - ROUGH * abs(value)), min(high, value + ROUGH * abs(value))
    return Range(low, high, open=False, value=value, step=step, is_bound=False, rough=rough)


def _number(text: str) -> float:
    return float(re.sub("[' ]", "", text).replace("−", "-"))


def _step(text: str) -> float:
    return 10.0 ** -len(text.partition(".")[2])
