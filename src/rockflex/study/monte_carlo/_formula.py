"""Formulas in place of numbers, such as "= 0.3 * weight"."""

import ast
import math
import operator
from collections.abc import Callable, Mapping
from functools import lru_cache
from typing import Any

from rockflex._errors import InputError
from rockflex._shown import shown

FUNCTIONS: dict[str, Callable[..., float]] = {
    "min": lambda *values: min(values),
    "max": lambda *values: max(values),
    "sqrt": math.sqrt,
    "exp": math.exp,
    "log": math.log,
}
LONGEST = 200  # characters
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


def names_of(formula: str) -> set[str]:
    """Return the names that a formula needs.

    Raises
    ------
    InputError
        If it is not a formula.
    """
    called = {id(node.func) for node in ast.walk(_parsed(formula)) if isinstance(node, ast.Call)}
    found = (node for node in ast.walk(_parsed(formula)) if isinstance(node, ast.Name) and id(node) not in called)
    return {node.id for node in found}


def value_of(formula: str, values: Mapping[str, float]) -> float:
    """Return the value of a formula, whose names are all in `values`; whole numbers stay whole.

    Raises
    ------
    InputError
        If it is not a formula, or has no value: a division by zero, for instance.
    """
    try:
        value = _value(_parsed(formula), values)
        if isinstance(value, complex):
            raise ValueError("a power of a negative number")
    except (ArithmeticError, ValueError, TypeError) as error:
        used = ", ".join(f"{name} = {values[name]:g}" for name in sorted(names_of(formula)))
        raise InputError(f"The formula {shown(formula)} has no value{used and f' for {used}'}: {error}.") from error
    return value


@lru_cache(maxsize=1024)
def _parsed(formula: str) -> ast.expr:
    text = formula.removeprefix("=").strip()
    try:
        if len(text) > LONGEST:
            raise SyntaxError
        found = ast.parse(text, mode="eval").body
        if not _is_sound(found):
            raise SyntaxError
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise InputError(
            f"{shown(formula)} is not a formula. Expected numbers, names of variables, + - * / **, parentheses, and "
            f"{', '.join(FUNCTIONS)}, in at most {LONGEST} characters."
        ) from error
    return found


def _is_sound(node: ast.expr) -> bool:
    if isinstance(node, ast.Constant):
        return isinstance(node.value, int | float) and not isinstance(node.value, bool)
    if isinstance(node, ast.UnaryOp):
        return type(node.op) in _SIGNS and _is_sound(node.operand)
    if isinstance(node, ast.BinOp):
        return type(node.op) in _OPERATORS and _is_sound(node.left) and _is_sound(node.right)
    if isinstance(node, ast.Call):
        known = isinstance(node.func, ast.Name) and node.func.id in FUNCTIONS
        return known and not node.keywords and bool(node.args) and all(map(_is_sound, node.args))
    return isinstance(node, ast.Name)


def _value(node: ast.expr, values: Mapping[str, float]) -> Any:
    if isinstance(node, ast.Constant):
        return node.value
    if isinstance(node, ast.UnaryOp):
        return _SIGNS[type(node.op)](_value(node.operand, values))
    if isinstance(node, ast.BinOp):
        return _OPERATORS[type(node.op)](_value(node.left, values), _value(node.right, values))
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
        return FUNCTIONS[node.func.id](*(_value(each, values) for each in node.args))
    return values[node.id if isinstance(node, ast.Name) else ""]
