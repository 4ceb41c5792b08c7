"""Values in the form that JSON can write."""

import math
from collections.abc import Mapping
from dataclasses import asdict, is_dataclass
from pathlib import Path
from typing import Any

import numpy as np

PLAIN = frozenset((str, int, bool, type(None)))


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
