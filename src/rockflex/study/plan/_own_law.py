"""The record of a user-defined impact law in the folder of a study, which must not be resumed with another law."""

import hashlib
import inspect
import math
import sys
from collections.abc import Mapping
from typing import Any, cast

import numpy as np

from rockflex._errors import InputError
from rockflex.models import ImpactLaw


def law_document(law: ImpactLaw) -> dict[str, Any]:
    """Return the class of a law, the names of what it keeps and loses, and its values, as plain JSON.

    Raises
    ------
    InputError
        If a value is not a number, text, array, or a list, tuple or dictionary of them.
    """
    kind = type(law)
    state = cast("Any", law).__getstate__()
    parts = state if isinstance(state, tuple) else (state,)  # a class with slots gives two dictionaries
    values = {name: _said(name, value, kind) for part in parts if part for name, value in part.items()}
    return {"law": f"{kind.__module__}.{kind.__qualname__}", "keeps": law.keeps, "loses": law.loses, "values": values}


def law_checksum(law: ImpactLaw) -> dict[str, str]:
    """Return the SHA-256 of the module that defines the class of a law; an empty dictionary for laws of rockflex.

    Raises
    ------
    InputError
        If the class is not defined in a file.
    """
    kind = type(law)
    if kind.__module__.partition(".")[0] == __name__.partition(".")[0]:
        return {}
    try:
        source = inspect.getsource(sys.modules[kind.__module__])
    except (OSError, TypeError, KeyError) as error:
        raise InputError(
            f"The impact law {kind.__qualname__} is not defined in a file, so a study that is resumed cannot check "
            "that it is the same. Put it into a module (a .py file) and import it, or run the study without a folder."
        ) from error
    return {f"impact, {kind.__module__}": hashlib.sha256(source.encode()).hexdigest()}


def _said(name: str, value: Any, kind: type) -> Any:
    if isinstance(value, float) and not math.isfinite(value):
        return str(value)
    if value is None or isinstance(value, str | bool | int | float):
        return value
    if isinstance(value, np.ndarray | np.generic):
        return _said(name, value.tolist(), kind)
    if isinstance(value, list | tuple):
        return [_said(name, each, kind) for each in cast("list[Any]", value)]
    if isinstance(value, Mapping):
        return {str(key): _said(name, each, kind) for key, each in cast("Mapping[Any, Any]", value).items()}
    raise InputError(
        f"A study's folder must record the values of its impact law, but {kind.__qualname__}.{name} is of type "
        f"{type(value).__name__}. Let the law hold numbers, texts and arrays, or run the study without a folder."
    )
