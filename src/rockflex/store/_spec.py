"""Specifications as plain JSON, and the differences between two of them."""

import json
import math
from collections.abc import Mapping, Sequence
from typing import Any, cast

from rockflex._errors import InputError
from rockflex._shown import counted, shortened, shown

SHOWN = 10  # differences in a message
DEEPEST = 50  # levels of a specification; those of studies have five
WIDTH = 60  # characters of a value in a message


def plain(name: str, value: object, depth: int = 0) -> Any:
    """Return `value` as dicts, lists, strings, numbers, booleans and None, as JSON would give it back.

    Infinities and NaN are allowed, as in Python's JSON.

    Raises
    ------
    InputError
        If it holds any other value, or is nested too deep; the message has the dotted path.
    """
    if depth > DEEPEST:
        raise InputError(
            f"{shortened(name)} is nested more than {DEEPEST} deep, which no specification is. Give the value itself, "
            "not lists within lists, and no list that holds itself."
        )
    if value is None or isinstance(value, str | bool):
        return value
    if isinstance(value, int | float):
        return int(value) if isinstance(value, int) else float(value)
    if isinstance(value, Mapping):
        items = cast("Mapping[object, object]", value)
        for key in items:
            if not isinstance(key, str):
                raise InputError(f"The keys of {name} must be strings, but {shown(key)} was given.")
        return {str(key): plain(f"{name}.{key}", each, depth + 1) for key, each in items.items()}
    if isinstance(value, list | tuple):
        entries = cast("Sequence[object]", value)
        return [plain(f"{name}[{place}]", each, depth + 1) for place, each in enumerate(entries)]
    raise InputError(
        f"{name} is of type {type(value).__name__}, which JSON does not know. Give a number, a string, a list or a "
        "dict; a NumPy array or number by its .tolist()."
    )


def differences(old: Any, new: Any, where: str = "") -> list[str]:
    """Return a line for each place where two plain values differ, by its dotted path."""
    if isinstance(old, dict) and isinstance(new, dict):
        before, now = cast("dict[str, Any]", old), cast("dict[str, Any]", new)
        found: list[str] = []
        for key in [*before, *(key for key in now if key not in before)]:
            path = f"{where}.{key}" if where else key
            if key not in now:
                found.append(f"{path}: {_shown(before[key])} in the folder, not given now")
            elif key not in before:
                found.append(f"{path}: not in the folder, {_shown(now[key])} now")
            else:
                found += differences(before[key], now[key], path)
        return found
    if isinstance(old, list) and isinstance(new, list):
        first, second = cast("list[Any]", old), cast("list[Any]", new)
        if len(first) != len(second):
            return [f"{where}: {counted(len(first), 'entry', 'entries')} in the folder, {len(second)} now"]
        pairs = enumerate(zip(first, second, strict=True))
        return [line for place, (one, two) in pairs for line in differences(one, two, f"{where}[{place}]")]
    return [] if _same(old, new) else [f"{where}: {_shown(old)} in the folder, {_shown(new)} now"]


def listed(lines: Sequence[str]) -> str:
    """Return the first lines, indented, and how many more there are."""
    more = [f"and {len(lines) - SHOWN} more"] if len(lines) > SHOWN else []
    return "".join(f"\n  {line}" for line in [*lines[:SHOWN], *more])


def _same(old: Any, new: Any) -> bool:
    if isinstance(old, float) and isinstance(new, float) and math.isnan(old) and math.isnan(new):
        return True
    return isinstance(old, bool) is isinstance(new, bool) and old == new


def _shown(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= WIDTH else f"{text[: WIDTH - 3]}..."
