"""A model prepared for runs on `rockflex.engine`, and what becomes of them."""

import math
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import cached_property
from threading import Lock
from typing import Any, cast

import numpy as np

from rockflex.engine.batch import Batch
from rockflex.engine.run import Run
from rockflex.engine.solution import Ends, Excitation, Solution, Solutions, Status
from rockflex.engine.solvers import SolverPool
from rockflex.engine.stops import check_interruption
from rockflex.engine.system import MAX_STATES, StepTooLongError, System
from rockflex.engine.tangent_pass import Crossing
from rockflex.engine.tangent_steps import Motion
from rockflex.foundation.arrays import Array, Bools, Integers
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError, SolverError
from rockflex.models._landing import GUARDED, GainsEnergyError
from rockflex.models._linear_bases import linear_system_base
from rockflex.models._linear_system import LinearSystemBase, linear_system_of
from rockflex.models._nonlinear_ground_system import nonlinear_system
from rockflex.models._nonlinear_system import nonlinear_system_key, states_with_branch_codes
from rockflex.models._phase import Key
from rockflex.models._quantities import Quantities
from rockflex.models._rigid_ground_system import may_stack, system_on_rigid_ground
from rockflex.models._rocking_model import RockingModel
from rockflex.models._run_failures import explaining_engine_failures, failure_of_limit, failure_of_run, failure_of_step
from rockflex.models._state_layout import GROUND, HEADER, RISE, SIDE, TIME
from rockflex.models._work import SEARCH, CostModel, Task, cost_model_of

SHARE = 0.5  # of the estimated time of a sample that one takes here
STEP = 12.0  # samples that a step of a nonlinear model counts like
STACK = 256  # systems in one stack, at most
MEMORY = 64_000_000  # bytes of the tables of one stack
SIZES = 64  # of runs whose work has been checked, at most
COUNTED = ("uplift", "impact", GUARDED)
OUTCOMES = np.array(  # for fixed times, and until settled
    [[Status.ENDED, Status.OVERTURNED, Status.SETTLED], [Status.UNSETTLED, Status.OVERTURNED, Status.SETTLED]]
)
MAX_SAMPLES = 2.0**62  # of free vibration: more than can ever be computed
_GATHERING = Lock()
FAILURES = {"accumulation": Status.CHATTER, "growth": Status.INFINITE, "stall": Status.STALLED}


Start = Array | tuple[Key, Array] | None  # the state of a model at time 0; None: at rest


def solver_pool(
    models: Sequence[RockingModel],
    quantities: Sequence[Quantities],
    base: LinearSystemBase | None = None,
    extremes: Quantities | None = None,
) -> SolverPool:
    """Return the solvers of models that differ only in numbers, or of one with elements. Errors name the first."""
    first = models[0]

    def system() -> System:
        if first.integrated:
            return nonlinear_system(first, quantities[0], extremes)
        return system_on_rigid_ground(models, quantities) if base is None else linear_system_of(base)

    return SolverPool(system, lambda: explaining_engine_failures(first))


class PreparedModel:
    """A model with its phases, prepared as runs meet them, for every time step used so far.

    Parameters
    ----------
    model
        The model.
    quantities
        Quantities whose peaks are computed.
    extremes
        Quantities of which only the largest value matters, not the magnitude.

    Raises
    ------
    InputError
        If the model has too many modes.
    """

    def __init__(self, model: RockingModel, quantities: Quantities, extremes: Quantities | None = None) -> None:
        self.model, self.quantities, self.extremes = model, quantities, extremes
        if model.layout.size > MAX_STATES:
            raise InputError(
                f"{model.label} has {model.properties.n_modes} modes, but at most {(MAX_STATES - 16) // 2} can be "
                "simulated. Keep fewer: the highest ones move nothing.",
                field="model",
            )
        self.place, self._accepted = 0, set[tuple[object, ...]]()
        # Phases and events with their derivatives by the scale of a record, of each time step
        self.tangents = dict[tuple[bool, float], tuple[dict[Any, Motion], dict[Any, Crossing]]]()
        self.n_peaks = 1 + len(quantities)

    @cached_property
    def base(self) -> LinearSystemBase | None:
        """The base of a model with elements, on springs, or that slides; None for all others."""
        return self._base(shaken=False)

    def _base(self, *, shaken: bool) -> LinearSystemBase | None:
        if self.model.integrated or self.model.has_bare_base:
            return None
        most = Quantities.none(self.model.layout.modes) if self.extremes is None else self.extremes
        return linear_system_base(self.model, self.quantities, most, shaken=shaken)

    @cached_property
    def pool(self) -> SolverPool:
        """The stack of the model, by itself unless it has been gathered."""
        return solver_pool([self.model], [self.quantities], self.base, self.extremes)

    @cached_property
    def shaken(self) -> SolverPool:
        """The same for ground that moves vertically, which other phases need only if there are elements."""
        return self.pool if self.base is None else solver_pool([self.model], [self.quantities], self._base(shaken=True))

    @cached_property
    def longest_settling_time(self) -> float:
        """The longest free vibration until settled, s."""
        p = self.model.properties
        slowest = float(p.omega.min(initial=math.inf))
        if self.base is not None or self.model.springs is not None:  # on springs it rocks more slowly
            base = self.base or linear_system_base(self.model.linear, *(Quantities.none(p.n_modes),) * 2)
            roots = np.linalg.eigvals(base.rates(self.model.linear.initial(None)[0])[:, :-2])
            slowest = float(np.abs(roots[roots.imag > 0.0]).min(initial=slowest))
        return 2000.0 * 2.0 * math.pi / slowest + 200.0 * math.sqrt(p.i_theta / (p.l0r * GRAVITY))

    @property
    def size(self) -> int:
        """Memory of what is kept for further runs, in bytes."""
        return sum(pool.size for pool in {vars(self)[name] for name in ("pool", "shaken") if name in vars(self)})

    @property
    def size_of_plain(self) -> int:
        """Memory of the tables of a model without elements in bytes, roughly, before they are made."""
        n, rows = self.model.layout.core, self.n_peaks + 3
        return 8 * len(self.model.sides) * (n + 6) * (5 * n + 14 * rows)

    @cached_property
    def cost_model(self) -> CostModel:
        """The properties that determine the work of runs."""
        return cost_model_of(self.model, self.n_peaks + 1)

    def task(self, run: Excitation, dt: float, free_vibration: float | None = 0.0, *, history: bool = False) -> Task:
        """Return the task of a run, which estimates its work."""
        return Task(self.model, self.cost_model, run.acceleration, dt, free_vibration, history, run.scale)

    def check_work(
        self, run: Excitation, dt: float, free_vibration: float | None, *, history: bool, limit: float | None
    ) -> None:
        """Raise `WorkLimitError` as `Task.check` does; of runs that are equally much work only the first is asked."""
        size = run.acceleration.size, dt, free_vibration, history, limit
        if size in self._accepted:
            return
        self.task(run, dt, free_vibration, history=history).check(limit)
        if not self.cost_model.flow:  # with a hysteresis that flows, the work depends on every sample
            if len(self._accepted) >= SIZES:
                self._accepted.clear()
            self._accepted.add(size)

    def join_pool(self, pool: SolverPool, place: int) -> None:
        """Share a pool with other models."""
        vars(self)["pool"], self.place = pool, place

    @property
    def group(self) -> int:
        """A number that engines have in common if they share a stack."""
        return id(vars(self).get("pool", self))

    def release(self) -> None:
        """Forget all tables; the next run makes them anew."""
        self.place = 0
        self.tangents.clear()
        for name in ("pool", "shaken"):
            vars(self).pop(name, None)

    def run(
        self,
        acceleration: Array,
        dt: float,
        *,
        free_vibration: float | None = 0.0,
        state: Start = None,
        history: bool = False,
        work_limit: float | None = None,
        vertical: Array | None = None,
    ) -> Solution:
        """Run one record as `run_all` does, and return its solution or raise its error."""
        runs = [Excitation(acceleration, vertical)]
        found = run_all(
            [self], runs, dt, free_vibration=free_vibration, starts=[state], history=history, work_limit=work_limit
        )
        return found.one(0)

    def pool_for(self, run: Excitation) -> SolverPool:
        """Return the stack that has the phases of a run."""
        return self.pool if run.vertical is None else self.shaken

    def start(self, state: Start) -> tuple[Key, Array]:
        """Return the first phase and the states of the engine at time 0, from a state [D.., D'.., θ, θ'].

        The state may also be that of a run that goes on: its branches, and all that the layout holds.

        Raises
        ------
        InputError
            If it does not fit the model.
        """
        if state is None:
            return self.at_rest
        key, start = state if isinstance(state, tuple) else self.model.initial(state)
        if self.model.integrated:
            return nonlinear_system_key(self.model, key, start), start
        return key, start if self.base is None else self.base.state_of(key, start)

    @cached_property
    def at_rest(self) -> tuple[Key, Array]:
        """First phase and states at rest."""
        return self.start(self.model.initial(None))

    def model_states(self, keys: Sequence[Key], places: Integers, states: Array, *, history: bool = False) -> Array:
        """The states of the model, from those of the engine."""
        if not places.size:  # all runs were refused
            return np.zeros((0, self.model.layout.size))
        if not self.model.integrated and self.base is None:
            return states
        known, places = np.unique(places, return_inverse=True)
        keys = [keys[place] for place in known.tolist()]
        if self.model.integrated:
            return states_with_branch_codes(self.model, keys, places, states)
        assert self.base is not None
        return self.base.states_of_model(keys, places, states, history=history)

    def failure(
        self, error: InputError | SolverError, solver: Run, task: Task, work_limit: float | None
    ) -> InputError | SolverError:
        """The error of a run that could not be solved, with its time and state."""
        if isinstance(error, StepTooLongError):
            return failure_of_step(error.rate, task.dt)
        samples = int(solver.time / task.dt)
        if solver.failure == "work":
            return failure_of_limit(task, samples, work_limit, solver.state)
        status = Status.GAINED if isinstance(error, GainsEnergyError) else FAILURES.get(solver.failure)
        return error if status is None else failure_of_run(self.model, status, samples, task.dt, solver.state)

    def samples_allowed(self, work_limit: float | None) -> int:
        """The number of samples that a work limit in s allows."""
        if work_limit is None:
            return 2**62
        sample, look, step = self.cost_model.prices(history=False)
        if self.model.integrated:
            return int(min(work_limit / step * STEP, 2.0**62))
        return int(min(work_limit / (SHARE * (sample + SEARCH * look)), 2.0**62))

    def history_of(self, solver: Run) -> Array:
        """Return the states of the model at samples and beside events, as in `Solution`."""
        times, places, ground, states, rise = solver.history
        keys = cast("list[Key]", solver.keys)
        kept = np.arange(times.size)
        if self.model.bouc_wen is not None:
            kept = np.flatnonzero(without_reversals(times, keys, places))
        kept = kept[_kept(times[kept], np.array([key[0] for key in keys])[places[kept]])]
        times, places, ground, states = times[kept], places[kept], ground[kept], states[kept]
        rows = np.zeros((times.size, HEADER + self.model.layout.size))
        rows[:, TIME], rows[:, GROUND], rows[:, RISE] = times, ground, rise[kept]
        rows[:, HEADER:] = self.model_states(keys, places, states, history=True)
        side, rotation = rows[:, SIDE], rows[:, HEADER + self.model.layout.rotation]
        side[:] = np.array([key[0] for key in keys])[places]
        memory = HEADER + self.model.layout.memory
        for node in np.flatnonzero((times[1:-1] == times[:-2]) & (times[1:-1] == times[2:]))[::-1] + 1:
            # A contact that does not last has the elements of what follows.
            rows[node, memory:] = rows[node + 1, memory:]
        rotation[side * rotation < 0.0] = 0.0  # by rounding
        lands = (rotation[1:] == 0.0) | (side[1:] != side[:-1])  # another event may follow before the time has changed
        rotation[:-1][(times[1:] == times[:-1]) & (side[:-1] != 0.0) & lands] = 0.0
        return rows


def run_all(
    engines: Sequence[PreparedModel],
    runs: Sequence[Excitation],
    dt: float,
    *,
    free_vibration: float | None = 0.0,
    starts: Sequence[Start] | None = None,
    history: bool = False,
    work_limit: float | None = None,
    seen: Callable[[Run], None] | None = None,
) -> Solutions:
    """Run records, each on one of the models of a pool, followed by `free_vibration` s (None: until settled).

    There is a model and a start for every run; starts are as in `PreparedModel.start`, and all at rest by default. The
    ground moves vertically in all runs, or in none. `work_limit` is the limit of the estimated and of the actual work
    of each run in s, see `CostModel`; None means no limit. Some ten times a second the runs can be interrupted by
    Ctrl-C or `stopping_when`. Only a single run can have a `history`, which keeps every state, and be `seen`: the
    solver, which has kept the states beside events, is shown after a run that could be solved.

    The failures of the result are the errors of single runs: an initial state that does not fit, a run that exceeds its
    work limit (`WorkLimitError` before it begins), a user-defined impact law that fails or a time step that is too long
    (`InputError`), events that accumulate without end, a motion that does not settle, or impacts that would gain energy
    (`SolverError`).

    Raises
    ------
    InputError
        If the numbers of the model overflow.
    RunStoppedError
        If the runs were stopped from outside.
    """
    first, settles, failures = engines[0], free_vibration is None, dict[int, InputError | SolverError]()
    begins = [first.at_rest] * len(runs)  # the same for all models of a pool
    for place, (engine, run) in enumerate(zip(engines, runs, strict=True)):
        try:
            engine.check_work(run, dt, free_vibration, history=history, limit=work_limit)
            if starts is not None:
                begins[place] = engine.start(starts[place])
        except InputError as error:
            failures[place] = error
    allowed = [place for place in range(len(runs)) if place not in failures]
    pool = first.pool_for(runs[0])
    batch = Batch(
        pool.system,
        [runs[place].acceleration for place in allowed],
        [runs[place].scale for place in allowed],
        free=(
            [free_vibration_samples(engines[place].longest_settling_time, dt) for place in allowed]
            if free_vibration is None
            else free_vibration_samples(free_vibration, dt)
        ),
        settles=settles,
        names=COUNTED,
        verticals=[runs[place].vertical for place in allowed],
        start=np.array([begins[place][1] for place in allowed]) if starts and allowed else begins[0][1],
        keys=[begins[place][0] for place in allowed],
        which=[engines[place].place for place in allowed],
    )
    check_interruption()
    solver = pool.acquire(dt)
    solver.watch, solver.limit = check_interruption, first.samples_allowed(work_limit)
    solver.marks = seen is not None
    while batch.place < len(allowed):
        try:
            solver.follow(batch, history)
        except (InputError, SolverError) as error:
            place = allowed[batch.place]
            task = engines[place].task(runs[place], dt, free_vibration, history=history)
            failures[place] = engines[place].failure(error, solver, task, work_limit)
            batch.place += 1
    states = first.model_states(cast("list[Key]", solver.keys), batch.places, batch.states)
    found = _ends_of(batch, states, dt, allowed, len(runs), settles=settles)
    for place in np.flatnonzero(found.status < 0).tolist():
        status, samples = Status(found.status[place]), int(found.samples[place])
        failures.setdefault(place, failure_of_run(engines[place].model, status, samples, dt, found.states[place]))
    kept = first.history_of(solver) if history and not failures else None
    if seen is not None and not failures:
        seen(solver)
    pool.release(solver)
    return Solutions(found, dt, first.n_peaks, first.n_peaks, failures, kept)


def free_vibration_samples(time: float, dt: float) -> int:
    """Return the number of samples in some seconds of free vibration."""
    return math.ceil(min(time / dt, MAX_SAMPLES) - 1e-9)


def _kept(times: Array, side: Integers) -> Bools:
    """Which states of a history are kept: none within one instant that the next one follows on the same side."""
    kept = np.ones(times.size, dtype=bool)
    kept[1:-1] = (times[1:-1] != times[:-2]) | (times[1:-1] != times[2:]) | (side[1:-1] != side[2:])
    return kept


def without_reversals(times: Array, keys: Sequence[Key], places: Integers) -> Bools:
    """Which states are not on both sides of a reversal of a hysteretic spring, which changes nothing else."""
    own, kept = np.array([key[:-1] for key in keys])[places], np.ones(times.size, dtype=bool)
    pairs = (times[1:] == times[:-1]) & (own[1:] == own[:-1]).all(axis=1) & (places[1:] != places[:-1])
    for k in np.flatnonzero(pairs).tolist():
        follows = k > 0 and times[k - 1] == times[k] and places[k - 1] != places[k]  # another event
        precedes = k + 2 < times.size and times[k + 2] == times[k]
        kept[k], kept[k + 1] = kept[k] and follows, precedes
    kept[0] = True
    return kept


def _ends_of(batch: Batch, states: Array, dt: float, allowed: Sequence[int], count: int, *, settles: bool) -> Ends:
    """How the runs have ended; those that were not allowed are left out."""
    status, samples = OUTCOMES[int(settles)][batch.outcomes], np.rint(batch.times / dt).astype(np.int64)
    uplifts, impacts, guarded = batch.counts.T
    found = Ends(status, samples, uplifts, impacts, guarded, batch.high, batch.when, states)
    if len(allowed) == count:
        return found
    return Ends(*(_spread(each, allowed, count) for each in found))


def _spread(values: Any, places: Sequence[int], count: int) -> Any:
    """Put values at places along a first axis of zeros."""
    found = np.zeros((count, *values.shape[1:]), values.dtype)
    found[list(places)] = values
    return found


def share_solvers(engines: Mapping[PreparedModel, Iterable[float]]) -> None:
    """Let engines of many models that differ only in numbers share their preparation, for their time steps."""
    with _GATHERING:  # two threads may gather the same engines
        alike = defaultdict[tuple[object, ...], list[PreparedModel]](list)
        for each, steps in engines.items():
            if each.model.integrated or not each.model.has_bare_base:
                continue
            if may_stack(each.model) and "pool" not in vars(each):
                kind = each.model.properties.n_modes, len(each.quantities), each.model.lifts, frozenset(steps)
                alike[kind].append(each)
        for some in alike.values():
            most = max(1, min(STACK, MEMORY // some[0].size_of_plain))
            for first in range(0, len(some), most):
                part = some[first : first + most]
                pool = solver_pool([each.model for each in part], [each.quantities for each in part])
                for place, each in enumerate(part):
                    each.join_pool(pool, place)
