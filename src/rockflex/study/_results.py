"""What the tables of all studies hold of a run: its status and its peaks."""

from collections.abc import Iterable
from functools import cache
from operator import attrgetter
from typing import Any

from rockflex.modal import RockingProperties, Tendon
from rockflex.response import NAMES, Response

# Every number and flag of a Response, by its name.
RESULTS: dict[str, type] = {name: Response.__annotations__[name] for name in NAMES if name != "status"}
OF_ELEMENTS = ("tendon_yield", "tendon_overload", "residual_rotation")
OF_GROUND = ("max_slip", "residual_slip", "max_edge_uplift", "max_edge_settlement")


def results_of(response: Response, suffix: str = "") -> dict[str, Any]:
    """Return the status of a response, and every number and flag by its name; `suffix` is added to each name."""
    return dict(zip(_named(suffix), _values_of(response), strict=True))


_values_of = attrgetter("status", *RESULTS)


@cache
def _named(suffix: str) -> tuple[str, ...]:
    return tuple(name + suffix for name in ("status", *RESULTS))


def result_columns(
    structures: Iterable[RockingProperties] = (), suffix: str = "", *, grounded: bool = False
) -> dict[str, type]:
    """Return the kinds of the columns that `results_of` fills in a study of these structures.

    Without elements other than elastic tendons the columns of `OF_ELEMENTS` would say nothing, and are left out; so are
    those of `OF_GROUND` on rigid ground on which no base slides, unless the study is `grounded`.
    """
    silent: tuple[str, ...] = () if grounded else OF_GROUND
    if not any(map(_is_controlled, structures)):
        silent += OF_ELEMENTS
    kinds = {"status": str, **RESULTS}
    return {name + suffix: kind for name, kind in kinds.items() if name not in silent}


def _is_controlled(properties: RockingProperties) -> bool:
    return any(not isinstance(each, Tendon) or each.post_yield_ratio is not None for each in properties.elements)
