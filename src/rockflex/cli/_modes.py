"""``rockflex modes``: modes and rocking parameters of a structure."""

from typing import TYPE_CHECKING, Annotated, Any

import typer

from rockflex._errors import InputError
from rockflex._number_format import moment_unit
from rockflex._schema import FrameFlags
from rockflex.cli import _options as options
from rockflex.cli._console import (
    console_table,
    number_for_console,
    print_console_table,
    print_remark,
    print_warning_messages,
    stdout_console,
)
from rockflex.cli._options import flag_values
from rockflex.cli._output import check_output_folder, document_to_json, staged_output_folder, versions_in_results

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

    from rockflex.cli._structures import LoadedStructure
    from rockflex.modal import Adequacy, Pivot, RockingProperties


EPILOG = """[bold]Examples[/bold]

rockflex modes structure.toml

rockflex modes structure.toml --modes 3 --json

rockflex modes structure.toml --adequacy

rockflex modes --stories 5 --story-height 3 --story-mass 40e3 --base-mass 40e3 --stiffness-ratio inf \
--period 1 --aspect-ratio 10 --damping-ratio 0.02 --out modes"""

UNITS = {
    "period": "s",
    "omega": "rad/s",
    "effective_mass": "kg",
    "effective_height": "m",
    "i_theta": "kg m²",
    "l0r": "kg m",
    "m_tot": "kg",
    "half_width": "m",
    "resisting_moment": "N m",
    "uplift_acceleration": "m/s²",
    "nominal_overturning_rotation": "rad",
    "translational_inertia": "kg m²",
    "prestress": "N",
    "tendon_stiffness": "N m/rad",
    "eccentricity": "m",
    "arm": "m",
    "weight_moment": "N m",
    "prestress_moment": "N m",
    "axial_stiffness_moment": "N/rad",
    "dissipator_moment": "N m",
    "rocking_stiffness": "N m/rad",
}
LISTED = ("self_centring", "elements", "pivots")
SIDES = {1: "right", -1: "left"}


def modes(
    context: typer.Context,
    file: Annotated[
        str | None, typer.Argument(metavar="STRUCTURE.toml", help="The structure file.", show_default=False)
    ] = None,
    structure: options.StructureFile = None,
    n_modes: Annotated[int | None, typer.Option("--modes", metavar="N", help="Show only the first N modes.")] = None,
    adequacy: Annotated[
        bool,
        typer.Option(
            "--adequacy", help="Report how many modes the structure needs, and why; --modes does not limit this."
        ),
    ] = False,
    json: options.Json = False,
    out: options.Out = None,
    force: options.Force = False,
) -> None:
    """Print the modes of a structure on a fixed base, and its rocking parameters."""
    from rockflex._checks import checked_whole_number
    from rockflex.cli._structures import (
        ELEMENT_UNITS,
        describe_rocking_properties,
        load_structure,
        split_structure_file_argument,
    )

    check_output_folder(out, force=force)
    path, rest = split_structure_file_argument(structure, [] if file is None else [file])
    if rest:
        raise InputError(f"{file} is not a structure file: a name that ends in .toml is expected.")
    loaded = load_structure(path, flag_values(context, FrameFlags))
    properties = loaded.properties
    if n_modes is not None:
        properties = properties.truncated(checked_whole_number("n_modes", n_modes, 1, properties.n_modes))
    rows = _fixed_base_mode_rows(loaded, properties)
    lifted = _uplifted_mode_rows(properties)
    rocking = describe_rocking_properties(properties)
    document: dict[str, Any] = {
        "versions": versions_in_results(),
        "structure": loaded.describe(),
        "modes": rows,
        "uplifted": lifted,
        "rocking": {name: value for name, value in rocking.items() if isinstance(value, float) or name in LISTED},
        "units": UNITS | ELEMENT_UNITS,
        "warnings": list(loaded.warnings),
    }
    need = _adequacy_of_loaded(loaded) if adequacy else None
    if need is not None:
        document["adequacy"] = _describe_adequacy(need)
    if out is not None:
        _write_modes(out, document, loaded, properties.n_modes, force=force)
    if json:
        typer.echo(document_to_json(document))
    else:
        print_modes(loaded, rows, lifted, properties)
        if need is not None:
            _print_adequacy(need)
    print_warning_messages(document["warnings"])


def _fixed_base_mode_rows(loaded: "LoadedStructure", properties: "RockingProperties") -> list[dict[str, Any]]:
    """One row per mode, in SI units; the share refers to the mass above the base if known, else to the total mass."""
    import math

    return _mode_rows_of_columns(
        mode=range(1, properties.n_modes + 1),
        period=2.0 * math.pi / properties.omega,
        omega=properties.omega,
        effective_mass=properties.effective_mass,
        mass_share=properties.effective_mass / loaded.reference_mass,
        effective_height=properties.effective_height,
        top_ordinate=properties.top_ordinate,
        zeta=properties.zeta,
    )


def _uplifted_mode_rows(properties: "RockingProperties") -> list[dict[str, Any]]:
    """One row per vibration about a pivot, or about both where they differ, with the same modes, in SI units."""
    import math

    from rockflex.modal import uplifted_modes

    rows: list[dict[str, Any]] = []
    for pivot in properties.pivots:
        found = uplifted_modes(properties, side=pivot.side)
        about = {} if properties.symmetric else {"side": SIDES[pivot.side]}
        found = _mode_rows_of_columns(
            mode=range(1, properties.n_modes + 1),
            period=2.0 * math.pi / found.omega,
            omega=found.omega,
            ratio=found.ratio,
            zeta=found.damping_ratio,
        )
        rows += [about | row for row in found]
    return rows


def _mode_rows_of_columns(**columns: "Iterable[Any]") -> list[dict[str, Any]]:
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]


def _adequacy_of_loaded(loaded: "LoadedStructure") -> "Adequacy":
    from rockflex.modal import adequacy

    return adequacy(loaded.properties, base_mass=loaded.base_mass)


def _describe_adequacy(need: "Adequacy") -> dict[str, Any]:
    """Return the result for a document; each row refers to the first k modes."""
    from dataclasses import asdict

    of_rows = ("base_moment", "base_moment_left", "base_shear", "base_shear_left", "frequency_error")
    rows = _mode_rows_of_columns(modes=range(1, need.n_modes + 1), **{name: getattr(need, name) for name in of_rows})
    head = {name: getattr(need, name) for name in ("model", "model_for_shear", "reason")}
    rest = {name: getattr(need, name) for name in ("reference_error", "mass", "base_known")}
    return {**head, "rows": rows, **rest, "tolerance": asdict(need.tolerance)}


def _print_adequacy(need: "Adequacy") -> None:

    console = stdout_console()
    mass = "m*_n/Σm" if need.base_known else "m*_n/m_tot"
    headings = ("modes", "m*_n h*_n/L_0^r", "left out [%]", mass, "left out [%]", "ω*_1 error [%]", "ω*_2 error [%]")
    columns = (
        need.base_moment,
        100.0 * need.base_moment_left,
        need.base_shear,
        100.0 * need.base_shear_left,
        *(100.0 * need.frequency_error).T,
    )
    rows = [[str(k + 1), *(number_for_console(float(column[k]), 3) for column in columns)] for k in range(need.n_modes)]
    console.print("\nNumber of modes needed", markup=False)
    print_console_table(console, console_table(headings, rows))
    console.print()
    console.print(need.reason, markup=False)


def _write_modes(
    folder: "Path", document: dict[str, Any], loaded: "LoadedStructure", n_modes: int, *, force: bool
) -> None:
    import pandas as pd

    from rockflex.modal import RockingProperties

    built = loaded.built
    drawn = not isinstance(built, RockingProperties)
    with staged_output_folder(folder, document, force=force) as stage:
        # As in the printed tables: each mode on a fixed base, then the mode of the same number while uplifted.
        lifted = pd.DataFrame(document["uplifted"]).drop(columns="mode", errors="ignore").add_prefix("uplifted_")
        pd.DataFrame(document["modes"]).join(lifted).to_csv(stage / "modes.csv", index=False, lineterminator="\n")
        if drawn:
            from rockflex.plot import plot_mode_shapes, save_figure

            save_figure(plot_mode_shapes(built.modal(), n_modes=n_modes), stage / "mode-shapes.png")
    print_remark(f"Written to {folder}" + ("" if drawn else f"; no figure, because [{loaded.kind}] has no mode shapes"))


Rows = list[dict[str, Any]]


def print_modes(loaded: "LoadedStructure", rows: Rows, lifted: Rows, p: "RockingProperties") -> None:
    """Print the modes on a fixed base and while uplifted, and the rocking parameters, for each edge if they differ."""
    console = stdout_console()
    console.print(f"{loaded.title}\n", markup=False, soft_wrap=True)
    share = "m*_n/m_tot" if loaded.base_mass is None else "m*_n/Σm"
    headings = ("mode", "T_n [s]", "ω_n [rad/s]", share, "h*_n [m]", "Γ_n φ_top", "ζ_n")
    keys = ("period", "omega", "mass_share", "effective_height", "top_ordinate", "zeta")
    if rows:
        print_console_table(console, console_table(headings, _mode_cells(rows, keys)))
        headings, keys = ("mode", "T*_n [s]", "ω*_n [rad/s]", "ω*_n/ω_n", "ζ*_n"), ("period", "omega", "ratio", "zeta")
        for side in ("",) if p.symmetric else ("right", "left"):
            about = f" about the {side} edge" if side else ""
            note = "" if side == "left" else "; with fewer (--modes) ζ*_n differs"
            console.print(f"\nWhile uplifted{about}, with these modes{note}", markup=False)
            kept = [row for row in lifted if row.get("side", "") == side]
            print_console_table(console, console_table(headings, _mode_cells(kept, keys)))
        console.print()
    total = [(f"Sum of {share}", number_for_console(sum(float(row["mass_share"]) for row in rows)), "")] if rows else []
    inertia = ("Moment of inertia about a pivot, I_θ", number_for_console(p.i_theta), "kg m²")
    values = (
        *total,
        *([inertia] if p.symmetric else []),
        ("First moment of mass, L_0^r", number_for_console(p.l0r), "kg m"),
        ("Total mass with the base, m_tot", number_for_console(p.m_tot), "kg"),
        *([("Leaning mass", number_for_console(p.leaning_mass), "kg")] if p.leaning_mass else []),
        *([("Share of the weight on the base", number_for_console(p.weight_share), "")] if p.leaning_mass else []),
        ("Half width of the base, B", number_for_console(p.half_width), "m"),
        *(
            [("Masses to the right of its middle, e", number_for_console(p.eccentricity), "m")]
            if p.eccentricity
            else []
        ),
        *([("Initial force of the tendons, P", number_for_console(p.prestress / 1e3), "kN")] if p.tendons else []),
        *(_parameters_of_both_pivots(p) if p.symmetric else []),
    )
    print_console_table(console, console_table(("Rocking", "", ""), values))
    if not p.symmetric:
        console.print()
        print_console_table(
            console, console_table(("About the edge", "right", "left", ""), _parameters_of_each_pivot(p))
        )
    if p.elements:
        from rockflex.cli._structures import elements_table

        console.print("\nBetween base and ground, x to the right of the masses", markup=False)
        print_console_table(console, elements_table(p.elements))


def _parameters_of_both_pivots(p: "RockingProperties") -> list[tuple[str, str, str]]:
    """The parameters that are the same about both pivots."""
    size, unit = moment_unit(p.resisting_moment)
    stiffness = ("Their stiffness while rocking", number_for_console(p.tendon_stiffness / size), f"{unit}/rad")
    weight = "(m_tot g + P)" if p.tendons else "m_tot g"
    return [
        *([stiffness] if p.tendons else []),
        (f"Resisting moment, M_r = {weight} B", number_for_console(p.resisting_moment / size), unit),
        ("Static uplift at a_lift = M_r/L_0^r", number_for_console(p.uplift_acceleration), "m/s²"),
        *((name, values[0], unit) for name, values, unit in _self_centring_rows(p, size, unit)),
        (
            f"Nominal limit, 0.7 atan({_slenderness_formula(p, 'B')})",
            number_for_console(p.nominal_overturning_rotation),
            "rad",
        ),
    ]


def _parameters_of_each_pivot(p: "RockingProperties") -> list[tuple[str, str, str, str]]:
    """The parameters that differ between the pivots."""
    size, unit = moment_unit(p.resisting_moment)
    sides = (p.pivot(1), p.pivot(-1))

    def row(name: str, values: tuple[float, ...], unit: str) -> tuple[str, str, str, str]:
        return (name, number_for_console(values[0]), number_for_console(values[1]), unit)

    stiffness = tuple(each.tendon_stiffness / size for each in sides)
    nominal = tuple(each.nominal_overturning_rotation for each in sides)
    return [
        row("Distance from the masses, b", tuple(each.arm for each in sides), "m"),
        row("Moment of inertia, I_θ", tuple(each.i_theta for each in sides), "kg m²"),
        *([row("Stiffness of the tendons", stiffness, f"{unit}/rad")] if p.tendons else []),
        row("Resisting moment, M_r", tuple(each.resisting_moment / size for each in sides), unit),
        row("Static uplift at a_lift", tuple(each.uplift_acceleration for each in sides), "m/s²"),
        *((name, *values, unit) for name, values, unit in _self_centring_rows(p, size, unit)),
        row(f"Nominal limit, 0.7 atan({_slenderness_formula(p, 'b')})", nominal, "rad"),
    ]


def _self_centring_rows(p: "RockingProperties", size: float, unit: str) -> list[tuple[str, tuple[str, str], str]]:
    """Rows about the dissipators: the name, the values about the right and the left pivot, the unit."""
    right, left = p.pivot(1), p.pivot(-1)
    if not right.dissipator_moment and not left.dissipator_moment:
        return []

    def both(of: "Callable[[Pivot], str]") -> tuple[str, str]:
        return of(right), of(left)

    def least(pivot: "Pivot") -> str:
        return number_for_console(max(pivot.resisting_moment - pivot.dissipator_moment, 0.0) / size)

    return [
        (
            "Moment of the dissipators, M_d",
            both(lambda pivot: number_for_console(pivot.dissipator_moment / size)),
            unit,
        ),
        ("Re-centring ratio, M_r/M_d", both(lambda pivot: number_for_console(pivot.recentring_ratio)), ""),
        ("Least moment that lifts it after yielding, M_r - M_d", both(least), unit),
        ("Self-centring", both(lambda pivot: "yes" if pivot.self_centring else "no: it may stay open"), ""),
    ]


def _slenderness_formula(p: "RockingProperties", width: str) -> str:
    return f"{width}/h*_1" if p.n_modes else f"{width} m_tot/L_0^r"


def _mode_cells(rows: Rows, keys: tuple[str, ...]) -> list[list[str]]:
    return [[str(row["mode"]), *(number_for_console(float(row[key])) for key in keys)] for row in rows]
