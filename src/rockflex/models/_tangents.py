"""Derivatives of a run of a linear model with respect to the scale of the record and to parameters."""

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, cast

import numpy as np

from rockflex.engine.phase_tangent import Neighbours, brought_to_rest, crossing_of_event, motion_of_phase
from rockflex.engine.run import Run
from rockflex.engine.solution import Excitation, Solution
from rockflex.engine.system import LinearPhase, System
from rockflex.engine.tangent import Trace, follow_tangents
from rockflex.engine.tangent_pass import Crossing
from rockflex.engine.tangent_steps import Motion
from rockflex.foundation.arrays import Array, Integers
from rockflex.foundation.errors import InputError
from rockflex.models._phase import Key
from rockflex.models._prepared_model import PreparedModel, Start, run_all, share_solvers

LONGEST, OF_QUIET = 12, 6  # doublings of a sample, in the motion without excitation and after the record
KEPT = 64  # phases, and kinds of events, whose matrices are kept for the next run of a model


class NeighbouringModels(NamedTuple):
    """A model at a few relative changes of one parameter, and the weights by which a derivative is their sum.

    If there are as many on both sides, further weights tell the jump of the derivative at a kink.
    """

    engines: Mapping[int, PreparedModel]
    starts: Mapping[int, Start]
    weights: Mapping[int, float]
    kinks: Mapping[int, float]


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
        Of the samples and events of the run, in s, shape (k,); empty if nothing was observed.
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
    parameters: Sequence[NeighbouringModels] = (),
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
        [engine], [run], dt, free_vibration=free_vibration, starts=[start], work_limit=work_limit, seen=seen
    )
    solution, trace = found.one(0), kept[0]
    system, free = engine.pool_for(run).system, not parameters and not trace.shakes and not observed
    around = _around(parameters, run)
    motions, crossings = engine.tangents.setdefault((rise is not None, dt), ({}, {})) if free else ({}, {})

    def neighbours_of(key: Any) -> Neighbours | None:
        if around is None:
            return None
        phases = [_linear_phase(each, key) for each in around.systems]
        return Neighbours(phases, around.places, around.weights, around.kinks)

    def motion_of(key: Any) -> Motion:
        if key not in motions:
            if len(motions) == KEPT:
                motions.clear()
            upward = LONGEST if free else OF_QUIET if free_vibration != 0.0 else 0
            phase = _linear_phase(system, key)
            motions[key] = motion_of_phase(phase, engine.place, dt, neighbours_of(key), free=free, upward=upward)
        return motions[key]

    def crossing_of(*of: Any) -> Crossing:
        if of not in crossings:
            if len(crossings) == KEPT:
                crossings.clear()
            key, event, target = of
            phase = _linear_phase(system, key)
            crossings[of] = crossing_of_event(phase, engine.place, event, target, neighbours_of(key))
        return crossings[of]

    one_sided = np.isin(list(system.outputs), list(system.one_sided))
    begins = _slopes_of_starts(parameters, system.layout.size)
    tangents = follow_tangents(trace, motion_of, crossing_of, begins, one_sided, free=free, observed=observed)
    key, state, final = trace.keys[int(trace.places[-1])], trace.states[-1], tangents.final
    if solution.settled:
        state, final = brought_to_rest(_linear_phase(system, key), engine.place, neighbours_of(key), state, final)
    rates = np.abs(tangents.rates[~np.isnan(tangents.rates)])
    return RunTangents(
        solution,
        tangents.peaks,
        final,
        state,
        cast("Key", key),
        trace.high,
        float(rates.min(initial=np.inf)),
        tangents.times * dt,
        tangents.seen,
        tangents.slopes,
    )


class _Around(NamedTuple):
    """The systems of all neighbours, as of `Neighbours`."""

    systems: Sequence[System]
    places: Sequence[tuple[Integers, Integers]]
    weights: Array
    kinks: Array


def _around(parameters: Sequence[NeighbouringModels], run: Excitation) -> _Around | None:
    """The neighbours of all parameters; those that differ only in numbers share a stack."""
    if not parameters:
        return None
    engines = [each for some in parameters for each in some.engines.values()]
    share_solvers(dict.fromkeys(engines, ()))
    (weights, kinks), first = np.zeros((2, len(parameters), len(engines))), 0
    for row, some in enumerate(parameters):
        for k, step in enumerate(some.engines, first):
            weights[row, k], kinks[row, k] = some.weights[step], some.kinks.get(step, 0.0)
        first += len(some.engines)
    systems, stacks = list[System](), list[list[tuple[int, int]]]()
    for k, each in enumerate(engines):
        system = each.pool_for(run).system
        known = [id(other) for other in systems]
        if id(system) not in known:
            systems.append(system)
            stacks.append([])
            known.append(id(system))
        stacks[known.index(id(system))].append((k, each.place))
    places = [(pair[:, 0], pair[:, 1]) for pair in (np.array(stack, dtype=np.int64) for stack in stacks)]
    return _Around(systems, places, weights, kinks)


def _slopes_of_starts(parameters: Sequence[NeighbouringModels], n: int) -> Array:
    """The derivatives of the states at time 0, shape (1 + P, n)."""
    found = np.zeros((1 + len(parameters), n))
    for row, some in zip(found[1:], parameters, strict=True):
        of_steps = {step: each.start(some.starts[step])[1] for step, each in some.engines.items()}
        first = next(iter(of_steps.values()))
        row += sum(some.weights[step] * (state - first) for step, state in of_steps.items())
    return found


def _linear_phase(system: System, key: Any) -> LinearPhase:
    """A phase of a stack of systems, which is linear."""
    found = system.checked(key)
    assert isinstance(found, LinearPhase)
    return found
