"""Every described argument refuses what it cannot be, and the error names it."""

import math
from collections.abc import Iterator
from inspect import signature
from typing import Any

import numpy as np
import pytest

import hostile
import rockflex as rf
from rockflex.foundation.descriptions import Described, described_arguments, is_described

PLAIN = {
    "text": "text", "complex": 1.0 + 1.0j, "bytes": b"1", "an object": object(), "a class": float,
    "a huge number": 10**400, "rows": [[1.0], [1.0, 2.0]], "a masked array": np.ma.masked_values([1.0, -9.0], -9.0),
    "a masked number": np.ma.masked, "NaN": math.nan,
}  # fmt: skip
NUMBERS = PLAIN | {"a boolean": True, "a NumPy boolean": np.True_, "a list": [1.0, 2.0], "-inf": -math.inf}
OUTSIDE = {
    "positive": {"zero": 0.0, "a negative number": -1.0, "inf": math.inf},
    "zero or positive": {"a negative number": -1.0, "inf": math.inf},
    "zero, positive or infinite": {"a negative number": -1.0},
    "finite": {"inf": math.inf},
    "from 0 to below 1": {"a negative number": -0.01, "one": 1.0, "inf": math.inf},
    "from 0 to 1": {"a negative number": -0.01, "more than one": 1.01, "inf": math.inf},
    "flag": {"one": 1, "a list": [True]},
    "whole": {"half a number": 1.5, "a float": 2.0, "inf": math.inf},
    "row": {"nothing": [], "one that is NaN": [1.0, math.nan], "one that is a text": [1.0, "2"], "a boolean": True},
    "": {},
}
IN_UNITS = ("positive", "zero or positive", "finite")
CALLS = {name: call for name, call in hostile.structures().items() if is_described(call[0])}


def bad_values(key: Described, *, optional: bool) -> Iterator[tuple[str, Any]]:
    """Values that an argument cannot be, with their names."""
    yield from (PLAIN if key.rule in ("", "flag", "row") else NUMBERS).items()
    yield from OUTSIDE[key.rule].items()
    if key.rule == "whole":
        low, high = key.within
        yield from (("too few", low - 1), *([] if high is None else [("too many", high + 1)]))
    if key.rule and not optional:
        yield "None", None


def cases() -> Iterator[Any]:
    for call, (made, _) in CALLS.items():
        for name, key in described_arguments(made).items():
            yield pytest.param(call, name, key, id=f"{call}-{name}")


def test_every_described_name_is_tried() -> None:
    public = {name for name in rf.__all__ if callable(made := getattr(rf, name)) and is_described(made)}
    assert public - {"Attachment"} <= {made.__name__ for made, _ in CALLS.values()}
    assert len(public) > 20


@pytest.mark.parametrize(("call", "name", "key"), list(cases()))
def test_what_an_argument_cannot_be_is_refused_by_its_name(call: str, name: str, key: Described) -> None:
    made, given = CALLS[call]
    made(**given)
    default = signature(made).parameters[name].default if name in signature(made).parameters else None  # of a place
    for what, value in bad_values(key, optional=default is None):
        with pytest.raises(rf.InputError) as caught:
            made(**given | {name: value})
        said = str(caught.value)
        assert caught.value.field == name, f"{what}: {said}"
        assert key.remedy in said, what
        if key.rule in IN_UNITS:
            assert f" in {key.unit}" in said or not key.unit, f"{what}: {said}"
