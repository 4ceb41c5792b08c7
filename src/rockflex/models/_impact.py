"""Impact laws: the velocities after the base returns to the ground.

At an impact θ = 0, the displacements do not change, and the law gives the velocities after it. A rotation velocity of
zero means full contact; otherwise rocking continues to the side given by its sign.
"""

import math
from dataclasses import dataclass
from typing import Annotated, Any, Protocol, runtime_checkable

from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_in_range
from rockflex.foundation.descriptions import Described, described
from rockflex.foundation.errors import InputError
from rockflex.foundation.schema import RESTITUTION
from rockflex.foundation.shown import shown
from rockflex.structure._rocking import RockingProperties


@runtime_checkable
class ImpactLaw(Protocol):
    """The protocol of impact laws; any object with these three members can be used.

    Attributes
    ----------
    keeps, loses : str
        Descriptions of the quantities that the law conserves and of those that it loses.

    Examples
    --------
    >>> import rockflex as rf
    >>> class Half:
    ...     keeps = "half of every modal velocity"
    ...     loses = "the rotation, and the other half"
    ...     def after(self, properties, modal_velocity, rotation_velocity):
    ...         return 0.5 * modal_velocity, 0.0
    ...
    >>> isinstance(Half(), rf.ImpactLaw)
    True
    """

    @property
    def keeps(self) -> str: ...

    @property
    def loses(self) -> str: ...

    def after(
        self, properties: RockingProperties, modal_velocity: Array, rotation_velocity: float
    ) -> tuple[ArrayLike, float]:
        """Return the velocities after an impact, D' (N,) in m/s and θ' in rad/s, from those before it."""
        ...


@dataclass(frozen=True)
class VVELSimplified:
    """Vertical velocity energy loss for each mass separately (Silva & Stojadinović 2024, Eqs. 25 and 32).

    Examples
    --------
    >>> import rockflex as rf
    >>> column = rf.CantileverWithTipMass(
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e8, base_mass=10e3, half_width=1.0, damping_ratio=0.02
    ... )
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=1.0)
    >>> rf.simulate(column, pulse, "2DOF-C", impact=rf.VVELSimplified()).status
    'rocking'
    """

    keeps = "the horizontal velocity of every mass, as far as the modes can follow"
    loses = "the rotation: its vertical velocities, and what the modes cannot follow"

    def after(
        self, properties: RockingProperties, modal_velocity: Array, rotation_velocity: float
    ) -> tuple[Array, float]:
        """Return D'_n + h*_n θ', and no rotation."""
        return modal_velocity + properties.effective_height * rotation_velocity, 0.0


@dataclass(frozen=True)
class VVELComplete:
    """Vertical velocity energy loss for all masses together (Silva & Stojadinović 2024, Eqs. 19 and 29).

    Eq. 19 is a single equation for all modes. The modal velocities of Eq. 25 are scaled by a common factor to satisfy
    it. For one mode this is Eq. 29 with the sign of Eq. 25; if all modes are kept, the factor is one.

    Examples
    --------
    >>> import rockflex as rf
    >>> column = rf.CantileverWithTipMass(
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e8, base_mass=10e3, half_width=1.0, damping_ratio=0.02
    ... )
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=1.0)
    >>> rf.simulate(column, pulse, "2DOF-S", impact=rf.VVELComplete()).status
    'rocking'
    """

    keeps = "the horizontal kinetic energy of all masses together"
    loses = "the rotation and its vertical velocities"

    def after(
        self, properties: RockingProperties, modal_velocity: Array, rotation_velocity: float
    ) -> tuple[Array, float]:
        """Return the velocities of Eq. 25, scaled to satisfy Eq. 19; zero stays zero."""
        p = properties
        velocity = modal_velocity + p.effective_height * rotation_velocity
        lever = p.effective_mass * p.effective_height
        moving = float(p.effective_mass @ velocity**2)
        unseen = (p.translational_inertia - float(lever @ p.effective_height)) * rotation_velocity**2
        return velocity * math.sqrt(1.0 + unseen / moving) if moving > 0.0 else velocity, 0.0


@described
@dataclass(frozen=True)
class Restitution:
    """The rotation continues on the other side with a fraction e of its velocity.

    Every mass keeps its horizontal velocity, D'_after = D'_before + h* (1 - e) θ'_before; e = 0 is `VVELSimplified`.
    Impacts may accumulate. Contact starts, as with e = 0, once the next excursion would be shorter than
    `shortest_excursion`, estimated from the accelerations right after the impact.

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> import rockflex as rf
    >>> block = rf.rigid_block(slenderness=0.25, half_diagonal=3.0)
    >>> start = rf.InitialState(rotation=0.1)
    >>> response = rf.simulate(block, rf.quiet_motion(10.0), "rigid", impact=rf.Restitution(0.9), initial=start)
    >>> response.n_impacts
    25
    """

    e: Annotated[float, RESTITUTION]
    shortest_excursion: Annotated[float, Described("the shortest duration of an excursion", "s", rule="positive")] = (
        1e-4
    )

    keeps = "the horizontal velocity of every mass, and a share of the rotation"
    loses = "the rest of the rotation's energy"

    def __post_init__(self) -> None:
        if not 0.0 <= self.e <= 1.0:
            raise InputError(
                f"The restitution e must lie from 0 to 1, but {shown(self.e)} was given. It is the ratio of the "
                "rotation velocities after and before an impact; more than 1 would gain energy.",
                field="e",
            )

    def after(
        self, properties: RockingProperties, modal_velocity: Array, rotation_velocity: float
    ) -> tuple[Array, float]:
        """Return D'_n + h*_n (1 - e) θ', and e θ'."""
        passed = self.e * rotation_velocity
        return modal_velocity + properties.effective_height * (rotation_velocity - passed), passed


@dataclass(frozen=True)
class SidedRestitution:
    """A restitution that depends on the edge about which the base rotated before the impact.

    Parameters
    ----------
    right, left
        For an impact that ends a rotation about the right edge (θ > 0, so θ' < 0 before it), or about the left edge.
    """

    right: Restitution
    left: Restitution

    keeps = Restitution.keeps
    loses = Restitution.loses

    def after(
        self, properties: RockingProperties, modal_velocity: Array, rotation_velocity: float
    ) -> tuple[Array, float]:
        """Apply the law of that edge."""
        law = self.right if rotation_velocity < 0.0 else self.left
        return law.after(properties, modal_velocity, rotation_velocity)


@described
@dataclass(frozen=True)
class Rebound:
    """What opens to one side turns back at the wall behind it with a fraction e of its velocity, θ' → -e θ'.

    It belongs to structures that open to one side (`OneSided`), which take no other law.
    """

    e: Annotated[float, RESTITUTION]
    shortest_excursion: Annotated[float, Described("the shortest duration of an excursion", "s", rule="positive")] = (
        1e-4
    )

    keeps = "the horizontal velocity of every mass, and a share of the rotation, turned back"
    loses = "the rest of the rotation's energy"

    def __post_init__(self) -> None:
        checked_in_range("e", self.e, 0.0, 1.0, closed=True)

    def after(
        self, properties: RockingProperties, modal_velocity: Array, rotation_velocity: float
    ) -> tuple[Array, float]:
        """Return D'_n + h*_n (1 + e) θ', and -e θ'."""
        back = -self.e * rotation_velocity
        return modal_velocity + properties.effective_height * (rotation_velocity - back), back


@dataclass(frozen=True)
class UnsavedLaw:
    """Stands for a user-defined law in a loaded response: its description, but not its formula."""

    description: str
    keeps: str  # pyright: ignore[reportIncompatibleVariableOverride]
    loses: str

    def after(
        self, properties: RockingProperties, modal_velocity: Array, rotation_velocity: float
    ) -> tuple[Array, float]:
        """Not available.

        Raises
        ------
        InputError
            Always.
        """
        del properties, modal_velocity, rotation_velocity
        raise InputError(f"The impact law {self.description} was not saved with the response. Pass the law itself.")


LAWS: dict[str, type[VVELSimplified | VVELComplete | Restitution]] = {
    "simplified": VVELSimplified,
    "complete": VVELComplete,
    "restitution": Restitution,
}
"""The laws of the package by their names in files, flags and forms."""

LAW_CLASSES: dict[str, Any] = {each.__name__: each for each in (*LAWS.values(), SidedRestitution, Rebound)}
"""All laws of the package by the names of their classes; they cannot change, unlike laws of a user's."""


def housner(properties: RockingProperties) -> Restitution | SidedRestitution:
    """Return Housner's impact law, η = 1 - 2 m_tot B²/I_θ: angular momentum about the new pivot is conserved.

    For an eccentric base, with the masses at the distances B_1 and B_2 from the pivots before and after the impact, it
    is η = 1 - m_tot (B_1 + B_2) B_2/I_2, which is different on the two sides.

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
