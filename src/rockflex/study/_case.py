"""One run, written once: a model tied to a structure and what is asked of its runs, under a motion at a scale."""

from dataclasses import dataclass, field

from rockflex._errors import InputError
from rockflex.models import Quantities, RockingModel
from rockflex.motion import GroundMotion
from rockflex.response import Response, asked_of, respond
from rockflex.solve import Engine, Solution, Task, preparing
from rockflex.study._arguments import WORK_LIMIT
from rockflex.study._initial import InitialState


@dataclass(frozen=True, eq=False)
class Case:
    """A model tied to a structure, and what is asked of its runs; its engine is made once, for any number of runs.

    Attributes
    ----------
    model
        The model, tied to its structure.
    free_vibration
        In s; None until settled.
    initial
        The state at t = 0; at rest if None.
    work_limit
        Most work of a run in s; None for no limit.
    history
        Whether the states are kept.
    floors
        Whether the peaks of the floors are tracked.
    extra
        Quantities whose peaks are tracked beside the usual ones.
    engine
        The model made ready for records.

    Raises
    ------
    InputError
        If a run is to settle and no one can tell when a hysteretic spring has, or the model's numbers overflow.
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
            asked = asked_of(self.model, floors=self.floors)
            engine = Engine(self.model, asked if self.extra is None else asked + self.extra)
        object.__setattr__(self, "engine", engine)

    def task(self, motion: GroundMotion, scale: float = 1.0) -> Task:
        """Return what a run is asked, to estimate its work by."""
        return self.engine.task(motion.acceleration * scale, motion.dt, self.free_vibration, history=self.history)

    def solve(self, motion: GroundMotion, scale: float = 1.0) -> Solution:
        """Run the motion at a scale.

        Raises
        ------
        InputError
            If the initial state is none of the model's, or the run is more work than it may be.
        SolverError
            If it cannot be solved.
        """
        return self.engine.run(
            motion.acceleration * scale,
            motion.dt,
            free_vibration=self.free_vibration,
            state=None if self.initial is None else self.initial.state(self.model),
            history=self.history,
            work_limit=self.work_limit,
        )

    def run(self, motion: GroundMotion, scale: float = 1.0) -> Response:
        """Run the motion at a scale, and name what was found; it raises what `solve` does."""
        return respond(self.model, motion.name, self.solve(motion, scale), floors=self.floors)
