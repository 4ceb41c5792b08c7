"""Figure 14 and Eqs. 33-35: the geometry of the chimney and the parameters that follow from it."""

import math

import rockflex as rf
from rockflex.papers.silva_stojadinovic_2024._number import compared
from rockflex.papers.silva_stojadinovic_2024._records import Records
from rockflex.papers.silva_stojadinovic_2024._structures import TOWER
from rockflex.report import Result

TITLE = "Geometry of the chimney, I_θ, L_0^r and M_r"


def reproduce(_: Records) -> Result:
    """Compare the three integrals."""
    p, unit = TOWER.rocking(), math.pi * TOWER.density
    numbers = (
        compared("I_θ", "Eq. 33", "24'178'750", p.i_theta / unit, "π ρ_c m⁵"),
        compared("L_0^r", "Eq. 34", "580000/3", p.l0r / unit, "π ρ_c m⁴"),
        compared("M_r", "Eq. 35", "17'600", p.resisting_moment / (9.81 * unit), "π ρ_c g m⁴"),
    )
    return Result("figure-14", TITLE, numbers, {"figure-14": lambda: rf.plot_tower(TOWER)})
