"""The table of an object, as a project has it, as the entry of a structure that files and forms have."""

import math
from collections.abc import Mapping
from typing import Any

from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.structure._podium import Podium
from rockflex.structure._structure import Restrained
from rockflex.structure.file._element_tables import ELEMENTS
from rockflex.structure.file._object_tables import CLASS, arguments_in_table
from rockflex.structure.file._structure_entry import KINDS
from rockflex.structure.file._structure_tables import PROFILES
from rockflex.structure.file._wrappers import WRAPPERS

_OF_CLASS = {kind.__name__: told for kind, told in WRAPPERS.values()}
_AROUND = (Restrained.__name__, *_OF_CLASS)


def entry_of_object_table(table: Any, place: str) -> dict[str, Any]:
    """Return the content of a `StructureEntry` for the table of an object; nothing is built, and no value is checked.

    Cross-sections and devices are numbers then, and floors of `RockingProperties` are left out. `place` names the table
    in messages.

    Raises
    ------
    InputError
        If no kind of structure or element makes the class.
    """
    try:
        return _entry_of_object_table(table)
    except (ArithmeticError, AttributeError, KeyError, TypeError, ValueError) as error:
        raise InputError(
            f"{place}: no kind of structure in a file is {shown(table)}. Read it with read_structure or read_project."
        ) from error


def _entry_of_object_table(table: dict[str, Any]) -> dict[str, Any]:
    name: str = table[CLASS]
    inner = _entry_of_object_table(table["structure"]) if name in _AROUND and "structure" in table else {}
    rest: dict[str, Any] = arguments_in_table({key: each for key, each in table.items() if key != "structure"})
    rest.pop("elements", None)
    held = [{"kind": _kind_made(ELEMENTS, each), **arguments_in_table(each)} for each in table.get("elements", [])]
    if elements := [*inner.pop("elements", []), *held]:
        inner["elements"] = elements
    if name == Podium.__name__ and "structure" not in table:
        inner["rocking_frame"] = _frame_of_podium(rest)
    elif told := _OF_CLASS.get(name):
        inner[told.key] = told.content(rest)
    elif name != Restrained.__name__:
        if eccentricity := rest.pop("eccentricity", 0.0):
            inner["eccentricity"] = eccentricity
        if (side := rest.pop("opens", "both")) != "both":
            inner["one_sided"] = {"restitution": rest.pop("restitution", 0.0), "side": side}
        if name == "RockingProperties" and _is_block(rest):
            inner["block"] = {"width": 2.0 * rest["half_width"], "height": 2.0 * rest["l0r"] / rest["m_tot"]}
            inner["block"]["mass"] = rest["m_tot"]
            return inner
        if "bending_stiffness" in rest:
            rest.pop("section", None)  # which gave stiffness and mass
        for key in PROFILES if name == "Beam" else ():
            if isinstance(rest.get(key), list):  # of heights and of values there
                z, rest[key] = rest[key]
                if rest.setdefault("z", z) != z:
                    raise ValueError("a beam whose quantities vary at other heights each")
        left = ("floors", "joints", "columns", *([] if rest.get("stories") else ["stories"]))
        inner[_kind_made(KINDS, table)] = {key: each for key, each in rest.items() if key not in left}
    return inner


def _frame_of_podium(given: dict[str, Any]) -> dict[str, Any]:
    """Return the table of a podium without a building."""
    kept = {key: given[key] for key in ("n_columns", "column_width", "column_height", "column_mass")}
    return kept | {"cap_mass": given.get("slab_mass", 0.0)}


def _kind_made(tables: Mapping[str, Any], table: dict[str, Any]) -> str:
    return {getattr(each.makes, "__name__", ""): kind for kind, each in tables.items()}[table[CLASS]]


def _is_block(given: dict[str, Any]) -> bool:
    """Tell whether properties are those of a homogeneous block that lands as one."""
    squares = given["half_width"] ** 2 + (given["l0r"] / given["m_tot"]) ** 2
    alike = math.isclose(given["i_theta"], 4.0 / 3.0 * given["m_tot"] * squares, rel_tol=1e-9)
    return not given["omega"] and alike and given.get("restitution") is None
