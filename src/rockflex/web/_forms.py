"""The forms of structures, from the tables that structure files are read with."""

import re
import types
import typing
from typing import Any, Literal, get_args, get_origin

from pydantic.fields import FieldInfo

from rockflex.structure.file import KINDS, StructureEntry, Table, TendonTable, beside
from rockflex.study.assumed import BoucWenTable
from rockflex.web._limits import INFINITE, RANGES
from rockflex.web._packing import plain
from rockflex.web._presets import PRESETS

TITLES = {
    "frame": "Frame of equal stories",
    "fish_bone": "Frame of unequal stories",
    "wall_frame": "Wall and frame",
    "tapered_tower": "Tapered tower",
    "cantilever": "Cantilever with a mass at its tip",
    "beam": "Beam, perhaps tapered",
    "lumped": "Lumped masses",
    "matrices": "Mass and stiffness matrices",
    "modes": "Modes of a finite element model",
    "properties": "Rocking parameters",
    "block": "Rigid block",
}
SYMBOLS = {
    "n_stories": "Stories",
    "n_modes": "Modes",
    "n_elements": "Elements",
    "aspect_ratio": "Slenderness h*₁/B",
    "i_theta": "I_θ",
    "l0r": "L₀ʳ",
    "m_tot": "Total mass",
    "zeta": "Damping ratio",
    "eccentricity": "Eccentricity e of the base",
    "omega": "ω",
    "post_yield_ratio": "Post-yield stiffness ratio α",
    "gamma": "γ",
    "beta": "β",
    "exponent": "Exponent n",
    "z": "Heights z",
}


def forms() -> dict[str, Any]:
    """Return the fields of every kind of structure, of its base, of a tendon and a hysteresis, and the presets."""
    return plain(
        {
            "kinds": {name: {"title": TITLES.get(name, name), "fields": _fields(KINDS[name])} for name in KINDS},
            "eccentricity": _field("eccentricity", StructureEntry.model_fields["eccentricity"]),
            "tendon": _fields(TendonTable),
            "bouc_wen": _fields(BoucWenTable),
            "presets": PRESETS,
        }
    )


def _fields(table: type[Table]) -> list[dict[str, Any]]:
    return [_field(name, field) for name, field in table.model_fields.items()]


def _field(name: str, field: FieldInfo) -> dict[str, Any]:
    low, high = RANGES.get(name, (None, None))
    default = None if field.is_required() else field.get_default(call_default_factory=True)
    return {
        "name": name,
        "label": SYMBOLS.get(name, name.replace("_", " ").capitalize()),
        "unit": beside(field, "unit"),
        "help": _sentence(field.description or ""),
        "type": _type(field.annotation),
        "choices": _choices(field.annotation),
        "required": field.is_required(),
        "default": None if hasattr(default, "model_fields") else default,
        "low": low,
        "high": high,
        "infinite": name in INFINITE,
        "fields": _fields(inner) if (inner := _table(field.annotation)) is not None else None,
    }


def _sentence(description: str) -> str:
    begins = description[:1].upper() if re.match("a |[a-z]{2}", description) else description[:1]  # not γ, n or h*_1
    return f"{begins}{description[1:]}."


def _parts(annotation: Any) -> list[Any]:
    """The kinds of value that a field takes."""
    origin = get_origin(annotation)
    if origin is typing.Annotated:
        return _parts(get_args(annotation)[0])
    if origin in (typing.Union, types.UnionType):
        return [part for each in get_args(annotation) for part in _parts(each)]
    return [annotation]


def _type(annotation: Any) -> str:
    """How a field is filled in: the simplest form that takes all of its kinds."""
    parts = _parts(annotation)
    if any(get_origin(part) is Literal for part in parts):
        return "choice"
    if bool in parts:
        return "flag"
    lists = [part for part in parts if get_origin(part) is list]
    if any(get_origin(get_args(part)[0]) is list for part in lists):
        return "matrix"
    if any(get_args(part) == (int,) for part in lists):
        return "indices"
    if lists:
        return "number or list" if float in parts else "list"
    if int in parts and float not in parts:
        return "whole"
    return "number" if float in parts else "table"


def _table(annotation: Any) -> type[Table] | None:
    """The table that a field holds, if it holds one."""
    tables = (part for part in _parts(annotation) if isinstance(part, type) and not get_args(part))
    return next((part for part in tables if issubclass(part, Table)), None)


def _choices(annotation: Any) -> list[str]:
    return [str(value) for part in _parts(annotation) if get_origin(part) is Literal for value in get_args(part)]
