"""The printed tables of ``rockflex modes``."""

from typing import TYPE_CHECKING, Any

from rockflex._numbers import moment_unit
from rockflex.cli._console import grid, number, output, show
from rockflex.cli._elements import elements_table

if TYPE_CHECKING:
    from collections.abc import Callable

    from rockflex.cli._structures import LoadedStructure
    from rockflex.modal import Pivot, RockingProperties

Rows = list[dict[str, Any]]


def print_modes(loaded: "LoadedStructure", rows: Rows, lifted: Rows, p: "RockingProperties") -> None:
    """Print the modes on a fixed base and while uplifted, and the rocking parameters, for each edge if they differ."""
    console = output()
    console.print(f"{loaded.title}\n", markup=False, soft_wrap=True)
    share = "m*_n/m_tot" if loaded.base_mass is None else "m*_n/Σm"
    headings = ("mode", "T_n [s]", "ω_n [rad/s]", share, "h*_n [m]", "Γ_n φ_top", "ζ_n")
    keys = ("period", "omega", "mass_share", "effective_height", "top_ordinate", "zeta")
    if rows:
        show(console, grid(headings, _numbers(rows, keys)))
        headings, keys = ("mode", "T*_n [s]", "ω*_n [rad/s]", "ω*_n/ω_n", "ζ*_n"), ("period", "omega", "ratio", "zeta")
        for side in ("",) if p.symmetric else ("right", "left"):
            about = f" about the {side} edge" if side else ""
            note = "" if side == "left" else "; with fewer (--modes) ζ*_n differs"
            console.print(f"\nWhile uplifted{about}, with these modes{note}", markup=False)
            kept = [row for row in lifted if row.get("side", "") == side]
            show(console, grid(headings, _numbers(kept, keys)))
        console.print()
    total = [(f"Sum of {share}", number(sum(float(row["mass_share"]) for row in rows)), "")] if rows else []
    inertia = ("Moment of inertia about a pivot, I_θ", number(p.i_theta), "kg m²")
    values = (
        *total,
        *([inertia] if p.symmetric else []),
        ("First moment of mass, L_0^r", number(p.l0r), "kg m"),
        ("Total mass with the base, m_tot", number(p.m_tot), "kg"),
        ("Half width of the base, B", number(p.half_width), "m"),
        *([("Masses to the right of its middle, e", number(p.eccentricity), "m")] if p.eccentricity else []),
        *([("Initial force of the tendons, P", number(p.prestress / 1e3), "kN")] if p.tendons else []),
        *(_alike(p) if p.symmetric else []),
    )
    show(console, grid(("Rocking", "", ""), values))
    if not p.symmetric:
        console.print()
        show(console, grid(("About the edge", "right", "left", ""), _each(p)))
    if p.elements:
        console.print("\nBetween base and ground, x to the right of the masses", markup=False)
        show(console, elements_table(p.elements))


def _alike(p: "RockingProperties") -> list[tuple[str, str, str]]:
    """The parameters that are the same about both pivots."""
    size, unit = moment_unit(p.resisting_moment)
    stiffness = ("Their stiffness while rocking", number(p.tendon_stiffness / size), f"{unit}/rad")
    weight = "(m_tot g + P)" if p.tendons else "m_tot g"
    return [
        *([stiffness] if p.tendons else []),
        (f"Resisting moment, M_r = {weight} B", number(p.resisting_moment / size), unit),
        ("Static uplift at a_lift = M_r/L_0^r", number(p.uplift_acceleration), "m/s²"),
        *((name, values[0], unit) for name, values, unit in _closing(p, size, unit)),
        (f"Nominal limit, 0.7 atan({_slope(p, 'B')})", number(p.nominal_overturning_rotation), "rad"),
    ]


def _each(p: "RockingProperties") -> list[tuple[str, str, str, str]]:
    """The parameters that differ between the pivots."""
    size, unit = moment_unit(p.resisting_moment)
    sides = (p.pivot(1), p.pivot(-1))

    def row(name: str, values: tuple[float, ...], unit: str) -> tuple[str, str, str, str]:
        return (name, number(values[0]), number(values[1]), unit)

    stiffness = tuple(each.tendon_stiffness / size for each in sides)
    nominal = tuple(each.nominal_overturning_rotation for each in sides)
    return [
        row("Distance from the masses, b", tuple(each.arm for each in sides), "m"),
        row("Moment of inertia, I_θ", tuple(each.i_theta for each in sides), "kg m²"),
        *([row("Stiffness of the tendons", stiffness, f"{unit}/rad")] if p.tendons else []),
        row("Resisting moment, M_r", tuple(each.resisting_moment / size for each in sides), unit),
        row("Static uplift at a_lift", tuple(each.uplift_acceleration for each in sides), "m/s²"),
        *((name, *values, unit) for name, values, unit in _closing(p, size, unit)),
        row(f"Nominal limit, 0.7 atan({_slope(p, 'b')})", nominal, "rad"),
    ]


def _closing(p: "RockingProperties", size: float, unit: str) -> list[tuple[str, tuple[str, str], str]]:
    """What the dissipators change about each pivot: the name, the values to the right and to the left, their unit."""
    right, left = p.pivot(1), p.pivot(-1)
    if not right.dissipator_moment and not left.dissipator_moment:
        return []

    def both(of: "Callable[[Pivot], str]") -> tuple[str, str]:
        return of(right), of(left)

    def least(pivot: "Pivot") -> str:
        return number(max(pivot.resisting_moment - pivot.dissipator_moment, 0.0) / size)

    return [
        ("Moment of the dissipators, M_d", both(lambda pivot: number(pivot.dissipator_moment / size)), unit),
        ("Re-centring ratio, M_r/M_d", both(lambda pivot: number(pivot.recentring_ratio)), ""),
        ("Least moment that lifts it after yielding, M_r - M_d", both(least), unit),
        ("Self-centring", both(lambda pivot: "yes" if pivot.self_centring else "no: it may stay open"), ""),
    ]


def _slope(p: "RockingProperties", width: str) -> str:
    return f"{width}/h*_1" if p.n_modes else f"{width} m_tot/L_0^r"


def _numbers(rows: Rows, keys: tuple[str, ...]) -> list[list[str]]:
    return [[str(row["mode"]), *(number(float(row[key])) for key in keys)] for row in rows]
