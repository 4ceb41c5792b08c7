"""Tendons that hold a base down."""

from dataclasses import dataclass

from rockflex._checks import finite, positive, real_or_nan
from rockflex._errors import InputError
from rockflex._shown import shown


@dataclass(frozen=True)
class Tendon:
    """An unbonded, elastic, vertical tendon from the structure through the base into the ground.

    While the base rocks about a pivot at the distance r, the tendon is stretched by the gap that opens at its place,
    2 r sin(|θ|/2), to first order r |θ|, as it is guided without friction on both sides of the joint. Its force
    increases linearly from the initial force (Vassiliou & Makris 2015, doi 10.1061/(ASCE)EM.1943-7889.0000953). It
    pulls and never pushes: it goes slack at zero force. On rigid ground no rotation makes an elastic tendon between the
    edges of the base slack; on springs the base can sink and shorten it.

    Attributes
    ----------
    initial_force : float
        Force in N while the base is in contact with the ground; zero or positive.
    stiffness : float
        Axial stiffness EA/L over the unbonded length in N/m; zero or positive.
    position : float
        Distance in m from the axis of the masses, positive to the right. Unless the base is eccentric, this axis passes
        through its middle.
    yield_force : float or None
        In N, positive. Without `post_yield_ratio` the tendon stays elastic, and its largest force is compared with it.
    post_yield_ratio : float or None
        α in [0, 1): the tendon yields at `yield_force`, with the stiffness α k from there on. It keeps its plastic
        stretch, loses prestress and becomes slack at zero force. Default: it stays elastic.
    rupture_elongation : float or None
        Elongation in m, from the base in contact, at which a yielding tendon breaks for good. Default: it never does.

    Raises
    ------
    InputError
        If a value is outside its range.

    Examples
    --------
    >>> import rockflex as rf
    >>> tendon = rf.Tendon(initial_force=500e3, stiffness=20e6, yield_force=900e3)
    >>> round(tendon.initial_force / tendon.yield_force, 3)
    0.556
    """

    initial_force: float
    stiffness: float
    position: float = 0.0
    yield_force: float | None = None
    post_yield_ratio: float | None = None
    rupture_elongation: float | None = None

    def __post_init__(self) -> None:
        vars(self).update(
            initial_force=positive("initial_force", self.initial_force, "N", zero=True),
            stiffness=positive("stiffness", self.stiffness, "N/m", zero=True),
            position=finite("position", self.position, "m"),
        )
        if self.yield_force is not None:
            limit = positive("yield_force", self.yield_force, "N")
            vars(self).update(yield_force=limit)
            if self.initial_force > limit:
                raise InputError(
                    f"initial_force must not exceed yield_force, {limit:g} N, but {self.initial_force:g} N was given. "
                    "A tendon that has yielded is not elastic; check the units too.",
                    field="initial_force",
                )
        if self.post_yield_ratio is not None:
            vars(self).update(post_yield_ratio=checked_ratio(self.post_yield_ratio))
            if self.yield_force is None or self.stiffness == 0.0:
                raise InputError(
                    "post_yield_ratio needs the yield_force in N of a tendon with stiffness, but "
                    f"yield_force = {shown(self.yield_force)} and stiffness = {self.stiffness:g} N/m were given.",
                    field="yield_force" if self.yield_force is None else "stiffness",
                )
        if self.rupture_elongation is not None:
            if self.yield_force is None or self.post_yield_ratio is None:
                raise InputError(
                    "rupture_elongation is for a tendon that yields. Give yield_force and post_yield_ratio as well.",
                    field="rupture_elongation",
                )
            yields_at = (self.yield_force - self.initial_force) / self.stiffness
            vars(self).update(rupture_elongation=checked_rupture(self.rupture_elongation, yields_at))


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
