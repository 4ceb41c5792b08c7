"""Bars between base and ground given by their branches: flag-shaped, with a gap, and multi-linear elastic."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Annotated, ClassVar

import numpy as np
from numpy.typing import NDArray

from rockflex.foundation.checks import real_or_nan
from rockflex.foundation.descriptions import Described, described
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.structure._attachment import Position
from rockflex.structure._element_law import Branch, BranchEnd, ElementLaw
from rockflex.structure._elements import PostYieldRatio

OnlyPulls = Annotated[bool, Described("whether the bar cannot push", rule="flag")]


@described
@dataclass(frozen=True, repr=False)
class FlagShapedBar(ElementLaw):
    """A superelastic bar of a shape-memory alloy, or any device with a flag-shaped loop.

    Its force follows k δ up to the yield force F_y, then the upper plateau with the stiffness α k. Where the elongation
    turns back it falls by β F_y with the stiffness k, then follows the lower plateau, parallel to the upper one, back
    to the line k δ (as Christopoulos, Filiatrault & Folz 2002). A whole loop to the elongation δ_m dissipates
    β F_y (δ_m - F_y/k) to each side.

    Raises
    ------
    InputError
        If a value is outside its range.

    Examples
    --------
    >>> import rockflex as rf
    >>> bar = rf.FlagShapedBar(stiffness=2e7, yield_force=200e3,
    ...     post_yield_ratio=0.05, flag_depth=0.8)
    >>> round(bar.slow_force(0.03))
    220000
    """

    title: ClassVar[str] = "Flag-shaped bar"

    stiffness: Annotated[float, Described("the elastic stiffness", "N/m", rule="positive")]
    yield_force: Annotated[float, Described("the force at which the upper plateau begins", "N", rule="positive")]
    post_yield_ratio: PostYieldRatio
    flag_depth: Annotated[
        float,
        Described(
            "the height of the loop over the yield force",
            note="β, from above 0 to 1 - α; at 1 - α the lower plateau meets zero force.",
        ),
    ]
    position: Position = 0.0
    tension_only: OnlyPulls = False

    def __post_init__(self) -> None:
        ratio, depth = self.post_yield_ratio, real_or_nan(self.flag_depth)
        if not 0.0 < depth <= 1.0 - ratio:
            raise InputError(
                f"flag_depth must be above 0 and at most 1 - post_yield_ratio, {1.0 - ratio:g}, but "
                f"{shown(self.flag_depth)} was given. It is the height of the loop over the yield force; a deeper one "
                "would push the base open, as a YieldingDissipator does.",
                field="flag_depth",
            )
        vars(self).update(flag_depth=depth)

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


@described
@dataclass(frozen=True, repr=False)
class GapBar(ElementLaw):
    """An elastic bar or stop that acts beyond a gap: F = k (δ - gap) where δ exceeds it, otherwise zero.

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

    stiffness: Annotated[float, Described("the stiffness beyond the gap", "N/m", rule="positive")]
    gap: Annotated[float, Described("the elongation from which the bar is stretched", "m", rule="zero or positive")]
    position: Position = 0.0
    both_ways: Annotated[bool, Described("whether it acts when it is shortened, too", rule="flag")] = False

    def branches(self) -> Mapping[str, Branch]:
        """Return the branch within the gap, and those beyond it."""
        if self.gap == 0.0:
            return branches_of_piecewise_bar([0.0, 1.0], [0.0, self.stiffness], mirrored=self.both_ways)
        return branches_of_piecewise_bar(
            [0.0, self.gap, self.gap + 1.0], [0.0, 0.0, self.stiffness], mirrored=self.both_ways
        )


@described
@dataclass(frozen=True, repr=False)
class MultilinearBar(ElementLaw):
    """A nonlinear elastic bar whose force is linear between given points, and beyond the last two.

    Raises
    ------
    InputError
        If the points do not rise, or are not as many elongations as forces.

    Examples
    --------
    >>> import rockflex as rf
    >>> rf.MultilinearBar(elongations=[0.01, 0.03],
    ...     forces=[100e3, 150e3]).slow_force(0.02)
    125000.0
    """

    title: ClassVar[str] = "Multi-linear elastic bar"

    elongations: Annotated[
        tuple[float, ...],
        Described("the elongations of the points", "m", rule="row", note="They rise from above zero, where F = 0."),
    ]
    forces: Annotated[tuple[float, ...], Described("the forces at these elongations", "N", rule="row")]
    position: Position = 0.0
    tension_only: OnlyPulls = False

    def __post_init__(self) -> None:
        steps = np.diff([0.0, *self.elongations])
        if len(self.forces) != len(self.elongations) or not (steps > 0.0).all():
            raise InputError(
                f"elongations must rise from above zero, and be as many as forces, but {shown(self.elongations)} m and "
                f"{shown(self.forces)} N were given. Leave out the point at zero.",
                field="elongations",
            )

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
