"""Values in the form that JSON can write."""

import math
from collections.abc import Mapping
from dataclasses import asdict, is_dataclass
from pathlib import Path
from typing import Any, cast

import numpy as np

PLAIN = frozenset((str, int, bool, type(None)))
_INFINITE = {"inf": math.inf, "-inf": -math.inf}
_TEXTS = {"name"}  # keys whose values are texts, whatever they say


def as_json_value(value: Any) -> Any:
    """Return dicts, lists, strings and numbers: NaN becomes None, an infinity "inf" or "-inf", a path its text."""
    if type(value) in PLAIN or (type(value) is float and math.isfinite(value)):  # as most are
        return value
    if is_dataclass(value) and not isinstance(value, type):
        return as_json_value(asdict(value))
    if isinstance(value, Mapping):
        return {str(key): as_json_value(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [as_json_value(item) for item in value]
    if isinstance(value, np.ndarray | np.generic):
        return as_json_value(value.tolist())
    if isinstance(value, float) and not math.isfinite(value):
        return None if math.isnan(value) else f"{value:g}"
    return str(value) if isinstance(value, Path) else value


def with_infinite_numbers(value: Any) -> Any:
    """Return content read from JSON with the infinite numbers that `as_json_value` wrote as texts; names stay texts."""
    if isinstance(value, dict):
        entries = cast("dict[str, Any]", value)
        return {key: each if key in _TEXTS else with_infinite_numbers(each) for key, each in entries.items()}
    if isinstance(value, list):
        return [with_infinite_numbers(each) for each in cast("list[Any]", value)]
    return _INFINITE.get(value, value) if isinstance(value, str) else value
