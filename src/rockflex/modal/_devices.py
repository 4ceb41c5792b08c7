"""Devices at the base that take energy out of the rocking: fuses, viscous dampers and friction dampers."""

from dataclasses import dataclass

from rockflex._checks import finite, instance, positive, real_or_nan
from rockflex._errors import InputError
from rockflex._shown import shown


@dataclass(frozen=True)
class YieldingDissipator:
    """A fuse between the base and the ground that yields in tension and compression, with kinematic hardening.

    At a distance r from the pivot it is stretched by δ = 2 r sin(|θ|/2), to first order r |θ|. Its force is
    F = α k δ + (1 - α) z, where z follows k δ and is limited to ± F_y. The first yield is therefore at F = F_y. A fuse
    that has yielded keeps a force while the base is closed, which shifts the moment at which the base lifts.

    Attributes
    ----------
    stiffness : float
        Elastic stiffness k in N/m, positive.
    yield_force : float
        F_y in N, positive.
    post_yield_ratio : float
        α, the stiffness after yielding over the elastic one, in [0, 1).
    position : float
        Distance in m from the axis of the masses, positive to the right.
    tension_only : bool
        Whether the fuse buckles or is unhooked, so that it cannot push: F = max(0, ·).
    rupture_elongation : float or None
        Elongation in m at which the fuse breaks, for good. Larger than F_y/k. Default: it never does.

    Raises
    ------
    InputError
        If a value is outside its range.
    """

    stiffness: float
    yield_force: float
    post_yield_ratio: float = 0.0
    position: float = 0.0
    tension_only: bool = False
    rupture_elongation: float | None = None

    def __post_init__(self) -> None:
        vars(self).update(
            stiffness=positive("stiffness", self.stiffness, "N/m"),
            yield_force=positive("yield_force", self.yield_force, "N"),
            post_yield_ratio=checked_ratio(self.post_yield_ratio),
            position=finite("position", self.position, "m"),
            tension_only=instance("tension_only", self.tension_only, bool),
            rupture_elongation=checked_rupture(self.rupture_elongation, self.yield_force / self.stiffness),
        )


@dataclass(frozen=True)
class ViscousDamper:
    """A linear viscous damper between the base and the ground: F = c δ'.

    Attributes
    ----------
    coefficient : float
        c in N s/m, zero or positive.
    position : float
        Distance in m from the axis of the masses, positive to the right.

    Raises
    ------
    InputError
        If a value is outside its range.
    """

    coefficient: float
    position: float = 0.0

    def __post_init__(self) -> None:
        vars(self).update(
            coefficient=positive("coefficient", self.coefficient, "N s/m", zero=True),
            position=finite("position", self.position, "m"),
        )


@dataclass(frozen=True)
class FrictionDamper:
    """A friction damper between the base and the ground: F = ± F_0 while it slides; it sticks in between.

    Attributes
    ----------
    force : float
        F_0 in N, zero or positive.
    position : float
        Distance in m from the axis of the masses, positive to the right.

    Raises
    ------
    InputError
        If a value is outside its range.
    """

    force: float
    position: float = 0.0

    def __post_init__(self) -> None:
        vars(self).update(
            force=positive("force", self.force, "N", zero=True),
            position=finite("position", self.position, "m"),
        )


def checked_ratio(value: float) -> float:
    """Return a post-yield stiffness ratio.

    Raises
    ------
    InputError
        If it is not in [0, 1).
    """
    ratio = real_or_nan(value)
    if not 0.0 <= ratio < 1.0:
        raise InputError(
            f"post_yield_ratio must be from 0 to below 1, but {shown(value)} was given. It is the stiffness after "
            "yielding over the elastic stiffness: 2 % is 0.02.",
            field="post_yield_ratio",
        )
    return ratio


def checked_rupture(value: float | None, yields_at: float) -> float | None:
    """Return the elongation at rupture in m.

    Raises
    ------
    InputError
        If it is not beyond the elongation `yields_at`, in m, at which yielding starts.
    """
    if value is None:
        return None
    limit = positive("rupture_elongation", value, "m")
    if limit <= yields_at:
        raise InputError(
            f"rupture_elongation must be beyond the elongation at yield, {yields_at:.4g} m, but {limit:g} m was given. "
            "Check the units: stiffness is in N/m, forces are in N and elongations in m.",
            field="rupture_elongation",
        )
    return limit
