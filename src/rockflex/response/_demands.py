"""The demands of a run that sets of records and comparisons tell."""

from collections.abc import Mapping
from typing import NamedTuple

from rockflex.foundation.units import Unit, UnitSystem


class Demand(NamedTuple):
    """A demand: its symbol, and the kind of quantity, from which its unit follows."""

    symbol: str
    quantity: str
    compared_as: str = ""  # in a comparison, where that is not the symbol
    usual: str = ""  # unit of sets in the system "kN", where it is not the usual one
    worst_is_least: bool = False

    def unit_in(self, units: UnitSystem) -> Unit:
        """Return the unit of tables of sets."""
        return units.of(self.quantity, self.usual)


DEMANDS: Mapping[str, Demand] = {
    "max_rotation": Demand("θ_max", "rotation"),
    "balance_ratio": Demand("θ_max/α", "ratio"),
    "max_top_displacement": Demand("u_top", "displacement", "u_top relative"),
    "max_total_top_displacement": Demand("total u_top", "displacement", "u_top total"),
    "max_story_drift": Demand("story drift", "displacement"),
    "max_floor_acceleration": Demand("floor a", "acceleration", "floor acceleration", "m/s²"),
    "max_base_moment": Demand("M_b", "moment"),
    "max_base_shear": Demand("V_b", "force"),
    "max_horizontal_reaction": Demand("ΣF_x", "force"),
    "min_vertical_reaction": Demand("N_min", "force", worst_is_least=True),
    "max_tendon_force": Demand("tendon force", "force"),
    "tendon_utilisation": Demand("tendons, F/F_y", "ratio"),
    "max_slip": Demand("slip", "displacement"),
    "max_edge_uplift": Demand("edge up", "displacement", "uplift of an edge"),
    "max_edge_settlement": Demand("edge down", "displacement", "settlement of an edge"),
    "residual_rotation": Demand("rotation left", "rotation"),
}
"""All demands by name; all but two, of floors, are the scalars of a `Response`."""

ONLY_COMPARED = ("balance_ratio", "tendon_utilisation", "residual_rotation")
DEMANDS_BY_RECORD = ("max_rotation", "max_total_top_displacement", "max_story_drift", "max_base_moment",
                     "max_base_shear", "min_vertical_reaction")  # fmt: skip
"""The demands that tables show for each record of a set."""

COMPARED_DEMANDS = (
    "max_rotation", "balance_ratio", "max_top_displacement", "max_total_top_displacement", "max_story_drift",
    "max_floor_acceleration", "max_base_shear", "max_base_moment", "tendon_utilisation", "max_edge_uplift",
    "max_edge_settlement", "max_slip", "residual_rotation",
)  # fmt: skip
"""The demands of a comparison, in the order of its table."""
