"""Rocking and overturning spectra."""

import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Literal, SupportsIndex

import numpy as np

from rockflex.foundation.checks import checked_in_range
from rockflex.foundation.constants import GRAVITY
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value
from rockflex.models._impact import ImpactLaw
from rockflex.models._label import Model, parse_model
from rockflex.motion._ground_motion import GroundMotion
from rockflex.response._response import Response, complete_model_label
from rockflex.structure._rigid_bodies import rigid_block
from rockflex.structure._rocking import RockingProperties
from rockflex.studies._arguments import (
    GroundChoice,
    RockingStructure,
    check_motion_argument,
    check_run_options,
    checked_positive_numbers,
    ground_under_structure,
    rocking_properties_of,
    type_description,
)
from rockflex.studies._prepared_case import RunOptions
from rockflex.studies._simulate import simulate_many
from rockflex.studies.parallel import map_runs_in_order
from rockflex.studies.progress import ProgressChoice, reporting_progress
from rockflex.studies.running import WorkLimit

if TYPE_CHECKING:
    import pandas as pd


def rocking_spectrum(
    motion: GroundMotion,
    slendernesses: Sequence[float],
    periods: Sequence[float],
    model: str | Model = "rigid-C",
    impact: ImpactLaw | None = None,
    free_vibration: float | Literal["settle"] = "settle",
    workers: SupportsIndex | None = None,
    work_limit: WorkLimit = "default",
    ground: GroundChoice = None,
    progress: ProgressChoice = None,
) -> "pd.DataFrame":
    """Largest rotation of homogeneous rigid blocks under one motion, for several slendernesses and sizes.

    This is the rocking spectrum of Makris & Konstantinidis (2003, Earthquake Engng Struct Dyn 32(12), 1879-1901):
    θ_max/α against 2π/p, a curve for each slenderness α = atan(b/h), with p² = 3 g/(4 R). "rigid" is linearised in the
    rotation, so a block is balanced at tan α and not at α; "rigid-C" is not linearised.

    Parameters
    ----------
    motion
        The ground motion.
    slendernesses
        α in rad, each above 0 and below π/2.
    periods
        2π/p in s, positive.
    model
        "rigid-C", or "rigid", which warns where it decides that a block overturns or passes α.
    impact
        None for Housner's coefficient of each block, 1 - 1.5 sin² α; or `Restitution(e)` for all blocks.
    free_vibration
        As in `simulate`. Blocks may overturn after the record.
    workers
        Number of threads; None for one a core.
    work_limit
        Work limit of each run, as in `simulate_many`.
    ground, progress
        As in `simulate_many`.

    Returns
    -------
    pandas.DataFrame
        One row a block, slendernesses outermost: `slenderness` (rad), `period` (s), `half_diagonal` (m), `status`,
        `max_rotation` (rad; π/2 if overturned), `relative_rotation` (θ_max/α), `overturned` and `n_impacts`. A run that
        cannot be solved has a message in `error` and no results.

    Raises
    ------
    InputError
        If a value is out of range, the model has modes, or a block is too squat for Housner's coefficient.

    Examples
    --------
    >>> import rockflex as rf
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> rf.rocking_spectrum(pulse, [0.2],
    ...     [2.0, 4.0])[["period", "status", "relative_rotation"]].round(3)
       period      status  relative_rotation
    0     2.0  overturned              7.854
    1     4.0     rocking              0.273
    """
    alphas, times = (
        checked_positive_numbers("slendernesses", slendernesses, "rad"),
        checked_positive_numbers("periods", periods, "s"),
    )
    chosen = parse_model(model)
    if chosen.n_modes != 0:
        raise InputError(f'Blocks have no modes, but the model {chosen.label} was given. Use "rigid" or "rigid-C".')
    check_run_options(None, impact, ground)
    radii = [0.75 * GRAVITY * (time / (2.0 * math.pi)) ** 2 for time in times]
    blocks = [rigid_block(alpha, radius) for alpha in alphas for radius in radii]
    squattest = blocks[int(np.argmax(alphas)) * len(radii)]
    chosen.of(squattest, impact, ground=ground_under_structure(squattest, ground))  # before any work
    table = simulate_many(
        blocks,
        motion,
        chosen,
        free_vibration=free_vibration,
        impact=impact,
        workers=workers,
        work_limit=work_limit,
        ground=ground,
        progress=progress,
    ).reset_index(drop=True)
    _warn_of_falls(chosen, fell=bool((table["status"] == "overturned").any() or (table["balance_ratio"] > 1.0).any()))
    slenderness, period = np.repeat(alphas, len(times)), np.tile(times, len(alphas))
    import pandas as pd

    return pd.DataFrame(
        {
            "slenderness": slenderness,
            "period": period,
            "half_diagonal": np.tile(radii, len(alphas)),
            "status": table["status"],
            "max_rotation": table["max_rotation"],
            "relative_rotation": table["max_rotation"] / slenderness,
            "overturned": (table["status"] == "overturned").astype("boolean").mask(table["status"].isna()),
            "n_impacts": table["n_impacts"],
            "error": table["error"],
        }
    )


SCAN = tuple(float(scale) for scale in np.arange(1.0, 30.01, 0.1))  # a_p/(g α)


@dataclass(frozen=True, eq=False)
class OverturningScales(Value):
    """The two boundaries of the scales that overturn. Overturning is not monotone: between them, runs may do either.

    Parameters
    ----------
    lowest
        Smallest scale found to overturn; NaN if none does.
    highest_standing
        Largest scale found to stand below one that overturns. NaN if none overturns; infinite if the largest scale of
        the scan stands although a smaller one overturned; `lowest`, within the tolerance, if there is one boundary.
    impacts
        Number of impacts before overturning at `lowest`.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> found = rf.overturning_scales(frame, pulse, (0.5, 20.0), "2DOF-C")
    >>> found.impacts
    0
    """

    lowest: float
    highest_standing: float
    impacts: int


def overturning_scales(
    structure: RockingStructure | RockingProperties,
    motion: GroundMotion,
    scales: Sequence[float],
    model: str | Model = "rigid-C",
    impact: ImpactLaw | None = None,
    tolerance: float = 1e-6,
    work_limit: WorkLimit = "default",
    ground: GroundChoice = None,
) -> OverturningScales:
    """Find the scales at which a motion starts to overturn a structure.

    The given scales are tried one by one. Bisection then narrows the boundary below the first that overturns, and the
    boundary above the last that stands. **An island of scales narrower than the step of the scan can be missed**, also
    below `lowest`: refine the scan where it matters. Scales above the largest are not considered. A run ends when it
    has overturned or can no longer overturn.

    Parameters
    ----------
    structure, impact, ground
        As in `simulate`; a rigid block from `rigid_block`, for instance.
    model
        As in `simulate`. By default large rotations are those of a complete model, since they decide the fall; one for
        small rotations, such as "rigid", warns.
    motion
        The ground motion at the scale 1.
    scales
        Scales to try: at least two, positive and rising.
    tolerance
        Relative width of the boundaries, from 1e-12 to below 0.1.
    work_limit
        Work limit of each run, as in `simulate`.

    Raises
    ------
    InputError
        If the scales do not rise, a value is out of range, or the model has a base that cannot lift.
    SolverError
        If a run cannot be solved.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> found = rf.overturning_scales(frame, pulse, (0.5, 20.0))
    >>> round(found.lowest, 3), found.impacts
    (2.281, 1)
    """
    tried = _checked_search_scales("scales", scales)
    width = checked_in_range("tolerance", tolerance, 1e-12, 0.1)
    check_motion_argument(motion)
    run = _run_of_spectrum(structure, model, impact, work_limit, ground)
    found = _search_overturning_scales(run, motion, tried, width)
    _warn_of_falls(parse_model(model), fell=not math.isnan(found.lowest))
    return found


def overturning_spectrum(
    structure: RockingStructure | RockingProperties,
    pulse: Callable[[float, float], GroundMotion],
    frequency_ratios: Sequence[float],
    model: str | Model = "rigid-C",
    impact: ImpactLaw | None = None,
    relative_amplitudes: Sequence[float] | None = None,
    tolerance: float = 1e-6,
    workers: SupportsIndex | None = None,
    work_limit: WorkLimit = "default",
    ground: GroundChoice = None,
    progress: ProgressChoice = None,
) -> "pd.DataFrame":
    """Smallest amplitude at which a pulse overturns a structure, as a function of the frequency of the pulse.

    With p² = L_0^r g/I_θ and α = m_tot B/L_0^r, the spectrum of a rigid block in ω_g/p and a_p/(g α) is the same for
    all sizes and slendernesses with the same impact (Zhang & Makris 2001, J. Struct. Eng. 127(5), 501-511), with the
    model "rigid" and for slender blocks.

    Parameters
    ----------
    structure, impact, ground
        As in `simulate`.
    model
        As in `overturning_scales`.
    pulse
        Function that returns a pulse for an amplitude in m/s² and a period 2π/ω_g in s, such as `one_sine_pulse`; for
        half a sine ``lambda amplitude, period: half_sine_pulse(amplitude, period / 2)``. It chooses the time step:
        about a thousandth of the period.
    frequency_ratios
        ω_g/p, positive.
    relative_amplitudes
        a_p/(g α) to try, rising; by default 1, 1.1, 1.2, ... 30. See `overturning_scales` for what the scan can miss.
    tolerance
        Relative width of the boundaries.
    workers
        Number of threads; None for one a core.
    work_limit
        Work limit of each run, as in `simulate`.
    progress
        As in `run_cloud`, counted in frequencies.

    Returns
    -------
    pandas.DataFrame
        One row a frequency: `frequency_ratio`, `period` (s), `lowest` (a_p/(g α), NaN if nothing overturns),
        `amplitude` (the same in m/s²), `highest_standing` (a_p/(g α)) and `impacts` before the fall at `lowest`.

    Raises
    ------
    InputError
        If a value is out of range, or `pulse` does not return a ground motion.
    SolverError
        If a run cannot be solved.

    Examples
    --------
    >>> import rockflex as rf
    >>> block = rf.rigid_block(slenderness=0.2, half_diagonal=2.0)
    >>> table = rf.overturning_spectrum(block, rf.one_sine_pulse, [3.0],
    ...     relative_amplitudes=(1.0, 10.0))
    >>> table[["frequency_ratio", "lowest"]].round(3)
       frequency_ratio  lowest
    0              3.0   1.382
    """
    ratios = checked_positive_numbers("frequency_ratios", frequency_ratios, "")
    tried = _checked_search_scales("relative_amplitudes", SCAN if relative_amplitudes is None else relative_amplitudes)
    width = checked_in_range("tolerance", tolerance, 1e-12, 0.1)
    properties = rocking_properties_of(structure)
    rate = math.sqrt(properties.l0r * GRAVITY / properties.i_theta)
    unit = properties.resisting_moment / properties.l0r  # g α
    run = _run_of_spectrum(properties, model, impact, work_limit, ground)
    periods = [2.0 * math.pi / (ratio * rate) for ratio in ratios]
    if not callable(pulse):
        raise InputError(
            f"pulse must be a function of an amplitude and a period, but {type_description(pulse)} was given."
        )
    pulses = [pulse(unit, period) for period in periods]
    for made in pulses:
        if not isinstance(made, GroundMotion):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InputError(
                f"pulse must make a GroundMotion of an amplitude and a period, but it made {type_description(made)}. "
                "Give one_sine_pulse, for instance."
            )
    with reporting_progress(progress, len(pulses), "frequencies") as advance:
        rows = map_runs_in_order(
            lambda made: _search_overturning_scales(run, made, tried, width), pulses, workers, lambda _: advance(1)
        )
    import pandas as pd

    _warn_of_falls(parse_model(model), fell=any(not math.isnan(row.lowest) for row in rows))
    table = pd.DataFrame(rows).assign(frequency_ratio=ratios, period=periods)
    table["amplitude"] = table["lowest"] * unit
    return table[["frequency_ratio", "period", "lowest", "amplitude", "highest_standing", "impacts"]]


def _warn_of_falls(model: Model, *, fell: bool) -> None:
    if fell and not model.complete:
        warnings.warn(
            f"{model.label} is for small rotations, but decides here what overturns: boundaries are off by several per "
            f"cent. Give a complete model, such as {complete_model_label(model.label)}.",
            stacklevel=3,
        )


Run = Callable[[GroundMotion, float], Response]


def _run_of_spectrum(
    structure: RockingStructure | RockingProperties,
    model: str | Model,
    impact: ImpactLaw | None,
    work_limit: WorkLimit,
    ground: GroundChoice,
) -> Run:
    options = RunOptions.of("settle", impact=impact, ground=ground, work_limit=work_limit)
    properties, choice = rocking_properties_of(structure), parse_model(model)
    if not choice.lifts:
        raise InputError(
            f"{choice.label} has a base that cannot lift, so nothing overturns it. Give a model that rocks."
        )
    return options.case(choice, properties).run


def _search_overturning_scales(run: Run, motion: GroundMotion, scales: list[float], width: float) -> OverturningScales:
    runs = [run(motion, scale) for scale in scales]
    falls = [response.status == "overturned" for response in runs]
    if not any(falls):
        return OverturningScales(math.nan, math.nan, 0)
    first = falls.index(True)
    _, lowest, impacts = _bisect_overturning_scale(
        run, motion, scales[first - 1] if first else 0.0, scales[first], width
    )
    standing = [place for place, fell in enumerate(falls) if not fell]
    if standing and standing[-1] == len(scales) - 1:
        return OverturningScales(lowest, math.inf, impacts)
    last = standing[-1] if standing else -1
    if last <= first - 1:
        return OverturningScales(lowest, lowest, impacts)
    return OverturningScales(
        lowest, _bisect_overturning_scale(run, motion, scales[last], scales[last + 1], width)[0], impacts
    )


def _bisect_overturning_scale(
    run: Run, motion: GroundMotion, stands: float, falls: float, width: float
) -> tuple[float, float, int]:
    """Return the scales on both sides of a boundary, one that stands and one that overturns, and its impacts."""
    impacts = run(motion, falls).n_impacts
    while falls - stands > width * falls:
        middle = 0.5 * (stands + falls)
        response = run(motion, middle)
        if response.status == "overturned":
            falls, impacts = middle, response.n_impacts
        else:
            stands = middle
    return stands, falls, impacts


def _checked_search_scales(name: str, scales: Sequence[float]) -> list[float]:
    numbers = checked_positive_numbers(name, scales, "")
    if len(numbers) < 2 or any(b <= a for a, b in pairwise(numbers)):
        raise InputError(
            f"{name} must rise, two at least, but {shown(scales)} was given. They are the grid that is searched."
        )
    return numbers
