"""Records chosen and scaled for a target spectrum."""

import warnings
from collections import Counter
from collections.abc import Hashable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import get_args

import numpy as np
from numpy.typing import ArrayLike

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import (
    checked_finite_vector,
    checked_instance,
    checked_positive,
    checked_whole_number,
    is_one_of,
    real_or_nan,
)
from rockflex.foundation.errors import InputError, RecordWarning
from rockflex.foundation.language import translated
from rockflex.foundation.shown import first_texts_shown, shown
from rockflex.motion._conditional import ConditionalSpectrum
from rockflex.motion._ground_motion import GroundMotion, check_horizontal_component
from rockflex.motion._recordings import Combination, Recording, horizontal_pairs
from rockflex.motion._spectra import (
    TargetSpectrum,
    comparison_periods,
    scalable_spectral_ordinate,
    spectrum_fitting_factor,
)

GroupLimits = tuple[tuple[Sequence[Hashable | None], int], ...]
"""For each limit the group of every record, None for a group of its own, and the most of one group."""

N_STARTS = 20  # sets that grow from one record each
MIN_GAIN = 1e-12  # relative improvement below which an exchange is left alone


@dataclass(frozen=True, eq=False)
class SelectionProblem:
    """The spectra to choose from, and the objective by which sets are compared.

    It is w times the mean of the squared misfits of the records, and 1 - w times the squared misfit of their mean.
    Where a spread of ln S_a is wanted, it is the mean over the periods of the squared misfits of mean and standard
    deviation of ln S_a (Jayaram, Lin & Baker 2011).
    """

    spectra: Array  # (n_records, m): scaled, over the target
    record_weight: float  # w
    group_limits: GroupLimits
    spread: Array | None = None  # (m,): wanted standard deviation of ln S_a

    @cached_property
    def values(self) -> Array:
        """What is summed over the records of a set, shape (n_records, m)."""
        return self.spectra if self.spread is None else np.log(self.spectra)

    @cached_property
    def squares(self) -> Array:
        """Squares that are summed beside it, shape (n_records, 1 or m)."""
        return self.misfits[:, None] ** 2 if self.spread is None else self.values**2

    @cached_property
    def misfits(self) -> Array:
        """Root mean square of ln(spectrum/target) of each record, shape (n_records,)."""
        return log_spectrum_misfit(self.spectra)

    def objective(self, total: Array, squares: Array, count: int) -> Array:
        """Return the objective of sets of `count` spectra with the given sums, along the first axis."""
        if self.spread is None:
            of_mean = log_spectrum_misfit(total / count) ** 2
            return (1.0 - self.record_weight) * of_mean + self.record_weight * squares[:, 0] / count
        mean = total / count
        variance = np.maximum(squares / count - mean**2, 0.0) * (count / max(count - 1, 1))
        return np.mean(mean**2 + (np.sqrt(variance) - self.spread) ** 2, axis=-1)

    def objective_of(self, chosen: Sequence[int]) -> float:
        """Return the objective of one set."""
        rows = list(chosen)
        total, squares = self.values[rows].sum(axis=0), self.squares[rows].sum(axis=0)
        return float(self.objective(total[None], squares[None], len(rows))[0])

    def allowed(self, chosen: Sequence[int]) -> np.ndarray:
        """Return which records may be added to a set, shape (n_records,)."""
        free = np.ones(len(self.spectra), dtype=bool)
        free[list(chosen)] = False
        for groups, most in self.group_limits:
            count = Counter(groups[i] for i in chosen)
            free &= [group is None or count[group] < most for group in groups]
        return free


def log_spectrum_misfit(ratios: Array) -> Array:
    """Root mean square of the logarithms along the last axis."""
    return np.sqrt(np.mean(np.log(ratios) ** 2, axis=-1))


def best_record_set(choice: SelectionProblem, n: int) -> list[int]:
    """Return the best of some sets of `n` records, in order: each is improved by exchanges until none helps.

    One set starts from the records with the least misfits; the others grow, each from one of these records, by the
    record that helps the mean most. The list is shorter than `n` where the limits leave too few records.
    """
    seeds = np.argsort(choice.misfits, kind="stable")[:N_STARTS]
    starts = [_ranked_records(choice, n), *(_greedy_record_set(choice, n, int(seed)) for seed in seeds)]
    longest = max(map(len, starts))
    sets = [_record_set_after_exchanges(choice, start) for start in starts if len(start) == longest]
    return sorted(min(sets, key=choice.objective_of))


def _ranked_records(choice: SelectionProblem, n: int) -> list[int]:
    chosen: list[int] = []
    for i in np.argsort(choice.misfits, kind="stable"):
        if len(chosen) < n and choice.allowed(chosen)[i]:
            chosen.append(int(i))
    return chosen


def _greedy_record_set(choice: SelectionProblem, n: int, seed: int) -> list[int]:
    chosen, total, squares = [seed], choice.values[seed], choice.squares[seed]
    while len(chosen) < n and (free := choice.allowed(chosen)).any():
        objective = choice.objective(total + choice.values, squares + choice.squares, len(chosen) + 1)
        i = int(np.argmin(np.where(free, objective, np.inf)))
        chosen.append(i)
        total, squares = total + choice.values[i], squares + choice.squares[i]
    return chosen


def _record_set_after_exchanges(choice: SelectionProblem, chosen: list[int]) -> list[int]:
    """Replace one record at a time, always by the exchange that helps most."""
    present = choice.objective_of(chosen)
    while True:
        best, exchange = present, None
        for place in range(len(chosen)):
            rest = chosen[:place] + chosen[place + 1 :]
            total, squares = choice.values[rest].sum(axis=0), choice.squares[rest].sum(axis=0)
            objective = choice.objective(total + choice.values, squares + choice.squares, len(chosen))
            objective[~choice.allowed(rest)] = np.inf
            other = int(np.argmin(objective))
            if objective[other] < best * (1.0 - MIN_GAIN):
                best, exchange = float(objective[other]), (place, other)
        if exchange is None:
            return chosen
        chosen = [*chosen[: exchange[0]], exchange[1], *chosen[exchange[0] + 1 :]]
        present = best


def select_records(
    motions: Sequence[GroundMotion],
    target: TargetSpectrum,
    n: int,
    periods: ArrayLike,
    *,
    measure: Combination,
    scale_limits: tuple[float, float],
    per_event: int | None,
    per_station: int | None,
    record_weight: float,
    least_ratio: float | None,
) -> tuple[Array, list[Recording], Array, Array]:
    """Return the periods, the chosen records, unscaled, their factors and their scaled spectra; see `Suite.select`."""
    fitted = checked_instance("target", target, TargetSpectrum)
    examined = comparison_periods(periods)
    aim = fitted.at(examined)
    if not is_one_of(measure, get_args(Combination)):
        words = ", ".join(map(repr, get_args(Combination)))
        raise InputError(f"measure must be one of {words}, but {shown(measure)} was given.", field="measure")
    low, high = _checked_scale_limits(scale_limits)
    weight = real_or_nan(record_weight)
    if not 0.0 <= weight <= 1.0:
        raise InputError(
            f"record_weight must lie in [0, 1], but {shown(record_weight)} was given.", field="record_weight"
        )
    caps = [
        (name, None if most is None else checked_whole_number(name, most, 1))
        for name, most in (("per_event", per_event), ("per_station", per_station))
    ]
    check_horizontal_component(*motions)
    records, spread = _candidate_recordings(motions, measure), None
    count = checked_whole_number("n", n, 1)
    if count > len(records):
        kind = "records" if measure == "component" else "pairs"
        raise InputError(f"n must be at most {len(records)}, the number of {kind}, but {count} was given.", field="n")
    unscaled = np.stack([record.sa(examined, measure, fitted.damping_ratio) for record in records])
    names = [record.names[0] for record in records]
    if isinstance(fitted, ConditionalSpectrum):
        _check_conditional_choice(count, weight, least_ratio)
        spread = fitted.dispersion_at(examined)
        factors = _factors_to_one_ordinate(records, names, fitted, measure)
        usable = np.flatnonzero((factors >= low) & (factors <= high))
        if usable.size < count:
            raise InputError(
                f"n = {count} records were asked for, but only {usable.size} of {len(records)} reach S_a("
                f"{fitted.period:g} s) = {fitted.at([fitted.period])[0]:.4g} m/s² with factors from {low:g} to "
                f"{high:g}. Choose fewer, give more records, or widen scale_limits.",
                field="n",
            )
        records, unscaled, factors = [records[i] for i in usable], unscaled[usable], factors[usable]
    else:
        fitting = [spectrum_fitting_factor(row, aim, name) for row, name in zip(unscaled, names, strict=True)]
        factors = np.clip(fitting, low, high)
    groups = {"per_event": [each.event for each in records], "per_station": [each.station for each in records]}
    limits = tuple((groups[name], most) for name, most in caps if most is not None)
    found = best_record_set(SelectionProblem(factors[:, None] * unscaled / aim, weight, limits, spread), count)
    if len(found) < count:
        given = " and ".join(f"{name}={most}" for name, most in caps if most is not None)
        raise InputError(
            f"n = {count} records were asked for, but with {given} only {len(found)} of {len(records)} can be chosen. "
            "Choose fewer, or raise the limit.",
            field="n",
        )
    factors, unscaled = factors[found], unscaled[found]
    if least_ratio is not None:
        factors = _raised_scale_factors(factors, unscaled / aim, checked_positive("least_ratio", least_ratio, ""), high)
    return examined, [records[i] for i in found], factors, factors[:, None] * unscaled


def _check_conditional_choice(count: int, weight: float, least_ratio: float | None) -> None:
    """Refuse what has no meaning where the spread of the records is given, too."""
    if count < 2:
        raise InputError(
            f"n must be at least 2 for a conditional spectrum, as one record has no spread, but {count} was given.",
            field="n",
        )
    for name, given in (("record_weight", weight or None), ("least_ratio", least_ratio)):
        if given is not None:
            raise InputError(
                f"{name} is for targets of codes: a conditional spectrum says how records scatter about it. Leave it "
                "out.",
                field=name,
            )


def _factors_to_one_ordinate(
    records: Sequence[Recording], names: Sequence[str], target: ConditionalSpectrum, measure: Combination
) -> Array:
    """Return the factors that give each record the ordinate of the target at its period."""
    period = target.period
    own = [float(record.sa([period], measure, target.damping_ratio)[0]) for record in records]
    usable = [scalable_spectral_ordinate(each, name, period) for each, name in zip(own, names, strict=True)]
    return target.at([period])[0] / np.array(usable)


def _checked_scale_limits(given: tuple[float, float]) -> tuple[float, float]:
    limits = checked_finite_vector("scale_limits", given, "")
    if limits.size != 2 or not 0.0 < limits[0] <= limits[1]:
        raise InputError(
            f"scale_limits must be the smallest and the largest factor, both positive, but {shown(given)} was given.",
            field="scale_limits",
        )
    return float(limits[0]), float(limits[1])


def _raised_scale_factors(factors: Array, ratios: Array, least: float, high: float) -> Array:
    """Return the factors, multiplied by one number of at least 1 with which the mean reaches `least` of the target."""
    more = max(1.0, least / float(np.min((factors[:, None] * ratios).mean(axis=0))))
    if factors.max() * more > high and more > 1.0:
        raise InputError(
            f"For a mean of at least {least:g} of the target, factors up to {factors.max() * more:.3g} are needed, but "
            f"scale_limits end at {high:g}. Raise the limit, choose more records, or give more to choose from.",
            field="least_ratio",
        )
    return factors * more


def _candidate_recordings(motions: Sequence[GroundMotion], measure: Combination) -> list[Recording]:
    if measure == "component":
        return [Recording((motion,)) for motion in motions]
    pairs, single = horizontal_pairs(motions)
    if not pairs:
        raise InputError(
            f'measure="{measure}" needs the two horizontal components of a recording, but no two motions belong '
            "together: by record sequence number, by event, year and station, or by name, as ABC000 and ABC090.",
            field="measure",
        )
    if single:
        warnings.warn(
            translated(
                "Left out: {n} motion that is not one of two components with the same time step, {names}."
                if len(single) == 1
                else "Left out: {n} motions that are not one of two components with the same time step, {names}.",
                n=len(single),
                names=first_texts_shown(single, 5),
            ),
            RecordWarning,
            stacklevel=4,
        )
    return pairs
