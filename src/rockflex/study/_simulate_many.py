"""The cross product of structures, motions, scales and models, one row a run."""

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from rockflex._errors import InputError, SolverError
from rockflex.modal import RockingProperties
from rockflex.models import LinearModel, Model, parse_model
from rockflex.motion import GroundMotion
from rockflex.parallel import map_threads
from rockflex.response import PEAKS, Response, respond
from rockflex.solve import ExactEngine
from rockflex.study._initial import InitialState
from rockflex.study._simulate import (
    Output,
    Structure,
    check_output,
    free_vibration_time,
    make_engine,
    properties_of,
)

if TYPE_CHECKING:
    import pandas as pd

__all__ = ["simulate_many"]

CHUNK = 64  # runs a task: long enough to hide a task's cost, short enough to share the work evenly
STATUSES = ("no_uplift", "rocking", "overturned")


def simulate_many(
    structures: Structure | RockingProperties | Sequence[Structure | RockingProperties],
    motions: GroundMotion | Sequence[GroundMotion],
    models: str | Model | Sequence[str | Model] = "MDOF-S",
    output: Output = "peaks",
    scales: Sequence[float] = (1.0,),
    free_vibration: float | Literal["settle"] = 0.0,
    initial: InitialState | None = None,
    workers: int | None = None,
) -> "pd.DataFrame":
    """Simulate every structure under every motion with every model at every scale.

    The runs are shared among threads; the kernels hold no interpreter lock. With ``output="peaks"`` nothing but the
    table grows with the number of runs.

    Parameters
    ----------
    structures, motions, models
        One of each, or a sequence; a suite is a sequence of motions.
    output
        ``"peaks"``, or ``"history"`` for a further column `response` with every run's `Response`.
    scales
        Factors on the acceleration.
    free_vibration, initial
        As in `simulate`.
    workers
        Number of threads; None for one a core.

    Returns
    -------
    pandas.DataFrame
        One row a run, structures outermost, then motions, models and scales. Columns: `structure` (index in
        `structures`), `motion` (name), `scale`, `model`, `status`, `error`, then every scalar of `Response` by its
        name, in SI units. A run that cannot be solved leaves its message in `error` and no status.

    Raises
    ------
    InputError
        If a label is unknown, a sequence is empty, or an argument is out of range.
    """
    check_output(output)
    everything = _sequence("structures", structures, (RockingProperties,), "rocking")
    records = _sequence("motions", motions, (GroundMotion,), None)
    chosen = [parse_model(model) for model in _sequence("models", models, (str, Model), None)]
    factors = _factors(scales)
    free = free_vibration_time(free_vibration)
    shape = (len(everything), len(records), len(chosen), len(factors))
    inner = len(chosen) * len(factors)  # runs of one structure under one motion
    each = len(records) * inner
    table = _Table(len(everything) * each, keep=output == "history")

    def tasks() -> Iterator[tuple[int, int, int, list[ExactEngine | str | None]]]:
        for index in range(len(everything)):
            engines: list[ExactEngine | str | None] = [None] * len(chosen)
            for first in range(0, each, CHUNK):
                yield index, first, min(first + CHUNK, each), engines

    def work(task: tuple[int, int, int, list[ExactEngine | str | None]]) -> None:
        index, first, last, engines = task
        for place in range(first, last):
            row = index * each + place
            motion, (which, factor) = records[place // inner], divmod(place % inner, len(factors))
            engine = engines[which]
            if engine is None:
                engine = engines[which] = _engine(everything[index], chosen[which], output)
            if isinstance(engine, str):
                table.errors[row] = engine
                continue
            try:
                state = None if initial is None else initial.state(engine.model)
                solution = engine.run(
                    motion.acceleration * factors[factor],
                    motion.dt,
                    free_vibration=free,
                    state=state,
                    history=output == "history",
                )
            except (SolverError, InputError) as error:
                table.errors[row] = str(error)
                continue
            table.enter(row, respond(engine.model, motion.name, solution))

    for _ in map_threads(work, tasks(), workers):
        pass
    return table.frame(shape, [motion.name for motion in records], factors, [model.label for model in chosen])


class _Table:
    """Columns of fixed length, filled row by row from any thread."""

    def __init__(self, rows: int, *, keep: bool) -> None:
        self.status = np.full(rows, -1, dtype=np.int8)
        self.columns: dict[str, NDArray[Any]] = {}
        for name in PEAKS:
            kind = Response.__annotations__[name]
            if kind in (float, int, bool):
                self.columns[name] = np.full(rows, np.nan) if kind is float else np.zeros(rows, dtype=kind)
        self.errors: dict[int, str] = {}
        self.responses: NDArray[np.object_] | None = np.full(rows, None, dtype=object) if keep else None

    def enter(self, row: int, response: Response) -> None:
        self.status[row] = STATUSES.index(response.status)
        for name, column in self.columns.items():
            column[row] = getattr(response, name)
        if self.responses is not None:
            self.responses[row] = response

    def frame(
        self, shape: tuple[int, ...], motions: list[str], scales: list[float], models: list[str]
    ) -> "pd.DataFrame":
        import pandas as pd

        structure, motion, model, scale = (axis.ravel() for axis in np.indices(shape, dtype=np.int32))
        error = pd.array(np.full(structure.size, None, dtype=object), dtype="string")
        for row, message in self.errors.items():
            error[row] = message
        table = pd.DataFrame(
            {
                "structure": structure,
                "motion": _named(motion, motions),
                "scale": np.asarray(scales)[scale],
                "model": _named(model, models),
                "status": pd.Categorical.from_codes(self.status, dtype=pd.CategoricalDtype(list(STATUSES))),
                "error": error,
                **self.columns,
            }
        )
        if self.responses is not None:
            table["response"] = self.responses
        return table


def _named(codes: NDArray[np.int32], names: list[str]) -> "pd.Categorical[Any]":
    """A categorical column; names that occur twice share a category."""
    import pandas as pd

    categories = list(dict.fromkeys(names))
    places = np.array([categories.index(name) for name in names], dtype=np.int32)
    return pd.Categorical.from_codes(places[codes], dtype=pd.CategoricalDtype(categories))


def _engine(structure: Structure | RockingProperties, model: Model, output: Output) -> ExactEngine | str:
    """An engine, or why there is none."""
    try:
        tied: LinearModel = model.of(properties_of(structure))
        return make_engine(tied, output)
    except InputError as error:
        return str(error)


def _sequence(name: str, given: Any, kinds: tuple[type, ...], marker: str | None) -> list[Any]:
    """One object or a sequence of them, as a list that is not empty."""
    if isinstance(given, kinds) or (marker is not None and hasattr(given, marker)):
        return [given]
    items = list(given)
    if not items:
        message = f"{name} is empty. Give at least one."
        raise InputError(message)
    for place, item in enumerate(items):
        if not isinstance(item, kinds) and not (marker is not None and hasattr(item, marker)):
            message = f"{name}[{place}] is a {type(item).__name__}. Expected {_wanted(name)}."
            raise InputError(message)
    return items


def _wanted(name: str) -> str:
    return {
        "structures": "a Frame, a LumpedStructure or RockingProperties",
        "motions": "a GroundMotion",
        "models": 'a label such as "2DOF-S", or a Model',
    }[name]


def _factors(scales: Sequence[float]) -> list[float]:
    factors = [float(scale) for scale in scales]
    if not factors or not np.all(np.isfinite(factors)):
        message = f"scales must be one or more finite factors, but {list(scales)!r} was given."
        raise InputError(message)
    return factors
