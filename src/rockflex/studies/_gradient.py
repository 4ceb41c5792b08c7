"""Derivatives of a run with respect to its record's scale and to parameters of structure, ground and impact law."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

from rockflex.engine.phase_tangent import CENTRAL, KINK
from rockflex.engine.solution import Excitation
from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value
from rockflex.models._label import Model, parse_model
from rockflex.models._quantities import Quantities
from rockflex.models._tangents import NeighbouringModels, RunTangents, tangents_of_run
from rockflex.motion._ground_motion import GroundMotion
from rockflex.response._respond import response_of_solution
from rockflex.response._response import Response
from rockflex.response._sensitivity import STEP, Neighbourhood, numbers_with_derivatives
from rockflex.structure._rocking import RockingProperties
from rockflex.studies._arguments import InitialState, RockingStructure, check_keywords, check_motion_argument
from rockflex.studies._parameters import SCALE, Subject
from rockflex.studies._prepared_case import PreparedCase, RunKeywords, RunOptions, has_vertical_motion

if TYPE_CHECKING:
    import pandas as pd


class GradientKeywords(RunKeywords, total=False):
    """The options of a run by name; `simulate` has their meaning."""

    initial: InitialState | None


@dataclass(frozen=True, eq=False, kw_only=True)
class Gradient(Value):
    """A run and the derivatives of its peaks with respect to parameters.

    Attributes
    ----------
    response : Response
        The run, with peaks only.
    parameters : tuple of str
        Names of the P parameters, the first of which is ``"scale"``, the factor on the record.
    values : ndarray, shape (P,)
        Their values; NaN of a list of numbers, which is one parameter that multiplies all of them.
    logarithmic : dict
        ∂ (peak)/∂ ln (parameter) by the name of the peak, each of shape (P,): what a relative change of a parameter
        adds to the peak, for small changes. NaN where a parameter is at a kink or within 0.6 % of one, as the height
        of a tie that is held at a floor: above and below it the displacement between floors is another one.
    slowest : float
        The slowest crossing at an event, its condition over the condition's scale, in 1/s. Where it is near zero a
        small change makes the event appear or vanish, and no derivative tells that.

    Examples
    --------
    >>> import rockflex as rf
    >>> block = rf.rigid_block(slenderness=0.2, half_diagonal=3.0)
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=1.0)
    >>> found = rf.gradient(block, pulse, "rigid", [], free_vibration=1.0)
    >>> found
    Gradient(rigid under 'One sine 3 m/s², T=1 s', 1 parameters)
    >>> found.elasticity("max_rotation").round(2)
    array([4.25])
    """

    response: Response
    parameters: tuple[str, ...]
    values: Array
    logarithmic: Mapping[str, Array]
    slowest: float

    def __getitem__(self, name: str) -> Array:
        """Return ∂ (peak)/∂ (parameter) of a peak, such as ``"max_rotation"``, in SI units, shape (P,)."""
        return self._of(name) / self.values

    def elasticity(self, name: str) -> Array:
        """Return ∂ ln (peak)/∂ ln (parameter) of a peak, shape (P,): by how many per cent 1 % changes it."""
        values, peak = self._of(name), float(getattr(self.response, name))
        return values / peak if peak else np.full(len(values), np.nan)

    def _of(self, name: str) -> Array:
        if name not in self.logarithmic:
            raise InputError(
                f"There is no derivative of {shown(name)}; there are {', '.join(self.logarithmic)}.", field="name"
            )
        return self.logarithmic[name]

    def to_frame(self) -> "pd.DataFrame":
        """Return a table with a row a parameter, its value, and the elasticity of every peak that is not zero."""
        import pandas as pd

        columns = {"value": self.values}
        known = ~np.all([np.isnan(values) for values in self.logarithmic.values()], axis=0)
        columns |= {
            name: self.elasticity(name)
            for name in self.logarithmic
            if np.isfinite(values := self.logarithmic[name][known]).all()
            and getattr(self.response, name)
            and values.any()
        }
        return pd.DataFrame(columns, index=pd.Index(self.parameters, name="parameter"))

    def __repr__(self) -> str:
        return f"Gradient({self.response.model} under {self.response.motion!r}, {len(self.parameters)} parameters)"


def gradient(
    structure: RockingStructure | RockingProperties,
    motion: GroundMotion,
    model: str | Model = "MDOF-S",
    parameters: Sequence[str] | None = None,
    **options: Unpack[GradientKeywords],
) -> Gradient:
    """Simulate a run, and find the derivatives of its peaks with respect to the record's scale and to parameters.

    They are those of the model itself, not differences of runs: tangents of the motion follow the run through its
    phases, and jump at uplifts, impacts, and wherever an element changes its branch. All parameters are followed at
    once. They tell what small changes do, as long as no event appears or vanishes.

    Parameters
    ----------
    structure, motion, model
        As in `simulate`; the model must be linear between events, as the simplified ones are.
    parameters
        Names of numbers of the structure, as its arguments are called: ``"period"``, ``"damping_ratio"``,
        ``"elements[0].stiffness"``, ``"floor_mass[2]"``; a list of numbers without a place, ``"floor_mass"``, is
        multiplied as a whole. Those of the ground and of the impact law begin with ``"ground."`` and ``"impact."``, as
        ``"ground.friction"``, ``"impact.e"`` of `Restitution` and ``"impact.restitution"`` of `AngularMomentum`.
        Default: all of `parameter_names`.
    options
        `free_vibration`, `impact`, `ground`, `initial` and `work_limit` by name, as in `simulate`.

    Returns
    -------
    Gradient
        The run, and the derivatives of its peaks.

    Raises
    ------
    InputError
        If there is no such number, or it is zero; if the model is not linear between events; as for `simulate`.
    SolverError
        If the run cannot be solved.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> pulse = rf.one_sine_pulse(amplitude=3.0, period=0.8)
    >>> found = rf.gradient(frame, pulse, parameters=["period", "damping_ratio"])
    >>> found.parameters
    ('scale', 'period', 'damping_ratio')
    >>> found.elasticity("max_rotation").round(2)
    array([-1.81, -1.4 ,  0.01])
    """
    check_keywords(options, GradientKeywords)
    check_motion_argument(motion)
    given: dict[str, Any] = {**options}
    chosen = parse_model(model)
    settings = replace(RunOptions.of(**given), all_yield=True)
    subject = Subject(structure, settings)
    names = subject.names() if parameters is None else tuple(dict.fromkeys(parameters))
    names = tuple(name for name in names if name != SCALE)
    for name in names:
        subject.place_of(name)
    case, nearby, made = follow(subject, chosen, names, motion)
    numbers = numbers_with_derivatives(case.tied, nearby, made)
    return Gradient(
        response=response_of_solution(case.model, motion.name, replace(made.solution, states=None), case.tracked),
        parameters=(SCALE, *names),
        values=np.array([1.0, *(subject.number(name) for name in names)]),
        logarithmic={name: slope for name, (_, slope) in numbers.items()},
        slowest=made.slowest,
    )


def follow(
    subject: Subject,
    model: Model,
    names: Sequence[str],
    motion: GroundMotion,
    extra: Mapping[str, Quantities] | None = None,
) -> tuple[PreparedCase, list[Neighbourhood], RunTangents]:
    """Run a motion, and follow its derivatives by the scale and by the numbers of some names.

    Of `extra`, further quantities by name, the values over time are followed as well.

    Returns
    -------
    case
        What was run.
    neighbourhoods
        Of each name, for `numbers_with_derivatives`.
    tangents
        The run and its derivatives.
    """
    case = subject.case(model, extra)
    nearby = [subject.neighbours(model, name, extra) for name in names]
    shakes = has_vertical_motion(motion)
    places = [case.tracked.peaks.places[name] for name in extra or ()]
    observed = [row for place in places if isinstance(place, slice) for row in range(place.start, place.stop)]
    made = tangents_of_run(
        case.engine,
        Excitation(motion.acceleration, motion.vertical if shakes else None),
        motion.dt,
        free_vibration=case.free_vibration,
        start=case.start,
        work_limit=case.work_limit,
        parameters=[
            NeighbouringModels(
                {step: each.engine for step, each in cases.items()},
                {step: each.start for step, each in cases.items()},
                {step: weight / STEP for step, weight in weights.items()},
                {step: weight / STEP for step, weight in KINK.items()} if weights is CENTRAL else {},
            )
            for cases, weights in nearby
        ],
        observed=observed,
    )
    tied = [Neighbourhood({k: each.tied for k, each in cases.items()}, weights) for cases, weights in nearby]
    return case, tied, made


def parameter_names(
    structure: RockingStructure | RockingProperties, **options: Unpack[GradientKeywords]
) -> tuple[str, ...]:
    """Return the names of the numbers of a structure, its ground and its impact law that `gradient` knows.

    Numbers that are zero or infinite are left out, as are counts.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.Frame(2, 3.0, 40e3, 40e3, 1.0, period=0.5, aspect_ratio=8.0,
    ...     damping_ratio=0.02)
    >>> rf.parameter_names(frame)
    ('story_height', 'story_mass', 'base_mass', 'stiffness_ratio', 'period', 'aspect_ratio', 'damping_ratio')
    """
    given: dict[str, Any] = {**options}
    return Subject(structure, RunOptions.of(**given)).names()
