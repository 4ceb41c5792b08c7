"""What the tables of all studies hold of a run: its status and its peaks."""

from typing import Any

from rockflex.response import PEAKS, Response

STATUSES = ("no_uplift", "rocking", "overturned")

RESULTS: dict[str, type] = {  # every number and flag of a Response, by its name
    name: kind for name in PEAKS if (kind := Response.__annotations__[name]) in (float, int, bool)
}


def results_of(response: Response, suffix: str = "") -> dict[str, Any]:
    """Return the status of a response, and every number and flag by its name; `suffix` is added to each name."""
    return {name + suffix: getattr(response, name) for name in ("status", *RESULTS)}


def result_columns(suffix: str = "") -> dict[str, type]:
    """Return the kinds of the columns that `results_of` fills."""
    return {name + suffix: kind for name, kind in {"status": str, **RESULTS}.items()}
