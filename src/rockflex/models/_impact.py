"""Impact laws: what remains of the velocities when the base comes back to the ground.

At an impact the displacements stay, θ = 0, and a law names the velocities after it. A rotation velocity of zero means
full contact; any other carries the rocking on, to the side of its sign.
"""

import math
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockflex._checks import finite, positive
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.modal import RockingProperties

Array = NDArray[np.float64]


@runtime_checkable
class ImpactLaw(Protocol):
    """An impact law; any object with these three can be passed as one.

    Attributes
    ----------
    keeps, loses : str
        What the law conserves and what it gives up, in words.
    """

    @property
    def keeps(self) -> str: ...

    @property
    def loses(self) -> str: ...

    def after(
        self, properties: RockingProperties, modal_velocity: Array, rotation_velocity: float
    ) -> tuple[ArrayLike, float]:
        """Velocities after an impact: D' in m/s, shape (N,), and θ' in rad/s, from those before it."""
        ...


@dataclass(frozen=True)
class VVELSimplified:
    """Vertical velocity energy loss, mass by mass (Silva & Stojadinović 2024, Eqs. 25 and 32)."""

    keeps = "the horizontal velocity of every mass, as far as the modes can follow"
    loses = "the rotation: its vertical velocities, and what the modes cannot follow"

    def after(
        self, properties: RockingProperties, modal_velocity: Array, rotation_velocity: float
    ) -> tuple[Array, float]:
        """D'_n + h*_n θ', and no rotation."""
        return modal_velocity + properties.effective_height * rotation_velocity, 0.0


@dataclass(frozen=True)
class VVELComplete:
    """Vertical velocity energy loss in total (Silva & Stojadinović 2024, Eqs. 19 and 29).

    Eq. 19 is one equation for all modes. Their velocities by Eq. 25 are scaled by one factor to meet it; for one mode
    that is Eq. 29 with the sign that Eq. 25 names, and where all modes are kept the factor is one.
    """

    keeps = "the horizontal kinetic energy of all masses together"
    loses = "the rotation and its vertical velocities"

    def after(
        self, properties: RockingProperties, modal_velocity: Array, rotation_velocity: float
    ) -> tuple[Array, float]:
        """Eq. 25's velocities, scaled to meet Eq. 19; zero stays zero."""
        p = properties
        velocity = modal_velocity + p.effective_height * rotation_velocity
        lever = p.effective_mass * p.effective_height
        moving = float(p.effective_mass @ velocity**2)
        unseen = (p.translational_inertia - float(lever @ p.effective_height)) * rotation_velocity**2
        return velocity * math.sqrt(1.0 + unseen / moving) if moving > 0.0 else velocity, 0.0


@dataclass(frozen=True)
class Restitution:
    """The rotation passes to the other side with a share e of its velocity.

    Every mass keeps its horizontal velocity, D'_after = D'_before + h* (1 - e) θ'_before; e = 0 is `VVELSimplified`.
    Impacts may accumulate; contact begins, as with e = 0, once the next excursion would be shorter than
    `shortest_excursion`, judged from the accelerations right after the impact.

    Parameters
    ----------
    e
        θ'_after / θ'_before, from 0 to 1.
    shortest_excursion
        In s, positive.

    Raises
    ------
    InputError
        If a value is out of range.
    """

    e: float
    shortest_excursion: float = 1e-4

    keeps = "the horizontal velocity of every mass, and a share of the rotation"
    loses = "the rest of the rotation's energy"

    def __post_init__(self) -> None:
        e = finite("e", self.e, "")
        if not 0.0 <= e <= 1.0:
            raise InputError(
                f"The restitution e must lie from 0 to 1, but {shown(self.e)} was given. It is the rotation velocity "
                "after an impact over that before it; more than 1 would gain energy."
            )
        object.__setattr__(self, "e", e)
        object.__setattr__(self, "shortest_excursion", positive("shortest_excursion", self.shortest_excursion, "s"))

    def after(
        self, properties: RockingProperties, modal_velocity: Array, rotation_velocity: float
    ) -> tuple[Array, float]:
        """D'_n + h*_n (1 - e) θ', and e θ'."""
        passed = self.e * rotation_velocity
        return modal_velocity + properties.effective_height * (rotation_velocity - passed), passed


@dataclass(frozen=True)
class SidedRestitution:
    """A restitution that depends on the edge of the base that the rotation leaves.

    Parameters
    ----------
    right, left
        For an impact that ends a rotation about the right edge (θ > 0, so θ' < 0 before it), and about the left one.
    """

    right: Restitution
    left: Restitution

    keeps = Restitution.keeps
    loses = Restitution.loses

    def after(
        self, properties: RockingProperties, modal_velocity: Array, rotation_velocity: float
    ) -> tuple[Array, float]:
        """What the law of that edge says."""
        law = self.right if rotation_velocity < 0.0 else self.left
        return law.after(properties, modal_velocity, rotation_velocity)


@dataclass(frozen=True)
class ForgottenLaw:
    """What a saved response remembers of the user's own law: not what it does."""

    description: str
    keeps: str  # pyright: ignore[reportIncompatibleVariableOverride]
    loses: str

    def after(
        self, properties: RockingProperties, modal_velocity: Array, rotation_velocity: float
    ) -> tuple[Array, float]:
        """Cannot be had.

        Raises
        ------
        InputError
            Always.
        """
        del properties, modal_velocity, rotation_velocity
        raise InputError(f"The impact law {self.description} was not saved with the response. Give the law itself.")


def housner(properties: RockingProperties) -> Restitution | SidedRestitution:
    """Housner's impact of a rigid block, η = 1 - 2 m_tot B²/I_θ: angular momentum about the new pivot is kept.

    On an eccentric base, with the masses at the distances B_1 and B_2 from the pivots before and after the impact, it
    is η = 1 - m_tot (B_1 + B_2) B_2/I_2, which differs from side to side.

    Raises
    ------
    InputError
        If the block is so squat that η would be negative.
    """
    p = properties
    if p.eccentricity == 0.0:
        eta = 1.0 - 2.0 * p.m_tot * p.half_width**2 / p.i_theta
        return Restitution(_not_negative(eta, "1 - 2 m_tot B²/I_θ is", "a block"))
    coefficients: list[Restitution] = []
    for new in (p.pivot(-1), p.pivot(1)):
        eta = 1.0 - 2.0 * p.m_tot * p.half_width * new.arm / new.i_theta  # B_1 + B_2 = 2 B
        coefficients.append(Restitution(_not_negative(eta, "1 - 2 m_tot B B_2/I_2 is", "an eccentric block")))
    return SidedRestitution(*coefficients)


def _not_negative(eta: float, formula: str, kind: str) -> float:
    if eta < 0.0:
        raise InputError(
            f"Housner's coefficient {formula} {eta:.4g}: {kind} this squat stops at its first impact. "
            "Give impact=VVELSimplified()."
        )
    return eta
