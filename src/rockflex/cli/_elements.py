"""The elements between a base and the ground: their values, in words and in tables."""

from collections.abc import Sequence
from dataclasses import asdict
from typing import TYPE_CHECKING, Any

from rockflex.cli._console import grid, number
from rockflex.modal import BaseElement, FrictionDamper, Tendon, ViscousDamper, YieldingDissipator
from rockflex.structure.file import ELEMENTS

if TYPE_CHECKING:
    from rich.table import Table

UNITS = {
    "position": "m",
    "initial_force": "N",
    "stiffness": "N/m",
    "yield_force": "N",
    "rupture_elongation": "m",
    "coefficient": "N s/m",
    "force": "N",
}
_HEADINGS = ("no.", "element", "x [m]", "k [kN/m]", "c [kN s/m]", "F_0 [kN]", "strength [kN]", "α", "breaks at [m]")
_WORDS = 2  # columns of words


def describe_elements(elements: Sequence[BaseElement]) -> list[dict[str, Any]]:
    """Return the kind and the values of each element, for a document."""
    return [{"kind": _kind(each), **asdict(each)} for each in elements]


def elements_table(elements: Sequence[BaseElement]) -> "Table":
    """Return the table of elements, without the columns that none of them needs."""
    rows = [(str(place), *_row(each)) for place, each in enumerate(elements, start=1)]
    kept = [k for k in range(len(_HEADINGS)) if k < _WORDS or any(row[k] != "-" for row in rows)]
    return grid([_HEADINGS[k] for k in kept], ([row[k] for k in kept] for row in rows), _WORDS)


def _row(element: BaseElement) -> tuple[str, ...]:
    stiffness = damping = prestress = strength = ratio = breaks = None
    if isinstance(element, Tendon | YieldingDissipator):
        stiffness, strength = element.stiffness / 1e3, element.yield_force and element.yield_force / 1e3
        ratio, breaks = element.post_yield_ratio, element.rupture_elongation
    if isinstance(element, Tendon):
        prestress = element.initial_force / 1e3
    elif isinstance(element, ViscousDamper):
        damping = element.coefficient / 1e3
    elif isinstance(element, FrictionDamper):
        strength = element.force / 1e3
    only = ", tension only" if isinstance(element, YieldingDissipator) and element.tension_only else ""
    values = (element.position, stiffness, damping, prestress, strength, ratio, breaks)
    return (_kind(element).replace("_", " ") + only, *map(number, values))


def _kind(element: BaseElement) -> str:
    return next(kind for kind, table in ELEMENTS.items() if table.makes is type(element))
