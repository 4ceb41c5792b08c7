"""One structure, one motion, one model."""

import math
from typing import Literal, Protocol, get_args

from rockflex._errors import InputError
from rockflex.modal import RockingProperties
from rockflex.models import LinearModel, Model, parse_model
from rockflex.motion import GroundMotion
from rockflex.response import Response, floor_observables, global_observables, respond
from rockflex.solve import ExactEngine
from rockflex.study._initial import InitialState

__all__ = [
    "Output",
    "Structure",
    "check_output",
    "free_vibration_time",
    "make_engine",
    "properties_of",
    "simulate",
]

Output = Literal["history", "peaks"]


class Structure(Protocol):
    """Anything that knows its rocking properties, such as a `Frame` or a `LumpedStructure`."""

    def rocking(self, n_modes: int | None = None) -> RockingProperties:
        """Properties of the first `n_modes` modes, or of all."""
        ...


def simulate(
    structure: Structure | RockingProperties,
    motion: GroundMotion,
    model: str | Model = "MDOF-S",
    output: Output = "history",
    free_vibration: float | Literal["settle"] = 0.0,
    initial: InitialState | None = None,
) -> Response:
    """Simulate one structure under one ground motion, exactly.

    The simplified models (Silva & Stojadinović 2024, Eqs. 15, 23-25 and 30-32) are carried in closed form; every
    uplift, impact and peak is found to machine precision, those between samples included.

    Parameters
    ----------
    structure
        A structure, or its `RockingProperties`.
    motion
        The ground motion; linear between samples, zero after the last one.
    model
        ``"2DOF-S"``, ``"3DOF-S"``, ... ``"MDOF-S"`` (all modes), ``"fixed"`` or ``"5DOF-fixed"``, or a `Model`.
    output
        ``"history"`` keeps the state at every sample and event, ``"peaks"`` only the peaks.
    free_vibration
        Seconds of free vibration after the record (rounded up to whole samples), or ``"settle"``: until overturned,
        or until the base can never lift again nor any peak grow.
    initial
        The state at t = 0; at rest if None.

    Returns
    -------
    Response
        Peaks, times, counts and, with ``output="history"``, the history.

    Raises
    ------
    InputError
        If the model's label is unknown, or a value is out of range.
    SolverError
        If the run cannot be solved; the message names the time and the state.
    """
    check_output(output)
    tied = parse_model(model).of(properties_of(structure))
    if not isinstance(motion, GroundMotion):  # pyright: ignore[reportUnnecessaryIsInstance]
        message = f"motion must be a GroundMotion, but {type(motion).__name__} was given. Read or build one first."
        raise InputError(message)
    engine = make_engine(tied, output)
    solution = engine.run(
        motion.acceleration,
        motion.dt,
        free_vibration=free_vibration_time(free_vibration),
        state=None if initial is None else initial.state(tied),
        history=output == "history",
    )
    return respond(tied, motion.name, solution)


def make_engine(model: LinearModel, output: Output) -> ExactEngine:
    """Engine that tracks the global peaks and, for histories, those of the floors."""
    rows = global_observables(model)
    if output == "history" and model.properties.floors is not None:
        rows = rows + floor_observables(model, model.properties.floors)
    return ExactEngine(model, rows.contact, rows.rocking)


def properties_of(structure: Structure | RockingProperties) -> RockingProperties:
    """The properties of a structure, or those given.

    Raises
    ------
    InputError
        If the object is neither.
    """
    if isinstance(structure, RockingProperties):
        return structure
    if not hasattr(structure, "rocking"):
        message = (
            f"structure must be a Frame, a LumpedStructure or RockingProperties, but {type(structure).__name__} "
            "was given."
        )
        raise InputError(message)
    return structure.rocking()


def free_vibration_time(value: float | Literal["settle"]) -> float | None:
    """Seconds of free vibration; None until settled.

    Raises
    ------
    InputError
        If the value is negative, not finite, or another word.
    """
    if value == "settle":
        return None
    if isinstance(value, str) or not (value >= 0.0 and math.isfinite(value)):  # pyright: ignore[reportUnnecessaryIsInstance]
        message = f'free_vibration must be zero or more seconds, or "settle", but {value!r} was given.'
        raise InputError(message)
    return float(value)


def check_output(output: str) -> None:
    """Raise an InputError unless `output` is known."""
    if output not in get_args(Output):
        message = f'output must be "history" or "peaks", but {output!r} was given.'
        raise InputError(message)
