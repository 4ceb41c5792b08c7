"""Bars between base and ground given by their branches: flag-shaped, with a gap, and multi-linear elastic.

The metadata of a field are what files and the page say of it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.checks import checked_instance, checked_positive, real_or_nan
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.structure._element_law import Branch, BranchEnd, ElementLaw
from rockflex.structure._elements import checked_post_yield_ratio


def about(description: str, unit: str = "", **more: Any) -> dict[str, Any]:
    """Return the metadata of a field: its description, which completes "it must be ...", and its unit."""
    return {"description": description, "unit": unit, **more}


POSITION = about("the distance to the right of the axis of the masses", "m")
ONLY_PULLS = about("whether the bar cannot push")


@dataclass(frozen=True, repr=False)
class FlagShapedBar(ElementLaw):
    """A superelastic bar of a shape-memory alloy, or any device with a flag-shaped loop.

    Its force follows k δ up to the yield force F_y, then the upper plateau with the stiffness α k. Where the elongation
    turns back it falls by β F_y with the stiffness k, then follows the lower plateau, parallel to the upper one, back
    to the line k δ (as Christopoulos, Filiatrault & Folz 2002). A whole loop to the elongation δ_m dissipates
    β F_y (δ_m - F_y/k) to each side.

    Attributes
    ----------
    stiffness : float
        k in N/m, positive.
    yield_force : float
        F_y in N, positive.
    post_yield_ratio : float
        α in [0, 1).
    flag_depth : float
        β, from above 0 to 1 - α; at 1 - α the lower plateau meets zero force.
    position : float
        Distance in m from the axis of the masses, positive to the right.
    tension_only : bool
        Whether the bar goes slack instead of pushing.

    Raises
    ------
    InputError
        If a value is outside its range.

    Examples
    --------
    >>> import rockflex as rf
    >>> bar = rf.FlagShapedBar(stiffness=2e7, yield_force=200e3, post_yield_ratio=0.05, flag_depth=0.8)
    >>> round(bar.slow_force(0.03))
    220000
    """

    title: ClassVar[str] = "Flag-shaped bar"

    stiffness: float = field(metadata=about("the elastic stiffness", "N/m"))
    yield_force: float = field(metadata=about("the force at which the upper plateau begins", "N"))
    post_yield_ratio: float = field(metadata=about("the stiffness after yielding over the elastic one"))
    flag_depth: float = field(metadata=about("the height of the loop over the yield force"))
    position: float = field(default=0.0, metadata=POSITION)
    tension_only: bool = field(default=False, metadata=ONLY_PULLS)

    def __post_init__(self) -> None:
        ratio = checked_post_yield_ratio(self.post_yield_ratio)
        depth = real_or_nan(self.flag_depth)
        if not 0.0 < depth <= 1.0 - ratio:
            raise InputError(
                f"flag_depth must be above 0 and at most 1 - post_yield_ratio, {1.0 - ratio:g}, but "
                f"{shown(self.flag_depth)} was given. It is the height of the loop over the yield force; a deeper one "
                "would push the base open, as a YieldingDissipator does.",
                field="flag_depth",
            )
        vars(self).update(
            stiffness=checked_positive("stiffness", self.stiffness, "N/m"),
            yield_force=checked_positive("yield_force", self.yield_force, "N"),
            post_yield_ratio=ratio,
            flag_depth=depth,
            tension_only=checked_instance("tension_only", self.tension_only, bool),
        )

    @property
    def plateaus(self) -> tuple[float, float]:
        """Elastic elongations in m at which the upper plateau begins and the lower one ends."""
        upper = self.yield_force / self.stiffness
        return upper, upper * (1.0 - self.flag_depth / (1.0 - self.post_yield_ratio))

    def branches(self) -> Mapping[str, Branch]:
        """Return the elastic branch, and three beyond the yield force to each side; or a slack one."""
        left = 1.0 - self.post_yield_ratio  # of m, where the force vanishes; m is zero on the elastic branch
        if self.tension_only:
            below = BranchEnd("slack", 0.0, rising=False, internal=left)
            others = {"slack": Branch(ends=[BranchEnd("elastic", 0.0, rising=True, internal=left)])}
        else:
            below = BranchEnd("pushed", -self.plateaus[0], rising=False, internal=1.0)
            others = self._side("pushed", "released", "extending", -1)
        above = BranchEnd("pulled", self.plateaus[0], rising=True, internal=1.0)
        elastic = Branch(self.stiffness, internal=-left * self.stiffness, ends=[above, below])
        return {"elastic": elastic} | self._side("pulled", "unloaded", "shortening", 1) | others

    def _side(self, loading: str, unloading: str, recovery: str, sign: int) -> dict[str, Branch]:
        k, ratio, (upper, lower) = self.stiffness, self.post_yield_ratio, self.plateaus
        out, share, outward = sign * upper, (1.0 - ratio) * k, sign > 0
        return {
            loading: Branch(ratio * k, share * out, yields=sign, offset=out, turns_to=unloading),
            unloading: Branch(
                k,
                internal=-share,
                ends=[
                    BranchEnd(loading, out, outward, internal=1.0),
                    BranchEnd(recovery, sign * lower, not outward, internal=1.0),
                ],
            ),
            recovery: Branch(
                ratio * k,
                share * sign * lower,
                ends=[BranchEnd("elastic", sign * lower, not outward)],
                yields=-sign,
                offset=sign * lower,
                turns_to=unloading,
            ),
        }

    def stored_energy(self, elongation: NDArray[np.float64], internal: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the stored energy in J: elastic, and of the phase change, which loses as much on either plateau."""
        k, ratio, (upper, lower) = self.stiffness, self.post_yield_ratio, self.plateaus
        elastic = 0.5 * k * (elongation - (1.0 - ratio) * internal) ** 2
        changed = (1.0 - ratio) * k * (0.5 * ratio * internal**2 + 0.5 * (upper + lower) * np.abs(internal))
        return np.where((elongation < 0.0) & self.tension_only, 0.0, elastic + changed)


@dataclass(frozen=True, repr=False)
class GapBar(ElementLaw):
    """An elastic bar or stop that acts beyond a gap: F = k (δ - gap) where δ exceeds it, otherwise zero.

    Attributes
    ----------
    stiffness : float
        k in N/m, positive.
    gap : float
        Elongation in m from which it is stretched, zero or positive.
    position : float
        Distance in m from the axis of the masses, positive to the right.
    both_ways : bool
        Whether it acts in the same way where it is shortened by more than the gap.

    Raises
    ------
    InputError
        If a value is outside its range.

    Examples
    --------
    >>> import rockflex as rf
    >>> rf.GapBar(stiffness=2e7, gap=0.01).slow_force(0.03)
    400000.0
    """

    title: ClassVar[str] = "Bar with a gap"

    stiffness: float = field(metadata=about("the stiffness beyond the gap", "N/m"))
    gap: float = field(metadata=about("the elongation from which the bar is stretched", "m"))
    position: float = field(default=0.0, metadata=POSITION)
    both_ways: bool = field(default=False, metadata=about("whether it acts when it is shortened, too"))

    def __post_init__(self) -> None:
        vars(self).update(
            stiffness=checked_positive("stiffness", self.stiffness, "N/m"),
            gap=checked_positive("gap", self.gap, "m", zero=True),
            both_ways=checked_instance("both_ways", self.both_ways, bool),
        )

    def branches(self) -> Mapping[str, Branch]:
        """Return the branch within the gap, and those beyond it."""
        if self.gap == 0.0:
            return branches_of_piecewise_bar([0.0, 1.0], [0.0, self.stiffness], mirrored=self.both_ways)
        return branches_of_piecewise_bar(
            [0.0, self.gap, self.gap + 1.0], [0.0, 0.0, self.stiffness], mirrored=self.both_ways
        )


@dataclass(frozen=True, repr=False)
class MultilinearBar(ElementLaw):
    """A nonlinear elastic bar whose force is linear between given points, and beyond the last two.

    Attributes
    ----------
    elongations : sequence of float
        Elongations in m, rising from above zero; at zero the force is zero.
    forces : sequence of float
        Forces in N at these elongations.
    position : float
        Distance in m from the axis of the masses, positive to the right.
    tension_only : bool
        Whether the bar cannot push; otherwise F(-δ) = -F(δ).

    Raises
    ------
    InputError
        If the points do not rise, or are not as many elongations as forces.

    Examples
    --------
    >>> import rockflex as rf
    >>> rf.MultilinearBar(elongations=[0.01, 0.03], forces=[100e3, 150e3]).slow_force(0.02)
    125000.0
    """

    title: ClassVar[str] = "Multi-linear elastic bar"

    elongations: tuple[float, ...] = field(metadata=about("the elongations of the points", "m"))
    forces: tuple[float, ...] = field(metadata=about("the forces at these elongations", "N"))
    position: float = field(default=0.0, metadata=POSITION)
    tension_only: bool = field(default=False, metadata=ONLY_PULLS)

    def __post_init__(self) -> None:
        for name in ("elongations", "forces"):
            given = getattr(self, name)
            values = [real_or_nan(each) for each in given] if isinstance(given, Sequence | np.ndarray) else []
            if not values or not np.isfinite(values).all():
                raise InputError(f"{name} must be a row of numbers, but {shown(given)} was given.", field=name)
            vars(self)[name] = tuple(values)
        steps = np.diff([0.0, *self.elongations])
        if len(self.forces) != len(self.elongations) or not (steps > 0.0).all():
            raise InputError(
                f"elongations must rise from above zero, and be as many as forces, but {shown(self.elongations)} m and "
                f"{shown(self.forces)} N were given. Leave out the point at zero.",
                field="elongations",
            )
        vars(self).update(tension_only=checked_instance("tension_only", self.tension_only, bool))

    def branches(self) -> Mapping[str, Branch]:
        """Return a branch for each piece."""
        return branches_of_piecewise_bar([0.0, *self.elongations], [0.0, *self.forces], mirrored=not self.tension_only)


BARS: dict[str, type[ElementLaw]] = {
    "flag_shaped_bar": FlagShapedBar,
    "gap_bar": GapBar,
    "multilinear_bar": MultilinearBar,
}
"""The classes of this module by the names of their kinds in files."""


def branches_of_piecewise_bar(
    elongations: Sequence[float], forces: Sequence[float], *, mirrored: bool
) -> dict[str, Branch]:
    """Return the branches of a force that is linear between points from zero on, and beyond the last two.

    Where δ is negative the force is that of -δ, turned round, if `mirrored`; otherwise zero.
    """
    ends, values = [*elongations[1:-1]], [*forces]
    slopes = [(forces[k + 1] - forces[k]) / (elongations[k + 1] - elongations[k]) for k in range(len(elongations) - 1)]
    found = dict[str, Branch]()
    for sign, side in ((1, "stretched"), (-1, "shortened")):
        for k, slope in enumerate(slopes if mirrored or sign > 0 else [0.0]):
            within = "shortened 1" if sign > 0 else "stretched 1"
            last = k == len(slopes) - 1 or not (mirrored or sign > 0)
            inner = BranchEnd(within if k == 0 else f"{side} {k}", sign * elongations[k], rising=sign < 0)
            outer = [] if last else [BranchEnd(f"{side} {k + 2}", sign * ends[k], rising=sign > 0)]
            force = sign * (values[k] - slope * elongations[k])
            found[f"{side} {k + 1}"] = Branch(slope, force, ends=[inner, *outer])
    return found
