"""Sets of ground motions."""

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from typing import overload

from rockflex._checks import instance
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex._values import Value
from rockflex.motion._ground_motion import GroundMotion


@dataclass(frozen=True, eq=False, init=False, repr=False)
class Suite(Value, Sequence[GroundMotion]):
    """An ordered set of motions with unique names: a sequence, and a mapping by name.

    ``suite[0]`` and ``suite["FF-12-a"]`` are motions, ``suite[:10]`` is a suite, ``"FF-12-a" in suite`` checks
    whether a name occurs, and iteration gives the motions.

    Parameters
    ----------
    motions : iterable of GroundMotion
        The motions, at least one, with unique names.
    name : str, optional
        Name of the suite.

    Raises
    ------
    InputError
        If there is no motion, an element is not a motion, or a name occurs twice.

    Examples
    --------
    >>> import rockflex as rf
    >>> pulses = [rf.ricker_pulse(2.0, period) for period in (0.5, 1.0)]
    >>> suite = rf.Suite(pulses, name="pulses")
    >>> len(suite), suite[0].pga == pulses[0].pga
    (2, True)
    """

    motions: tuple[GroundMotion, ...]
    name: str = ""

    def __init__(self, motions: Iterable[GroundMotion], name: str = "") -> None:
        if not isinstance(motions, Iterable):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(
                f"motions must be a sequence of GroundMotion objects, but {type(motions).__name__} was given."
            )
        members = tuple(motions)
        instance("name", name, str)
        if not members:
            raise InputError("A suite needs at least one motion, but none was given.")
        for motion in members:
            if not isinstance(motion, GroundMotion):  # pyright: ignore[reportUnnecessaryIsInstance]
                raise InputError(f"A suite holds GroundMotion objects, but {type(motion).__name__} was given.")
        repeated = [key for key, count in Counter(motion.name for motion in members).items() if count > 1]
        if repeated:
            names = ", ".join(map(repr, repeated[:5]))
            raise InputError(
                f"The motions of a suite need different names, but {names} occurs more than once. "
                "Rename: dataclasses.replace(motion, name=...), or rename the files."
            )
        vars(self).update(motions=members, name=name)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the motions, in order."""
        return tuple(motion.name for motion in self.motions)

    def __repr__(self) -> str:
        return f"Suite({self.name!r}, {len(self)} motions: {self.names[0]!r} ... {self.names[-1]!r})"

    def __len__(self) -> int:
        return len(self.motions)

    def __iter__(self) -> Iterator[GroundMotion]:
        return iter(self.motions)

    def __contains__(self, value: object) -> bool:
        return value in self.names if isinstance(value, str) else value in self.motions

    @overload
    def __getitem__(self, index: int | str) -> GroundMotion: ...
    @overload
    def __getitem__(self, index: slice) -> "Suite": ...
    def __getitem__(self, index: int | str | slice) -> "GroundMotion | Suite":
        """Return the motion at an index or with a name, or the suite of a slice."""
        if isinstance(index, slice):
            return Suite(self.motions[index], self.name)
        if not isinstance(index, str):
            return self.motions[index]
        for motion in self.motions:
            if motion.name == index:
                return motion
        near = get_close_matches(index, self.names, n=3, cutoff=0.4) or self.names[:3]
        raise InputError(
            f"No motion of the suite {shown(self.name)} is named {shown(index)}. "
            f"The nearest names are {', '.join(map(repr, near))}; .names lists all {len(self)}."
        )
