"""Derivatives of a run with respect to its record's scale and to parameters of structure, ground and impact law."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, is_dataclass, replace
from typing import TYPE_CHECKING, Any, Unpack

import numpy as np

from rockflex.engine.phase_tangent import CENTRAL, ONE_SIDED
from rockflex.engine.solution import Excitation
from rockflex.foundation.arrays import Array
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.foundation.values import Value
from rockflex.models._label import Model, parse_model
from rockflex.models._tangents import Neighbours, tangents_of_run
from rockflex.motion._ground_motion import GroundMotion
from rockflex.response._respond import response_of_solution
from rockflex.response._response import Response
from rockflex.response._sensitivity import STEP, Neighbourhood, TiedModel, numbers_with_derivatives
from rockflex.structure._rocking import RockingProperties
from rockflex.studies._arguments import (
    InitialState,
    RockingStructure,
    check_keywords,
    check_motion_argument,
    rocking_properties_of,
)
from rockflex.studies._prepared_case import PreparedCase, RunKeywords, RunOptions, has_vertical_motion

if TYPE_CHECKING:
    import pandas as pd

SCALE = "scale"
ROOTS = ("ground", "impact")
_STEP = re.compile(r"([A-Za-z_]\w*+)((?:\[\d++\])*+)")

Place = tuple[str | int, ...]


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
        adds to the peak, for small changes.
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
        columns |= {
            name: self.elasticity(name)
            for name in self.logarithmic
            if np.isfinite(values := self.logarithmic[name]).all() and getattr(self.response, name) and values.any()
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
        ``"ground.friction"`` and ``"impact.restitution"``. Default: all of `parameter_names`.
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
    subject = _Subject(structure, settings)
    names = parameter_names(structure, **options) if parameters is None else tuple(dict.fromkeys(parameters))
    names = tuple(name for name in names if name != SCALE)
    places = [subject.place_of(name) for name in names]
    case = subject.case(chosen)
    nearby = [subject.neighbours(chosen, place, name) for name, place in zip(names, places, strict=True)]
    shakes = has_vertical_motion(motion)
    made = tangents_of_run(
        case.engine,
        Excitation(motion.acceleration, motion.vertical if shakes else None),
        motion.dt,
        free_vibration=case.free_vibration,
        start=case.start,
        work_limit=case.work_limit,
        parameters=[
            Neighbours(
                {step: each.engine for step, each in cases.items()},
                {step: each.start for step, each in cases.items()},
                {step: weight / STEP for step, weight in weights.items()},
            )
            for cases, weights in nearby
        ],
    )
    nearby_tied = [Neighbourhood({k: _tied(each) for k, each in cases.items()}, weights) for cases, weights in nearby]
    numbers = numbers_with_derivatives(_tied(case), nearby_tied, made)
    values = [1.0, *(float(found) if np.ndim(found := subject.value(place)) == 0 else np.nan for place in places)]
    return Gradient(
        response=response_of_solution(case.model, motion.name, replace(made.solution, states=None), case.tracked),
        parameters=(SCALE, *names),
        values=np.array(values),
        logarithmic={name: slope for name, (_, slope) in numbers.items()},
        slowest=made.slowest,
    )


def _tied(case: PreparedCase) -> TiedModel:
    return TiedModel(case.model, case.engine, case.tracked)


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
    return _Subject(structure, RunOptions.of(**given)).names()


class _Subject:
    """A structure with the ground and the impact law of its runs, of which numbers are changed."""

    def __init__(self, structure: RockingStructure | RockingProperties, options: RunOptions) -> None:
        rocking_properties_of(structure)
        self.structure, self.options = structure, options
        self.roots: dict[str, Any] = {"structure": structure, "ground": options.ground, "impact": options.impact}

    def case(self, model: Model) -> PreparedCase:
        """The runs of a model of the structure."""
        return self.options.case(model, rocking_properties_of(self.structure))

    def names(self) -> tuple[str, ...]:
        """The names of all numbers."""
        found = dict[str, None]()
        for root, subject in self.roots.items():
            prefix = "" if root == "structure" else f"{root}."
            for name in _number_names(subject):
                found.setdefault(prefix + name.removeprefix("structure."))
        kept = list[str]()
        for name in found:
            try:
                self.place_of(name)
                self.changed(self.place_of(name), STEP)
            except InputError:
                continue
            kept.append(name)
        return tuple(kept)

    def place_of(self, name: str) -> Place:
        """The place of a number, by its name."""
        root, _, rest = name.partition(".")
        place: Place = _place(name) if root not in ROOTS or not rest else (root, *_place(rest))
        if place[0] not in ROOTS:
            while True:
                try:
                    _value(self.structure, place)
                    break
                except LookupError:
                    inner = ("structure",) * (1 + sum(step == "structure" for step in place))
                    place = (*inner, *(step for step in place if step != "structure"))
                    try:
                        _value(self.structure, inner)
                    except LookupError:
                        raise self._unknown(name) from None
            place = ("structure", *place)
        try:
            value = np.asarray(_value(self.roots[str(place[0])], place[1:]), dtype=float)
        except (LookupError, TypeError, ValueError):
            raise self._unknown(name) from None
        if not (np.isfinite(value).all() and value.any()):
            raise InputError(
                f"{name} is {shown(value.tolist())}, but a derivative is found from relative changes: it must be "
                "finite and not zero. Give it a small value.",
                field="parameters",
            )
        return place

    def _unknown(self, name: str) -> InputError:
        known = [each for root in self.roots for each in _number_names(self.roots[root])]
        return InputError(
            f"There is no number {shown(name)} in the structure, its ground or its impact law. Expected a name as of "
            f"the arguments, such as {', '.join(known[:6])}.",
            field="parameters",
        )

    def value(self, place: Place) -> Any:
        """The number at a place."""
        return _value(self.roots[str(place[0])], place[1:])

    def changed(self, place: Place, by: float) -> "_Subject":
        """The same with another number: its logarithm is larger by so much."""
        root = str(place[0])
        made = _changed(self.roots[root], place[1:], float(np.exp(by)))
        if root == "structure":
            return _Subject(made, self.options)
        return _Subject(self.structure, replace(self.options, **{root: made}))

    def neighbours(self, model: Model, place: Place, name: str) -> tuple[dict[int, PreparedCase], Mapping[int, float]]:
        """The runs at a few steps of a number, on both sides or, at the end of its range, on one."""
        refused: InputError | None = None
        backwards = {-step: -weight for step, weight in ONE_SIDED.items()}
        for weights in (CENTRAL, ONE_SIDED, backwards):
            try:
                return {step: self.changed(place, step * STEP).case(model) for step in weights}, weights
            except InputError as error:
                refused = error
        raise InputError(f"{name} cannot be changed by {STEP:g} of its value: {refused}", field="parameters")


def _place(name: str) -> Place:
    """The steps of a name such as elements[0].stiffness."""
    found = list[str | int]()
    for part in name.split("."):
        step = _STEP.fullmatch(part)
        if step is None:
            raise InputError(
                f"{shown(name)} is not the name of a number. Expected one such as period or elements[0].stiffness.",
                field="parameters",
            )
        found.append(step[1])
        found += [int(place) for place in re.findall(r"\d++", step[2])]
    return tuple(found)


def _value(subject: Any, place: Place) -> Any:
    """What is at a place; raises a LookupError if there is nothing."""
    for step in place:
        if isinstance(step, int):
            subject = subject[step]
        elif is_dataclass(subject) and step in {each.name for each in fields(subject)}:
            subject = getattr(subject, step)
        else:
            raise LookupError(step)
    return subject


def _changed(subject: Any, place: Place, factor: float) -> Any:
    """The same with the number at a place multiplied."""
    if not place:
        return np.asarray(subject) * factor if np.ndim(subject) else subject * factor
    step, rest = place[0], place[1:]
    if isinstance(step, str):
        return replace(subject, **{step: _changed(getattr(subject, step), rest, factor)})
    if isinstance(subject, np.ndarray):
        made = subject.copy()
        made[step] *= factor
        return made
    return (*subject[:step], _changed(subject[step], rest, factor), *subject[step + 1 :])


def _number_names(subject: Any) -> Iterator[str]:
    """The names of the numbers of a value made of dataclasses, tuples and arrays, that are not whole."""
    if not is_dataclass(subject) or isinstance(subject, type):
        return
    for each in fields(subject):
        value = getattr(subject, each.name)
        if isinstance(value, float) or (isinstance(value, np.ndarray) and value.dtype == float):
            yield each.name
        elif isinstance(value, tuple):
            for place, item in enumerate(value):  # pyright: ignore[reportUnknownVariableType, reportUnknownArgumentType]
                yield from (f"{each.name}[{place}].{name}" for name in _number_names(item))
        else:
            yield from (f"{each.name}.{name}" for name in _number_names(value))
