"""A table of a TOML file, and the messages about one that is wrong."""

import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from functools import cache
from inspect import Parameter, signature, unwrap
from types import GenericAlias, UnionType
from typing import Annotated, Any, ClassVar, SupportsIndex, TypeVar, Union, get_args, get_origin, get_type_hints

from pydantic import BaseModel, ConfigDict, ValidationError, create_model
from pydantic.fields import FieldInfo

from rockflex.foundation.descriptions import FLAG, NUMBER, PLAIN, WHOLE, Described, described_arguments
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown

AnyTable = TypeVar("AnyTable", bound="TomlTable")


class TomlTable(BaseModel):
    """A table of a file: known keys only, and no silent conversion.

    Each field has a `Described` in its annotation, or a description that completes the sentence "it must be ...".
    """

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, allow_inf_nan=True)
    gone: ClassVar[Mapping[str, str]] = {}  # keys of earlier versions, and what to write in their place


_FORMS = {
    float: NUMBER,
    int: WHOLE,
    bool: FLAG,
    str: "{}, a text in quotes",
    list[float]: "{}, a list of numbers{unit}",
}


def table_of(
    made: Callable[..., Any], base: type[AnyTable], module: str, kinds: Mapping[str, Any] | None = None, **more: Any
) -> type[AnyTable]:
    """Return the table of a class or function: its arguments are the keys, with what is known of them.

    `module` is the name of the calling module, where pickle finds it; `kinds` are the types of arguments that are
    tables in a file, and `more` are further fields, as of `pydantic.create_model`.
    """
    keys: dict[str, Any] = {}
    parameters = dict(signature(made).parameters)
    returned = get_type_hints(unwrap(made)).get("return")
    hints = get_type_hints(made if isinstance(made, type) else unwrap(made))
    for name, known in described_arguments(made).items():
        if known.in_file is False:
            continue
        if name in parameters:
            hint, default = hints[name], parameters[name].default
        else:  # of **place: as the element that is returned has it
            hint, default = get_type_hints(returned)[name], signature(returned).parameters[name].default  # pyright: ignore
        kind = (kinds or {}).get(name) or known.in_file or _type_in_file(hint)
        form = known.form or _FORMS.get(members_of_annotation(kind)[0], PLAIN)
        keys[name] = Annotated[kind, replace(known, form=form)], ... if default is Parameter.empty else default
    found: Any = create_model(f"{made.__name__}Table", __base__=base, __module__=module, **more, **keys)
    setattr(sys.modules[module], found.__name__, found)
    found.makes, found.title = made, getattr(made, "title", "") or made.__name__
    found.tuples = tuple(name for name in keys if get_origin(hints.get(name)) is tuple)
    return found


def _type_in_file(hint: Any) -> Any:
    """Return the type of a value in a file: lists for tuples, and whole numbers for what is one."""
    if get_origin(hint) in (Union, UnionType):
        return Union[tuple(map(_type_in_file, get_args(hint)))]  # noqa: UP007
    if get_origin(hint) is tuple:
        return list[get_args(hint)[0]]
    return int if hint is SupportsIndex else hint


def schema_key_of_field(field: FieldInfo) -> Described:
    """Return the key of a field; one without it has its description alone."""
    return next(
        (part for part in field.metadata if isinstance(part, Described)), Described(field.description or "", form=PLAIN)
    )


def valid_value_description(field: FieldInfo) -> str:
    """Return the description of a valid value, and how it is written."""
    return schema_key_of_field(field).expected


def members_of_annotation(annotation: Any) -> list[Any]:
    """Return the kinds of value that an annotation accepts: the members of a union, or itself."""
    if get_origin(annotation) is Annotated:
        return members_of_annotation(get_args(annotation)[0])
    if get_origin(annotation) in (Union, UnionType):
        return [part for member in get_args(annotation) for part in members_of_annotation(member)]
    return [annotation]


def tables_in_annotation(annotation: Any) -> list[type["TomlTable"]]:
    """Return the kinds of table that a field holds, one or a list of them; none if it holds other values."""
    inner = [get_args(part)[0] if get_origin(part) is list else part for part in members_of_annotation(annotation)]
    return [
        kind
        for part in inner
        for kind in members_of_annotation(part)
        if isinstance(kind, type) and not isinstance(kind, GenericAlias) and issubclass(kind, TomlTable)
    ]


def first_table_in_annotation(annotation: Any) -> type["TomlTable"] | None:
    """Return the kind of table that a field holds, the first of several; None if it holds another value."""
    return next(iter(tables_in_annotation(annotation)), None)


@cache
def tables_of_fields(table: type[TomlTable]) -> Mapping[str, type[TomlTable] | None]:
    """Return the `first_table_in_annotation` of every field of a table by its name."""
    return {name: first_table_in_annotation(field.annotation) for name, field in table.model_fields.items()}


def parse_toml_table(model: type[AnyTable], content: Mapping[str, Any], place: str = "") -> AnyTable:
    """Return the content of a file as a table; `place` names the file in messages.

    Raises
    ------
    InputError
        If a key is unknown or missing, or a value is of the wrong kind; the message lists all of them.
    """
    try:
        return model.model_validate(content)
    except ValidationError as error:
        message = " ".join(toml_problem_sentences(error, content, model))
        raise InputError(f"{place}: {message}" if place else message) from error


def toml_problem_sentences(error: ValidationError, content: Mapping[str, Any], model: type[TomlTable]) -> list[str]:
    """Return a sentence for each wrong key, with a description of valid values; the branches of a union count once.

    All unknown keys of a table are in one sentence.
    """
    sentences: dict[tuple[str | int, ...], str] = {}
    unknown: dict[tuple[str | int, ...], list[str]] = {}
    for problem in error.errors():
        spot = toml_problem_place(problem["loc"], content, model)
        key = str(spot.path[-1]) if spot.path and not spot.of_table else ""
        label = toml_key_label(spot.path) if key else _toml_table_heading(spot.path).removesuffix(",")
        known = spot.table.model_fields
        if problem["type"] == "extra_forbidden":
            table = spot.path[:-1]
            others = unknown.setdefault(table, [])
            others += [key] * (key not in others)
            sentences[(*table, "")] = _unknown_key_sentence(table, others, spot.table)
            continue
        if problem["type"] == "value_error":  # raised by a check of the whole table
            said = str(problem["ctx"]["error"]) if "ctx" in problem else ""
            if not said.startswith(label):  # which the check may have named
                said = ": ".join(filter(None, (label, said)))
        elif problem["type"] in ("missing", "union_tag_not_found"):
            said = f"{label} is missing: {valid_value_description(known[key])}."
        elif key:
            said = f"{label} must be {valid_value_description(known[key])}, but {shown(spot.value)} was given."
        else:
            said = f"{label or 'It'} must be a table, but {shown(spot.value)} was given."
        sentences[spot.path] = said
    return list(sentences.values())


def _unknown_key_sentence(table: tuple[str | int, ...], keys: list[str], model: type[TomlTable]) -> str:
    known = list(model.model_fields)
    label = " ".join(filter(None, (_toml_table_heading(table), ", ".join(keys))))
    near = {key: found[0] for key in keys if (found := get_close_matches(key, known, n=1))}
    meant = [each if len(keys) == 1 else f"{each} for {key}" for key, each in near.items()]
    hint = "".join(f" {model.gone[key]}" for key in keys if key in model.gone)
    hint = hint or (f" Did you mean {', '.join(meant)}?" if meant else "")
    return f"{label} {'is' if len(keys) == 1 else 'are'} not known; there are {', '.join(known)}.{hint}"


@dataclass(frozen=True)
class TomlProblemPlace:
    """The place of a problem: the keys, and the numbers of tables in lists, down to the last that a file names.

    Attributes
    ----------
    path
        Keys and numbers from 0.
    table
        The kind of table that has the last key.
    field
        The field of the last key; None if it is not known.
    value
        The content at this place.
    """

    path: tuple[str | int, ...]
    table: type[TomlTable]
    field: FieldInfo | None
    value: Any

    @property
    def of_table(self) -> bool:
        """Whether it is a table rather than one of its keys."""
        if not self.path or isinstance(self.path[-1], int):
            return True
        if self.field is None or not isinstance(self.value, Mapping):
            return False
        return first_table_in_annotation(self.field.annotation) in members_of_annotation(self.field.annotation)


def toml_problem_place(location: Sequence[str | int], content: Any, model: type[TomlTable]) -> TomlProblemPlace:
    """Follow the location of a problem, without the parts that unions and lists of values add.

    Of a table whose `kind` is missing or unknown, it is that key.
    """
    spot, inner, tags = TomlProblemPlace((), model, None, content), model, dict[str, type[TomlTable]]()
    for key in location:
        if inner is None:
            break
        if key in tags and isinstance(spot.path[-1], int):  # the kind of the table, which is no key
            spot, inner, tags = replace(spot, table=tags[key]), tags[key], {}
            continue
        path, value = (*spot.path, key), spot.value
        if isinstance(key, int):
            spot = TomlProblemPlace(path, inner, spot.field, value[key] if isinstance(value, list) else None)
            tags = {} if spot.field is None else _tables_by_kind(spot.field)
            continue
        field = inner.model_fields.get(key)
        spot = TomlProblemPlace(path, inner, field, value.get(key) if isinstance(value, Mapping) else None)
        inner = None if field is None else first_table_in_annotation(field.annotation)
    if tags and isinstance(spot.value, Mapping):
        kind = spot.table.model_fields["kind"]
        return TomlProblemPlace((*spot.path, "kind"), spot.table, kind, spot.value.get("kind"))
    return spot


def _tables_by_kind(field: FieldInfo) -> dict[str, type[TomlTable]]:
    """Return the tables of a field by their kinds; none if it has one kind of table at most."""
    tables = tables_in_annotation(field.annotation)
    if len(tables) < 2:
        return {}
    return {word: table for table in tables for word in get_args(table.model_fields["kind"].annotation)}


def toml_key_label(path: Sequence[str | int]) -> str:
    """Return the words for a key of a file: the heading of its table, and its name; places in its list do not count."""
    while isinstance(path[-1], int):
        path = path[:-1]
    return " ".join(filter(None, (_toml_table_heading(path[:-1]), path[-1])))


def _toml_table_heading(path: Sequence[str | int]) -> str:
    """The heading of a table in a file; in a list, with its number."""
    names, words = list[str](), list[str]()
    for part in path:
        if isinstance(part, int):
            words.append(f"[[{'.'.join(names)}]] no. {part + 1},")
        else:
            names.append(part)
    return " ".join([*words, f"[{'.'.join(names)}]"] if path and isinstance(path[-1], str) else words)
