"""Links with values that cannot be used: what opens all the same."""

import json
from copy import deepcopy
from typing import Any, cast

from rockflex.structure.file._element_tables import ELEMENTS
from rockflex.structure.file._structure_entry import KINDS
from rockflex.structure.file._wrappers import WRAPPERS
from rockflex.web._refusal import Refusal
from rockflex.web._state import MAX_MESSAGES, PageState, parse_page_state

WHOLE = ("structure", "alternatives")  # taken out as such
TABLES = ("ground", "bouc_wen")  # that go as a whole where they cannot do without a value
_Removed = list[tuple[list[str], Any]]  # paths and values


def usable_page_state(content: dict[str, Any], structure: dict[str, Any]) -> dict[str, Any] | None:
    """Return the state of a link that is refused; None if nothing of it can be shown.

    Numbers that cannot be used stay in their fields, where their messages appear; choices that do not exist, and what
    no field shows, have their default. Alternatives that are refused are left out. `structure` stands in for one that
    cannot be drawn.
    """
    rest, removed, own = deepcopy(content), _Removed(), content.get("structure")
    for _ in range(MAX_MESSAGES):
        try:
            state = parse_page_state(rest)
        except Refusal as error:
            places = {path.split(".")[0] if path.startswith(WHOLE) else path for path in error.errors}
            if not all(_take_out(rest, path.split("."), removed, structure) for path in sorted(places)):
                return None
            continue
        break
    else:
        return None
    usual: Any = parse_page_state({"structure": structure}).model_dump(exclude_none=True)
    opened = state.model_dump(exclude_none=True)
    for path, value in reversed(removed):
        _put_back(opened, path, value, usual)
    opened |= {"structure": own} if _can_be_drawn(own) else {}
    try:
        json.dumps(opened, ensure_ascii=False).encode()
    except UnicodeEncodeError:  # half a character
        return None
    return opened


def _take_out(content: dict[str, Any], path: list[str], removed: _Removed, structure: dict[str, Any]) -> bool:
    """Take what is at a path, or around it, out of a state; tell whether there was something."""
    if path[0] not in PageState.model_fields:
        return content.pop(path[0], None) is not None
    if path[0] == "structure":
        before, content["structure"] = content.get("structure"), structure
        return before is not structure
    if path[0] == "alternatives":
        return _take_out_alternatives(content)
    table: Any = content
    for place, name in enumerate(path):
        inner = table.get(name)
        if place == len(path) - 1 or not isinstance(inner, dict) or path[place + 1] not in inner:
            if name not in table:
                return False
            removed.append((path[: place + 1], table.pop(name)))
            return True
        table = inner
    return False


def _take_out_alternatives(content: dict[str, Any]) -> bool:
    """Leave out the alternatives that are refused by themselves; all, where each of them can be used."""
    given = content.pop("alternatives", None)
    if not isinstance(given, list):
        return given is not None
    kept = list[Any]()
    for each in cast("list[Any]", given):
        try:
            parse_page_state({"structure": each["structure"], "alternatives": [each]})
        except (Refusal, KeyError, TypeError):
            continue
        kept.append(each)
    if len(kept) < len(given):
        content["alternatives"] = kept
    return True


def _put_back(opened: dict[str, Any], path: list[str], value: Any, usual: dict[str, Any]) -> None:
    """Put a value into its field again, if the page has one that can show it: no list has it as one of its choices."""
    *tables, name = path
    table, known = opened, usual
    for each in tables:
        table, known = table.get(each), known.get(each, {})
        if not isinstance(table, dict):
            return
    default = known.get(name)
    leaves = value if isinstance(value, list) else [value]
    shown = all(isinstance(each, int | float | str) for each in leaves)
    number = isinstance(default, int | float) and not isinstance(default, bool) and not isinstance(value, list)
    many = isinstance(default, list) and isinstance(value, list) and name != "suites"
    if (shown and (number or many or default is None)) or (
        path[0] in TABLES and not tables and isinstance(value, dict)
    ):
        table[name] = value


def _can_be_drawn(structure: Any) -> bool:
    """Tell whether a structure has the form of one, whatever its values are."""
    if not isinstance(structure, dict) or not isinstance(structure.get("name", ""), str):
        return False
    kinds = [kind for kind in KINDS if structure.get(kind) is not None]
    elements = structure.get("elements", [])
    tables = [
        *(structure[kind] for kind in kinds),
        *(structure.get(key, {}) for key, (_, told) in WRAPPERS.items() if told.value is None),
    ]
    return (
        len(kinds) == 1
        and all(isinstance(each, dict) for each in tables)
        and isinstance(structure[kinds[0]].get("section", {}), dict)
        and isinstance(elements, list)
        and all(isinstance(each, dict) and each.get("kind") in ELEMENTS for each in elements)
    )
