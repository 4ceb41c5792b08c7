"""Requirements on a design, and its cost in proportion to its width and forces."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_in_range, checked_positive
from rockflex.foundation.errors import InputError, SolverError
from rockflex.fragility._hazard import HazardCurve
from rockflex.fragility._limit_states import limit_state_label
from rockflex.studies.design._exceedance_fit import (
    DesignRuns,
    ShakingLevel,
    check_design_limit,
    check_measure_of_record_alone,
)

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class DesignCost:
    """Unit costs of a base, its prestress and its dissipators, in any one currency.

    The cost of a design is half_width B + prestress ΣF_0 + dissipator_force ΣF_y, where ΣF_0 is the initial force of
    all tendons, and ΣF_y the yield force of all dissipators and the force of all friction dampers. Only ratios of
    these unit costs decide which design is the cheapest.

    Attributes
    ----------
    half_width : float
        Cost of each metre of the half width B.
    prestress : float
        Cost of each newton of ΣF_0.
    dissipator_force : float
        Cost of each newton of ΣF_y.

    Raises
    ------
    InputError
        If one is negative, or all are zero.

    Examples
    --------
    >>> import rockflex as rf
    >>> cost = rf.DesignCost(half_width=100.0, prestress=2e-5,
    ...     dissipator_force=1e-4)
    >>> price = cost.of(half_width=2.0, prestress=1e6, dissipator_force=4e5)
    >>> print(f"{price:.4g}")
    260
    """

    half_width: float = 0.0
    prestress: float = 0.0
    dissipator_force: float = 0.0

    def __post_init__(self) -> None:
        vars(self).update(
            half_width=checked_positive("half_width", self.half_width, "cost/m", zero=True),
            prestress=checked_positive("prestress", self.prestress, "cost/N", zero=True),
            dissipator_force=checked_positive("dissipator_force", self.dissipator_force, "cost/N", zero=True),
        )
        if not (self.half_width or self.prestress or self.dissipator_force):
            raise InputError(
                "cost: all unit costs are zero, so that no design is cheaper than another. Give half_width in cost/m, "
                "prestress or dissipator_force in cost/N."
            )

    def of(self, half_width: Any, prestress: Any, dissipator_force: Any) -> Any:
        """Cost of a design, or of each of several in arrays; m, N and N."""
        forces = self.prestress * prestress + self.dissipator_force * dissipator_force
        return self.half_width * half_width + forces


MAX_MARGIN = 5.0  # largest margin; values far from a target say little about where it is met
MIN_PROBABILITY = 1e-12


@dataclass(frozen=True)
class Requirement:
    """A limit, and the largest probability or annual rate with which a design may exceed it.

    Attributes
    ----------
    limit : float or str
        As in `design_table`.
    target : float
        Largest probability at the level `at`, or with a hazard the largest annual rate in 1/year.
    at : float or None
        Level of the measure in its unit.
    hazard : HazardCurve or None
        Hazard curve in the measure's unit, in place of a level.
    measure : str
        Intensity measure, which must not depend on the base.

    Raises
    ------
    InputError
        If the limit or measure is unknown, the target is not positive, or not exactly one of `at` and `hazard` is
        given.

    Examples
    --------
    >>> import rockflex as rf
    >>> rf.Requirement("overturning", target=0.01, at=0.8).label
    'overturning at pgv = 0.8'
    """

    limit: float | str
    target: float
    at: float | None = None
    hazard: HazardCurve | None = None
    measure: str = "pgv"

    def __post_init__(self) -> None:
        check_design_limit(self.limit)
        check_measure_of_record_alone(self.measure)
        ShakingLevel.of(self.at, self.hazard)
        if self.hazard is None:
            checked_positive("target", self.target, "probability")
            checked_in_range("target", self.target, 0.0, 1.0, hint="With a level it is a probability.")
        else:
            checked_positive("target", self.target, "1/year")

    @property
    def level(self) -> ShakingLevel:
        """The strength of the shaking."""
        return ShakingLevel.of(self.at, self.hazard)

    @property
    def label(self) -> str:
        """The limit in words, with the level."""
        return limit_state_label(self.limit) + ("" if self.at is None else f" at {self.measure} = {self.at:g}")

    @property
    def asked(self) -> str:
        """The quantity of `target`."""
        return "P" if self.hazard is None else "annual rate"

    def value(self, runs: "pd.DataFrame") -> float:
        """Probability or annual rate of the runs of one design; NaN if it cannot be fitted."""
        some = DesignRuns.of(runs, self.limit, self.measure)
        try:
            return np.nan if some is None else self.level.exceedance(some.fitted().curve)[0]
        except (InputError, SolverError):
            return np.nan

    def band(self, runs: "pd.DataFrame", confidence: float) -> tuple[float, float]:
        """Confidence limits of the value, as in `design_table`; NaN where there are none."""
        some = DesignRuns.of(runs, self.limit, self.measure)
        if some is None:
            return np.nan, np.nan
        try:
            return some.fitted(banded=True).band(self.level, confidence, len(set(some.groups)))[:2]
        except (InputError, SolverError):
            return np.nan, np.nan

    def resampled(self, runs: "pd.DataFrame", n: int, seed: int) -> Array:
        """The same for `n` resamples of the recordings, shape (n,)."""
        some = DesignRuns.of(runs, self.limit, self.measure)
        return np.full(n, np.nan) if some is None else some.resampled(self.level, n, seed)

    def margin(self, values: Any) -> Array:
        """How far values are above the target, within ±5: probits of probabilities, logarithms of rates.

        The probit of a lognormal fragility is linear in the logarithm of its median.
        """
        from scipy.special import ndtri

        given = np.clip(np.asarray(values, dtype=float), MIN_PROBABILITY, None)
        if self.hazard is not None:
            return np.clip(np.log(given / self.target), -MAX_MARGIN, MAX_MARGIN)
        return np.clip(
            ndtri(np.clip(given, MIN_PROBABILITY, 1.0 - MIN_PROBABILITY)) - ndtri(self.target), -MAX_MARGIN, MAX_MARGIN
        )


def checked_requirements(given: Sequence[Requirement]) -> list[Requirement]:
    """Return requirements as a list."""
    listed = list(given)
    for place, each in enumerate(listed):
        if not isinstance(each, Requirement):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(f"requirements[{place}] is {type(each).__name__}. Expected a Requirement.")
    labels = [each.label for each in listed]
    if not labels or len(set(labels)) < len(labels):
        raise InputError(
            "requirements must be one or more Requirement objects, each with another limit or level, but "
            f"{labels or 'none'} were given."
        )
    return listed


def requirement_values(designs: "Sequence[pd.DataFrame]", requirements: Sequence[Requirement]) -> Array:
    """Value of each requirement for the runs of each design, shape (n_designs, n_requirements)."""
    found = [[each.value(runs) for each in requirements] for runs in designs]
    return np.reshape(np.array(found, dtype=float), (len(designs), len(requirements)))


def requirement_margins(values: Array, requirements: Sequence[Requirement]) -> Array:
    """Margins of values whose last axis is that of the requirements; NaN where there is no value."""
    return np.stack([each.margin(values[..., place]) for place, each in enumerate(requirements)], axis=-1)
