"""Random variables: their distributions, and their values for the number of a structure."""

import hashlib
import math
from collections.abc import Mapping
from graphlib import CycleError, TopologicalSorter
from statistics import NormalDist
from typing import Annotated, Any

import numpy as np
from pydantic import model_validator

from rockflex._arrays import Array
from rockflex._errors import InputError
from rockflex._schema import PLAIN, Key
from rockflex._shown import shown
from rockflex.structure.file import Table, checked
from rockflex.study.monte_carlo._formula import FUNCTIONS, is_formula, names_of, value_of

_BITS = 52  # of a draw, which is the middle of one of 2**52 parts of (0, 1)


class DistributionTable(Table):
    """The distribution of a variable: one of these keys."""

    uniform: Annotated[list[float] | None, Key("a list of the smallest and the largest value", form=PLAIN)] = None
    log_uniform: Annotated[
        list[float] | None,
        Key("a list of the smallest and the largest value, for a logarithm that is uniform", form=PLAIN),
    ] = None
    whole: Annotated[
        list[int] | None, Key("a list of the smallest and the largest of equally likely whole numbers", form=PLAIN)
    ] = None
    normal: Annotated[list[float] | None, Key("a list of the mean and the standard deviation", form=PLAIN)] = None
    lognormal: Annotated[
        list[float] | None, Key("a list of the median and the standard deviation of the logarithm", form=PLAIN)
    ] = None
    one_of: Annotated[list[int | float] | None, Key("a list of equally likely values", form=PLAIN)] = None

    @model_validator(mode="after")
    def _one(self) -> "DistributionTable":
        given = self.model_dump(exclude_none=True)
        if len(given) != 1:
            *others, last = type(self).model_fields
            raise InputError(
                f"one distribution is expected, {', '.join(others)} or {last}, but {len(given)} were given."
            )
        ((name, numbers),) = given.items()
        if name == "one_of":
            if not numbers or any(map(math.isnan, numbers)):
                raise InputError(f"one_of must be a list of one number or more, but {shown(numbers)} was given.")
            return self
        first, second = numbers if len(numbers) == 2 else (math.nan, math.nan)
        if not (math.isfinite(first) and math.isfinite(second)):
            raise InputError(f"{name} must be a list of two finite numbers, but {shown(numbers)} was given.")
        if name in ("lognormal", "log_uniform") and first <= 0.0:
            raise InputError(f"{name} must begin with a positive number, but {shown(numbers)} was given.")
        if name in ("normal", "lognormal"):
            if second < 0.0:
                raise InputError(f"{name} must end with a standard deviation, but {second:g} is negative.")
        elif first > second:
            raise InputError(
                f"{name} must be a range whose first number is the smaller, but {shown(numbers)} was given."
            )
        return self

    def value(self, draw: float) -> float:
        """Return the value that is exceeded with the probability 1 - `draw`; `draw` is between 0 and 1."""
        if self.one_of is not None:
            return self.one_of[int(draw * len(self.one_of))]
        if self.whole is not None:
            return self.whole[0] + int(draw * (self.whole[1] - self.whole[0] + 1))
        if self.uniform is not None:
            return self.uniform[0] + (self.uniform[1] - self.uniform[0]) * draw
        if self.log_uniform is not None:
            low, high = self.log_uniform
            return low * (high / low) ** draw
        normal = NormalDist().inv_cdf(draw)
        if self.normal is not None:
            return self.normal[0] + self.normal[1] * normal
        median, spread = self.lognormal or (math.nan, math.nan)
        return median * math.exp(spread * normal)


class Variables:
    """Random variables by name: distributions, formulas of other variables, and numbers.

    The draw of a variable depends only on the seed, the number of the structure, and its own name. So another variable,
    or another order of them, changes no other value.

    Raises
    ------
    InputError
        If a name or a value cannot be used, or formulas refer to unknown names or to each other.
    """

    def __init__(self, given: Mapping[str, Any], reserved: Mapping[str, str]) -> None:
        self.kinds = {name: _variable(name, value, reserved) for name, value in given.items()}
        graph = {name: names_of(kind) for name, kind in self.kinds.items() if isinstance(kind, str)}
        for name, needed in graph.items():
            check_known(f"[variables] {name}", needed, self.kinds)
        try:
            order = [*TopologicalSorter(graph).static_order()]
        except CycleError as error:
            ring = " → ".join(error.args[1])
            raise InputError(f"[variables] Formulas refer to each other: {ring}. One of them needs a value.") from error
        self._formulas = [name for name in order if name in graph]

    def draw(self, seed: int, number: int) -> dict[str, float]:
        """Return the values for the structure of a number, in the order in which the variables are given.

        Raises
        ------
        InputError
            If a formula has no value.
        """
        found: dict[str, float] = {}
        for name, kind in self.kinds.items():
            if isinstance(kind, DistributionTable):
                found[name] = kind.value(float(draws(seed, number, name)[0]))
            elif not isinstance(kind, str):
                found[name] = kind
        for name in self._formulas:
            found[name] = value_of(str(self.kinds[name]), found)
        return {name: found[name] for name in self.kinds}


def draws(seed: int, number: int, name: str, size: int = 1) -> Array:
    """Return uniform draws between 0 and 1 that belong to a seed, a number and a name, shape (size,)."""
    words = np.frombuffer(hashlib.sha256(name.encode()).digest()[:16], "<u4").tolist()
    bits = np.random.Philox(np.random.SeedSequence(seed, spawn_key=(number, *words)))
    return (np.random.Generator(bits).integers(2**_BITS, size=size) + 0.5) / 2**_BITS


def check_known(place: str, needed: set[str], known: Mapping[str, object]) -> None:
    """Raise an InputError if a formula needs a name that is not known."""
    for name in sorted(needed - known.keys()):
        raise InputError(f"{place}: {name} is not known; there are {', '.join(known) or 'no variables'}.")


def _variable(name: str, given: Any, reserved: Mapping[str, str]) -> DistributionTable | str | float:
    if not name.isidentifier():
        raise InputError(
            f"[variables] {shown(name)} is not a name. Expected letters, digits and _, such as fuse_ratio."
        )
    if name in FUNCTIONS or name in reserved:
        what = reserved.get(name, "a function")
        raise InputError(f"[variables] {name} is already {what}. Give the variable another name.")
    if is_formula(given):
        names_of(given)
        return given
    if isinstance(given, int | float) and not isinstance(given, bool):
        return given
    if not isinstance(given, Mapping):
        raise InputError(
            f"[variables] {name} must be a distribution such as {{ uniform = [0.1, 0.5] }}, a formula such as "
            f'"= 2 * height", or a number, but {shown(given)} was given.'
        )
    return checked(DistributionTable, {str(key): value for key, value in given.items()}, f"[variables.{name}]")  # pyright: ignore[reportUnknownVariableType, reportUnknownArgumentType]
