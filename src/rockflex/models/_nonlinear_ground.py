"""The nonlinear models that slide on rigid ground, or stand on springs: complete, yielding, or both."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

import numpy as np

from rockflex._arrays import Array, Bools
from rockflex._constants import GRAVITY
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._element import Dashpot
from rockflex.models._elements import CLOSED, SUMS, element_force_sums, internal_count, internal_places
from rockflex.models._layout import StateLayout, codes_for, layout_of
from rockflex.models._linear_model import LinearModel
from rockflex.models._phase import Key
from rockflex.models._sliding import LOST, STICK, SlidingModel
from rockflex.models._spring_model import LOADED, RECEDING, SpringModel


@dataclass(frozen=True, eq=False)
class GroundPhase:
    """What moves and what acts in a phase of a base that slides or stands on springs.

    Attributes
    ----------
    side
        The pivot, 1 right, -1 left; 0 in contact and on springs.
    branch
        Sign of the velocity of a hysteretic spring.
    turns
        Whether the base rotates.
    way
        Sign of the velocity of the slip; 0 if it sticks.
    pressed
        Whether the ground has a pressure to rub against; on rigid ground.
    offset, inertia
        Position of the pivot to the right of the axis of the masses in m, and rotary inertia about it in kg m²; on
        springs about the axis itself.
    friction
        Coulomb's coefficient on rigid ground.
    pulls : ndarray, shape (7, 1 + M)
        Sums over the elements of a base on rigid ground, see `element_force_sums`.
    springs : ndarray, shape (n_springs, 5)
        Position in m, stiffness, coefficient of the dashpot, friction, and 1 if it is loaded, -1 if it recedes.
    elements : ndarray, shape (E, 6)
        On springs: position, k, c, f and g of the tension k δ + c δ' + f + g m, and δ at z = θ = 0 in m.
    recalled
        On springs: places of the internal variables m in the state, -1 where there are none.
    """

    side: int
    branch: int
    turns: bool
    way: int
    pressed: bool
    offset: float
    inertia: float
    friction: float
    pulls: Array
    springs: Array
    elements: Array
    recalled: tuple[int, ...] = ()


@dataclass(frozen=True, eq=False)
class NonlinearSlidingModel(SlidingModel):
    """A base that slides on rigid ground, with large rotations, a yielding superstructure, or both.

    The vertical reaction that friction acts on is that of all terms. Elements slide along with the base, so that their
    inclination puts no horizontal force on the ground. At an impact the velocities relative to the base change by its
    law, and the base keeps its own.

    Parameters
    ----------
    label, properties, lifts, law, missing_mass, gravity, friction
        As in `SlidingModel`.
    complete, bouc_wen
        As in `NonlinearModel`.
    """

    complete: bool = field(kw_only=True, default=True)  # pyright: ignore[reportIncompatibleMethodOverride]
    bouc_wen: BoucWen | None = field(kw_only=True, default=None)  # pyright: ignore[reportIncompatibleMethodOverride]

    @property
    def integrated(self) -> bool:
        """Always True: the model is integrated while it rocks, and with a hysteretic spring also in contact."""
        return True

    @cached_property
    def layout(self) -> StateLayout:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Layout of the state vector."""
        return layout_of(
            self.properties.n_modes,
            integrated=True,
            viscous=any(isinstance(each, Dashpot) for each in self.elements),
            n_internal=internal_count(self.elements) + 1,
            slides=True,
        )

    @property
    def linear(self) -> LinearModel:
        """The simplified, elastic model of the same modes."""
        return SlidingModel(
            self.label, self.properties, self.lifts, self.law, self.missing_mass, self.gravity, self.friction
        )

    def ground_phase(self, key: Key, branch: int) -> GroundPhase:
        """Return what moves and what acts in a phase."""
        p, side, slip = self.properties, key[0], key[-1]
        pivot = p.pivot(side or 1)
        return GroundPhase(
            side=side,
            branch=branch,
            turns=side != CLOSED,
            way=int(np.sign(slip)),
            pressed=slip != STICK and abs(slip) != LOST,
            offset=side * pivot.arm,
            inertia=pivot.i_theta,
            friction=self.friction,
            pulls=element_force_sums(p, self.elements, self.element_key(key)),
            springs=np.zeros((0, 5)),
            elements=np.zeros((0, 6)),
        )


@dataclass(frozen=True, eq=False)
class NonlinearSpringModel(SpringModel):
    """A base on springs that cannot pull, with large rotations, a yielding superstructure, or both.

    Springs and elements stand upright and travel with the base: the depth of a spring is z - x sin θ, and its force has
    the lever arm x cos θ about the point where the axis of the masses meets the base. So has an element. That point is
    held by the ground, or slides against the friction of all springs.

    Parameters
    ----------
    label, properties, lifts, law, missing_mass, gravity, springs, inertia, friction, rest
        As in `SpringModel`.
    complete, bouc_wen
        As in `NonlinearModel`.
    """

    complete: bool = field(kw_only=True, default=True)  # pyright: ignore[reportIncompatibleMethodOverride]
    bouc_wen: BoucWen | None = field(kw_only=True, default=None)  # pyright: ignore[reportIncompatibleMethodOverride]

    @property
    def integrated(self) -> bool:
        """Always True."""
        return True

    def integrates(self, side: Array | int) -> Bools:
        """Return True for every side: no phase is solved in closed form."""
        return np.ones(np.shape(side), dtype=np.bool_)

    def bends(self, side: Array | int) -> Bools:
        """Return for every side whether rotations may be large."""
        return np.full(np.shape(side), self.complete)

    @cached_property
    def layout(self) -> StateLayout:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Layout of the state vector."""
        return layout_of(
            self.properties.n_modes,
            integrated=True,
            n_internal=internal_count(self.elements) + codes_for(self._key_size, self.code_base),
            slides=self.friction is not None,
            heaves=True,
            springs=self.springs.n,
            elements=len(self.elements),
        )

    @property
    def linear(self) -> LinearModel:
        """The simplified, elastic model of the same modes."""
        names = ("label", "properties", "lifts", "law", "missing_mass", "gravity")
        names += ("springs", "inertia", "friction", "rest")
        given: dict[str, Any] = {name: getattr(self, name) for name in names}
        return SpringModel(**given)

    def leaning(self) -> tuple[Array, float]:
        """Return D in m, and z of a hysteretic spring, at rest: the weight bends a structure whose base is tilted."""
        p = self.properties
        if not self.complete:
            return np.zeros(p.n_modes), 0.0
        bent = GRAVITY * np.sin(self.rest.rotation) / p.omega**2
        return bent, 0.0 if self.bouc_wen is None else float(bent[0]) / self.bouc_wen.yield_displacement

    def initial(self, state: Array | None) -> tuple[Key, Array]:
        """Return the branches and the state at the start of a run, as `SpringModel` does."""
        key, start = super().initial(state)
        if state is None:
            start[: self.layout.modes], start[self.layout.hysteresis] = self.leaning()
        return key, start

    def ground_phase(self, key: Key, branch: int) -> GroundPhase:
        """Return what moves and what acts in a phase."""
        n, springs = self.springs.n, self.springs
        friction = np.zeros(n) if self.friction is None else self.friction
        acts = [{LOADED: 1.0, RECEDING: -1.0}.get(branch, 0.0) for branch in key[1 : n + 1]]
        known, recalled, rows = internal_places(self.elements), list[int](), np.zeros((len(self.elements), 6))
        for place, (each, taken) in enumerate(zip(self.elements, self.element_key(key)[1:], strict=True)):
            rows[place] = (each.position, *_tension(each.pull(taken)), self.stretch(place, CLOSED)[-1])
            recalled.append(self.layout.memory + known[place] if place in known else -1)
        return GroundPhase(
            side=CLOSED,
            branch=branch,
            turns=True,
            way=key[n + 1],
            pressed=True,
            offset=0.0,
            inertia=self.inertia,
            friction=0.0,
            pulls=np.zeros((SUMS, 1)),
            springs=np.column_stack((springs.positions, springs.stiffness, springs.damping, friction, acts)),
            elements=rows,
            recalled=tuple(recalled),
        )


def _tension(pull: Any) -> tuple[float, float, float, float]:
    return pull.stiffness, pull.damping, pull.force, pull.recall


GroundModel = NonlinearSlidingModel | NonlinearSpringModel


def on_ground(model: Any) -> GroundModel | None:
    """Return a nonlinear model that slides or stands on springs; None for any other model."""
    return model if isinstance(model, NonlinearSlidingModel | NonlinearSpringModel) else None


def made_nonlinear(model: LinearModel, *, complete: bool, bouc_wen: BoucWen | None) -> GroundModel:
    """Return the nonlinear model on the same ground as a linear one."""
    kept = {name: getattr(model, name) for name in type(model).__dataclass_fields__}
    kind = NonlinearSpringModel if isinstance(model, SpringModel) else NonlinearSlidingModel
    return kind(**kept, complete=complete, bouc_wen=bouc_wen)
