"""Findings about the samples in a file with their evidence: unit, time step, quantity and component."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Generic, Literal, TypeVar

from rockflex.foundation.errors import InputError

T = TypeVar("T")
What = Literal["quantity", "unit", "time step", "component", "samples"]
MAX_QUOTED = 80  # characters of a line that is quoted


class NoAccelerationError(InputError):
    """A file holds no acceleration, such as a velocity, a spectrum or text; a folder of records leaves it out.

    Attributes
    ----------
    found : str
        What it holds, in a word or two for a list of files, such as "velocity".
    """

    def __init__(self, message: str = "", *, found: str = "no acceleration", field: str | None = None) -> None:
        super().__init__(message, field=field)
        self.found = found


@dataclass(frozen=True)
class Finding:
    r"""Something that is known of a record, and what says so.

    Parameters
    ----------
    what : {"quantity", "unit", "time step", "component", "samples"}
        What it is about.
    value : str
        What was found, such as "cm/s2" or "0.005 s".
    evidence : str
        What says so: a line of the file, a label, the name of the file, an argument, or the document of the format.

    Examples
    --------
    >>> import rockflex as rf
    >>> from pathlib import Path
    >>> _ = Path("lab.csv").write_text(
    ...     "time (s), acc (g)\n0.00, 0.0\n0.01, 0.2\n0.02, 0.0\n")
    >>> [print(each) for each in rf.read_motion("lab.csv").metadata.findings][:0]
    quantity: acceleration (label "acc (g)")
    unit: g (label "acc (g)")
    time step: 0.01 s (column "time (s)")
    []
    """

    what: What
    value: str
    evidence: str

    def __str__(self) -> str:
        return f"{self.what}: {self.value} ({self.evidence})"


@dataclass(frozen=True)
class Evidence(Generic[T]):
    """A value, and what says so, as `Finding.evidence`."""

    value: T
    said: str

    def finding(self, what: What, value: str | None = None) -> Finding:
        """Return it as a finding; `value` if it is shown in another way."""
        return Finding(what, str(self.value) if value is None else value, self.said)


def shown_step(dt: float) -> str:
    """Return a time step as a finding shows it."""
    return f"{dt:.12g} s"


def same_step(one: float, other: float) -> bool:
    """Return whether two statements mean the same time step, as far as digits in print tell."""
    return abs(one - other) <= 1e-3 * other


def quoted_line(line: int, text: str) -> str:
    """Return a line of a file as evidence."""
    return f'line {line}: "{" ".join(text.split())[:MAX_QUOTED]}"'


def settled(
    file: Path,
    what: What,
    stated: Sequence[Evidence[T]],
    given: Evidence[T] | None,
    remedy: str,
    same: Callable[[T, T], bool],
) -> Evidence[T] | None:
    """Return what the file states, or what the caller says where it states nothing; None if nobody says anything.

    Where the file contradicts itself, the caller decides; where the caller contradicts the file, nobody does.

    Parameters
    ----------
    stated
        What the file says, the most trustworthy first.
    remedy
        What to do about statements that contradict each other, in the message.

    Raises
    ------
    InputError
        If two statements differ and `given` is none of them, or `given` differs from all statements.
    """
    field = {"unit": "units", "time step": "dt"}.get(what)
    if given is not None:
        if stated and not any(same(given.value, each.value) for each in stated):
            raise InputError(
                f"{file}: the {what} is {stated[0].value} in the file ({stated[0].said}), but {given.said} was given. "
                "Leave the argument out if the file is right; else correct the file.",
                field=field,
            )
        return given
    if not stated:
        return None
    other = next((each for each in stated[1:] if not same(each.value, stated[0].value)), None)
    if other is not None:
        raise InputError(
            f"{file} contradicts itself about the {what}: {stated[0].value} ({stated[0].said}), but {other.value} "
            f"({other.said}). {remedy}",
            field=field,
        )
    return stated[0]
