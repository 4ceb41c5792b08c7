"""A study as TOML text."""

import json
import math
from collections.abc import Mapping
from typing import Any

__all__ = ["toml"]


def toml(content: Mapping[str, Any]) -> str:
    """Write tables, lists of tables, numbers, text and lists of them as TOML; values first, then tables."""
    return "\n".join(_lines(content, "")).strip() + "\n"


def _lines(table: Mapping[str, Any], header: str) -> list[str]:
    lines = [f"{_key(key)} = {_value(value)}" for key, value in table.items() if not _is_table(value)]
    for key, value in table.items():
        path = f"{header}.{_key(key)}" if header else _key(key)
        if isinstance(value, Mapping):
            inner = _lines(value, path)
            bare = not inner or not all(_is_table(each) for each in value.values())
            lines += ["", f"[{path}]", *inner] if bare else inner
        elif _is_table(value):
            for each in value:
                lines += ["", f"[[{path}]]", *_lines(each, path)]
    return lines


def _is_table(value: Any) -> bool:
    return isinstance(value, Mapping) or (
        isinstance(value, list) and bool(value) and all(isinstance(each, Mapping) for each in value)
    )


def _key(key: str) -> str:
    return (
        key if key.replace("_", "").replace("-", "").isascii() and key.replace("_", "").isalnum() else json.dumps(key)
    )


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, float):
        if math.isinf(value):
            return "inf" if value > 0.0 else "-inf"
        text = repr(value)
        return text if any(mark in text for mark in ".en") else f"{text}.0"
    if isinstance(value, list | tuple):
        return f"[{', '.join(_value(each) for each in value)}]"
    return str(value)
