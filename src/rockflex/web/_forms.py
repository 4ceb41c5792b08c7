"""The forms of structures, generated from the tables of structure files, and example structures."""

import math
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, Literal, get_args, get_origin

from pydantic.fields import FieldInfo

from rockflex.foundation.json import as_json_value
from rockflex.models._impact import LAWS
from rockflex.structure._attachment import PLACE
from rockflex.structure._outline import SYMBOLS
from rockflex.structure.file._element_tables import ELEMENTS
from rockflex.structure.file._section_tables import PartTable
from rockflex.structure.file._structure_entry import KINDS, StructureEntry
from rockflex.structure.file._toml_table import (
    TomlTable,
    first_table_in_annotation,
    members_of_annotation,
    schema_key_of_field,
)
from rockflex.structure.file._wrappers import WRAPPERS
from rockflex.studies._case_keys import BoucWenTable
from rockflex.studies._ground_tables import GroundTable


def _preset_frame(number: int, period: float, aspect_ratio: float, stiffness_ratio: float) -> dict[str, Any]:
    kind = "shear" if stiffness_ratio else "flexure"
    return {
        "title": f"Frame #{number}: {kind}, {period:g} s, h*/B = {aspect_ratio:g}",
        "structure": {
            "name": f"Structure #{number} of Table 1",
            "frame": {
                "n_stories": 5,
                "story_height": 3.0,
                "story_mass": 40e3,
                "base_mass": 40e3,
                "stiffness_ratio": stiffness_ratio,
                "period": period,
                "aspect_ratio": aspect_ratio,
                "damping_ratio": 0.02,
            },
        },
    }


PRESETS: list[dict[str, Any]] = [
    _preset_frame(1, 1.0, 10.0, math.inf),
    _preset_frame(2, 1.0, 10.0, 0.0),
    _preset_frame(3, 0.5, 10.0, math.inf),
    _preset_frame(4, 0.5, 10.0, 0.0),
    _preset_frame(5, 1.0, 5.0, math.inf),
    _preset_frame(6, 1.0, 5.0, 0.0),
    *tomllib.loads((Path(__file__).parent / "presets.toml").read_text("utf-8"))["presets"],
]
"""Title and structure of each preset: Table 1 of Silva & Stojadinović 2024, its chimney, and others."""


MATERIALS: list[dict[str, Any]] = [
    {"title": "concrete", "elastic_modulus": 3e10, "density": 2500.0},
    {"title": "steel", "elastic_modulus": 2.1e11, "density": 7850.0},
    {"title": "timber", "elastic_modulus": 1.1e10, "density": 450.0},
    {"title": "masonry", "elastic_modulus": 5e9, "density": 1900.0},
]
"""Materials of sections to choose from: modulus in N/m² and density in kg/m³."""


def material_name(given: Mapping[str, Any]) -> str:
    """Return the name of the material that a table of these values has; empty if it is none of `MATERIALS`."""
    values = ("elastic_modulus", "density")
    return next((each["title"] for each in MATERIALS if all(given.get(name) == each[name] for name in values)), "")


OF_WHOLE = sorted(WRAPPERS, key=lambda key: WRAPPERS[key][1].floors)
"""Fields of every kind of structure, and then of those with floors."""
FIRST: dict[str, Any] = {
    "structure": next(each["structure"] for each in PRESETS if "24 m" in each["title"]),
    "scale": 2.0,
}
"""The structure of the first screen: a pier that rocks."""


def forms_of_structures() -> dict[str, Any]:
    """Return the fields of every structure, element and base, the impact laws, a hysteresis, and the presets."""
    return as_json_value(
        {
            "kinds": {name: {"title": table.title, "fields": _form_fields(table)} for name, table in KINDS.items()},
            "whole": [
                _form_field(name, StructureEntry.model_fields[name]) | {"floors": WRAPPERS[name][1].floors}
                for name in OF_WHOLE
            ],
            "elements": {
                name: {"title": table.title, "fields": _form_fields(table)} for name, table in ELEMENTS.items()
            },
            "symbols": SYMBOLS,
            "laws": [{"name": name, **each._asdict()} for name, law in LAWS.items() for each in law.choices],
            "bouc_wen": _form_fields(BoucWenTable),
            "ground": _form_fields(GroundTable),
            "section_part": _form_fields(PartTable),
            "materials": MATERIALS,
            "presets": PRESETS,
        }
    )


def _form_fields(table: type[TomlTable]) -> list[dict[str, Any]]:
    left_out = ("kind", "parts")  # chosen in a list; of a composite section
    names = sorted(table.model_fields, key=lambda name: name in PLACE[1:])  # where else an element may act, at the end
    return [_form_field(name, table.model_fields[name]) for name in names if name not in left_out]


def _form_field(name: str, field: FieldInfo) -> dict[str, Any]:
    key, inner = schema_key_of_field(field), first_table_in_annotation(field.annotation)
    default = None if field.is_required() else field.get_default(call_default_factory=True)
    return {
        "name": name,
        "label": key.label or name.replace("_", " ").capitalize(),
        "unit": key.unit,
        "help": _form_field_sentence(key.page or key.description, key.unit),
        "type": _form_field_type(field.annotation),
        "choices": _form_field_choices(field.annotation),
        "required": field.is_required(),
        "default": None if hasattr(default, "model_fields") else default,
        "low": key.low,
        "high": key.high,
        "fields": None if inner is None else _form_fields(inner),
    }


def _form_field_sentence(description: str, unit: str) -> str:
    if unit:  # beside the field, which may be in another one
        description = re.sub(rf",? in {re.escape(unit)}(?!\w)", "", description)
    begins = description[:1].upper() if re.match("a |[a-z]{2}", description) else description[:1]  # not γ, n or h*_1
    return f"{begins}{description[1:]}."


def _form_field_type(annotation: Any) -> str:
    """The simplest form that accepts every kind of value of a field."""
    kinds = members_of_annotation(annotation)
    if any(get_origin(kind) is Literal for kind in kinds) and float not in kinds:  # a number, or what else files have
        return "choice"
    if bool in kinds:
        return "flag"
    lists = [kind for kind in kinds if get_origin(kind) is list]
    if any(get_origin(get_args(part)[0]) is list for part in lists):
        return "matrix"
    if any(get_args(part) == (int,) for part in lists):
        return "indices"
    if lists:
        mapped = any(get_origin(kind) is dict for kind in kinds)
        return "number or list" if float in kinds else "list or map" if mapped else "list"
    if int in kinds and float not in kinds:
        return "whole"
    return "number" if float in kinds else "table"


def _form_field_choices(annotation: Any) -> list[str]:
    words = [
        str(value)
        for part in members_of_annotation(annotation)
        if get_origin(part) is Literal
        for value in get_args(part)
    ]
    return [word for word in words if word != "composite"]  # a section of several parts, which only files have
