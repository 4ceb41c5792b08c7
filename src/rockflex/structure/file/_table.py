"""A table of a TOML file, and the messages about one that is wrong."""

import reprlib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from types import GenericAlias, UnionType
from typing import Annotated, Any, TypeVar, Union, get_args, get_origin

from pydantic import BaseModel, ConfigDict, ValidationError
from pydantic.fields import FieldInfo

from rockflex._errors import InputError
from rockflex._schema import PLAIN, Key

AnyTable = TypeVar("AnyTable", bound="Table")


class Table(BaseModel):
    """A table of a file: known keys only, and no silent conversion.

    Each field has a `Key` in its annotation, or a description that completes the sentence "it must be ...".
    """

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=True)


def key_of(field: FieldInfo) -> Key:
    """Return the key of a field; one without it has its description alone."""
    return next((part for part in field.metadata if isinstance(part, Key)), Key(field.description or "", form=PLAIN))


def expected(field: FieldInfo) -> str:
    """Say what a field must be, and how it is written."""
    return key_of(field).expected


def parts(annotation: Any) -> list[Any]:
    """Return the kinds of value that an annotation accepts: the members of a union, or itself."""
    if get_origin(annotation) is Annotated:
        return parts(get_args(annotation)[0])
    if get_origin(annotation) in (Union, UnionType):
        return [part for member in get_args(annotation) for part in parts(member)]
    return [annotation]


def inner_table(annotation: Any) -> type["Table"] | None:
    """Return the kind of table that a field holds, one or a list of them; None if it holds another value."""
    for part in parts(annotation):
        kind = get_args(part)[0] if get_origin(part) is list else part
        if isinstance(kind, type) and not isinstance(kind, GenericAlias) and issubclass(kind, Table):
            return kind
    return None


def checked(model: type[AnyTable], content: Mapping[str, Any], place: str = "") -> AnyTable:
    """Return what was read as a table; `place` names the file in messages.

    Raises
    ------
    InputError
        If a key is unknown or missing, or a value is of the wrong kind; the message lists all of them.
    """
    try:
        return model.model_validate(content)
    except ValidationError as error:
        message = " ".join(problems(error, content, model))
        raise InputError(f"{place}: {message}" if place else message) from error


def problems(error: ValidationError, content: Mapping[str, Any], model: type[Table]) -> list[str]:
    """Return one sentence for each key at fault, with what is expected; the branches of a union count once."""
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
    """The place of a problem in a file; `key` is empty where it is the table itself."""

    header: str
    key: str
    value: Any
    model: type[Table]


def _spot(location: Sequence[str | int], content: Any, model: type[Table]) -> _Spot:
    """Follow the location of a problem down to the last key that has a name in the file."""
    spot, names = _Spot("", "", content, model), list[str]()
    numbers: list[str] = []
    rest = list(location)
    while rest:
        key = str(rest.pop(0))
        value = spot.value.get(key) if isinstance(spot.value, Mapping) else None
        field = spot.model.model_fields.get(key)
        inner = None if field is None else inner_table(field.annotation)
        many = field is not None and any(get_origin(part) is list for part in parts(field.annotation))
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
