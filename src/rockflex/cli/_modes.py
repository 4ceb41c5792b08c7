"""``rockflex modes``: modes and rocking parameters of a structure."""

import math
from typing import TYPE_CHECKING, Annotated, Any

import typer

from rockflex.cli import _console as console
from rockflex.cli import _options as options
from rockflex.cli import _output as output
from rockflex.cli._options import flag_values
from rockflex.foundation.errors import InputError
from rockflex.foundation.schema import FrameFlags
from rockflex.foundation.units import UnitSystem

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable
    from pathlib import Path

    from rockflex.cli._structures import LoadedStructure
    from rockflex.structure._adequacy import Adequacy
    from rockflex.structure._pivot import Pivot
    from rockflex.structure._rocking import RockingProperties


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
SHOWN = 10  # modes that are printed without --all
SIDES = {1: "right", -1: "left"}


def modes(
    context: typer.Context,
    file: Annotated[
        str | None, typer.Argument(metavar="STRUCTURE.toml", help="The structure file.", show_default=False)
    ] = None,
    structure: options.StructureFile = None,
    n_modes: Annotated[int | None, options.option("--modes", "N", "Show only the first N modes.")] = None,
    every: Annotated[
        bool, typer.Option("--all", help="Print all modes, not only the first ten; files and --json have them anyway.")
    ] = False,
    adequacy: Annotated[
        bool,
        typer.Option(
            "--adequacy", help="Report how many modes the structure needs, and why; --modes does not limit this."
        ),
    ] = False,
    output_units: options.OutputUnits = None,
    decimal_comma: options.DecimalComma = False,  # noqa: ARG001  its callback tells the console
    json: options.Json = False,
    out: options.Out = None,
    force: options.Force = False,
) -> None:
    """Print the modes of a structure on a fixed base, and its rocking parameters."""
    from rockflex.cli._structures import (
        ELEMENT_UNITS,
        describe_rocking_properties,
        load_structure,
        split_structure_file_argument,
    )
    from rockflex.foundation.checks import checked_whole_number
    from rockflex.structure._adequacy import adequacy as adequacy_of

    output.check_output_folder(out, force=force)
    path, rest = split_structure_file_argument(structure, [] if file is None else [file])
    if rest:
        raise InputError(f"{file} is not a structure file: a name that ends in .toml is expected.")
    loaded = load_structure(path, flag_values(context, FrameFlags))
    properties = loaded.properties
    if n_modes is not None:
        properties = properties.truncated(checked_whole_number("--modes", n_modes, 1, properties.n_modes))
    rows = _fixed_base_mode_rows(loaded, properties)
    lifted = _uplifted_mode_rows(properties)
    rocking = describe_rocking_properties(properties)
    document: dict[str, Any] = {
        "versions": output.versions(),
        "structure": loaded.describe(),
        "modes": rows,
        "uplifted": lifted,
        "rocking": {name: value for name, value in rocking.items() if isinstance(value, float) or name in LISTED},
        "units": UNITS | ELEMENT_UNITS,
        "warnings": list(loaded.warnings),
    }
    need = adequacy_of(loaded.properties, base_mass=loaded.base_mass) if adequacy else None
    if need is not None:
        document["adequacy"] = _describe_adequacy(need)
    if out is not None:
        _write_modes(out, document, loaded, properties.n_modes, force=force)
    if json:
        typer.echo(output.to_json(document))
    else:
        most = properties.n_modes if every or n_modes is not None else SHOWN
        print_modes(loaded, rows, lifted, properties, UnitSystem(output_units or "kN"), most)
        if need is not None:
            _print_adequacy(need, need.n_modes if every else SHOWN)
    console.print_warnings(document["warnings"])


def _fixed_base_mode_rows(loaded: "LoadedStructure", properties: "RockingProperties") -> list[dict[str, Any]]:
    """One row per mode, in SI units; the share refers to the mass above the base if known, else to the total mass."""
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
    from rockflex.structure._uplifted import uplifted_modes

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


def _describe_adequacy(need: "Adequacy") -> dict[str, Any]:
    """Return the result for a document; each row refers to the first k modes."""
    from dataclasses import asdict

    of_rows = ("base_moment", "base_moment_left", "base_shear", "base_shear_left", "frequency_error")
    rows = _mode_rows_of_columns(modes=range(1, need.n_modes + 1), **{name: getattr(need, name) for name in of_rows})
    head = {name: getattr(need, name) for name in ("model", "model_for_shear", "reason")}
    rest = {name: getattr(need, name) for name in ("reference_error", "mass", "base_known")}
    return {**head, "rows": rows, **rest, "tolerance": asdict(need.tolerance)}


def _print_adequacy(need: "Adequacy", most: int) -> None:
    mass = "m*_n/Σm" if need.base_known else "m*_n/m_tot"
    headings = ("modes", "m*_n h*_n/L_0^r", "left out [%]", mass, "left out [%]", "ω*_1 error [%]", "ω*_2 error [%]")
    columns = (
        need.base_moment,
        100.0 * need.base_moment_left,
        need.base_shear,
        100.0 * need.base_shear_left,
        *(100.0 * need.frequency_error).T,
    )
    rows = [
        [str(k + 1), *(console.number(float(column[k]), 3) for column in columns)]
        for k in range(min(need.n_modes, most))
    ]
    console.print_line("\nNumber of modes needed")
    console.print_rows(headings, rows)
    console.print_line()
    console.print_line(need.reason, wrap=True)


def _write_modes(
    folder: "Path", document: dict[str, Any], loaded: "LoadedStructure", n_modes: int, *, force: bool
) -> None:
    import pandas as pd

    from rockflex.structure._outline import has_shapes

    built: Any = loaded.built
    drawn = has_shapes(built)
    with output.staged_output_folder(folder, document, force=force) as stage:
        # As in the printed tables: each mode on a fixed base, then the mode of the same number while uplifted.
        lifted = pd.DataFrame(document["uplifted"]).drop(columns="mode", errors="ignore").add_prefix("uplifted_")
        pd.DataFrame(document["modes"]).join(lifted).to_csv(stage / "modes.csv", index=False, lineterminator="\n")
        if drawn:
            from rockflex.plot._figures import save_figure
            from rockflex.plot._structure import plot_mode_shapes

            modes = built.modal()  # pyright: ignore[reportAttributeAccessIssue]
            save_figure(plot_mode_shapes(modes, n_modes=n_modes), stage / "mode-shapes.png")
    console.print_remark(
        f"Written to {folder}" + ("" if drawn else f"; no figure, because [{loaded.kind}] has no mode shapes")
    )


Rows = list[dict[str, Any]]


def print_modes(
    loaded: "LoadedStructure", rows: Rows, lifted: Rows, p: "RockingProperties", units: UnitSystem, most: int
) -> None:
    """Print the modes on a fixed base and while uplifted, and the rocking parameters, for each edge if they differ.

    Of the modes the first `most` are printed.
    """
    console.print_line(f"{loaded.title}\n")
    share = "m*_n/m_tot" if loaded.base_mass is None else "m*_n/Σm"
    if rows:
        length = units.of("length")
        headings = ("mode", "T_n [s]", "ω_n [rad/s]", share, length.heading("h*_n"), "Γ_n φ_top", "ζ_n")
        measured = [{**row, "effective_height": row["effective_height"] / length.size} for row in rows[:most]]
        console.print_rows(
            headings, _mode_cells(measured, "period omega mass_share effective_height top_ordinate zeta")
        )
        for side in ("",) if p.symmetric else ("right", "left"):
            about = f" about the {side} edge" if side else ""
            note = "" if side == "left" else "; with fewer (--modes) ζ*_n differs"
            console.print_line(f"\nWhile uplifted{about}, with these modes{note}", wrap=True)
            kept = [row for row in lifted if row.get("side", "") == side][:most]
            headings = ("mode", "T*_n [s]", "ω*_n [rad/s]", "ω*_n/ω_n", "ζ*_n")
            console.print_rows(headings, _mode_cells(kept, "period omega ratio zeta"))
        if len(rows) > most:
            console.print_line(f"\nThe first {most} of {len(rows)} modes; --all prints the others.")
        console.print_line()
    total = sum(float(row["mass_share"]) for row in rows)
    values: tuple[tuple[object, str, float, tuple[str, ...]], ...] = (
        (rows, f"Sum of {share}", total, ("ratio",)),
        (p.symmetric, "Moment of inertia about a pivot, I_θ", p.i_theta, ("inertia", "kg m²")),
        (True, "First moment of mass, L_0^r", p.l0r, ("first moment of mass", "kg m")),
        (True, "Total mass with the base, m_tot", p.m_tot, ("mass", "kg")),
        (p.leaning_mass, "Leaning mass", p.leaning_mass, ("mass", "kg")),
        (p.leaning_mass, "Share of the weight on the base", p.weight_share, ("ratio",)),
        (True, "Half width of the base, B", p.half_width, ("length",)),
        (p.eccentricity, "Masses to the right of its middle, e", p.eccentricity, ("length",)),
        (p.tendons, "Initial force of the tendons, P", p.prestress, ("force",)),
        (p.opens != "both", f"Opens to the {p.opens} alone, restitution", p.restitution or 0.0, ("ratio",)),
    )
    wanted = ((name, value, units.of(*quantity)) for asked, name, value, quantity in values if asked)
    cells = [(name, console.number(value / size), unit) for name, value, (size, unit) in wanted]
    of_pivots = _parameters_of_pivots(p, units)
    # Where both pivots are alike, one column has the values of both.
    console.print_rows(
        ("Rocking", "", ""), (*cells, *((name, right, unit) for name, right, _, unit in of_pivots if p.symmetric))
    )
    if not p.symmetric:
        console.print_line()
        console.print_rows(("About the edge", "right", "left", ""), of_pivots)
    if p.elements:
        from rockflex.cli._structures import elements_table

        console.print_line("\nBetween base and ground, x to the right of the masses")
        console.print_table(elements_table(p.elements, units))


def _parameters_of_pivots(p: "RockingProperties", units: UnitSystem) -> list[tuple[str, str, str, str]]:
    """Return the name, the values about the right and the left pivot, and the unit of what depends on the pivot."""
    right, left, moment = p.pivot(1), p.pivot(-1), units.of("moment", largest=p.resisting_moment).name
    rows: list[tuple[str, str, str, str]] = []

    def row(name: str, of: "Callable[[Pivot], float | str]", *quantity: str) -> None:
        unit = units.of(*quantity, largest=p.resisting_moment)
        both = (of(right), of(left))
        first, second = (each if isinstance(each, str) else console.number(each / unit.size) for each in both)
        rows.append((name, first, second, unit.name))

    width = "B" if p.symmetric else "b"
    slenderness = f"{width}/h*_1" if p.n_modes else f"{width} m_tot/L_0^r"
    if not p.symmetric:
        row("Distance from the masses, b", lambda pivot: pivot.arm, "length")
        row("Moment of inertia, I_θ", lambda pivot: pivot.i_theta, "inertia", "kg m²")
    if p.tendons:
        name = "Their stiffness while rocking" if p.symmetric else "Stiffness of the tendons"
        row(name, lambda pivot: pivot.tendon_stiffness, "rotational stiffness", f"{moment}/rad")
    formula = f" = {'(m_tot g + P)' if p.tendons else 'm_tot g'} B" if p.symmetric else ""
    row(f"Resisting moment, M_r{formula}", lambda pivot: pivot.resisting_moment, "moment")
    formula = " = M_r/L_0^r" if p.symmetric else ""
    row(f"Static uplift at a_lift{formula}", lambda pivot: pivot.uplift_acceleration, "acceleration", "m/s²")
    if right.dissipator_moment or left.dissipator_moment:
        row("Moment of the dissipators, M_d", lambda pivot: pivot.dissipator_moment, "moment")
        row("Re-centring ratio, M_r/M_d", lambda pivot: pivot.recentring_ratio, "ratio")
        row(
            "Least moment that lifts it after yielding, M_r - M_d",
            lambda pivot: max(pivot.resisting_moment - pivot.dissipator_moment, 0.0),
            "moment",
        )
        row("Self-centring", lambda pivot: "yes" if pivot.self_centring else "no: it may stay open", "ratio")
    row(
        f"Nominal limit, 0.7 atan({slenderness})",
        lambda pivot: pivot.nominal_overturning_rotation,
        "rotation",
        "rad",
    )
    return rows


def _mode_cells(rows: Rows, keys: str) -> list[list[str]]:
    return [[str(row["mode"]), *(console.number(float(row[key])) for key in keys.split())] for row in rows]
