"""Hybrid systems: states, phases, events, jumps and outputs. Physics says what they are; `Run` advances them."""

import ctypes
from collections.abc import Callable, Hashable, Sequence
from dataclasses import dataclass, replace
from dataclasses import field as initially
from functools import cached_property
from inspect import Parameter, signature
from math import isfinite
from typing import Any
from weakref import WeakValueDictionary

import numpy as np

from rockflex.engine.field import Compiled, Field, Function, Jump
from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import masked_count
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown

Key = Hashable
MAX_STATES, MAX_ROWS = 1000, 4096  # as in march.h
C_FUNCTION: Any = ctypes.CFUNCTYPE(None).__base__  # of all functions that ctypes knows


class StepTooLongError(InputError):
    """Within one time step a motion grows beyond all numbers; `rate` is the largest growth in 1/s."""

    def __init__(self, message: str, rate: float) -> None:
        super().__init__(message)
        self.rate = rate


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

    @cached_property
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
class Rest:
    """What follows an event instead, where row · y + direct a + constant <= 0 for the state y after its jump.

    Under a vertical acceleration a_v the sum has the terms direct_v a_v + a_v row_v · y, too.

    Attributes
    ----------
    row : ndarray, shape (n,)
    target : hashable
        Key of the next phase; None ends the run.
    constant, direct : float
    jump : ndarray, shape (n, n), optional
        Matrix by which the state after the jump is multiplied.
    row_v : ndarray, shape (n,), optional
    direct_v : float
    """

    row: Array
    target: Key | None
    constant: float | Array = 0.0
    direct: float | Array = 0.0
    jump: Array | None = None
    row_v: Array | None = None
    direct_v: float | Array = 0.0


@dataclass(frozen=True, eq=False)
class Event:
    """A condition that holds while a phase lasts, and what follows when it fails.

    Attributes
    ----------
    name : str
        What the event is called in the log.
    row : ndarray, shape (n,)
        Condition: row · y + direct a + constant >= 0; under a vertical acceleration a_v the sum has the terms
        direct_v a_v + a_v row_v · y, too.
    target : hashable
        Key of the next phase; None ends the run.
    constant, direct : float
        See `row`.
    scale : float
        Size of a violation, positive: of several conditions that fail at once that with the largest violation over its
        scale is the event.
    jump : ndarray, shape (n, n), or Jump, or callable, optional
        Matrix by which the state is multiplied; or a compiled `Jump`, which may choose `other` instead of `target`; or
        a function of the state, the acceleration and, if it takes a third argument, the vertical one, that returns the
        state and the key of the next phase, instead of `target`. Without it the state is continuous.
    rest : Rest, optional
        What follows if the motion is too slow after the jump, which must be a matrix.
    other : hashable, optional
        Key of the phase that a compiled jump may choose.
    noted : str, optional
        Name under which the event counts, too, where a compiled jump says so.
    row_v : ndarray, shape (n,), optional
    direct_v : float
        See `row`.
    """

    name: str
    row: Array
    target: Key | None
    constant: float | Array = 0.0
    direct: float | Array = 0.0
    scale: float | Array = 1.0
    jump: Array | Jump | Callable[..., tuple[Array, Key | None]] | None = None
    rest: Rest | None = None
    other: Key | None = None
    noted: str = ""
    row_v: Array | None = None
    direct_v: float | Array = 0.0
    third: bool = initially(init=False, default=False, repr=False)  # whether the jump asks for the vertical one, too

    def __post_init__(self) -> None:
        if callable(self.jump):
            object.__setattr__(self, "third", _takes_three(self.jump))

    def apply_jump(self, state: Array, acceleration: float, vertical: float = 0.0) -> tuple[Array, Key | None]:
        """The state after a jump that is a function, and the key of the phase that follows."""
        assert callable(self.jump)
        more = (vertical,) if self.third else ()
        found, key = self.jump(state.copy(), acceleration, *more)
        return array(f"the state after event {self.name!r}", found, state.shape), key


@dataclass(frozen=True, eq=False)
class LinearPhase:
    """A phase: y' = A y + f a(t) + c with outputs C y + d a + e, while the conditions of its events hold.

    Under a vertical acceleration a_v it is y' = A y + f a + f_v a_v + a_v A_v y + c with outputs
    C y + d a + d_v a_v + a_v C_v y + e. What is left out is zero.

    For a stack of systems all arrays and numbers of the phase and of its events may have a first axis more.

    Attributes
    ----------
    A : ndarray, shape (n, n)
    f, c : ndarray, shape (n,)
    C : ndarray, shape (m, n)
    d, e : ndarray, shape (m,)
    events : tuple of Event
    A_v : ndarray, shape (n, n), optional
    f_v : ndarray, shape (n,), optional
    C_v : ndarray, shape (m, n), optional
    d_v : ndarray, shape (m,), optional
    """

    A: Array
    f: Array
    c: Array
    C: Array
    d: Array
    e: Array
    events: tuple[Event, ...] = ()
    A_v: Array | None = None
    f_v: Array | None = None
    C_v: Array | None = None
    d_v: Array | None = None

    def of(self, place: int) -> "LinearPhase":
        """The phase of one system of a stack."""
        given = {name: getattr(self, name) for name in ("A", "f", "c", "C", "d", "e", *VERTICAL)}
        arrays = {name: each[place] for name, each in given.items() if each is not None}
        return LinearPhase(**arrays, events=tuple(_of(event, place, EVENT_NUMBERS) for event in self.events))

    @property
    def nbytes(self) -> int:
        """Memory of the phase and its events, in bytes."""
        return _memory_of(self, *self.events, *(event.rest for event in self.events))


def _memory_of(*parts: object) -> int:
    """The memory of dataclasses with arrays, in bytes."""
    found = 0
    for part in parts:
        if part is not None:
            found += OBJECT
            for each in vars(part).values():
                if type(each) is np.ndarray:
                    found += each.nbytes
    return found


OBJECT = 400  # bytes of an event without the numbers in its arrays, or of what follows instead, roughly
VERTICAL = "A_v", "f_v", "C_v", "d_v"


@dataclass(frozen=True, eq=False)
class NonlinearPhase:
    """A phase: y' = F(y, a, a_v) with outputs C y + d a + e or of other forms, while the conditions of its events hold.

    Under a vertical acceleration a_v the outputs have the terms d_v a_v + a_v C_v y, too.

    Attributes
    ----------
    field : Field, or callable
        F, and the outputs that are not linear; or a function of y, a and a_v that returns y', which takes some 25 µs
        a step; or the compiled function ``void f(const double *y, double a, double a_v, double *out)``, as
        ``numba.cfunc`` or ctypes give it. It is called without the interpreter's lock.
    C : ndarray, shape (m, n)
    d, e : ndarray, shape (m,)
    events : tuple of Event
    scale : ndarray, shape (k,)
        Sizes of the first k states below which their errors do not matter, positive. The rates depend on these states,
        and on those that are constant.
    counted : int, optional
        Number of states with rates, n by default; the others are constant. Those after the first k are integrals of
        which nothing else depends.
    velocities : dict
        Places of the states whose rates are states, and places of these.
    curved : dict
        Numbers of the outputs that `field` computes from their rows, each with a size, zero or positive: a peak within
        a step is looked for where the ends of the step are closer to the highest value than a quarter of that or of it.
    curved_events : sequence of int
        Numbers of the events whose conditions `field` computes; their rows are not used. A condition within a
        ten-billionth of its event's scale is zero.
    """

    field: Field | Callable[[Array, float, float], Array]
    C: Array
    d: Array
    e: Array
    events: tuple[Event, ...]
    scale: Array
    counted: int | None = None
    velocities: dict[int, int] = initially(default_factory=dict)
    curved: dict[int, float] = initially(default_factory=dict)
    C_v: Array | None = None
    d_v: Array | None = None
    curved_events: Sequence[int] = ()

    def of(self, place: int) -> "NonlinearPhase":
        """The phase itself: there is no stack of them."""
        del place
        return self

    @property
    def nbytes(self) -> int:
        """Memory of the phase and its events, in bytes."""
        return _memory_of(self, *self.events)


@dataclass(frozen=True, eq=False)
class System:
    """A hybrid system, or a stack of systems that differ only in numbers.

    Attributes
    ----------
    layout : StateLayout
        The states.
    outputs : sequence of str
        Names of the m outputs, in the order of the rows of every phase.
    phase : callable
        Returns the `LinearPhase` or `NonlinearPhase` of a key; called once for each that a run meets, and not for a
        linear one that another run of the system holds, as for another time step.
    start : hashable
        Key of the first phase.
    one_sided : sequence of str
        Names of the outputs whose peak is the largest value, and not the largest magnitude.
    count : int
        Number of systems in the stack.
    """

    layout: StateLayout
    outputs: Sequence[str]
    phase: Callable[[Any], LinearPhase | NonlinearPhase]
    start: Key
    one_sided: Sequence[str] = initially(default=())
    count: int = 1
    _held: "WeakValueDictionary[Key, LinearPhase]" = initially(
        init=False, default_factory=WeakValueDictionary, repr=False
    )

    def __post_init__(self) -> None:
        if not 0 < self.layout.size <= MAX_STATES:
            raise InputError(f"A system must have 1 to {MAX_STATES} states, but the layout has {self.layout.size}.")
        if len(set(self.outputs)) < len(self.outputs):
            raise InputError(f"The names of outputs must differ, but {list(self.outputs)} were given.")
        for name in self.one_sided:
            if name not in self.outputs:
                raise InputError(f"The one-sided output {name!r} is none of the outputs {list(self.outputs)}.")

    def checked(self, key: Key) -> LinearPhase | NonlinearPhase:
        """The phase of a key, its arrays as copies of double precision.

        Raises
        ------
        InputError
            If there is no such phase, or an array has the wrong shape, or holds NaN or infinity; it names the key and
            the output or event.
        """
        found: Any = self._held.get(key)
        if found is not None:
            return found
        try:
            found = self.phase(key)
        except LookupError as error:
            raise InputError(f"The system has no phase {key!r}: {error!r}.") from error
        place, n, m = f"phase {key!r}: ", self.layout.size, len(self.outputs)
        if not isinstance(found, LinearPhase | NonlinearPhase):
            raise InputError(f"{place}a LinearPhase or NonlinearPhase is needed, but {type(found).__name__} was given.")
        shapes: dict[str, tuple[int, ...]] = {"C": (m, n), "d": (m,), "e": (m,)}
        if isinstance(found, LinearPhase):
            shapes = {"A": (n, n), "f": (n,), "c": (n,), **shapes}
        else:
            found = _checked_field(place, found, n, m, self.count)
        arrays = {
            name: stacked_array(place + name, getattr(found, name), shape, self.count, finite=name in "Afc")
            for name, shape in shapes.items()
        }
        for name, shape in zip(VERTICAL, ((n, n), (n,), (m, n), (m,)), strict=True):
            given = getattr(found, name, None)
            if given is not None:
                arrays[name] = stacked_array(place + name, given, shape, self.count, finite=name in ("A_v", "f_v"))
        wrong = np.zeros(m, dtype=bool)
        for name in arrays.keys() & {"C", "d", "e", "C_v", "d_v"}:
            wrong |= ~np.isfinite(arrays[name]).all(axis=(0, 2) if name in {"C", "C_v"} else (0,))
        if wrong.any():
            raise InputError(
                f"{place}output {self.outputs[int(wrong.argmax())]!r} must be finite, but NaN or infinity was given."
            )
        listed: Any = found.events
        if not isinstance(listed, tuple | list):
            raise InputError(f"{place}events must be a tuple, but {shown(listed)} was given.")
        events = _checked_events(place, found.events, n, self.count)
        if up8(max(1, m + len(events))) > MAX_ROWS:
            raise InputError(f"{place}{m} outputs and {len(events)} events are more than {MAX_ROWS} rows.")
        phase = replace(found, events=events, **arrays)
        if isinstance(phase, LinearPhase) and not any(isinstance(event.jump, Jump) for event in events):
            self._held[key] = phase  # a compiled jump, as a field, has numbers of its run
        return phase


def _checked_field(place: str, phase: NonlinearPhase, n: int, m: int, count: int) -> NonlinearPhase:
    """What a phase has instead of matrices."""
    if count > 1:
        raise InputError(f"{place}a stack of systems can have linear phases only.")
    found: Any = phase.field
    if not isinstance(found, Field):
        if not callable(found):
            raise InputError(f"{place}field must be a Field or a function, but {shown(found)} was given.")
        function: Any = found
        address = _address_of(function)
        found = Function(function, n) if address is None else Compiled(function, address, n)
    elif hasattr(type(found), "rates") and not hasattr(Field, "rates"):  # nothing would ever move
        raise InputError(
            f"{place}{type(found).__name__} is a Field in plain Python, whose methods the compiled engine cannot call. "
            "Give a function of y, a and a_v as field; if it is of rockflex itself, install the package anew, so that "
            "all of it is compiled."
        )
    scale, counted = np.asarray(phase.scale, dtype=float), n if phase.counted is None else phase.counted
    if scale.ndim != 1 or not 0 < scale.size <= n or not (scale > 0.0).all():
        raise InputError(f"{place}scale must be 1 to {n} positive numbers, but {phase.scale!r} was given.")
    if not scale.size <= counted <= n:
        raise InputError(f"{place}counted must be from {scale.size} to {n}, but {counted} was given.")
    numbers = [*phase.velocities, *phase.velocities.values()]
    if not all(0 <= each < n for each in numbers) or not all(0 <= each < m for each in phase.curved):
        raise InputError(f"{place}velocities and curved must name states and outputs that there are.")
    if not all(0 <= each < len(phase.events) for each in phase.curved_events):
        raise InputError(
            f"{place}curved_events must be numbers from 0 to {len(phase.events) - 1}, but {phase.curved_events!r} was "
            "given."
        )
    return replace(phase, field=found, scale=scale, counted=counted)


def _address_of(function: Any) -> int | None:
    """The address of a compiled function that ctypes or numba holds; None for a function in Python."""
    if isinstance(function, C_FUNCTION):
        return ctypes.cast(function, ctypes.c_void_p).value
    address: Any = getattr(function, "address", None)
    return address if isinstance(address, int) else None


EVENT_NUMBERS = {"row": 1, "constant": 0, "direct": 0, "scale": 0, "jump": 2, "row_v": 1, "direct_v": 0}
REST_NUMBERS = {"row": 1, "constant": 0, "direct": 0, "jump": 2, "row_v": 1, "direct_v": 0}  # and numbers of their axes
OPTIONAL = "jump", "row_v"


def _takes_three(jump: Callable[..., object]) -> bool:
    """Whether a jump asks for the vertical acceleration: whether it has a third argument without default."""
    try:
        asked = signature(jump).parameters.values()
    except (TypeError, ValueError):  # as of some functions in C
        return False
    places = Parameter.POSITIONAL_ONLY, Parameter.POSITIONAL_OR_KEYWORD
    return sum(each.kind in places and each.default is Parameter.empty for each in asked) > 2


def _of(part: Any, place: int, names: dict[str, int]) -> Any:
    """An event, or what follows instead, of one system of a stack."""
    given = {name: getattr(part, name) for name in names}
    found = {name: each[place] if isinstance(each, np.ndarray) else each for name, each in given.items()}
    if getattr(part, "rest", None) is not None:
        found["rest"] = _of(part.rest, place, REST_NUMBERS)
    return replace(part, **found)


def _checked_events(place: str, events: Sequence[Any], n: int, count: int) -> tuple[Event, ...]:
    for event in events:
        if not isinstance(event, Event):
            raise InputError(f"{place}events must be of the class Event, but {shown(event)} was given.")
    places = [f"{place}event {event.name!r}: " for event in events]
    found = _stacked(places, events, EVENT_NUMBERS, n, count)
    for here, event, numbers in zip(places, events, found, strict=True):
        if not (numbers["scale"] > 0.0).all():
            raise InputError(f"{here}scale must be positive, but {event.scale} was given.")
        if (callable(event.jump) or isinstance(event.jump, Jump)) and count > 1:
            raise InputError(f"{here}a stack of systems can have no jump that is a function.")
        rest: Any = event.rest
        if rest is None:
            continue
        if not isinstance(rest, Rest):
            raise InputError(f"{here}rest must be of the class Rest, but {shown(rest)} was given.")
        if callable(event.jump):
            raise InputError(f"{here}a jump that is a function says itself what follows, so that there can be no rest.")
        if isinstance(event.jump, Jump):
            raise InputError(f"{here}a compiled jump says itself what follows, so that there can be no rest.")
        numbers["rest"] = _changed(rest, _stacked([here + "rest: "], [rest], REST_NUMBERS, n, count)[0])
    return tuple(_changed(event, numbers) for event, numbers in zip(events, found, strict=True))


def _changed(part: Any, numbers: dict[str, Any]) -> Any:
    """As `dataclasses.replace`, which takes longer than all else that is done to an event."""
    found = object.__new__(type(part))
    vars(found).update(vars(part), **numbers)
    return found


def _stacked(
    places: Sequence[str], parts: Sequence[Any], names: dict[str, int], n: int, count: int
) -> list[dict[str, Any]]:
    """The numbers of every part, with a first axis for the systems."""
    found = [dict[str, Any]() for _ in parts]
    for name, axes in names.items():
        given, shape = [getattr(part, name) for part in parts], (n,) * axes
        alike = _alike(given, shape) if count == 1 else None
        for k, (place, each) in enumerate(zip(places, given, strict=True)):
            if alike is not None:
                found[k][name] = alike[k : k + 1]
            elif (each is None and name in OPTIONAL) or callable(each) or isinstance(each, Jump):
                found[k][name] = each
            else:
                found[k][name] = stacked_array(place + name, each, shape, count)
    return found


def _alike(values: list[Any], shape: tuple[int, ...]) -> Array | None:
    """Copies of all in one array; None if one is of another type or shape, or not finite."""
    kinds = {type(each) for each in values}
    if kinds != {np.ndarray if shape else float} or (shape and {each.shape for each in values} != {shape}):
        return None
    found = np.array(values)
    return found if found.dtype == float and np.isfinite(found).all() else None


def up8(count: int) -> int:
    """The next multiple of 8."""
    return -(-count // 8) * 8


def stacked_array(name: str, values: Any, shape: tuple[int, ...], count: int, *, finite: bool = True) -> Array:
    """Return a copy as `array` does, with a first axis for the systems of a stack, for all of which it may be given."""
    if type(values) is float and not shape and isfinite(values):
        return np.array([values] * count)
    if type(values) is np.ndarray and values.dtype == float and values.shape == (count, *shape):
        copied = values.copy()
        if not finite or np.isfinite(copied).all():
            return copied
    if np.ndim(values) == len(shape) + 1:
        return array(name, values, (count, *shape), finite=finite)
    found = array(name, values, shape, finite=finite)[None]
    return found if count == 1 else np.repeat(found, count, axis=0)


def array(name: str, values: Any, shape: tuple[int, ...], *, finite: bool = True) -> Array:
    """Return a copy in double precision, and refuse what has another shape, is masked or is not finite."""
    _check_unmasked(name, values)
    if type(values) is np.ndarray and values.dtype == float:
        found = values.copy()
    else:
        try:
            found = np.array(values, dtype=complex if np.iscomplexobj(values) else float).astype(float, casting="safe")
        except (TypeError, ValueError) as error:
            raise InputError(f"{name} must consist of real numbers.") from error
    if found.shape != shape:
        raise InputError(f"{name} must have the shape {shape}, but {found.shape} was given.")
    if finite and not np.isfinite(found).all():
        raise InputError(f"{name} must be finite, but NaN or infinity was given.")
    return found


def _check_unmasked(name: str, values: Any) -> None:
    if masked_count(values):
        raise InputError(f"{name} must not have masked values: leave them out or fill them first.")


def acceleration(values: Any) -> Array:
    """Return an acceleration as the loops need it."""
    _check_unmasked("the acceleration", values)
    found = np.asarray(values)
    if found.ndim != 1 or found.size == 0:
        raise InputError(f"The acceleration must be one row of at least one sample, but {found.shape} was given.")
    if found.dtype != float or not found.flags.c_contiguous or not found.flags.aligned:
        found = array("the acceleration", found, found.shape, finite=False)
    if not np.isfinite(found).all():
        first = int(np.argmin(np.isfinite(found)))
        raise InputError(f"The acceleration must be finite, but sample {first} is {found[first]}.")
    return found


def checked_vertical_acceleration(vertical: Any, ground: Any) -> Array:
    """Return a vertical acceleration as the loops need it, and refuse one that is not as long as the other."""
    found = acceleration(vertical)
    if found.size != len(ground):
        raise InputError(f"The acceleration has {len(ground)} samples, but the vertical one has {found.size}.")
    return found
