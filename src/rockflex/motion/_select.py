"""The choice of records for a target spectrum: checks, factors, limits."""

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from typing import get_args

import numpy as np
from numpy.typing import ArrayLike

from rockflex._arrays import Array
from rockflex._checks import finite_vector, instance, one_of, positive, real_or_nan, whole_number
from rockflex._errors import InputError, RecordWarning
from rockflex._shown import counted, shown
from rockflex.motion._choice import Choice, best_set
from rockflex.motion._direction import check_horizontal
from rockflex.motion._ground_motion import GroundMotion
from rockflex.motion._periods import examined_periods
from rockflex.motion._recordings import Combination, Recording, paired
from rockflex.motion._scaling import fitting_factor
from rockflex.motion._target import TargetSpectrum

_NAMED = 5  # motions that a warning names


@dataclass(frozen=True, kw_only=True)
class Wishes:
    """The options of `Suite.select`, as given."""

    measure: Combination
    scale_limits: tuple[float, float]
    per_event: int | None
    per_station: int | None
    record_weight: float
    least_ratio: float | None


def chosen_records(
    motions: Sequence[GroundMotion], target: TargetSpectrum, n: int, periods: ArrayLike, wishes: Wishes
) -> tuple[Array, list[Recording], Array, Array]:
    """Return the periods, the chosen records, unscaled, their factors and their scaled spectra; see `Suite.select`."""
    wanted = instance("target", target, TargetSpectrum)
    examined = examined_periods(periods)
    aim = wanted.at(examined)
    if not one_of(wishes.measure, get_args(Combination)):
        words = ", ".join(map(repr, get_args(Combination)))
        raise InputError(f"measure must be one of {words}, but {shown(wishes.measure)} was given.", field="measure")
    low, high = _limits(wishes.scale_limits)
    weight = _share("record_weight", wishes.record_weight)
    caps = [
        (name, None if most is None else whole_number(name, most, 1))
        for name, most in (("per_event", wishes.per_event), ("per_station", wishes.per_station))
    ]
    check_horizontal(*motions)
    records = _recordings(motions, wishes.measure)
    count = whole_number("n", n, 1)
    if count > len(records):
        kind = "records" if wishes.measure == "component" else "pairs"
        raise InputError(f"n must be at most {len(records)}, the number of {kind}, but {count} was given.", field="n")
    unscaled = np.stack([record.sa(examined, wishes.measure, wanted.damping_ratio) for record in records])
    fitting = [fitting_factor(row, aim, record.names[0]) for row, record in zip(unscaled, records, strict=True)]
    factors = np.clip(fitting, low, high)
    groups = {"per_event": [each.event for each in records], "per_station": [each.station for each in records]}
    limits = tuple((groups[name], most) for name, most in caps if most is not None)
    found = best_set(Choice(factors[:, None] * unscaled / aim, weight, limits), count)
    if len(found) < count:
        given = " and ".join(f"{name}={most}" for name, most in caps if most is not None)
        raise InputError(
            f"n = {count} records were asked for, but with {given} only {len(found)} of {len(records)} can be chosen. "
            "Choose fewer, or raise the limit.",
            field="n",
        )
    factors, unscaled = factors[found], unscaled[found]
    if wishes.least_ratio is not None:
        factors = _raised(factors, unscaled / aim, positive("least_ratio", wishes.least_ratio, ""), high)
    return examined, [records[i] for i in found], factors, factors[:, None] * unscaled


def _share(name: str, given: float) -> float:
    share = real_or_nan(given)
    if not 0.0 <= share <= 1.0:
        raise InputError(f"{name} must lie in [0, 1], but {shown(given)} was given.", field=name)
    return share


def _limits(given: tuple[float, float]) -> tuple[float, float]:
    limits = finite_vector("scale_limits", given, "")
    if limits.size != 2 or not 0.0 < limits[0] <= limits[1]:
        raise InputError(
            f"scale_limits must be the smallest and the largest factor, both positive, but {shown(given)} was given.",
            field="scale_limits",
        )
    return float(limits[0]), float(limits[1])


def _raised(factors: Array, ratios: Array, least: float, high: float) -> Array:
    """Return the factors, multiplied by one number of at least 1 with which the mean reaches `least` of the target."""
    more = max(1.0, least / float(np.min((factors[:, None] * ratios).mean(axis=0))))
    if factors.max() * more > high and more > 1.0:
        raise InputError(
            f"For a mean of at least {least:g} of the target, factors up to {factors.max() * more:.3g} are needed, but "
            f"scale_limits end at {high:g}. Raise the limit, choose more records, or give more to choose from.",
            field="least_ratio",
        )
    return factors * more


def _recordings(motions: Sequence[GroundMotion], measure: Combination) -> list[Recording]:
    if measure == "component":
        return [Recording((motion,)) for motion in motions]
    pairs, single = paired(motions)
    if not pairs:
        raise InputError(
            f'measure="{measure}" needs the two horizontal components of a recording, but no two motions belong '
            "together: by record sequence number, by event, year and station, or by name, as ABC000 and ABC090.",
            field="measure",
        )
    if single:
        count = counted(len(single), "motion that is", "motions that are")
        more = f" and {len(single) - _NAMED} more" if len(single) > _NAMED else ""
        warnings.warn(
            f"Left out: {count} not one of two components with the same time step, {', '.join(single[:_NAMED])}{more}.",
            RecordWarning,
            stacklevel=4,
        )
    return pairs
