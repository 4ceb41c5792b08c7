"""The checks of a run, or of a set of records, as the page shows them."""

from typing import Any

from rockflex._units import UnitSystem
from rockflex.response import NO_LIMIT, RecordSet, Response, check, check_in_units
from rockflex.web._state import PageState

LONG = "its friction takes too long for a page; use rockflex check, or rf.check"


def checks_view(result: Response | RecordSet, state: PageState, *, friction: bool) -> dict[str, Any]:
    """Return the checks against the limits of a state; `friction` tells whether to compute what friction is required.

    `unlimited` has the names of the checks that only need a limit, and `missing` what the others lack.
    """
    table = check(result, state.check_limits(friction=friction))
    left_out = {"sliding": LONG} if "friction" in state.limits and not friction else {}
    missing = [(name, left_out.get(name, lacks)) for name, lacks in table.missing]
    rows: list[dict[str, Any]] = []
    for each in table.rows:
        demand, limit, unit = check_in_units(each, UnitSystem(state.units))
        row: dict[str, Any] = {"name": each.name, "value": each.demand, "demand": demand, "limit": limit, "unit": unit}
        rows.append(row | {key: getattr(each, key) for key in ("ratio", "ok", "at_least", "source", "note")})
    return {
        "rows": rows,
        "missing": [each for each in missing if not each[1].startswith(NO_LIMIT)],
        "unlimited": [name for name, lacks in missing if lacks.startswith(NO_LIMIT)],
    }
