"""Numbers of a structure, its ground and its impact law by their names, and what other numbers would make of them."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import fields, is_dataclass, replace
from typing import Any

import numpy as np

from rockflex.engine.phase_tangent import CENTRAL, ONE_SIDED
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.models._label import Model
from rockflex.models._quantities import Quantities
from rockflex.response._sensitivity import STEP
from rockflex.structure._rocking import RockingProperties
from rockflex.studies._arguments import RockingStructure, rocking_properties_of
from rockflex.studies._prepared_case import PreparedCase, RunOptions

SCALE = "scale"
ROOTS = ("ground", "impact")
_STEP = re.compile(r"([A-Za-z_]\w*+)((?:\[\d++\])*+)")

Place = tuple[str | int, ...]


class Subject:
    """A structure with the ground and the impact law of its runs, of which numbers are changed."""

    def __init__(self, structure: RockingStructure | RockingProperties, options: RunOptions) -> None:
        rocking_properties_of(structure)
        self.structure, self.options = structure, options
        self.roots: dict[str, Any] = {"structure": structure, "ground": options.ground, "impact": options.impact}

    def case(self, model: Model, extra: Mapping[str, Quantities] | None = None) -> PreparedCase:
        """The runs of a model of the structure, of which further quantities may be tracked."""
        return self.options.case(model, rocking_properties_of(self.structure), extra=extra)

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

    def number(self, name: str) -> float:
        """The number of a name; NaN of a list of different numbers."""
        place = self.place_of(name)
        found = np.unique(np.asarray(_value(self.roots[str(place[0])], place[1:]), dtype=float))
        return float(found[0]) if found.size == 1 else np.nan

    def changed(self, place: Place, by: float) -> "Subject":
        """The same with another number: its logarithm is larger by so much."""
        root = str(place[0])
        made = _changed(self.roots[root], place[1:], float(np.exp(by)))
        if root == "structure":
            return Subject(made, self.options)
        return Subject(self.structure, replace(self.options, **{root: made}))

    def neighbours(
        self, model: Model, name: str, extra: Mapping[str, Quantities] | None = None
    ) -> tuple[dict[int, PreparedCase], Mapping[int, float]]:
        """The runs at a few steps of a number, on both sides or, at the end of its range, on one."""
        place, refused = self.place_of(name), None
        backwards = {-step: -weight for step, weight in ONE_SIDED.items()}
        for weights in (CENTRAL, ONE_SIDED, backwards):
            try:
                return {step: self.changed(place, step * STEP).case(model, extra) for step in weights}, weights
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
