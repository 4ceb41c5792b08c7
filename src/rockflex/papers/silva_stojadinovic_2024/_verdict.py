"""The verdicts on a printed number, the kinds of remarks, and their meanings."""

from enum import StrEnum

WIDEST = 0.5  # of the printed value: the width of an interval, above which it tells nothing
ROUGH = 0.2  # of a value that is printed as "about" so much: how far from it ours may be


class _Explained(StrEnum):
    meaning: str

    def __new__(cls, name: str, meaning: str) -> "_Explained":
        """Make a member whose value is the name."""
        member = str.__new__(cls, name)
        member._value_, member.meaning = name, meaning
        return member


class Verdict(_Explained):
    """How our number compares with the printed one; `_number` has the rules. `meaning` is the rule in a sentence."""

    REPRODUCED = (
        "reproduced",
        "From the input in the paper: it rounds to the printed digits (or is cut off to them, as noted), and is within "
        f'{100.0 * ROUGH:g} % of a value printed as "about" or "approximately" so much, which is our reading; or the '
        "criterion holds.",
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


class Kind(_Explained):
    """The kind of a remark, with its `meaning`."""

    AFTERWARDS = (
        "chosen after the fact",
        "An interpretation or a value that was chosen to match the printed one. It shows what would have to be the "
        "case, but is not evidence that the authors did this.",
    )
    BESIDE = "beside the paper", "Computed in addition to the printed numbers, to show what one of them depends on."
