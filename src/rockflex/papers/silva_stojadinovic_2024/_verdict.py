"""The verdicts on a printed number, and their meanings."""

from enum import StrEnum

WIDEST = 0.5  # of the printed value: the width of an interval, above which it tells nothing


class Verdict(StrEnum):
    """How our number compares with the printed one; `_number` has the rules."""

    REPRODUCED = "reproduced"
    COMPATIBLE = "compatible"
    EQUIVALENT = "equivalent specimen"
    UNDECIDED = "cannot tell"
    NOT = "does not reproduce"

    @property
    def meaning(self) -> str:
        """The rule in one or two sentences."""
        return _MEANINGS[self]


_MEANINGS = {
    Verdict.REPRODUCED: (
        "From the input in the paper: it rounds to the printed digits (or is cut off to them, as noted), or the "
        "criterion holds."
    ),
    Verdict.COMPATIBLE: (
        "With other records or random draws: the 90 % interval overlaps what rounds to the printed digits "
        "and is at most half as wide as the printed value; or the criterion holds over the whole interval. "
        "This does not contradict the paper, but does not prove it."
    ),
    Verdict.EQUIVALENT: (
        'As "reproduced", for a structure that meets the published ratios of a tested specimen but is not the specimen.'
    ),
    Verdict.UNDECIDED: (
        "With other records or draws: the 90 % interval overlaps the printed value but is wider than half of "
        "it, or the criterion holds over only a part of the interval."
    ),
    Verdict.NOT: "None of these. Nothing is adjusted to pass; the difference is shown.",
}
