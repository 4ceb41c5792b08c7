"""Impact laws: the velocities after the base returns to the ground.

At an impact θ = 0, the displacements do not change, and the law gives the velocities after it. A rotation velocity of
zero means full contact; otherwise rocking continues to the side given by its sign.
"""

import math
from dataclasses import dataclass
from inspect import Parameter, signature
from typing import Annotated, Any, ClassVar, NamedTuple, Protocol, runtime_checkable

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.descriptions import described, described_arguments
from rockflex.foundation.errors import InputError
from rockflex.foundation.language import translated
from rockflex.foundation.number_format import rounded_number
from rockflex.foundation.schema import RESTITUTION, SHORTEST_EXCURSION, ShortestExcursion
from rockflex.foundation.shown import shown
from rockflex.models._rebound import Rebound
from rockflex.structure._rocking import RockingProperties


@runtime_checkable
class ImpactLaw(Protocol):
    """The protocol of impact laws; any object with these three members can be used.

    An `after` of three arguments will do: the last one is for laws that depend on where the masses are.

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
    ...     def after(self, properties, velocity, spin, displacement):
    ...         return 0.5 * velocity, 0.0
    ...
    >>> isinstance(Half(), rf.ImpactLaw)
    True
    """

    @property
    def keeps(self) -> str: ...

    @property
    def loses(self) -> str: ...

    def after(
        self,
        properties: RockingProperties,
        modal_velocity: Array,
        rotation_velocity: float,
        modal_displacement: Array,
        /,
    ) -> tuple[ArrayLike, float]:
        """Return the velocities after an impact, D' (N,) in m/s and θ' in rad/s, from those before it.

        The side that ends is that of -θ'. `modal_displacement` is D (N,) in m as far as the inertias of the model
        depend on it: zero in simplified models.
        """
        ...


@dataclass(frozen=True)
class LandingRule:
    """The landing on one side by a law of the package, for its `after` and for the compiled models.

    Parameters
    ----------
    ratio
        θ'_a/θ'_b; None for that of the angular momentum about the new pivot.
    follows
        Whether no impulse acts on the modes, D'_a = D'_b + h* (θ'_b - θ'_a); otherwise they keep their velocities.
    guarded
        Whether `VVELSimplified` acts where the rule would gain energy or turn the base back.
    scaled
        Whether the modal velocities are then scaled to satisfy Eq. 19.
    shortest_excursion
        Duration in s below which the next excursion does not count.
    """

    ratio: float | None
    follows: bool = True
    guarded: bool = False
    scaled: bool = False
    shortest_excursion: float = SHORTEST_EXCURSION

    def fixed_share(self, properties: RockingProperties, side: int) -> float | None:
        """Return θ'_a/θ'_b of simplified models if no impact has another, so that each is a matrix; else None."""
        if self.guarded or self.scaled:
            return None
        straight = np.zeros(properties.n_modes)
        return self.share(properties, side, straight, straight)

    def share(self, properties: RockingProperties, side: int, modal_velocity: Array, displacement: Array) -> float:
        """Return θ'_a/θ'_b where θ'_b = -side; below zero where the guard acts."""
        if self.ratio is not None and not self.guarded:
            return self.ratio
        p, old, new = properties, properties.pivot(side), properties.pivot(-side)
        lean, square = float(p.effective_mass @ displacement), float(p.effective_mass @ displacement**2)
        before = old.i_theta - 2.0 * side * old.arm * lean + square
        after = new.i_theta + 2.0 * side * new.arm * lean + square
        free = float(p.effective_mass @ p.effective_height**2) if self.follows else 0.0
        share = self.ratio
        if share is None:
            share = 1.0 - side * (old.arm + new.arm) * (side * p.m_tot * new.arm + lean) / (after - free)
            if not self.guarded:
                return max(share, 0.0)
        flow = -side * float((p.effective_mass * p.effective_height) @ modal_velocity)
        return share if 0.5 * (before - share**2 * after) + (1.0 - share) * flow >= 0.0 else -1.0


class FormChoice(NamedTuple):
    """A law in the list of a form: its name, what it does, and whether a restitution is asked for."""

    title: str
    help: str
    restitution: bool = False


class RuledLaw:
    """A law of the package, which is a `LandingRule` for each side."""

    keeps: str
    loses: str
    choices: ClassVar[tuple[FormChoice, ...]] = ()  # in the list of a form

    def __post_init__(self) -> None:
        """Check nothing beyond what is known of each field."""

    def in_words(self) -> str:
        """Return the name of the law in reports."""
        raise NotImplementedError

    def rule_of(self, side: int) -> LandingRule:
        """Return the rule of the landing that ends rocking on a side."""
        raise NotImplementedError

    def after(
        self,
        properties: RockingProperties,
        modal_velocity: Array,
        rotation_velocity: float,
        modal_displacement: Array | None = None,
    ) -> tuple[Array, float]:
        """Return the velocities after an impact, D' (N,) in m/s and θ' in rad/s, from those before it.

        `modal_displacement` is D (N,) in m in complete models; None for zero, as in simplified ones.
        """
        p, spin, side = properties, rotation_velocity, -1 if rotation_velocity > 0.0 else 1
        if spin == 0.0:
            return modal_velocity, 0.0
        rule, D = self.rule_of(side), np.zeros(p.n_modes) if modal_displacement is None else modal_displacement
        share, follows = rule.share(p, side, modal_velocity / abs(spin), D), rule.follows
        if share < 0.0:
            share, follows = 0.0, True
        passed = share * spin if share else 0.0
        velocity = modal_velocity + p.effective_height * (spin - passed) if follows else modal_velocity
        moving = float(p.effective_mass @ velocity**2)
        if rule.scaled and moving > 0.0:
            lever = p.effective_mass * p.effective_height
            unseen = (p.translational_inertia - float(lever @ p.effective_height)) * spin**2
            velocity = velocity * math.sqrt(1.0 + unseen / moving)
        return velocity, passed

    @classmethod
    def restitution_name(cls) -> str:
        """Return the name of the field that is a restitution; empty if there is none."""
        return next((name for name, each in described_arguments(cls).items() if each is RESTITUTION), "")

    @property
    def given_restitution(self) -> float | None:
        """The restitution that was given; None if there is none."""
        return getattr(self, self.restitution_name() or "_", None)

    def effective_restitution(self, properties: RockingProperties) -> float:
        """Return θ' at an impact over that at the one before, once the vibration has decayed between them.

        Damping of the flexure does not change the angular momentum about the pivot, so that I_θ θ' + Σ m* h* D' after
        an impact is I_θ θ' at last. For an eccentric base it is the geometric mean of both edges. A restitution that
        is measured from successive peaks of a free rocking test is this one.
        """
        return effective_restitution(self, properties)


def effective_restitution(law: ImpactLaw, properties: RockingProperties) -> float:
    """Return `RuledLaw.effective_restitution` of any law."""
    p, found = properties, 1.0
    lever, still = p.effective_mass * p.effective_height, np.zeros(p.n_modes)
    for side in (1, -1):
        velocity, spin = law.after(p, still, -float(side), *[still][: takes_displacement(law)])
        found *= abs(spin + float(lever @ np.asarray(velocity)) / p.pivot(-side).i_theta)
    return math.sqrt(found)


def restitution_left(law: Any, properties: RockingProperties) -> tuple[float, float] | None:
    """Return the restitution that a law was given and its effective one; None if none was given, or they agree."""
    given = law.given_restitution if isinstance(law, RuledLaw) else None
    if given is None or not properties.n_modes:
        return None
    effective = effective_restitution(law, properties)
    return None if math.isclose(effective, given, rel_tol=1e-9) else (given, effective)


def takes_displacement(law: Any) -> bool:
    """Return whether `after` of a law takes a fourth argument, the modal displacements."""
    try:
        asked = signature(law.after).parameters.values()
    except (TypeError, ValueError):  # as of some functions in C
        return False
    return sum(each.kind in (Parameter.POSITIONAL_ONLY, Parameter.POSITIONAL_OR_KEYWORD) for each in asked) > 3


@dataclass(frozen=True)
class VVELSimplified(RuledLaw):
    """Vertical velocity energy loss for each mass separately (Silva & Stojadinović 2024, Eqs. 25 and 32).

    Examples
    --------
    >>> import rockflex as rf
    >>> column = rf.CantileverWithTipMass(
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e8, base_mass=10e3,
    ...     half_width=1.0, damping_ratio=0.02
    ... )
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=1.0)
    >>> rf.simulate(column, pulse, "2DOF-C", impact=rf.VVELSimplified()).status
    'rocking'
    """

    keeps = "the horizontal velocity of every mass, as far as the modes can follow"
    loses = "the rotation: its vertical velocities, and what the modes cannot follow"
    choices = (
        FormChoice(
            "velocities of the masses are kept (simplified, Eq. 25)",
            "Conserves the horizontal velocity of each mass; the rotation stops.",
        ),
    )

    def in_words(self) -> str:
        """Return the name of the law in reports."""
        return translated("Simplified (Silva & Stojadinović 2024, Eq. 25)")

    def rule_of(self, side: int) -> LandingRule:  # noqa: ARG002
        """Return D'_n + h*_n θ', and no rotation."""
        return LandingRule(0.0)


@dataclass(frozen=True)
class VVELComplete(RuledLaw):
    """Vertical velocity energy loss for all masses together (Silva & Stojadinović 2024, Eqs. 19 and 29).

    Eq. 19 is a single equation for all modes. The modal velocities of Eq. 25 are scaled by a common factor to satisfy
    it. For one mode this is Eq. 29 with the sign of Eq. 25; if all modes are kept, the factor is one.

    Examples
    --------
    >>> import rockflex as rf
    >>> column = rf.CantileverWithTipMass(
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e8, base_mass=10e3,
    ...     half_width=1.0, damping_ratio=0.02
    ... )
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=1.0)
    >>> rf.simulate(column, pulse, "2DOF-S", impact=rf.VVELComplete()).status
    'rocking'
    """

    keeps = "the horizontal kinetic energy of all masses together"
    loses = "the rotation and its vertical velocities"
    choices = (
        FormChoice(
            "kinetic energy is kept (complete, Eq. 19)",
            "Conserves the total horizontal kinetic energy; the rotation stops.",
        ),
    )

    def in_words(self) -> str:
        """Return the name of the law in reports."""
        return translated("Complete (Silva & Stojadinović 2024, Eq. 29)")

    def rule_of(self, side: int) -> LandingRule:  # noqa: ARG002
        """Return the velocities of Eq. 25, scaled to satisfy Eq. 19; zero stays zero."""
        return LandingRule(0.0, scaled=True)


@described
@dataclass(frozen=True)
class Restitution(RuledLaw):
    """The rotation continues on the other side with a fraction e of its velocity.

    Every mass keeps its horizontal velocity, D'_after = D'_before + h* (1 - e) θ'_before; e = 0 is `VVELSimplified`.
    Impacts may accumulate. Contact starts, as with e = 0, once the next excursion would be shorter than
    `shortest_excursion`, estimated from the accelerations right after the impact.

    Of a flexible structure e is not what a free rocking test shows: the modes give the rotation back most of what it
    lost, and 1 - (1 - e) (I_θ - Σ m* h*²)/I_θ of the velocity is left from one half cycle to the next, see
    `effective_restitution`. For a measured restitution take `AngularMomentum`.

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> import rockflex as rf
    >>> block = rf.rigid_block(slenderness=0.25, half_diagonal=3.0)
    >>> start = rf.InitialState(rotation=0.1)
    >>> response = rf.simulate(block, rf.quiet_motion(10.0), "rigid",
    ...     impact=rf.Restitution(0.9), initial=start)
    >>> response.n_impacts
    25
    """

    e: Annotated[float, RESTITUTION]
    shortest_excursion: ShortestExcursion = SHORTEST_EXCURSION

    keeps = "the horizontal velocity of every mass, and a share of the rotation"
    loses = "the rest of the rotation's energy"
    choices = (
        FormChoice(
            "part of the rotation goes on (restitution)",
            "Conserves the horizontal velocity of each mass; part of the rotation continues about the other edge.",
            restitution=True,
        ),
    )

    def in_words(self) -> str:
        """Return the name of the law in reports."""
        return translated("Restitution, e = {e}", e=rounded_number(self.e))

    def rule_of(self, side: int) -> LandingRule:  # noqa: ARG002
        """Return D'_n + h*_n (1 - e) θ', and e θ'."""
        return LandingRule(self.e, shortest_excursion=self.shortest_excursion)


@described
@dataclass(frozen=True)
class AngularMomentum(RuledLaw):
    """The angular momentum about the new pivot is conserved, and the modes keep their velocities; or θ' is e θ'.

    Without a restitution θ'_after = η θ'_before with Housner's η = 1 - 2 m_tot B²/I_θ, of complete models with the
    terms of D. With one, θ'_after = e θ'_before: what is measured from the decay of a free rocking test, as
    `restitution_from_decay` gives it. Where floors move against the rotation either would gain energy; there
    `VVELSimplified` acts instead, and `Response.guarded_impacts` is the share of such impacts. The law is for stiff
    structures, of which few impacts need that.

    Raises
    ------
    InputError
        If the restitution is out of range.

    Examples
    --------
    >>> import rockflex as rf
    >>> column = rf.CantileverWithTipMass(
    ...     height=10.0, tip_mass=50e3, bending_stiffness=8e10, base_mass=10e3,
    ...     half_width=2.0, damping_ratio=0.05
    ... )
    >>> start = rf.InitialState(rotation=0.05)
    >>> law = rf.AngularMomentum(0.8)
    >>> run = rf.simulate(column, rf.quiet_motion(8.0), impact=law, initial=start)
    >>> run.n_impacts, round(run.guarded_impacts, 2)
    (21, 0.29)
    """

    restitution: Annotated[float | None, RESTITUTION] = None

    keeps = "the angular momentum about the new pivot, or a share of the rotation, and the velocity of every mode"
    loses = "the rest of the rotation's energy; as the simplified law where it would gain"
    choices = (
        FormChoice(
            "angular momentum is kept (Housner)",
            "Conserves the angular momentum about the new pivot and the velocities of the modes. Where that would gain "
            "energy, the simplified law acts. For stiff structures.",
        ),
        FormChoice(
            "the restitution was measured",
            "Part of the rotation continues about the other edge, as in the decay of a free rocking test; the modes "
            "keep their velocities. Where that would gain energy, the simplified law acts. For stiff structures.",
            restitution=True,
        ),
    )

    def in_words(self) -> str:
        """Return the name of the law in reports."""
        if self.restitution is None:
            return translated("Angular momentum about the new pivot (Housner)")
        return translated("Measured restitution, e = {e}", e=rounded_number(self.restitution))

    def rule_of(self, side: int) -> LandingRule:  # noqa: ARG002
        """Return D'_n, and η θ' or e θ'."""
        return LandingRule(self.restitution, follows=False, guarded=True)


@dataclass(frozen=True)
class PivotImpulse(RuledLaw):
    """The only impulse acts at the new pivot: no mode is struck, and the base rocks on if its old edge then rises.

    D'_after = D'_before + h* (θ'_before - θ'_after) as with `Restitution`, with θ'_after by the angular momentum about
    the new pivot, and zero where the old edge would be pressed down. So it is the solution without rebound of the
    contact at both edges, and never gains energy. If all masses are lumped and modelled, and the base is not far
    heavier at its edges, it is `VVELSimplified`; models of few modes, or with wide floors, rock on.

    Examples
    --------
    >>> import numpy as np, rockflex as rf
    >>> frame = rf.Frame(5, 3.0, 40e3, 40e3, 0.0, period=0.5, aspect_ratio=10.0,
    ...     damping_ratio=0.02).rocking()
    >>> for n in (1, 5):
    ...     p = frame.truncated(n)
    ...     _, spin = rf.PivotImpulse().after(p, np.zeros(n), -0.1)
    ...     print(round(spin, 4))
    -0.0249
    0.0
    """

    keeps = "the angular momentum about the new pivot, with no impulse on the modes"
    loses = "what an impact without rebound at the new pivot takes"
    choices = (
        FormChoice(
            "the new pivot alone is struck",
            "Conserves the angular momentum about the new pivot, with no impulse on the modes; the rotation continues "
            "about the other edge if the old one then rises.",
        ),
    )

    def in_words(self) -> str:
        """Return the name of the law in reports."""
        return translated("Impulse at the new pivot alone")

    def rule_of(self, side: int) -> LandingRule:  # noqa: ARG002
        """Return D'_n + h*_n (θ'_b - θ'_a), and θ'_a by the momentum."""
        return LandingRule(None)


@dataclass(frozen=True)
class SidedRestitution(RuledLaw):
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

    def in_words(self) -> str:
        """Return the name of the law in reports."""
        return translated(
            "Restitution, e = {right} from the right and {left} from the left edge",
            right=rounded_number(self.right.e),
            left=rounded_number(self.left.e),
        )

    def rule_of(self, side: int) -> LandingRule:
        """Return the rule of that edge."""
        return (self.right if side > 0 else self.left).rule_of(side)


@dataclass(frozen=True)
class UnsavedLaw:
    """Stands for a user-defined law in a loaded response: its description, but not its formula."""

    description: str
    keeps: str  # pyright: ignore[reportIncompatibleVariableOverride]
    loses: str

    def after(
        self,
        properties: RockingProperties,
        modal_velocity: Array,
        rotation_velocity: float,
        modal_displacement: Array | None = None,
    ) -> tuple[Array, float]:
        """Not available.

        Raises
        ------
        InputError
            Always.
        """
        del properties, modal_velocity, rotation_velocity, modal_displacement
        raise InputError(f"The impact law {self.description} was not saved with the response. Pass the law itself.")


LAWS: dict[str, type[RuledLaw]] = {
    "simplified": VVELSimplified,
    "complete": VVELComplete,
    "restitution": Restitution,
    "angular-momentum": AngularMomentum,
    "pivot-impulse": PivotImpulse,
}
"""The laws of the package by their names in files, flags and forms."""


def law_of_name(name: str, restitution: float | None) -> RuledLaw:
    """Return a law by its name in files, flags and forms, with its restitution if it takes one.

    Raises
    ------
    InputError
        If the restitution is missing, out of range, or of no use to the law.
    """
    law = LAWS[name]
    field = law.restitution_name()
    if restitution is None and field and signature(law).parameters[field].default is Parameter.empty:
        raise InputError(
            f'The impact law "{name}" needs its coefficient. Give restitution, a number from 0 to 1.',
            field="restitution",
        )
    if restitution is not None and not field:
        raise unused_restitution_error(restitution, shown(name))
    return law() if restitution is None else law(**{field: restitution})


def unused_restitution_error(restitution: float, chosen: str) -> InputError:
    """Return the error of a restitution that was given besides a law without one."""
    names = [f'"{name}"' for name, law in LAWS.items() if law.restitution_name()]
    return InputError(
        f"A restitution of {restitution:g} was given, but the impact law is {chosen}. Choose the impact law "
        f"{' or '.join(names)}, or leave restitution out.",
        field="restitution",
    )


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
