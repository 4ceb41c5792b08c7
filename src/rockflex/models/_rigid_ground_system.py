"""The simplified models on rigid ground as hybrid systems: phases, events and outputs for `rockflex.engine`."""

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from rockflex.engine.system import Event, LinearPhase, Rest, StateLayout, System
from rockflex.engine.tables import by_rows
from rockflex.foundation.arrays import Array
from rockflex.foundation.constants import GRAVITY
from rockflex.models._elements import CLOSED, LEFT, QUARTER_TURN, RIGHT
from rockflex.models._fields import LinearTurn
from rockflex.models._landing import (
    GUARDED,
    fixed_share,
    landing_jump,
    landing_of_rule,
    rotation_acceleration_by_rows,
    rule_of_law,
)
from rockflex.models._phase import Key
from rockflex.models._quantities import GROUND, RIGHT_ROTATION, ROTATION, TURN, Quantities
from rockflex.models._rocking_model import RockingModel

SMALL, LARGE = 1e-30, 1e30  # of numbers in SI units that certainly do not overflow
CONTACT, ALONE = (CLOSED,), {RIGHT: (RIGHT,), LEFT: (LEFT,)}


def may_stack(model: RockingModel) -> bool:
    """Return whether a model can be in a stack: at its impacts, if any, the state is multiplied by a matrix."""
    p = model.properties
    numbers = [*map(abs, p.omega.tolist()), p.i_theta, abs(p.l0r), p.m_tot, p.half_width]
    usual = min(numbers) > SMALL and max(numbers) < LARGE  # what overflows is told of one model
    rules = [(side, rule_of_law(model.law, side)) for side in (RIGHT, LEFT) if model.lifts]
    return usual and all(rule is not None and rule.fixed_share(p, side) == 0.0 for side, rule in rules)


def system_on_rigid_ground(models: Sequence[RockingModel], quantities: Sequence[Quantities]) -> System:
    """Return models without elements, on rigid ground, as a stack of hybrid systems.

    The models have equal numbers of modes and quantities, and all of them can lift, or none. The outputs are the
    rotation, the quantities, and the loss of support, of which the largest value counts. The equations are those of
    Silva & Stojadinović 2024, Eqs. 15 and 23 to 25.
    """
    first, N = models[0], models[0].properties.n_modes
    every = [each.properties for each in models]
    omega = np.array([p.omega for p in every])
    if not (omega**2 > 0.0).all():
        raise FloatingPointError("underflow encountered in square")
    names = ("rotation", *(f"quantity {k}" for k in range(len(quantities[0]))), "loss of support")
    layout = StateLayout(displacement=N, velocity=N, rotation=1, spin=1)
    stack = RigidGround(
        model=first,
        omega=omega,
        zeta=np.array([p.zeta for p in every]),
        mass=np.array([p.effective_mass for p in every]),
        height=np.array([p.effective_height for p in every]),
        l0r=np.array([p.l0r for p in every]),
        m_tot=np.array([p.m_tot for p in every]),
        gravity=np.array([each.gravity for each in models]),
        pivots={
            side: np.array([(pivot.i_theta, pivot.arm) for pivot in [p.pivot(side) for p in every]]).T
            for side in (RIGHT, LEFT)
        },
        shares=np.array([each.shares for each in quantities]),
        swings=np.array([each.swings for each in quantities]),
    )
    return System(layout, names, stack.phase, CONTACT, names[-1:], len(models))


@dataclass(frozen=True, eq=False)
class RigidGround:
    """The numbers of S models with N modes; rows have columns D, D', θ, θ', the ground acceleration and 1."""

    model: RockingModel  # one of them
    omega: Array  # (S, N)
    zeta: Array
    mass: Array
    height: Array
    l0r: Array  # (S,)
    m_tot: Array
    gravity: Array
    pivots: dict[int, Array]  # of each side: I_θ and the arm, (2, S)
    shares: Array = field(repr=False)  # (S, F, 3 N + 4)
    swings: Array = field(repr=False)  # (S, F, 2)

    def phase(self, key: Key) -> LinearPhase:
        """Return a phase: full contact, or rocking about one side."""
        (S, N), side = self.omega.shape, key[0]
        turn = self.turn(side)
        accelerations = np.zeros((S, N, 2 * N + 4))  # D'': Eq. 15 or 23
        modes = np.arange(N)
        accelerations[:, modes, modes] = -(self.omega**2)
        accelerations[:, modes, N + modes] = -2.0 * self.zeta * self.omega
        accelerations[..., -2] = -1.0
        accelerations -= self.height[..., None] * turn[:, None]
        rates = np.zeros((S, 2 * N + 2, 2 * N + 4))
        rates[:, modes, N + modes] = 1.0
        rates[:, N : 2 * N], rates[:, -1] = accelerations, turn
        rates[:, -2, 2 * N + 1] = side != CLOSED
        rows = np.concatenate((self.rotation, self.rows(side, accelerations, turn), self.support(side, turn)), 1)
        events = (self.landing(side), self.overturning(side)) if side != CLOSED else self.uplifts()
        A, C = rates[..., :-2], rows[..., :-2]
        return LinearPhase(
            A, rates[..., -2], rates[..., -1], C, rows[..., -2], rows[..., -1], events, **self.shaken(side)
        )

    def shaken(self, side: int) -> dict[str, Array]:
        """The coefficients of the vertical acceleration, which acts like that much more gravity."""
        (S, N), turn = self.omega.shape, self.turn_by_weight(side)
        accelerations = -self.height[..., None] * turn[:, None]
        rates = np.zeros((S, 2 * N + 2, 2 * N + 4))
        rates[:, N : 2 * N], rates[:, -1] = accelerations, turn
        quantities = by_rows(self.shares[..., 2 * N : 3 * N], accelerations)
        quantities += self.shares[..., TURN, None] * turn[:, None]
        lost = self.lost_support(side, turn, self.m_tot)
        rows = np.concatenate((np.zeros_like(lost), quantities, lost), axis=1)
        return {"A_v": rates[..., :-2], "f_v": rates[..., -1], "C_v": rows[..., :-2], "d_v": rows[..., -1]}

    @cached_property
    def rotation(self) -> Array:
        """θ: a row, shape (S, 1, C)."""
        found = np.zeros((len(self.l0r), 1, 2 * self.omega.shape[1] + 4))
        found[..., -4] = 1.0
        return found

    @cached_property
    def moment(self) -> Array:
        """The overturning moment in contact, left-hand side of Eq. 24, in N m: a row, shape (S, C)."""
        (S, N), arm = self.omega.shape, self.mass * self.height
        found = np.zeros((S, 2 * N + 4))
        found[:, :N], found[:, N : 2 * N] = -arm * self.omega**2, -arm * 2.0 * self.zeta * self.omega
        found[:, -2] = self.l0r - arm.sum(axis=1)
        return found

    def turn(self, side: int) -> Array:
        """θ'', Eq. 23 with D'' eliminated, in rad/s²: a row, shape (S, C)."""
        if side == CLOSED:
            return np.zeros_like(self.moment)
        arm = self.pivots[side][1]
        found = -self.moment
        found[:, -4] += self.l0r * self.gravity
        found[:, -1] -= side * self.m_tot * self.gravity * arm
        return found / self.free_inertia(side)[:, None]

    def turn_by_weight(self, side: int) -> Array:
        """The share of θ'' of the weight under a gravity of 1 m/s²: a row, shape (S, C)."""
        found = np.zeros_like(self.moment)
        if side != CLOSED:
            found[:, -4], found[:, -1] = self.l0r, -side * self.m_tot * self.pivots[side][1]
            found /= self.free_inertia(side)[:, None]
        return found

    def free_inertia(self, side: int) -> Array:
        """I_θ - Σ m* h*² about a pivot in kg m²: the inertia of the rotation with free modes, shape (S,)."""
        return self.pivots[side][0] - (self.mass * self.height**2).sum(axis=1)

    def rows(self, side: int, accelerations: Array, turn: Array) -> Array:
        """The quantities: rows, shape (S, F, C)."""
        N, shares = self.omega.shape[1], self.shares
        found = by_rows(shares[..., 2 * N : 3 * N], accelerations) + shares[..., TURN, None] * turn[:, None]
        found[..., :N] += shares[..., :N] + shares[..., N : 2 * N] * (self.omega**2)[:, None]
        found[..., -4] += shares[..., ROTATION] + shares[..., RIGHT_ROTATION] * (side == RIGHT)
        found[..., -2] += shares[..., GROUND]
        if side != CLOSED:
            found[..., -3] += self.swings[..., 0] + self.swings[..., 1] * (side == RIGHT)
        return found

    def support(self, side: int, turn: Array) -> Array:
        """The decrease of ΣF_z below m_tot g in N, Eq. 22 for small rotations, the sign corrected, shape (S, 1, C)."""
        return self.lost_support(side, turn, self.m_tot * (self.gravity - GRAVITY))

    def lost_support(self, side: int, turn: Array, heavier: Array) -> Array:
        """The part of ΣF_z that θ'' takes away, beyond the heavier weight, shape (S, 1, C)."""
        found = np.zeros((len(turn), 1, turn.shape[1]))
        if side != CLOSED:
            found[:, 0] = -side * (self.m_tot * self.pivots[side][1])[:, None] * turn
        found[:, 0, -1] -= heavier
        return found

    def uplifts(self) -> tuple[Event, ...]:
        """The base lifts about a pivot when the overturning moment exceeds that of the weight (Eq. 24)."""
        if not self.model.lifts:
            return ()
        found, moment = list[Event](), self.moment
        for side in self.model.sides[1:]:
            weight = self.m_tot * self.gravity * self.pivots[side][1]
            row = side * moment
            scale = np.where(weight > 0.0, weight, 1.0)
            more = self.m_tot * self.pivots[side][1]
            found.append(Event("uplift", row[:, :-2], (side,), weight, row[:, -2], scale, direct_v=more))
        return tuple(found)

    def overturning(self, side: int) -> Event:
        """The end of the run at a rotation of π/2."""
        return Event("overturning", -side * self.rotation[:, 0, :-2], None, QUARTER_TURN, scale=QUARTER_TURN)

    def landing(self, side: int) -> Event:
        """The impact, after which rocking may go on to the other side."""
        row, model = side * self.rotation[:, 0, :-2], self.model
        rule, (share, excursion) = rule_of_law(model.law, side), fixed_share(model, side)
        if share == 0.0:
            return Event("impact", row, CONTACT, jump=self.struck(0.0))
        onto = side if share is not None and share < 0.0 else -side
        if rule is None and (share is None or self.gains(side, onto, share)):
            turns = {each: (self.turn(each)[0], self.turn_by_weight(each)[0]) for each in (RIGHT, LEFT)}
            jump = landing_jump(
                model,
                {CLOSED: CONTACT, **ALONE},
                lambda each, _: model.free_inertia(each),
                rotation_acceleration_by_rows(turns),
            )
            return Event("impact", row, CONTACT, jump=jump)
        if rule is not None and (share is None or self.gains(side, onto, share)):
            spin = 2 * self.omega.shape[1] + 1
            beyond = LinearTurn(self.turn(-side)[0], self.turn_by_weight(-side)[0], spin)
            jump = landing_of_rule(model, side, rule, beyond, spin + 1)
            return Event("impact", row, CONTACT, jump=jump, other=ALONE[-side], noted=GUARDED)
        assert share is not None  # any other is a jump
        back = -onto * excursion * self.turn(onto)  # what the rotation would lose within the shortest excursion
        back[:, -3] -= 2.0 * onto
        more = -onto * excursion * self.turn_by_weight(onto)
        rest = Rest(-back[:, :-2], CONTACT, -back[:, -1], -back[:, -2], self.struck(0.0), -more[:, :-2], -more[:, -1])
        return Event("impact", row, ALONE[onto], jump=self.struck(share), rest=rest)

    def struck(self, e: float) -> Array:
        """The jump at an impact: every mass keeps its velocity, and the rotation a share e of its own (Eq. 25)."""
        S, N = self.omega.shape
        found = np.zeros((S, 2 * N + 2, 2 * N + 2))
        found[:, range(2 * N), range(2 * N)] = 1.0
        found[:, N : 2 * N, -1], found[:, -1, -1] = (1.0 - e) * self.height, e
        return found

    def gains(self, side: int, onto: int, share: float) -> bool:
        """Whether the restitution may gain energy: on an eccentric base, whose pivots have different inertias."""
        return bool((share**2 * self.free_inertia(onto) > self.free_inertia(side)).any())
