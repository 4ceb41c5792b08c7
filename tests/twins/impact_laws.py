"""What an impact does, each law from its own statement (Silva & Stojadinović 2024, Eqs. 19, 25, 29 and 32).

A law takes the state just before, θ = 0 and the side that is coming down, and gives the state and side after.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from twins.complete_model import CompleteModel
from twins.result import Vector


class Law(Protocol):
    def after(self, model: CompleteModel, y: Vector, a: float, side: int) -> tuple[Vector, int]: ...


def kept_horizontally(model: CompleteModel, y: Vector, kept: float) -> Vector:
    """θ' becomes ``kept`` θ', and every mass goes on at its horizontal velocity h_i θ' + u'_i."""
    after = y.copy()
    after[0], after[1] = 0.0, kept * y[1]
    after[2 + model.n : 2 + 2 * model.n] += model.structure.effective_height * (1.0 - kept) * y[1]
    return after


@dataclass(frozen=True)
class SimplifiedVVEL:
    """Eq. 25: the base sticks, and each mass keeps its horizontal velocity."""

    def after(self, model: CompleteModel, y: Vector, a: float, side: int) -> tuple[Vector, int]:
        return kept_horizontally(model, y, 0.0), 0


@dataclass(frozen=True)
class CompleteVVEL:
    """Eq. 19: the base sticks, and the horizontal kinetic energy of all the masses stays.

    Truncated modes cannot carry it all at the velocities of Eq. 25, so these grow by one common factor; one
    mode makes this Eq. 29. Where all of them are zero there is nothing to scale.
    """

    def after(self, model: CompleteModel, y: Vector, a: float, side: int) -> tuple[Vector, int]:
        p = model.structure
        v, spin = model.modal(y)[1], y[1]
        before = spin**2 * p.translational_inertia + 2.0 * spin * (model.arm @ v) + p.effective_mass @ v**2
        after = kept_horizontally(model, y, 0.0)
        speeds = model.modal(after)[1]
        carried = p.effective_mass @ speeds**2
        if carried > 0.0:
            speeds *= np.sqrt(before / carried)
        return after, 0


@dataclass(frozen=True)
class SidedRestitution:
    """A `Restitution` that depends on the side that is coming down."""

    right: float
    left: float
    shortest: float = 1e-4

    def after(self, model: CompleteModel, y: Vector, a: float, side: int) -> tuple[Vector, int]:
        law = Restitution(self.right if side > 0 else self.left, self.shortest)
        return law.after(model, y, a, side)


@dataclass(frozen=True)
class Restitution:
    """Rocking goes over to the other side at e θ', and each mass keeps its horizontal velocity.

    Where the next excursion would be shorter than ``shortest`` seconds, by 2|θ'|/|θ''| just after the impact,
    contact begins instead, as with e = 0. An acceleration that points away from zero is no end of rocking.
    """

    e: float
    shortest: float = 1e-4

    def after(self, model: CompleteModel, y: Vector, a: float, side: int) -> tuple[Vector, int]:
        on = kept_horizontally(model, y, self.e)
        pull = model.accelerations(on, a, -side)[0]
        returns = pull * on[1] < 0.0 and 2.0 * abs(on[1]) < self.shortest * abs(pull)
        if on[1] == 0.0 or returns:
            return kept_horizontally(model, y, 0.0), 0
        return on, -side
