"""Hybrid systems: states, phases, events, jumps and outputs. Physics says what they are; `Run` advances them."""

from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from rockflex._arrays import Array
from rockflex._errors import InputError

Key = Hashable
MAX_STATES, MAX_ROWS = 320, 640  # as in march.h


@dataclass(frozen=True, init=False)
class StateLayout:
    """Names of the places in a state vector, in their order, each with the number of places.

    Examples
    --------
    >>> from rockflex.engine import StateLayout
    >>> layout = StateLayout(displacement=2, velocity=2, rotation=1)
    >>> layout.size, layout["velocity"], layout["rotation"]
    (5, slice(2, 4, None), 4)
    """

    parts: tuple[tuple[str, int], ...]

    def __init__(self, **parts: int) -> None:
        for name, count in parts.items():
            if count != int(count) or count < 0:
                raise InputError(f"The number of places of the state {name!r} must be a whole number, not {count!r}.")
        object.__setattr__(self, "parts", tuple(parts.items()))

    @property
    def size(self) -> int:
        """Number of states."""
        return sum(count for _, count in self.parts)

    def __getitem__(self, name: str) -> int | slice:
        """The place of a state, or the places of several."""
        first = 0
        for part, count in self.parts:
            if part == name:
                return first if count == 1 else slice(first, first + count)
            first += count
        raise KeyError(name)

    def unit(self, name: str) -> Array:
        """The row that is 1 at the places of a name, shape (n,)."""
        row = np.zeros(self.size)
        row[self[name]] = 1.0
        return row


@dataclass(frozen=True, eq=False)
class Event:
    """A condition that holds while a phase lasts, and what follows when it fails.

    Attributes
    ----------
    name : str
        What the event is called in the log.
    row : ndarray, shape (n,)
        Condition: row · y + direct a + constant >= 0.
    target : hashable
        Key of the next phase; None ends the run.
    constant, direct : float
        See `row`.
    scale : float
        Size of a violation, positive: of several conditions that fail at once that with the largest violation over its
        scale is the event.
    jump : ndarray, shape (n, n), or callable, optional
        Matrix by which the state is multiplied; or a function of the state and the acceleration that returns the state
        and the key of the next phase, instead of `target`. Without it the state is continuous.
    rest : tuple of ndarray (n,), float and key, optional
        Where |row · y| after the jump is at most that number, the next phase is that of this key.
    """

    name: str
    row: Array
    target: Key | None
    constant: float = 0.0
    direct: float = 0.0
    scale: float = 1.0
    jump: Array | Callable[[Array, float], tuple[Array, Key | None]] | None = None
    rest: tuple[Array, float, Key] | None = None

    def follow(self, state: Array, acceleration: float) -> tuple[Array, Key | None]:
        """The state after the jump, and the key of the phase that follows."""
        if callable(self.jump):
            found, key = self.jump(state.copy(), acceleration)
            return array(f"the state after event {self.name!r}", found, state.shape), key
        after = state if self.jump is None else self.jump @ state
        if self.rest is not None and abs(float(self.rest[0] @ after)) <= self.rest[1]:
            return after, self.rest[2]
        return after, self.target


@dataclass(frozen=True, eq=False)
class LinearPhase:
    """A phase: y' = A y + f a(t) + c with outputs C y + d a + e, while the conditions of its events hold.

    Attributes
    ----------
    A : ndarray, shape (n, n)
    f, c : ndarray, shape (n,)
    C : ndarray, shape (m, n)
    d, e : ndarray, shape (m,)
    events : tuple of Event
    """

    A: Array
    f: Array
    c: Array
    C: Array
    d: Array
    e: Array
    events: tuple[Event, ...] = ()


@dataclass(frozen=True, eq=False)
class System:
    """A hybrid system.

    Attributes
    ----------
    layout : StateLayout
        The states.
    outputs : sequence of str
        Names of the m outputs, in the order of the rows of every phase.
    phase : callable
        Returns the `LinearPhase` of a key; called once for each that a run meets.
    start : hashable
        Key of the first phase.
    one_sided : sequence of str
        Names of the outputs whose peak is the largest value, and not the largest magnitude.
    """

    layout: StateLayout
    outputs: Sequence[str]
    phase: Callable[[Any], LinearPhase]
    start: Key
    one_sided: Sequence[str] = field(default=())

    def __post_init__(self) -> None:
        if not 0 < self.layout.size <= MAX_STATES:
            raise InputError(f"A system must have 1 to {MAX_STATES} states, but the layout has {self.layout.size}.")
        if len(set(self.outputs)) < len(self.outputs):
            raise InputError(f"The names of outputs must differ, but {list(self.outputs)} were given.")
        for name in self.one_sided:
            if name not in self.outputs:
                raise InputError(f"The one-sided output {name!r} is none of the outputs {list(self.outputs)}.")

    def checked(self, key: Key) -> LinearPhase:
        """The phase of a key, its arrays as copies of double precision.

        Raises
        ------
        InputError
            If there is no such phase, or an array has the wrong shape, or holds NaN or infinity; it names the key and
            the output or event.
        """
        found: Any
        try:
            found = self.phase(key)
        except LookupError as error:
            raise InputError(f"The system has no phase {key!r}: {error!r}.") from error
        place, n, m = f"phase {key!r}: ", self.layout.size, len(self.outputs)
        if not isinstance(found, LinearPhase):
            raise InputError(f"{place}a LinearPhase is needed, but {type(found).__name__} was given.")
        shapes = {"A": (n, n), "f": (n,), "c": (n,), "C": (m, n), "d": (m,), "e": (m,)}
        arrays = {
            name: array(place + name, getattr(found, name), shape, finite=name in "Afc")
            for name, shape in shapes.items()
        }
        for output, *row in zip(self.outputs, arrays["C"], arrays["d"], arrays["e"], strict=True):
            array(f"{place}output {output!r}", np.hstack(row), (n + 2,))
        listed: Any = found.events
        if not isinstance(listed, tuple | list):
            raise InputError(f"{place}events must be a tuple, but {listed!r} was given.")
        events = tuple(_checked(place, event, n) for event in found.events)
        if up8(max(1, m)) + up8(len(events)) > MAX_ROWS:
            raise InputError(f"{place}{m} outputs and {len(events)} events are more than {MAX_ROWS} rows.")
        return replace(found, events=events, **arrays)


def _checked(place: str, event: Any, n: int) -> Event:
    if not isinstance(event, Event):
        raise InputError(f"{place}events must be of the class Event, but {event!r} was given.")
    place += f"event {event.name!r}: "
    numbers = {name: float(array(place + name, getattr(event, name), ())) for name in ("constant", "direct", "scale")}
    if numbers["scale"] <= 0.0:
        raise InputError(f"{place}scale must be positive, but {event.scale} was given.")
    jump, rest = event.jump, event.rest
    if jump is not None and not callable(jump):
        jump = array(place + "jump", jump, (n, n))
    if rest is not None:
        row, limit, key = rest
        rest = array(place + "rest", row, (n,)), float(array(place + "rest", limit, ())), key
    return replace(event, row=array(place + "row", event.row, (n,)), jump=jump, rest=rest, **numbers)


def up8(count: int) -> int:
    """The next multiple of 8."""
    return -(-count // 8) * 8


def array(name: str, values: Any, shape: tuple[int, ...], *, finite: bool = True) -> Array:
    """Return a copy in double precision, and refuse what has another shape or is not finite."""
    try:
        found = np.array(values, dtype=complex if np.iscomplexobj(values) else float).astype(float, casting="safe")
    except (TypeError, ValueError) as error:
        raise InputError(f"{name} must consist of real numbers.") from error
    if found.shape != shape:
        raise InputError(f"{name} must have the shape {shape}, but {found.shape} was given.")
    if finite and not np.isfinite(found).all():
        raise InputError(f"{name} must be finite, but NaN or infinity was given.")
    return found


def acceleration(values: Any) -> Array:
    """Return an acceleration as the loops need it."""
    found = np.asarray(values)
    if found.ndim != 1 or found.size == 0:
        raise InputError(f"The acceleration must be one row of at least one sample, but {found.shape} was given.")
    if found.dtype != float or not found.flags.c_contiguous or not found.flags.aligned:
        found = array("the acceleration", found, found.shape, finite=False)
    if not np.isfinite(found).all():
        first = int(np.argmin(np.isfinite(found)))
        raise InputError(f"The acceleration must be finite, but sample {first} is {found[first]}.")
    return found
