"""Identification: the parameters of a structure for which its computed motion is closest to a measured one."""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from statistics import NormalDist
from typing import TYPE_CHECKING, Any, Literal, Unpack

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_in_range, is_one_of
from rockflex.foundation.errors import InputError, SolverError
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value
from rockflex.models._label import Model, parse_model
from rockflex.models._named_quantities import floor_quantities
from rockflex.models._quantities import Quantities
from rockflex.models._rocking_model import RockingModel
from rockflex.motion._ground_motion import GroundMotion
from rockflex.structure._rocking import RockingProperties
from rockflex.studies._arguments import RockingStructure, check_keywords, check_motion_argument
from rockflex.studies._gradient import GradientKeywords, follow
from rockflex.studies._parameters import SCALE, Subject
from rockflex.studies._prepared_case import RunOptions

if TYPE_CHECKING:
    import pandas as pd

Observed = Literal["rotation", "floor_acceleration", "total_floor_displacement"]
CLOSE = 0.01  # a step over its standard errors, below which a fit has ended: it is much smaller than the uncertainty
CLOSE_ENOUGH = 0.5  # the same, where no step fits better: an impact appears or vanishes at the minimum
EXACT = 1e-9  # a step of a logarithm that is no step, whatever the errors
WEAKEST, STRONGEST, STIFFER, SOFTER = 1e-6, 1e6, 4.0, 10.0  # damping of a step, and its factors after each trial
PART_CLOSE = 0.5  # CLOSE of the parts that only lead to the next one
# The ways to the best fit, of which the best one counts: parts of the samples that are fitted one after the other, and
# the longest step of a logarithm. Short steps keep impacts in time, the early ones first; long ones leave a bad start.
WAYS = (((0.25, 0.5, 1.0), 0.2), ((1.0,), 1.0))


@dataclass(frozen=True, eq=False, kw_only=True)
class Identification(Value):
    """Parameters that fit a measured motion, and how sure they are.

    Attributes
    ----------
    parameters : tuple of str
        Names of the P parameters.
    values : ndarray, shape (P,)
        Their values.
    covariance : ndarray, shape (P, P)
        Of their logarithms, from the residuals, which it takes for independent noise of one size.
    residual : float
        Standard deviation of the residuals, in the unit of what was measured.
    iterations : int
        Number of steps, of all searches.
    structure
        The structure with these values; `ground` and `impact` are those of its runs.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> weak = rf.one_sine_pulse(amplitude=0.1, period=0.8)
    >>> floors = rf.simulate(frame, weak).floor_acceleration
    >>> found = rf.identify(frame, weak, floors, ["period"],
    ...     observed="floor_acceleration")
    >>> found.to_frame().columns.tolist()
    ['value', 'standard_error', 'low', 'high']
    """

    parameters: tuple[str, ...]
    values: Array
    covariance: Array
    residual: float
    iterations: int
    structure: Any
    ground: Any = None
    impact: Any = None

    @property
    def standard_errors(self) -> Array:
        """Standard errors of the logarithms, about the relative errors of the values, shape (P,)."""
        return np.sqrt(np.diag(self.covariance))

    def interval(self, level: float = 0.9) -> Array:
        """Return the lower and the upper end of the confidence interval of each value, shape (2, P).

        Raises
        ------
        InputError
            If the level is not between 0 and 1.
        """
        spread = NormalDist().inv_cdf(0.5 + 0.5 * checked_in_range("level", level, 0.0, 1.0))
        return self.values * np.exp(spread * np.outer((-1.0, 1.0), self.standard_errors))

    def to_frame(self) -> "pd.DataFrame":
        """Return a table with a row a parameter: its value, relative standard error, and the ends of 90 %."""
        import pandas as pd

        low, high = self.interval()
        columns = {"value": self.values, "standard_error": self.standard_errors, "low": low, "high": high}
        return pd.DataFrame(columns, index=pd.Index(self.parameters, name="parameter"))

    def __repr__(self) -> str:
        found = zip(self.parameters, self.values, self.standard_errors, strict=True)
        return f"Identification({', '.join(f'{name} = {v:.4g} ± {100 * e:.2g} %' for name, v, e in found)})"


def identify(
    structure: RockingStructure | RockingProperties,
    motion: GroundMotion,
    measured: ArrayLike,
    parameters: Sequence[str],
    model: str | Model = "MDOF-S",
    *,
    observed: Observed = "rotation",
    iterations: int = 30,
    **options: Unpack[GradientKeywords],
) -> Identification:
    """Find the parameters for which the computed motion is closest to a measured one, by Levenberg-Marquardt.

    The sum of squares of the differences at the samples of the record is made as small as possible, with the exact
    derivatives of `gradient`. It has other minima far away, since each impact is in time or not. So the fit is sought
    twice, and the better one counts: by short steps on the first quarter of the samples, then on half, then on all of
    them; and by long steps on all. Start near all the same, or measure a free rocking test, whose few impacts follow
    one another.

    Parameters
    ----------
    structure, motion, model, options
        What was tested, with first guesses of the parameters; as in `gradient`. A free rocking test is
        `quiet_motion(duration, dt)` with an `initial` state.
    measured
        What was measured at the samples of the motion: the rotation in rad, shape (n,), or a quantity of every floor,
        shape (n, N_floors). NaN where it was not; fewer samples than the motion has are its first.
    parameters
        Names of the parameters, such as ``"damping_ratio"``, ``"impact.restitution"`` or ``"period"``.
    observed
        ``"rotation"``; ``"floor_acceleration"`` (total, m/s²) or ``"total_floor_displacement"`` (m).
    iterations
        At most so many steps of a search; one takes a run with derivatives, or a few where steps fail.

    Returns
    -------
    Identification
        The values, with their covariance.

    Raises
    ------
    InputError
        If what was measured does not fit the motion, or a parameter changes nothing of it; as for `gradient`.
    SolverError
        If no search converges, or the first run cannot be solved.

    Examples
    --------
    >>> import rockflex as rf
    >>> block = rf.rigid_block(slenderness=0.2, half_diagonal=3.0)
    >>> start, still = rf.InitialState(rotation=0.1), rf.quiet_motion(6.0, 0.01)
    >>> test = rf.simulate(block, still, "rigid", impact=rf.AngularMomentum(0.9),
    ...     initial=start)
    >>> seen = test.resample(0.01).rotation
    >>> found = rf.identify(block, still, seen, ["impact.restitution"], "rigid",
    ...     impact=rf.AngularMomentum(0.92), initial=start)
    >>> float(found.values[0].round(6))
    0.9
    """
    check_keywords(options, GradientKeywords)
    check_motion_argument(motion)
    if not is_one_of(observed, ("rotation", "floor_acceleration", "total_floor_displacement")):
        raise InputError(
            'observed must be "rotation", "floor_acceleration" or "total_floor_displacement", but '
            f"{shown(observed)} was given.",
            field="observed",
        )
    names = tuple(dict.fromkeys(parameters))
    if not names or SCALE in names:
        raise InputError(
            "parameters must be one or more names of numbers of the structure, its ground or its impact law, but "
            f"{shown(list(names))} was given.",
            field="parameters",
        )
    given: dict[str, Any] = {**options}
    chosen, subject = parse_model(model), Subject(structure, RunOptions.of(**given))
    quantities = _quantities(subject.case(chosen).model, observed)
    seen = _checked_measured(measured, motion, len(quantities), len(names))
    fit = _Fit(chosen, names, motion, quantities, seen)
    found, runs = fit.by_all_ways(subject, iterations)
    _, covariance = found.step()
    return Identification(
        parameters=names,
        values=np.array([found.subject.number(name) for name in names]),
        covariance=covariance,
        residual=math.sqrt(found.cost / (found.difference.size - len(names))),
        iterations=runs,
        structure=found.subject.structure,
        ground=found.subject.options.ground,
        impact=found.subject.options.impact,
    )


def _quantities(model: RockingModel, observed: str) -> Quantities:
    """What is observed, as rows."""
    if observed == "rotation":
        return Quantities.of(1, model.properties.n_modes, rotation=1.0)
    if model.properties.floors is None:
        raise InputError(
            f"The structure has no floors, so it has no {observed}. Observe its rotation.", field="observed"
        )
    return floor_quantities(model, model.properties.floors, (observed,))


def _checked_measured(measured: ArrayLike, motion: GroundMotion, count: int, parameters: int) -> Array:
    """What was measured at the first samples, shape (n, count)."""
    try:
        found = np.array(measured, dtype=float)
    except (TypeError, ValueError) as error:
        raise InputError("measured must be an array of numbers.", field="measured") from error
    found = found[:, None] if found.ndim == 1 else found
    samples = len(motion.acceleration)
    if found.ndim != 2 or found.shape[1] != count or not 0 < len(found) <= samples:
        raise InputError(
            f"measured must have a row for each of the {samples} samples of the motion, or fewer, and {count} "
            f"columns, but an array of shape {np.shape(measured)} was given.",
            field="measured",
        )
    if np.isinf(found).any() or np.isfinite(found).sum() <= parameters:
        raise InputError(
            f"measured must have more finite values than the {parameters} parameters, and no infinite ones.",
            field="measured",
        )
    return found


@dataclass(frozen=True, eq=False)
class _Point:
    """The fit at some values of the parameters."""

    subject: Subject
    difference: Array  # (m,): measured minus computed
    slopes: Array  # (m, P): of the computed values, by the logarithms
    names: tuple[str, ...]

    @property
    def cost(self) -> float:
        """Sum of squares."""
        return float(self.difference @ self.difference)

    def step(self, damping: float = 0.0) -> tuple[Array, Array]:
        """The step of Levenberg and Marquardt, without damping that of Gauss and Newton, and the covariance."""
        size = np.sqrt((self.slopes**2).sum(axis=0))
        if np.isnan(size).any():
            raise InputError(
                f"{self.names[int(np.isnan(size).argmax())]} has no derivative at its value: the structure has a kink "
                "there, such as a tie that is held just at a floor. Start from a slightly different value.",
                field="parameters",
            )
        if not (size > 0.0).all():
            name = self.names[int(np.argmin(size))]
            raise InputError(
                f"{name} changes nothing of what was measured, so that it cannot be identified. Leave it out.",
                field="parameters",
            )
        left, sizes, right = np.linalg.svd(self.slopes / size, full_matrices=False)
        if sizes[-1] < 1e-10 * sizes[0]:
            raise InputError(
                f"{', '.join(self.names)} change what was measured in the same way, so that they cannot be told apart. "
                "Leave one out.",
                field="parameters",
            )
        inverse = (right.T / sizes) / size[:, None]
        freedom = max(self.difference.size - len(size), 1)
        damped = (right.T * (sizes / (sizes**2 + damping))) / size[:, None]
        return damped @ (left.T @ self.difference), inverse @ inverse.T * self.cost / freedom


@dataclass(frozen=True, eq=False)
class _Fit:
    model: Model
    names: tuple[str, ...]
    motion: GroundMotion
    quantities: Quantities
    measured: Array
    longest: float = 1.0  # step of a logarithm

    def by_all_ways(self, subject: Subject, iterations: int) -> tuple[_Point, int]:
        """The best fit that any way finds, and the number of runs with derivatives of all of them."""
        found, failures = list[tuple[_Point, int]](), list[SolverError]()
        for parts, longest in WAYS:
            try:
                found.append(replace(self, longest=longest).by_parts(subject, parts, iterations))
            except SolverError as error:
                failures.append(error)
        if not found:
            raise failures[-1]
        most = max(point.difference.size for point, _ in found)  # fewer are compared where it overturns
        best = min((point for point, _ in found if point.difference.size == most), key=lambda point: point.cost)
        return best, sum(runs for _, runs in found)

    def by_parts(self, subject: Subject, parts: Sequence[float], iterations: int) -> tuple[_Point, int]:
        """The best fit of all samples from the best of the first ones, and the number of runs with derivatives."""
        before = 0
        for part in parts[:-1]:
            fit = replace(self, measured=self.measured[: math.ceil(part * len(self.measured))])
            try:
                point, runs = fit.best(subject, iterations, PART_CLOSE)
            except (InputError, SolverError):
                continue  # too little is seen in so few samples
            subject, before = point.subject, before + runs
        point, runs = self.best(subject, iterations, CLOSE)
        return point, before + runs

    def best(self, subject: Subject, iterations: int, close: float) -> tuple[_Point, int]:
        """The best fit near a subject, and the number of runs with derivatives."""
        at, damping = self.at(subject), 1e-3
        for runs in range(1, iterations + 1):
            step, covariance = at.step()
            errors = np.sqrt(np.diag(covariance))
            if (np.abs(step) <= np.maximum(close * errors, EXACT)).all():
                return at, runs
            following, damping = self.better(at, damping)
            if following is None:
                if close > CLOSE or (np.abs(step) <= CLOSE_ENOUGH * errors).all():
                    return at, runs
                raise SolverError(
                    f"The identification has come to an end after {runs} runs where no step along the slope fits "
                    "better: an impact of the run appears or vanishes there. Start from other values."
                )
            at = following
        if close > CLOSE:
            return at, iterations
        raise SolverError(f"The identification has not converged in {iterations} runs. Start closer, or give more.")

    def at(self, subject: Subject) -> _Point:
        """Run the subject, and compare."""
        *_, made = follow(subject, self.model, self.names, self.motion, {"observed": self.quantities})
        samples = np.arange(len(self.measured)) * self.motion.dt
        nodes = np.searchsorted(made.times, samples + 1e-6 * self.motion.dt) - 1  # the last one of an instant
        nodes = nodes[made.times[nodes] > samples - 1e-6 * self.motion.dt]  # none after it has overturned
        known = np.isfinite(self.measured[: len(nodes)])
        difference = (self.measured[: len(nodes)] - made.seen[nodes])[known]
        return _Point(subject, difference, made.slopes[1:, nodes][:, known].T, self.names)

    def better(self, at: _Point, damping: float) -> tuple[_Point | None, float]:
        """A point that fits better, None if no step leads to one, and the damping of the next step.

        A step whose run cannot be solved, overturns early or is of an impossible structure is one that fits worse.
        """
        while damping < STRONGEST:
            step, _ = at.step(damping)
            if (np.abs(step) <= self.longest).all():
                moved: Subject | None = at.subject
                for name, by in zip(self.names, step.tolist(), strict=True):
                    moved = None if moved is None else self._changed(moved, name, by)
                found = None if moved is None else self._tried(moved)
                if found is not None and found.difference.size >= at.difference.size and found.cost < at.cost:
                    return found, max(damping / SOFTER, WEAKEST)
            damping *= STIFFER
        return None, damping

    def _tried(self, subject: Subject) -> _Point | None:
        try:
            return self.at(subject)
        except SolverError:
            return None

    @staticmethod
    def _changed(subject: Subject, name: str, by: float) -> Subject | None:
        try:
            made = subject.changed(subject.place_of(name), by)
        except InputError:  # out of its range
            return None
        return made
