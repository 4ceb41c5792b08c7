"""Random variables: their distributions, formulas of other variables, and values for the number of a structure."""

import ast
import hashlib
import math
import operator
from collections.abc import Callable, Mapping
from functools import lru_cache
from graphlib import CycleError, TopologicalSorter
from statistics import NormalDist
from typing import Annotated, Any

import numpy as np
from pydantic import model_validator

from rockflex.foundation.arrays import Array
from rockflex.foundation.descriptions import PLAIN, Described
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.structure.file._toml_table import TomlTable, parse_toml_table

FUNCTIONS: dict[str, Callable[..., float]] = {
    "min": lambda *values: min(values),
    "max": lambda *values: max(values),
    "sqrt": math.sqrt,
    "exp": math.exp,
    "log": math.log,
}
MAX_CHARACTERS = 200  # characters
_SIGNS: dict[type, Callable[[Any], Any]] = {ast.USub: operator.neg, ast.UAdd: operator.pos}
_OPERATORS: dict[type, Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: lambda base, exponent: float(base) ** float(exponent),  # a whole number could grow without limit
}


def is_formula(given: object) -> bool:
    """Tell whether something is a text that begins with "="."""
    return isinstance(given, str) and given.startswith("=")


def names_in_formula(formula: str) -> set[str]:
    """Return the names that a formula needs."""
    called = {id(node.func) for node in ast.walk(_parsed_formula(formula)) if isinstance(node, ast.Call)}
    found = (
        node for node in ast.walk(_parsed_formula(formula)) if isinstance(node, ast.Name) and id(node) not in called
    )
    return {node.id for node in found}


def formula_value(formula: str, values: Mapping[str, float]) -> float:
    """Return the value of a formula, whose names are all in `values`; whole numbers stay whole."""
    try:
        value = _formula_node_value(_parsed_formula(formula), values)
        if isinstance(value, complex):
            raise ValueError("a power of a negative number")
    except (ArithmeticError, ValueError, TypeError) as error:
        used = ", ".join(f"{name} = {values[name]:g}" for name in sorted(names_in_formula(formula)))
        raise InputError(f"The formula {shown(formula)} has no value{used and f' for {used}'}: {error}.") from error
    return value


@lru_cache(maxsize=1024)
def _parsed_formula(formula: str) -> ast.expr:
    text = formula.removeprefix("=").strip()
    try:
        if len(text) > MAX_CHARACTERS:
            raise SyntaxError
        found = ast.parse(text, mode="eval").body
        if not _is_allowed_formula_node(found):
            raise SyntaxError
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise InputError(
            f"{shown(formula)} is not a formula. Expected numbers, names of variables, + - * / **, parentheses, and "
            f"{', '.join(FUNCTIONS)}, in at most {MAX_CHARACTERS} characters."
        ) from error
    return found


def _is_allowed_formula_node(node: ast.expr) -> bool:
    if isinstance(node, ast.Constant):
        return isinstance(node.value, int | float) and not isinstance(node.value, bool)
    if isinstance(node, ast.UnaryOp):
        return type(node.op) in _SIGNS and _is_allowed_formula_node(node.operand)
    if isinstance(node, ast.BinOp):
        return (
            type(node.op) in _OPERATORS and _is_allowed_formula_node(node.left) and _is_allowed_formula_node(node.right)
        )
    if isinstance(node, ast.Call):
        known = isinstance(node.func, ast.Name) and node.func.id in FUNCTIONS
        return known and not node.keywords and bool(node.args) and all(map(_is_allowed_formula_node, node.args))
    return isinstance(node, ast.Name)


def _formula_node_value(node: ast.expr, values: Mapping[str, float]) -> Any:
    if isinstance(node, ast.Constant):
        return node.value
    if isinstance(node, ast.UnaryOp):
        return _SIGNS[type(node.op)](_formula_node_value(node.operand, values))
    if isinstance(node, ast.BinOp):
        return _OPERATORS[type(node.op)](
            _formula_node_value(node.left, values), _formula_node_value(node.right, values)
        )
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
        return FUNCTIONS[node.func.id](*(_formula_node_value(each, values) for each in node.args))
    return values[node.id if isinstance(node, ast.Name) else ""]


_BITS = 52  # of a draw, which is the middle of one of 2**52 parts of (0, 1)


MAX_LOG_SPREAD = 10.0  # of a lognormal variable; draws then still span 70 powers of ten


class DistributionTable(TomlTable):
    """The distribution of a variable: one of these keys."""

    uniform: Annotated[list[float] | None, Described("a list of the smallest and the largest value", form=PLAIN)] = None
    log_uniform: Annotated[
        list[float] | None,
        Described("a list of the smallest and the largest value, for a logarithm that is uniform", form=PLAIN),
    ] = None
    whole: Annotated[
        list[int] | None,
        Described("a list of the smallest and the largest of equally likely whole numbers", form=PLAIN),
    ] = None
    normal: Annotated[list[float] | None, Described("a list of the mean and the standard deviation", form=PLAIN)] = None
    lognormal: Annotated[
        list[float] | None, Described("a list of the median and the standard deviation of the logarithm", form=PLAIN)
    ] = None
    one_of: Annotated[list[int | float] | None, Described("a list of equally likely values", form=PLAIN)] = None

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
            if name == "lognormal" and second > MAX_LOG_SPREAD:
                raise InputError(
                    f"lognormal must end with the standard deviation of the logarithm, at most {MAX_LOG_SPREAD:g}, but "
                    f"{shown(numbers)} was given. For a mean m and a standard deviation s it is √(ln(1 + (s/m)²)), "
                    "about s/m."
                )
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


class RandomVariables:
    """Random variables by name: distributions, formulas of other variables, and numbers.

    The draw of a variable depends only on the seed, the number of the structure, and its own name. So another variable,
    or another order of them, changes no other value.
    """

    def __init__(self, given: Mapping[str, Any], reserved: Mapping[str, str]) -> None:
        self.kinds = {name: _checked_random_variable(name, value, reserved) for name, value in given.items()}
        graph = {name: names_in_formula(kind) for name, kind in self.kinds.items() if isinstance(kind, str)}
        for name, needed in graph.items():
            check_formula_names_known(f"[variables] {name}", needed, self.kinds)
        try:
            order = [*TopologicalSorter(graph).static_order()]
        except CycleError as error:
            ring = " → ".join(error.args[1])
            raise InputError(f"[variables] Formulas refer to each other: {ring}. One of them needs a value.") from error
        self._formulas = [name for name in order if name in graph]

    def draw(self, seed: int, number: int) -> dict[str, float]:
        """Return the values for the structure of a number, in the order in which the variables are given."""
        found: dict[str, float] = {}
        for name, kind in self.kinds.items():
            if isinstance(kind, DistributionTable):
                found[name] = kind.value(float(uniform_draws(seed, number, name)[0]))
            elif not isinstance(kind, str):
                found[name] = kind
        for name in self._formulas:
            found[name] = formula_value(str(self.kinds[name]), found)
        return {name: found[name] for name in self.kinds}


def uniform_draws(seed: int, number: int, name: str, size: int = 1) -> Array:
    """Return uniform draws between 0 and 1 that belong to a seed, a number and a name, shape (size,)."""
    words = np.frombuffer(hashlib.sha256(name.encode()).digest()[:16], "<u4").tolist()
    bits = np.random.Philox(np.random.SeedSequence(seed, spawn_key=(number, *words)))
    return (np.random.Generator(bits).integers(2**_BITS, size=size) + 0.5) / 2**_BITS


def check_formula_names_known(place: str, needed: set[str], known: Mapping[str, object]) -> None:
    """Raise an InputError if a formula needs a name that is not known."""
    for name in sorted(needed - known.keys()):
        raise InputError(f"{place}: {name} is not known; there are {', '.join(known) or 'no variables'}.")


def _checked_random_variable(name: str, given: Any, reserved: Mapping[str, str]) -> DistributionTable | str | float:
    if not name.isidentifier():
        raise InputError(
            f"[variables] {shown(name)} is not a name. Expected letters, digits and _, such as fuse_ratio."
        )
    if name in FUNCTIONS or name in reserved:
        what = reserved.get(name, "a function")
        raise InputError(f"[variables] {name} is already {what}. Give the variable another name.")
    if is_formula(given):
        names_in_formula(given)
        return given
    if isinstance(given, int | float) and not isinstance(given, bool):
        return given
    if not isinstance(given, Mapping):
        raise InputError(
            f"[variables] {name} must be a distribution such as {{ uniform = [0.1, 0.5] }}, a formula such as "
            f'"= 2 * height", or a number, but {shown(given)} was given.'
        )
    return parse_toml_table(DistributionTable, {str(key): value for key, value in given.items()}, f"[variables.{name}]")  # pyright: ignore[reportUnknownVariableType, reportUnknownArgumentType]
