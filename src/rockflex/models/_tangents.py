"""Derivatives of a run of a linear model with respect to the scale of the record and to parameters."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, cast

import numpy as np

from rockflex.engine.phase_tangent import PhaseTangent, joined_tangents, phase_tangent, scale_tangent
from rockflex.engine.run import Run
from rockflex.engine.solution import Excitation, Solution
from rockflex.engine.system import LinearPhase, System
from rockflex.engine.tangent import Trace, follow_tangents
from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError
from rockflex.models._phase import Key
from rockflex.models._prepared_model import PreparedModel, Start, run_all


class Neighbours(NamedTuple):
    """A model at a few relative changes of one parameter, and the weights by which a derivative is their sum."""

    engines: Mapping[int, PreparedModel]
    starts: Mapping[int, Start]
    weights: Mapping[int, float]


class RunTangents(NamedTuple):
    """A run and its derivatives with respect to the logarithms of P parameters; the first is the scale of the record.

    Parameters
    ----------
    solution
        The run.
    peaks
        Derivatives of what the engine tracks, as `Ends.peaks`, shape (P, F).
    final
        Those of the last states of the engine, shape (P, n).
    state, key
        These states, and the phase.
    peak_values
        The peaks themselves, shape (F,).
    slowest
        The slowest crossing of a condition at an event, over its scale in 1/s; infinite without events.
    times
        Of the states of the run, in s, shape (k,).
    seen, slopes
        Of what was observed, at these times: (k, r), and its derivatives, (P, k, r).
    """

    solution: Solution
    peaks: Array
    final: Array
    state: Array
    key: Key
    peak_values: Array
    slowest: float
    times: Array
    seen: Array
    slopes: Array


def tangents_of_run(
    engine: PreparedModel,
    run: Excitation,
    dt: float,
    *,
    free_vibration: float | None = 0.0,
    start: Start = None,
    work_limit: float | None = None,
    parameters: Sequence[Neighbours] = (),
    observed: Sequence[int] = (),
) -> RunTangents:
    """Run a record as `run_all` does, and follow its derivatives.

    `observed` are numbers of tracked quantities whose values over time are wanted, too.

    Raises
    ------
    InputError
        If the model is not linear between events, or near its value a parameter changes what can happen.
    SolverError
        If the run cannot be solved.
    """
    if engine.model.integrated:
        raise InputError(
            f"{engine.model.label} is integrated step by step, but derivatives are known of models that are linear "
            "between events, such as MDOF-S.",
            field="model",
        )
    kept = list[Trace]()
    ground = run.acceleration * run.scale
    rise = None if run.vertical is None else run.vertical * run.scale

    def seen(solver: Run) -> None:
        kept.append(Trace.of(solver, ground, rise))

    found = run_all(
        [engine],
        [run],
        dt,
        free_vibration=free_vibration,
        starts=[start],
        history=True,
        work_limit=work_limit,
        seen=seen,
    )
    solution, trace = found.one(0), kept[0]
    system = engine.pool_for(run).system
    others = [{step: each.pool_for(run).system for step, each in some.engines.items()} for some in parameters]

    def phase_of(key: Any) -> LinearPhase:
        return _linear_phase(system, key, engine.place)

    def tangent_of(key: Any) -> PhaseTangent:
        parts = [scale_tangent(phase_of(key))]
        if parameters:
            phases = [{step: _linear_phase(each, key, 0) for step, each in some.items()} for some in others]
            parts.append(phase_tangent(phase_of(key), phases, [some.weights for some in parameters]))
        return joined_tangents(parts)

    begins = np.zeros((1 + len(parameters), system.layout.size))
    for row, some in zip(begins[1:], parameters, strict=True):
        of_steps = {step: each.start(some.starts[step])[1] for step, each in some.engines.items()}
        first = next(iter(of_steps.values()))
        row += sum(some.weights[step] * (state - first) for step, state in of_steps.items())
    one_sided = np.isin(list(system.outputs), list(system.one_sided))
    tangents = follow_tangents(
        trace, phase_of, tangent_of, begins, one_sided, at_rest=solution.settled, observed=observed
    )
    rates = np.abs(tangents.rates[~np.isnan(tangents.rates)])
    return RunTangents(
        solution,
        tangents.peaks,
        tangents.final,
        tangents.state,
        cast("Key", trace.keys[tangents.place]),
        trace.high,
        float(rates.min(initial=np.inf)),
        trace.times * dt,
        tangents.seen,
        tangents.slopes,
    )


def _linear_phase(system: System, key: Key, place: int) -> LinearPhase:
    """A phase of one system of a stack, which is linear."""
    found = system.checked(key)
    assert isinstance(found, LinearPhase)
    return found.of(place)
