"""The structure on the page: its parameters and its modes."""

import math
import re
from typing import Any

import numpy as np

from rockflex._constants import GRAVITY
from rockflex._errors import InputError, SolverError
from rockflex.modal import RockingProperties, UpliftedModes, uplifted_modes
from rockflex.report.run._numbers import moment_unit
from rockflex.report.run._table import Cell, Fact, Table, fact, shows

LISTED = 4  # modes
_MOST_UPLIFTED = 200  # modes, for which the uplifted ones are found at once


def kind_of(structure: Any) -> str:
    """Return the kind of a structure in words: "Frame", "Cantilever with tip mass, restrained"."""
    if isinstance(structure, RockingProperties):
        return "Structure given by its rocking properties" if structure.n_modes else "Rigid block"
    around: list[str] = []
    while hasattr(structure, "structure"):  # restrained or eccentric
        around.append(_words(structure).lower())
        structure = structure.structure
    return ", ".join([_words(structure), *around])


def structure_facts(p: RockingProperties) -> list[Fact]:
    """Return the parameters of a structure."""
    size, unit = moment_unit(p.resisting_moment)
    height = float(p.effective_height[0]) if p.n_modes else p.l0r / p.m_tot
    pivot = p.weaker_pivot
    slope = "h*_1/B" if p.n_modes else "h/B"
    base = [] if p.base_mass is None else [fact("Mass of the base m_0", p.base_mass, "t", "base_mass", 1e3)]
    top = [] if p.top_height is None else [fact("Height of the top", p.top_height, "m", "top_height")]
    shift = [fact("Eccentricity e", p.eccentricity, "m", "eccentricity")] if p.eccentricity else []
    held = [fact("Prestress of the tendons", p.prestress, "kN", "prestress", 1e3)] if p.tendons else []
    return [
        Fact("Modes", Cell(str(p.n_modes) if p.n_modes else "none (rigid)", p.n_modes, "n_modes")),
        fact("Total mass m_tot", p.m_tot, "t", "m_tot", 1e3, 4),
        *base,
        *top,
        fact("Half width of the base B", p.half_width, "m", "half_width"),
        *shift,
        fact(f"Slenderness {slope}", height / p.half_width, "", "slenderness"),
        *_limits(p),
        fact("Inertia about a pivot I_θ", pivot.i_theta, "t m²", "i_theta", 1e3, 4),
        *held,
        fact("Resisting moment M_r", p.resisting_moment, unit, "resisting_moment", size, 4),
        fact("Uplift at a_lift = M_r/L_0", p.uplift_acceleration, "g", "uplift_acceleration", GRAVITY),
    ]


def _limits(p: RockingProperties) -> list[Fact]:
    """Return θ_nom, and α where the static moment vanishes at all; about both edges if they differ."""
    height, found = "h*_1" if p.n_modes else "h", list[Fact]()
    for pivot, name, width in zip(p.pivots, ("right", "left"), ("B − e", "B + e"), strict=False):
        one = p.symmetric
        label = "θ_nom" if one else f"θ_nom {name}"
        arm = "B" if not p.eccentricity else f"({width})"
        nominal, end = pivot.nominal_overturning_rotation, "" if one else f"_{name}"
        found.append(fact(f"{label} = 0.7 atan({arm}/{height})", nominal, "mrad", f"nominal{end}", 1e-3))
        if math.isfinite(pivot.balance_rotation):
            slope = "(L_0 g)" if not p.tendons else "(L_0 g − k_t)"
            found.append(
                fact(f"α{'' if one else f' {name}'} = M_r/{slope}", pivot.balance_rotation, "mrad", f"alpha{end}", 1e-3)
            )
    return found


def mode_table(p: RockingProperties) -> Table | None:
    """Return the first modes, on a fixed base and while uplifted; None for a rigid block."""
    if not p.n_modes:
        return None
    uplifted = _uplifted(p)
    above = p.m_tot if p.base_mass is None else p.m_tot - p.base_mass
    shares = p.effective_mass / above
    rows: list[list[Cell]] = []
    for n in range(min(p.n_modes, LISTED)):
        beyond = None if uplifted is None else 2.0 * math.pi / float(uplifted.omega[n])
        damped = None if uplifted is None else float(uplifted.damping_ratio[n])
        rows.append(
            [
                Cell(str(n + 1)),
                shows(2.0 * math.pi / float(p.omega[n]), "period"),
                shows(beyond, "uplifted_period"),
                shows(float(shares[n]), "mass_share", 0.01),
                shows(float(p.effective_height[n]), "effective_height"),
                shows(float(p.zeta[n]), "zeta", 0.01),
                shows(damped, "uplifted_damping_ratio", 0.01),
            ]
        )
    total = Cell(f"1–{p.n_modes}" if p.n_modes > LISTED else "Σ")
    if p.n_modes > 1:
        empty = Cell("")
        rows.append([total, empty, empty, shows(float(np.sum(shares)), "mass_share", 0.01), empty, empty, empty])
    share = "m*_n/m_tot" if p.base_mass is None else "m*_n/Σm"
    heads = [("mode", ""), ("T_n", "s"), ("T*_n", "s"), (share, "%"), ("h*_n", "m"), ("ζ_n", "%"), ("ζ*_n", "%")]
    return Table(heads, rows)


def _uplifted(p: RockingProperties) -> UpliftedModes | None:
    try:
        return uplifted_modes(p) if p.n_modes <= _MOST_UPLIFTED else None
    except (InputError, SolverError):
        return None


def _words(structure: Any) -> str:
    """Return the name of a class in words."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", type(structure).__name__).capitalize()
