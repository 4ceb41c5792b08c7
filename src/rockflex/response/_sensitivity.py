"""How the peaks of a run change with the scale of its record and with parameters."""

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from rockflex.engine.solution import Excitation, Solution
from rockflex.foundation.arrays import Array, Bools
from rockflex.foundation.language import translated
from rockflex.foundation.number_format import rounded_number
from rockflex.models._prepared_model import PreparedModel
from rockflex.models._rocking_model import RockingModel
from rockflex.models._state_layout import GROUND, HEADER, RISE, SIDE, TIME
from rockflex.models._tangents import RunTangents, tangents_of_run
from rockflex.response._outputs import OUTPUTS
from rockflex.response._peaks import GLOBAL, TrackedPeaks, peak_numbers, tracked_quantities

STEP = 2e-3  # of the logarithm of a parameter, over which a model is smooth
PEAK_STEP = 1e-6  # of the same, over which no peak becomes larger than another one
SHARE = 1e-3  # of a peak, by which it moves at most in that step
IN_FLIGHT = 1e-9  # of the reaction at rest
SAME = 1e-9  # of a time step: instants that are one
FLAGGED = 10.0  # elasticity from which on 1 % of the record moves a peak by more than 10 %
KEPT = 4  # models that are prepared for further sensitivities
DERIVED = (
    "max_rotation", *(f"max_{name}" for name in GLOBAL), "min_vertical_reaction", "max_tendon_force",
    "tendon_utilisation", "residual_rotation", "balance_ratio", "max_joint_rotation", "min_joint_force",
    "max_slip", "residual_slip", "max_edge_uplift", "max_edge_settlement", "leaning_push", "column_pull",
)  # fmt: skip
"""The numbers of a response that have derivatives."""


class TiedModel(NamedTuple):
    """A model prepared for runs, and what its runs track."""

    model: RockingModel
    engine: PreparedModel
    tracked: TrackedPeaks


class Neighbourhood(NamedTuple):
    """A model after so many `STEP` of the logarithm of a parameter, and the weights of a derivative."""

    models: Mapping[int, TiedModel]
    weights: Mapping[int, float]


@dataclass(frozen=True)
class Sensitivity(Mapping[str, float]):
    """By how many per cent the peaks of a run change for 1 % on the scale of its record: ∂ ln (peak)/∂ ln (scale).

    A mapping from names of peaks, such as ``"max_rotation"``. Peaks that are zero are left out.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> run = rf.simulate(frame, pulse)
    >>> round(run.sensitivity["max_rotation"], 2)
    -1.81
    >>> run.sensitivity.flagged
    ()
    """

    elasticities: Mapping[str, float]

    def __getitem__(self, name: str) -> float:
        return self.elasticities[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.elasticities)

    def __len__(self) -> int:
        return len(self.elasticities)

    @cached_property
    def flagged(self) -> tuple[str, ...]:
        """Names of the peaks that 1 % of the record moves by more than 10 %."""
        return tuple(name for name, value in self.items() if not abs(value) <= FLAGGED)

    @property
    def note(self) -> str:
        """What that means, in words; empty if no peak is flagged."""
        if not self.flagged:
            return ""
        worst = max(self.flagged, key=lambda name: math.inf if math.isnan(self[name]) else abs(self[name]))
        return translated(
            "1 % on the scale of the record moves {peaks} by more than 10 %, {worst} by {percent} %. A single run "
            "says little there: judge by many records, or by the same record at several scales.",
            peaks=", ".join(translated(OUTPUTS[name].symbol) for name in self.flagged),
            worst=translated(OUTPUTS[worst].symbol),
            percent=rounded_number(abs(self[worst])),
        )


def numbers_with_derivatives(
    tied: TiedModel, neighbourhoods: Sequence[Neighbourhood], tangents: RunTangents
) -> dict[str, tuple[float, Array]]:
    """Return the numbers of `DERIVED` and their derivatives with respect to the logarithms of P parameters, (P,).

    Parameters
    ----------
    tied
        The model of the run.
    neighbourhoods
        Of each parameter but the first, which is the scale of the record.
    tangents
        The derivatives of what the engine tracks; what has none by a parameter, NaN, has none of these numbers either.
    """
    values = peak_numbers(tied.model, tangents.solution, tied.tracked)
    found = {name: (float(values[name]), np.zeros(1 + len(neighbourhoods))) for name in DERIVED}

    def add(place: int, tied: TiedModel, solution: Solution, weight: float) -> None:
        numbers = peak_numbers(tied.model, solution, tied.tracked)
        numbers["min_vertical_reaction"] = tied.model.properties.resting_reaction - solution.lost_support
        for name in DERIVED:
            found[name][1][place] += weight * numbers[name]

    unknown: Bools = np.asarray(np.isnan(tangents.final).any(axis=1))
    for place in np.flatnonzero(~unknown).tolist():
        step = _step_of_peaks(tangents, place)
        for way in (1.0, -1.0):
            add(place, tied, _moved(tangents, tied.engine, place, way * step), way / (2.0 * step))
    for place, (models, weights) in enumerate(neighbourhoods, 1):  # what another model makes of the same peaks
        for k, each in models.items() if not unknown[place] else ():
            add(place, each, _moved(tangents, each.engine, place, 0.0), weights[k] / STEP)
    least, slopes = found["min_vertical_reaction"]
    if tied.model.springs is not None and least < IN_FLIGHT * tied.model.properties.resting_reaction:
        slopes[:] = 0.0  # the base has left the ground
    for _, slopes in found.values():
        slopes[unknown] = np.nan
    return found


def _step_of_peaks(tangents: RunTangents, place: int) -> float:
    """A step of the logarithm of a parameter that hardly moves any peak."""
    peaks, slopes = np.abs(tangents.peak_values), np.abs(tangents.peaks[place])
    some = (peaks > 0.0) & (slopes > 0.0)
    return float(max((SHARE * peaks[some] / slopes[some]).min(initial=PEAK_STEP), 1e-3 * PEAK_STEP))


def _moved(tangents: RunTangents, engine: PreparedModel, place: int, by: float) -> Solution:
    """What a run would have found, to the first order, where the logarithm of a parameter is another one."""
    solution, n = tangents.solution, len(tangents.solution.peaks)
    peaks = tangents.peak_values + by * tangents.peaks[place]
    states = (tangents.state + by * tangents.final[place])[None]
    (final,) = engine.model_states([tangents.key], np.zeros(1, dtype=np.int64), states)
    return replace(
        solution, peaks=peaks[:n], extremes=peaks[n:-1], lost_support=float(peaks[-1]), final_state=final, states=None
    )


_known = dict[int, TiedModel]()  # by identity: the runs of one structure share their model


def _prepared(model: RockingModel) -> TiedModel:
    """The model prepared for runs; the last few are kept."""
    found = _known.get(id(model))
    if found is None:
        tracked = tracked_quantities(model)
        extremes = None if tracked.extremes is None else tracked.extremes.quantities
        found = TiedModel(model, PreparedModel(model, tracked.peaks.quantities, extremes), tracked)
        for oldest in list(_known)[: 1 - KEPT]:
            _known.pop(oldest, None)
        _known[id(model)] = found
    return found


def sensitivity_of_history(model: RockingModel, states: Array) -> Sensitivity:
    """Return the sensitivity of a run to the scale of its record, from its history.

    Raises
    ------
    InputError
        If the model is not linear between events.
    """
    tied = _prepared(model)
    run, dt, free = _run_of_history(states)
    first = states[:1]
    (key,) = model.branches_at(first[:, SIDE], model.layout.of(first, model.layout.rotation), first).tolist()
    start = (tuple(key), first[0, HEADER:].copy())
    made = tangents_of_run(tied.engine, run, dt, free_vibration=free, start=start)
    numbers = numbers_with_derivatives(tied, (), made)
    return Sensitivity(
        {name: float(slope[0]) / value for name, (value, slope) in numbers.items() if _is_peak(name) and value > 0.0}
    )


def _is_peak(name: str) -> bool:
    return name.startswith("max_")


def _run_of_history(states: Array) -> tuple[Excitation, float, float]:
    """What shook the run of a history, its time step, and the free vibration after it in s."""
    times = np.ascontiguousarray(states[:, TIME])
    apart = np.concatenate(((True,), np.diff(times) > 0.0, (True,)))
    single = times[apart[:-1] & apart[1:]]  # the time of an event occurs twice, and there may be many within a sample
    lengths = np.diff(single if single.size > 1 else times[apart[1:]])
    step = float(np.partition(lengths, lengths.size // 2)[lengths.size // 2])
    count = round(float(times[-1]) / step)
    step = float(times[-1]) / count if abs(times[-1] / count - step) < SAME * step else step
    count = math.ceil(float(times[-1]) / step - SAME)
    shaken = states[:, (GROUND, RISE)] if states[:, RISE].any() else states[:, (GROUND,)]
    samples = step * np.arange(count + 1)
    found = np.stack([np.interp(samples, times, column) for column in shaken.T], axis=1)
    nodes = np.minimum(np.searchsorted(times, samples - SAME * step), len(times) - 1)
    at = np.abs(times[nodes] - samples) < SAME * step
    found[at] = shaken[nodes[at]]
    if not at[-1]:  # it overturned within a sample
        place = int(nodes[-2])
        found[-1] = found[-2] + (shaken[-1] - shaken[place]) * step / (times[-1] - times[place])
    jumps = np.flatnonzero((np.diff(times) == 0.0) & (np.diff(shaken, axis=0) != 0.0).any(axis=1))
    end = round(float(times[jumps[0]]) / step) if jumps.size else count
    vertical = found[: end + 1, 1].copy() if found.shape[1] > 1 else None
    return Excitation(found[: end + 1, 0].copy(), vertical), step, (count - end) * step
