"""One run: a model tied to a structure, with the options of its runs, under a motion at a scale."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from rockflex._errors import InputError, SolverError
from rockflex.models import Quantities, RockingModel
from rockflex.motion import GroundMotion
from rockflex.response import Response, respond, tracked_extremes, tracked_quantities
from rockflex.solve import Engine, Excitation, Solution, Solutions, Task, gather, preparing
from rockflex.study._arguments import WORK_LIMIT
from rockflex.study._initial import InitialState


@dataclass(frozen=True, eq=False)
class Case:
    """A model tied to a structure, with the options of its runs. Its engine is built once, for any number of runs.

    Attributes
    ----------
    model
        The model, tied to its structure.
    free_vibration
        Seconds of free vibration; None means until settled.
    initial
        The state at t = 0; at rest if None.
    work_limit
        Limit of the work of a run in s; None for no limit.
    history
        Whether the history of the states is stored.
    floors
        Whether the peaks of the floors are tracked.
    extra
        Additional quantities whose peaks are tracked.
    engine
        The engine of the model, ready to run records.

    Raises
    ------
    InputError
        If a run with a hysteretic spring is to settle, or the numbers of the model overflow.
    """

    model: RockingModel
    free_vibration: float | None = 0.0
    initial: InitialState | None = None
    work_limit: float | None = WORK_LIMIT
    history: bool = False
    floors: bool = False
    extra: Quantities | None = None
    engine: Engine = field(init=False, repr=False)

    def __post_init__(self) -> None:
        if self.free_vibration is None and self.model.bouc_wen is not None:
            raise InputError(
                f'free_vibration="settle" cannot tell when the hysteretic spring of {self.model.label} is at rest. '
                "Give the free vibration in seconds.",
                field="free_vibration",
            )
        with preparing(self.model):
            asked = tracked_quantities(self.model, floors=self.floors)
        asked = asked if self.extra is None else asked + self.extra
        most = tracked_extremes(self.model)
        object.__setattr__(self, "engine", Engine(self.model, asked, most))

    def task(self, motion: GroundMotion, scale: float = 1.0) -> Task:
        """Return the task of a run, from which its work is estimated."""
        return self.engine.task(
            Excitation(motion.acceleration, None, scale), motion.dt, self.free_vibration, history=self.history
        )

    def solve(self, motion: GroundMotion, scale: float = 1.0) -> Solution:
        """Run the motion at a scale and return the solution.

        Raises
        ------
        InputError
            If the initial state does not fit the model, or the run exceeds its work limit.
        SolverError
            If the run cannot be solved.
        """
        return self.solve_all([(motion, scale)], motion.dt, shaken=is_shaken(motion)).one(0)

    def solve_all(self, runs: Sequence[tuple[GroundMotion, float]], dt: float, *, shaken: bool) -> Solutions:
        """Run motions with one time step, each at a scale, which are all `shaken` vertically or none of them.

        Only a single run can have a history. Runs that cannot be solved are among the failures.

        Raises
        ------
        InputError
            If the initial state does not fit the model, or its numbers overflow.
        """
        return self.engine.run_all(
            [Excitation(motion.acceleration, motion.vertical if shaken else None, scale) for motion, scale in runs],
            dt,
            free_vibration=self.free_vibration,
            state=None if self.initial is None else self.initial.state(self.model),
            history=self.history,
            work_limit=self.work_limit,
        )

    def run(self, motion: GroundMotion, scale: float = 1.0) -> Response:
        """Run the motion at a scale and return the response; raises the errors of `solve`."""
        return respond(self.model, motion.name, self.solve(motion, scale), floors=self.floors)

    def attempt(self, motion: GroundMotion, scale: float = 1.0) -> Response | InputError | SolverError:
        """Run the motion at a scale and return the response, or the error of `solve`."""
        try:
            return self.run(motion, scale)
        except (InputError, SolverError) as error:
            return error


def prepare_together(cases: Iterable[object]) -> None:
    """Let those of many cases that differ only in numbers share their preparation."""
    gather(case.engine for case in cases if isinstance(case, Case))


def is_shaken(motion: GroundMotion) -> bool:
    """Return whether the ground moves vertically in a motion."""
    return motion.vertical is not None and bool(motion.vertical.any())
