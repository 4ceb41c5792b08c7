"""Speed against OpenSees, at the same error of θ_max; a line instead of the table if it is not installed."""

import sys
from pathlib import Path

from rich.table import Table

sys.path.insert(0, str(Path(__file__).parents[1] / "validation" / "opensees"))

from frames import FLEXURE, SHEAR, load_opensees
from speed import speeds
from springs import speeds_on_springs


def table() -> Table | str:
    """A Ricker pulse, five stories, all modes: the fastest of OpenSees' settings, for one excursion or on springs."""
    try:
        load_opensees()
    except ImportError as error:
        return f"no comparison with OpenSees: {error}"
    columns = ("structure", "model", "error ≤", "OpenSees dt", "OpenSees ms", "one call ms", "OpenSees / one call")
    result = Table(*columns, title="rocking under a pulse, OpenSees to a given error of θ_max")
    for prototype in (SHEAR, FLEXURE):
        for each in (*speeds(prototype), *speeds_on_springs(prototype)):
            times = (f"{each.opensees * 1e3:.0f}", f"{each.rockflex * 1e3:.2f}", f"{each.ratio:.0f}")
            result.add_row(prototype.name, each.model, f"{each.target:g}", f"{each.dt:g}", *times)
    return result
