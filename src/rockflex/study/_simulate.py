"""One structure, one motion, one model."""

from dataclasses import replace
from typing import Literal

from rockflex.modal import RockingProperties
from rockflex.models import BoucWen, ImpactLaw, Model, parse_model
from rockflex.motion import GroundMotion
from rockflex.response import Response
from rockflex.study._arguments import (
    WORK_LIMIT,
    GroundChoice,
    Output,
    RockingStructure,
    check_motion,
    ground_under,
    properties_of,
    wants_history,
)
from rockflex.study._initial import InitialState
from rockflex.study._prepared import run_prepared
from rockflex.study._run_options import RunOptions


def simulate(
    structure: RockingStructure | RockingProperties,
    motion: GroundMotion,
    model: str | Model = "MDOF-S",
    output: Output = "history",
    free_vibration: float | Literal["settle"] = 0.0,
    bouc_wen: BoucWen | None = None,
    impact: ImpactLaw | None = None,
    initial: InitialState | None = None,
    work_limit: float | None = WORK_LIMIT,
    ground: GroundChoice = None,
) -> Response:
    """Simulate one structure under one ground motion.

    The simplified models (Silva & Stojadinović 2024, Eqs. 15, 23-25 and 30-32) are advanced in closed form; every
    uplift, impact and peak is found to machine precision, also between samples. The complete models (Eqs. 13-16 and
    26-29) are advanced in closed form while in contact, and integrated to about ten digits while they rock; yielding
    models (Eqs. 37-38) are always integrated.

    Parameters
    ----------
    structure
        A structure, or its `RockingProperties`.
    motion
        The ground motion; linear between samples, and zero in the free vibration after the last one.
    model
        ``"2DOF-S"``, ``"3DOF-S"``, ... ``"MDOF-S"`` (all modes): simplified. ``"2DOF-C"``, ``"MDOF-C"``: complete;
        with some of several modes ``"3DOF-C-SI"`` (impact by Eq. 25) or ``"3DOF-C-E"`` (scaled to meet Eq. 19).
        ``"rigid"``, ``"rigid-C"``: the same structure without flexure, and with Housner's impact. ``"fixed"``,
        ``"5DOF-fixed"``: on a base that cannot lift. Or a `Model`.
    output
        ``"history"`` stores the state at every sample and event, ``"peaks"`` only the peaks.
    free_vibration
        Seconds of free vibration after the record (rounded up to whole samples), or ``"settle"``: until overturned,
        or until the base cannot lift again and no peak can grow. With zero the run ends at the last sample, where the
        last acceleration of the record still acts. In free vibration the ground is at rest: if the record ends with an
        acceleration that is not zero, it jumps to zero there, and the history has both sides of the jump.
    bouc_wen
        Hysteresis of the superstructure of a model with one mode, "2DOF-S" or "1DOF-fixed" for instance.
    impact
        An impact law other than the model's own: `VVELSimplified`, `VVELComplete`, `Restitution`, or any object that
        is an `ImpactLaw`.
    initial
        The state at t = 0; at rest if None.
    work_limit
        Limit of the work of the run, in s of computing on one core; None for no limit. A run is refused if its
        estimate exceeds the limit, and stopped when it reaches the limit. Work is counted, not timed, so the limit is
        the same on every machine. A typical run takes milliseconds.
    ground
        Springs under the base, friction between base and ground, or both; for simplified models with an elastic
        superstructure. Or a function that returns a `Ground` for the `RockingProperties` of a structure. Default: rigid
        ground on which the base cannot slide.

    Returns
    -------
    Response
        Peaks, times, counts and, with ``output="history"``, the history.

    Raises
    ------
    InputError
        If the model's label is unknown, a value is out of range, an argument is of the wrong kind, or the motion is a
        vertical component; if the run is more work than `work_limit`, or its history more than memory holds.
    SolverError
        If the run cannot be solved, or has done the work of `work_limit`; the message names the time and the state.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0, damping_ratio=0.02)
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> response = rf.simulate(frame, pulse, "2DOF-S")
    >>> response.status, round(response.max_rotation, 4)
    ('rocking', 0.0198)
    """
    history = wants_history(output)
    options = RunOptions.of(
        free_vibration, impact=impact, bouc_wen=bouc_wen, ground=ground, initial=initial, work_limit=work_limit
    )
    properties = properties_of(structure)
    choice, below = parse_model(model), ground_under(properties, ground)
    check_motion(motion)
    return run_prepared(choice, properties, replace(options, ground=below, all_yield=True), motion, history=history)
