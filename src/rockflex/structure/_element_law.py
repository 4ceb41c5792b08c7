"""Elements of any law: branches as data, on each of which the force is linear."""

import math
from abc import abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import Field, dataclass, fields
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_finite, checked_instance, real_or_nan
from rockflex.foundation.errors import InputError
from rockflex.foundation.overflow import explaining_overflow
from rockflex.foundation.shown import shown
from rockflex.structure._base_element import BaseElement
from rockflex.structure._branches import BranchLimit, Element, ElementDefaults, ElementTension

ROUNDING = 1e-9  # relative: by how much forces and energies may differ that must be equal
MAX_BRANCHES = 32
MAX_CHANGES = 1000  # of branches in one slow movement


@dataclass(frozen=True)
class BranchEnd:
    """An elongation that ends a branch of an element, δ = `elongation` + `internal` m, and the branch that follows.

    Attributes
    ----------
    branch : str
        Name of the branch that follows.
    elongation : float
        In m.
    rising : bool
        Whether it is reached while δ grows; otherwise while δ falls.
    internal : float
        Factor of the internal variable m.

    Examples
    --------
    >>> import rockflex as rf
    >>> rf.BranchEnd("yielding", elongation=0.01, rising=True,
    ...     internal=1.0).branch
    'yielding'
    """

    branch: str
    elongation: float
    rising: bool
    internal: float = 0.0


@dataclass(frozen=True)
class Branch:
    """A branch of an element, on which its tension is F = `stiffness` δ + `force` + `internal` m.

    The internal variable m is constant, unless the branch `yields`: then m = δ - `offset` follows the elongation.

    Attributes
    ----------
    stiffness : float
        In N/m.
    force : float
        In N.
    internal : float
        Factor of m in N/m; zero on a branch that yields.
    ends : sequence of BranchEnd
        Where the branch ends. None for a branch that never ends.
    yields : int
        1 on a branch that yields while δ grows, -1 while δ falls, 0 on others.
    offset : float
        δ - m in m on a branch that yields.
    turns_to : str
        Name of the branch that follows where the elongation turns back on a branch that yields.

    Examples
    --------
    >>> import rockflex as rf
    >>> elastic = rf.Branch(2e7,
    ...     ends=[rf.BranchEnd("yielding", 0.01, rising=True, internal=1.0)])
    >>> elastic.stiffness
    20000000.0
    """

    stiffness: float = 0.0
    force: float = 0.0
    internal: float = 0.0
    ends: Sequence[BranchEnd] = ()
    yields: int = 0
    offset: float = 0.0
    turns_to: str = ""


class SlowState(NamedTuple):
    """The branch of an element that moves slowly, its elongation δ and its internal variable m in m."""

    branch: str
    elongation: float
    internal: float


class ElementLaw(BaseElement):
    """An element whose law is given by its branches, between base and ground or attached to floors.

    Derive a frozen dataclass from it: its fields are the parameters, numbers or texts, among them the `position` in m
    from the axis of the masses, positive to the right; `between`, `cosine` and `height` of `Attachment` come with it.
    The first branch is that of the element as built, at δ = m = 0.
    The force must be continuous where branches meet; that, and the energies, are checked when an element is made.
    `rockflex` finds all events, forces, energies and peaks from the branches. A package makes its elements known to
    structure files and saved responses by an entry point of the group ``rockflex.elements`` with the name of the kind.

    Raises
    ------
    InputError
        If the branches contradict each other.

    Examples
    --------
    A spring that becomes stiffer beyond a gap, in a few lines:

    >>> import rockflex as rf
    >>> from dataclasses import dataclass
    >>> @dataclass(frozen=True)
    ... class Bumper(rf.ElementLaw):
    ...     stiffness: float
    ...     gap: float
    ...     position: float = 0.0
    ...
    ...     def branches(self):
    ...         opened = rf.Branch(0.0,
    ...         ends=[rf.BranchEnd("pressed", self.gap, rising=True)])
    ...         pressed = rf.Branch(
    ...             self.stiffness, -self.stiffness * self.gap,
    ...             ends=[rf.BranchEnd("open", self.gap, rising=False)]
    ...         )
    ...         return {"open": opened, "pressed": pressed}
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> held = rf.Restrained(frame, Bumper(stiffness=50e6, gap=0.005))
    >>> [round(rf.simulate(each, pulse, free_vibration=2.0).max_rotation, 4)
    ...     for each in (frame, held)]
    [0.056, 0.0389]
    """

    if TYPE_CHECKING:
        __dataclass_fields__: ClassVar[dict[str, Field[Any]]]  # every class that is derived is a dataclass

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        own = getattr(cls, "__post_init__", None)

        def check(self: ElementLaw) -> None:
            lists = {each.name: getattr(self, each.name) for each in fields(self)}  # as files hold them
            vars(self).update({name: tuple(value) for name, value in lists.items() if isinstance(value, list)})
            if own is not None:
                own(self)
            vars(self).update(position=checked_finite("position", self.position, "m"))
            self.check_attachment()
            _ = self.law

        cls.__post_init__ = check  # pyright: ignore[reportAttributeAccessIssue]

    @abstractmethod
    def branches(self) -> Mapping[str, Branch]:
        """Return the branches by their names, the first one that of the element as built."""

    @cached_property
    def law(self) -> Mapping[str, Branch]:
        """The branches, checked."""
        with explaining_overflow(f"The forces and energies of {shown(self)}"):
            return checked_law(self)

    def stored_energy(self, elongation: NDArray[np.float64], internal: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the energy stored at elongations δ with internal variables m in m, in J; zero at δ = m = 0.

        Its derivative with respect to δ is the force on branches that do not yield. An element without an internal
        variable stores all work; others must say what they store.
        """
        del internal
        parts = [slow_path(self, [min(0.0, float(np.min(elongation, initial=0.0)))])[::-1]]
        parts.append(slow_path(self, [max(0.0, float(np.max(elongation, initial=0.0)))])[1:])
        states = [state for part in parts for state in part]
        places = np.array([state.elongation for state in states])
        forces = np.array([tension_of(self, state) for state in states])
        work = np.concatenate(([0.0], np.cumsum(0.5 * (forces[1:] + forces[:-1]) * np.diff(places))))
        work -= work[len(parts[0]) - 1]
        below = np.clip(np.searchsorted(places, elongation, side="right") - 1, 0, places.size - 1)
        force = np.interp(elongation, places, forces)
        return work[below] + 0.5 * (forces[below] + force) * (elongation - places[below])

    def branched(self) -> Element:
        """Return it as its branches, numbered, of which models make the phases of a run."""
        return LawElement(self)

    @property
    def force_at_rest(self) -> float:
        """Force in N while the base is in contact, as built: `initial_force`."""
        return self.initial_force

    @property
    def dissipates(self) -> bool:
        """Whether a branch yields."""
        return any(branch.yields for branch in self.law.values())

    @property
    def recentres(self) -> bool:
        """Whether it helps to close the base: it cannot keep it open."""
        return self.locked_force == 0.0

    @property
    def largest_stiffness(self) -> float:
        """Largest stiffness of its branches in N/m."""
        return max(branch.stiffness for branch in self.law.values())

    @cached_property
    def initial_force(self) -> float:
        """Force in N while the base is in contact, as built."""
        return next(iter(self.law.values())).force

    @cached_property
    def locked_force(self) -> float:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Largest force in N with which the element can keep a base from closing, after any slow movement."""
        far = elongation_beyond_branches(self)
        closing = [slow_path(self, [sign * far, 0.0])[-1] for sign in (1.0, -1.0)]
        return max(0.0, *(-sign * tension_of(self, state) for sign, state in zip((1.0, -1.0), closing, strict=True)))

    def slow_force(self, elongation: float) -> float:
        """Return the force in N as built, stretched slowly by an elongation in m."""
        return tension_of(self, slow_path(self, [elongation])[-1])

    def extremes(self, low: float, high: float, speed: float = 0.0) -> tuple[float, bool]:  # noqa: ARG002
        """Return the largest |F| in N between two elongations in m, and whether it yields, in slow cycles to both."""
        cycles = [slow_path(self, [*ends, *ends]) for ends in ((high, low), (low, high))]
        states = [state for cycle in cycles for state in cycle]
        return max(abs(tension_of(self, state)) for state in states), any(
            self.law[state.branch].yields for state in states
        )


@dataclass(frozen=True)
class LawElement(ElementDefaults):
    """An element of any law: its branches in their order. It remembers its internal variable and its branch."""

    law: ElementLaw

    @cached_property
    def parts(self) -> tuple[Branch, ...]:
        """Its branches."""
        return tuple(self.law.law.values())

    @cached_property
    def places(self) -> dict[str, int]:
        """Their numbers, by name."""
        return {name: place for place, name in enumerate(self.law.law)}

    @property
    def position(self) -> float | None:
        return self.law.place

    @property
    def n_internal(self) -> int:
        return 2

    @property
    def stretches(self) -> float | None:
        return 0.0

    @property
    def branches(self) -> tuple[int, ...]:
        return tuple(range(len(self.parts)))

    def tension(self, branch: int) -> ElementTension:
        part = self.parts[branch]
        return ElementTension(part.stiffness, 0.0, part.force, part.internal)

    def limits(self, branch: int) -> tuple[BranchLimit, ...]:
        ends = self.parts[branch].ends
        return tuple(BranchLimit(end.rising, end.elongation, end.internal, self.places[end.branch]) for end in ends)

    def yields(self, branch: int) -> bool:
        return self.parts[branch].yields != 0

    def direction(self, branch: int) -> int:
        return self.parts[branch].yields

    def reversal_offset(self, branch: int) -> float | None:
        return self.parts[branch].offset if self.parts[branch].yields else None

    def branch_at_rest(self, branch: int) -> int:
        return self.places[self.parts[branch].turns_to] if self.parts[branch].yields else branch

    def moving(self, branch: int, direction: int) -> int:
        del direction
        return branch

    def branch_code(self, branch: int) -> float | None:
        return float(branch)

    def state_after_slow_stretch(self, elongation: float) -> tuple[int, tuple[float, ...]]:
        state = slow_path(self.law, [elongation])[-1]
        place = self.places[state.branch]
        return place, (state.internal, float(place))

    def branch_at(self, elongation: Array, memory: Array) -> NDArray[np.int64]:
        del elongation
        return memory[:, 1].astype(np.int64)

    def stored_energy(self, elongation: Array, force: Array, plastic: Array) -> Array:
        del force
        return np.asarray(self.law.stored_energy(elongation, plastic), dtype=float)

    def lost_energy(self, elongation: Array, force: Array, plastic: Array, stored: Array, sweep: Array) -> Array:
        """The work that is not stored where m changes; the force is linear between adjacent states."""
        del sweep
        lost = 0.5 * (force[1:] + force[:-1]) * np.diff(elongation) - np.diff(stored)
        return np.where(np.diff(plastic) == 0.0, 0.0, lost)


def elongation_beyond_branches(law: ElementLaw) -> float:
    """Return an elongation in m beyond all ends of branches."""
    ends = [abs(end.elongation) for branch in law.law.values() for end in branch.ends]
    return 4.0 * max(ends, default=0.0) or 1.0


def tension_of(law: ElementLaw, state: SlowState) -> float:
    """Return the force in N of a slow state."""
    branch = law.law[state.branch]
    return branch.stiffness * state.elongation + branch.force + branch.internal * state.internal


def slow_path(law: ElementLaw, targets: Iterable[float]) -> list[SlowState]:
    """Return the states of an element as built that is brought slowly to elongations in m, one after the other.

    There is one at the start, at every change of its branch, and at every target.

    Raises
    ------
    InputError
        If its branches follow one another without end.
    """
    states = [SlowState(next(iter(law.law)), 0.0, 0.0)]
    for target in targets:
        way = 1 if target > states[-1].elongation else -1
        for _ in range(MAX_CHANGES):
            name, elongation, internal = states[-1]
            branch = law.law[name]
            if branch.yields == -way:
                states.append(SlowState(branch.turns_to, elongation, internal))
                continue
            ahead = [(end.elongation + end.internal * internal, end) for end in branch.ends if end.rising == (way > 0)]
            reached, end = min(ahead, key=lambda each: way * each[0], default=(way * math.inf, None))
            if end is None or way * (target - reached) < 0.0:
                states.append(SlowState(name, target, target - branch.offset if branch.yields else internal))
                break
            at = max(reached, elongation) if way > 0 else min(reached, elongation)
            states.append(SlowState(end.branch, at, at - branch.offset if branch.yields else internal))
        else:
            raise InputError(
                f"{shown(law)}: its branches follow one another without end at an elongation of "
                f"{states[-1].elongation:.6g} m. Let each end lead to a branch that goes on in the same direction.",
                field="branches",
            )
    return states


def checked_law(law: ElementLaw) -> Mapping[str, Branch]:
    """Return the branches of an element.

    Raises
    ------
    InputError
        If a branch is not one, names none, or has another force than the next one where they meet; or if the element
        stores or loses energy where it must not.
    """
    found = law.branches()
    if not isinstance(found, Mapping) or not 0 < len(found) <= MAX_BRANCHES:  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            f"branches must return a dictionary of 1 to {MAX_BRANCHES} branches by name, but {shown(found)} was given.",
            field="branches",
        )
    for name, branch in found.items():
        _check_branch(name, branch, found)
    vars(law)["law"] = found
    size = _force_scale(law)
    for name, branch in found.items():
        for end in branch.ends:
            _check_end(name, branch, end, found[end.branch], size)
        if branch.yields:
            _check_turn(name, branch, found[branch.turns_to], size)
    _check_energy(law, size)
    return found


def _check_branch(name: str, branch: Any, known: Mapping[str, Branch]) -> None:
    checked_instance(f"branches[{name!r}]", branch, Branch)
    numbers = {key: getattr(branch, key) for key in ("stiffness", "force", "internal", "offset")}
    for end in branch.ends:
        checked_instance(f"an end of branches[{name!r}]", end, BranchEnd)
        numbers |= {f"elongation of the end to {end.branch!r}": end.elongation, "internal of an end": end.internal}
    for key, value in numbers.items():
        if not math.isfinite(real_or_nan(value)):
            raise InputError(
                f"branches[{name!r}]: {key} must be a number, but {shown(value)} was given.", field="branches"
            )
    if branch.yields not in (-1, 0, 1) or (branch.yields and branch.internal):
        raise InputError(
            f"branches[{name!r}]: yields must be 1, 0 or -1, and internal zero where it is not 0, but yields = "
            f"{shown(branch.yields)} and internal = {branch.internal:g} were given. On a branch that yields, m is "
            "δ - offset, so that its force depends on δ alone.",
            field="branches",
        )
    named = [end.branch for end in branch.ends] + ([branch.turns_to] if branch.yields else [])
    missing = [each for each in named if each not in known]
    if missing:
        raise InputError(
            f"branches[{name!r}] leads to {shown(missing[0])}, which is no branch. Name one of {', '.join(known)}"
            + (", and give turns_to." if missing == [""] else "."),
            field="branches",
        )


def _force_scale(law: ElementLaw) -> float:
    """Return a force in N that is large for an element."""
    far = elongation_beyond_branches(law)
    return max(abs(branch.force) + abs(branch.stiffness) * far for branch in law.law.values()) or 1.0


def _check_end(name: str, branch: Branch, end: BranchEnd, after: Branch, size: float) -> None:
    """Check the force where a branch ends, as a + b m."""
    if branch.yields:  # there δ is the elongation of the end, and m = δ - offset
        if end.internal:
            raise InputError(
                f"branches[{name!r}]: the end to {end.branch!r} must not depend on m, which follows δ on this branch.",
                field="branches",
            )
        internal = end.elongation - branch.offset
        jumps = (
            abs(_force(branch, end.elongation, internal) - _force(after, end.elongation, internal)) > ROUNDING * size
        )
        shifts = after.yields != 0 and abs(after.offset - branch.offset) > ROUNDING * (
            abs(branch.offset) + abs(end.elongation)
        )
    else:
        constant = _force(branch, end.elongation, 0.0) - _force(after, end.elongation, 0.0)
        slope = branch.stiffness * end.internal + branch.internal - after.stiffness * end.internal - after.internal
        reach = abs(end.elongation) or 1.0
        jumps = abs(constant) > ROUNDING * size or abs(slope) * reach > ROUNDING * size
        shifts = after.yields != 0 and (end.internal != 1.0 or end.elongation != after.offset)
    if shifts:
        raise InputError(
            f"branches[{name!r}]: the internal variable jumps at the end to {end.branch!r}, which yields with m = δ - "
            f"{after.offset:g}. That end must be at δ = {after.offset:g} + m: elongation={after.offset:g}, internal=1.",
            field="branches",
        )
    if jumps:
        at = f"δ = {end.elongation:g}" + (f" + {end.internal:g} m" if end.internal else "")
        raise InputError(
            f"branches[{name!r}]: the force jumps at the end to {end.branch!r}, {at}: at m = 0 from "
            f"{_force(branch, end.elongation, 0.0):.6g} to {_force(after, end.elongation, 0.0):.6g} N. Give forces "
            "that agree there for every m.",
            field="branches",
        )


def _check_turn(name: str, branch: Branch, after: Branch, size: float) -> None:
    """Check the force where the elongation turns back, at any δ, with m = δ - offset."""
    slope = branch.stiffness - after.stiffness - after.internal
    constant = branch.force - after.force + after.internal * branch.offset
    if (
        after.yields
        or abs(constant) > ROUNDING * size
        or abs(slope) > ROUNDING * (abs(branch.stiffness) + abs(after.stiffness))
    ):
        raise InputError(
            f"branches[{name!r}]: the force jumps where the elongation turns back to {branch.turns_to!r}. That branch "
            f"must not yield, and have stiffness + internal = {branch.stiffness:g} N/m and force = "
            f"{branch.force:g} N + internal · {branch.offset:g} m.",
            field="branches",
        )


def _force(branch: Branch, elongation: float, internal: float) -> float:
    return branch.stiffness * elongation + branch.force + branch.internal * internal


def _check_energy(law: ElementLaw, size: float) -> None:
    """Compare the energy stored along slow cycles with the work."""
    if any(branch.yields for branch in law.law.values()) and type(law).stored_energy is ElementLaw.stored_energy:
        raise InputError(
            f"{type(law).__name__} has a branch that yields, so that it must define stored_energy(elongation, "
            "internal): the energy in J that is not dissipated.",
            field="stored_energy",
        )
    far = elongation_beyond_branches(law)
    for ends in ((far, -far, far), (-far, far, -far), (0.3 * far, -0.3 * far, 0.6 * far)):
        states = slow_path(law, ends)
        elongation, internal = (
            np.array([getattr(each, name) for each in states]) for name in ("elongation", "internal")
        )
        forces = np.array([tension_of(law, each) for each in states])
        stored = np.asarray(law.stored_energy(elongation, internal), dtype=float)
        if stored.shape != elongation.shape or not np.isfinite(stored).all():
            raise InputError(
                f"stored_energy must return one finite number for each of {elongation.size} elongations, but "
                f"{shown(stored)} was returned.",
                field="stored_energy",
            )
        work = 0.5 * (forces[1:] + forces[:-1]) * np.diff(elongation)
        lost = work - np.diff(stored)
        room = 10.0 * ROUNDING * size * far
        yields = np.array([law.law[each.branch].yields != 0 for each in states[:-1]])
        if abs(stored[0]) > room or (lost < -room).any() or (np.abs(lost[~yields]) > room).any():
            place = int(np.argmax(np.where(yields, -lost, np.abs(lost))))
            raise InputError(
                f"stored_energy of {type(law).__name__}: from δ = {elongation[place]:.6g} to "
                f"{elongation[place + 1]:.6g} m on the branch {states[place].branch!r} the work is {work[place]:.6g} "
                f"J, and {np.diff(stored)[place]:.6g} J of that are stored. A branch that does not yield must store "
                "all work, another one no more than that; and nothing is stored at δ = m = 0.",
                field="stored_energy",
            )
