"""A table of a TOML file, and what is said of one that is wrong."""

import reprlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from types import GenericAlias
from typing import Any, TypeVar, get_args, get_origin

from pydantic import BaseModel, ConfigDict, JsonValue, ValidationError
from pydantic.fields import FieldInfo

from rockflex._errors import InputError

AnyTable = TypeVar("AnyTable", bound="Table")


class Table(BaseModel):
    """A table of a file: known keys only, and no silent conversion.

    The description of each key completes the sentence "it must be ...", in the form that it may have beside it.
    """

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=True)


def written(form: str, unit: str = "") -> dict[str, JsonValue]:
    """Return what a key has beside its description: how it is written, the description in place of {}, and its unit."""
    return {"form": form, "unit": unit}


def number(unit: str) -> dict[str, JsonValue]:
    """Return what a number with a unit has beside its description."""
    return written(f"{{}}, a number in {unit}", unit)


def each(what: str, unit: str = "") -> dict[str, JsonValue]:
    """Return what a number, or one for each of many, has beside its description."""
    return written(f"{{}}, a number or one for each {what}", unit)


NUMBER, WHOLE = written("{}, a number"), written("{}, a whole number")


def beside(field: FieldInfo, key: str) -> str:
    """Return the form or the unit of a field; empty where it has none."""
    extra = field.json_schema_extra
    return str(extra.get(key, "")) if isinstance(extra, dict) else ""


def expected(field: FieldInfo) -> str:
    """Say what a field must be, and how it is written."""
    return (beside(field, "form") or "{}").format(field.description or "")


def checked(model: type[AnyTable], content: Mapping[str, Any], place: str = "") -> AnyTable:
    """Return what was read as a table; `place` names the file in messages.

    Raises
    ------
    InputError
        If a key is unknown or missing, or a value is of the wrong kind; every one of them is told.
    """
    try:
        return model.model_validate(content)
    except ValidationError as error:
        message = " ".join(problems(error, content, model))
        raise InputError(f"{place}: {message}" if place else message) from error


def problems(error: ValidationError, content: Mapping[str, Any], model: type[Table]) -> list[str]:
    """Say of each key at fault what is expected, in a sentence each; the branches of a union count once."""
    sentences: dict[tuple[str, str], str] = {}
    for problem in error.errors():
        spot = _spot(problem["loc"], content, model)
        label = " ".join(filter(None, (spot.header, spot.key)))
        known = spot.model.model_fields
        if problem["type"] == "extra_forbidden":
            near = get_close_matches(spot.key, known, n=1)
            hint = f" Did you mean {near[0]}?" if near else ""
            said = f"{label} is not known; there are {', '.join(known)}.{hint}"
        elif problem["type"] == "value_error":  # raised by a check of the whole table
            said = ": ".join(filter(None, (label, str(problem["ctx"]["error"]) if "ctx" in problem else "")))
        elif problem["type"] == "missing":
            said = f"{label} is missing: {expected(known[spot.key])}."
        elif spot.key:
            said = f"{label} must be {expected(known[spot.key])}, but {reprlib.repr(spot.value)} was given."
        else:
            said = f"{spot.header or 'It'} must be a table, but {reprlib.repr(spot.value)} was given."
        sentences[spot.header, spot.key] = said
    return list(sentences.values())


@dataclass(frozen=True)
class _Spot:
    """Where in a file a problem lies; `key` is empty where it is the table itself."""

    header: str
    key: str
    value: Any
    model: type[Table]


def _spot(location: Sequence[str | int], content: Any, model: type[Table]) -> _Spot:
    """Follow the location of a problem down to the last key that the file has a name for."""
    spot, names = _Spot("", "", content, model), list[str]()
    numbers: list[str] = []
    rest = list(location)
    while rest:
        key = str(rest.pop(0))
        value = spot.value.get(key) if isinstance(spot.value, Mapping) else None
        field = spot.model.model_fields.get(key)
        inner, many = (None, False) if field is None else _inner(field.annotation)
        if inner is None or not (rest or isinstance(value, Mapping)):
            return _Spot(spot.header, key, value, spot.model)
        names.append(key)
        header = f"[{'.'.join(names)}]"
        if many:
            if not rest:
                return _Spot(spot.header, key, value, spot.model)
            place = int(rest.pop(0))
            numbers.append(f"[{header}] no. {place + 1},")
            value = value[place] if isinstance(value, Sequence) else None
        spot = _Spot(" ".join(numbers if many else [*numbers, header]), "", value, inner)
    return _Spot(spot.header.removesuffix(","), "", spot.value, spot.model)


def _inner(annotation: Any) -> tuple[type[Table] | None, bool]:
    """Return the kind of table that a field holds, if any, and whether it holds a list of them."""
    if isinstance(annotation, type) and not isinstance(annotation, GenericAlias):
        return (annotation, False) if issubclass(annotation, Table) else (None, False)
    for part in get_args(annotation):
        found, many = _inner(part)
        if found is not None:
            return found, many or get_origin(annotation) in (list, tuple)
    return None, False
