"""``rockflex modes``: modes and rocking parameters of a structure."""

from typing import TYPE_CHECKING, Annotated, Any

import typer

from rockflex._errors import InputError
from rockflex._schema import FrameFlags
from rockflex.cli import _options as options
from rockflex.cli._flags import given

if TYPE_CHECKING:
    from collections.abc import Iterable
    from pathlib import Path

    from rockflex.cli._structures import LoadedStructure
    from rockflex.modal import Adequacy, RockingProperties

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
    from rockflex._checks import whole_number
    from rockflex.cli._console import warn
    from rockflex.cli._elements import UNITS as ELEMENT_UNITS
    from rockflex.cli._modes_tables import print_modes
    from rockflex.cli._output import check_folder, to_json, versions
    from rockflex.cli._structures import describe_properties, load_structure, split_arguments

    check_folder(out, force=force)
    path, rest = split_arguments(structure, [] if file is None else [file])
    if rest:
        raise InputError(f"{file} is not a structure file: a name that ends in .toml is expected.")
    loaded = load_structure(path, given(context, FrameFlags))
    properties = loaded.properties
    if n_modes is not None:
        properties = properties.truncated(whole_number("n_modes", n_modes, 1, properties.n_modes))
    rows = _rows(loaded, properties)
    lifted = _uplifted_rows(properties)
    rocking = describe_properties(properties)
    document: dict[str, Any] = {
        "versions": versions(),
        "structure": loaded.describe(),
        "modes": rows,
        "uplifted": lifted,
        "rocking": {name: value for name, value in rocking.items() if isinstance(value, float) or name in LISTED},
        "units": UNITS | ELEMENT_UNITS,
        "warnings": list(loaded.warnings),
    }
    need = _adequacy(loaded) if adequacy else None
    if need is not None:
        document["adequacy"] = _describe_adequacy(need)
    if out is not None:
        _write(out, document, loaded, properties.n_modes, force=force)
    if json:
        typer.echo(to_json(document))
    else:
        print_modes(loaded, rows, lifted, properties)
        if need is not None:
            _print_adequacy(need)
    warn(document["warnings"])


def _rows(loaded: "LoadedStructure", properties: "RockingProperties") -> list[dict[str, Any]]:
    """One row per mode, in SI units; the share refers to the mass above the base if known, else to the total mass."""
    import math

    return _table(
        mode=range(1, properties.n_modes + 1),
        period=2.0 * math.pi / properties.omega,
        omega=properties.omega,
        effective_mass=properties.effective_mass,
        mass_share=properties.effective_mass / loaded.reference_mass,
        effective_height=properties.effective_height,
        top_ordinate=properties.top_ordinate,
        zeta=properties.zeta,
    )


def _uplifted_rows(properties: "RockingProperties") -> list[dict[str, Any]]:
    """One row per vibration about a pivot, or about both where they differ, with the same modes, in SI units."""
    import math

    from rockflex.modal import uplifted_modes

    rows: list[dict[str, Any]] = []
    for pivot in properties.pivots:
        found = uplifted_modes(properties, side=pivot.side)
        about = {} if properties.symmetric else {"side": SIDES[pivot.side]}
        found = _table(
            mode=range(1, properties.n_modes + 1),
            period=2.0 * math.pi / found.omega,
            omega=found.omega,
            ratio=found.ratio,
            zeta=found.damping_ratio,
        )
        rows += [about | row for row in found]
    return rows


def _table(**columns: "Iterable[Any]") -> list[dict[str, Any]]:
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]


def _adequacy(loaded: "LoadedStructure") -> "Adequacy":
    from rockflex.modal import adequacy

    return adequacy(loaded.properties, base_mass=loaded.base_mass)


def _describe_adequacy(need: "Adequacy") -> dict[str, Any]:
    """Return the result for a document; each row refers to the first k modes."""
    from dataclasses import asdict

    of_rows = ("base_moment", "base_moment_left", "base_shear", "base_shear_left", "frequency_error")
    rows = _table(modes=range(1, need.n_modes + 1), **{name: getattr(need, name) for name in of_rows})
    head = {name: getattr(need, name) for name in ("model", "model_for_shear", "reason")}
    rest = {name: getattr(need, name) for name in ("reference_error", "mass", "base_known")}
    return {**head, "rows": rows, **rest, "tolerance": asdict(need.tolerance)}


def _print_adequacy(need: "Adequacy") -> None:
    from rockflex.cli._console import grid, number, output, show

    console = output()
    mass = "m*_n/Σm" if need.base_known else "m*_n/m_tot"
    headings = ("modes", "m*_n h*_n/L_0^r", "left out [%]", mass, "left out [%]", "ω*_1 error [%]", "ω*_2 error [%]")
    columns = (
        need.base_moment,
        100.0 * need.base_moment_left,
        need.base_shear,
        100.0 * need.base_shear_left,
        *(100.0 * need.frequency_error).T,
    )
    rows = [[str(k + 1), *(number(float(column[k]), 3) for column in columns)] for k in range(need.n_modes)]
    console.print("\nNumber of modes needed", markup=False)
    show(console, grid(headings, rows))
    console.print()
    console.print(need.reason, markup=False)


def _write(folder: "Path", document: dict[str, Any], loaded: "LoadedStructure", n_modes: int, *, force: bool) -> None:
    import pandas as pd

    from rockflex.cli._console import note
    from rockflex.cli._output import staged
    from rockflex.modal import RockingProperties

    built = loaded.built
    drawn = not isinstance(built, RockingProperties)
    with staged(folder, document, force=force) as stage:
        # As in the printed tables: each mode on a fixed base, then the mode of the same number while uplifted.
        lifted = pd.DataFrame(document["uplifted"]).drop(columns="mode", errors="ignore").add_prefix("uplifted_")
        pd.DataFrame(document["modes"]).join(lifted).to_csv(stage / "modes.csv", index=False, lineterminator="\n")
        if drawn:
            from rockflex.plot import plot_mode_shapes, save_figure

            save_figure(plot_mode_shapes(built.modal(), n_modes=n_modes), stage / "mode-shapes.png")
    note(f"Written to {folder}" + ("" if drawn else f"; no figure, because [{loaded.kind}] has no mode shapes"))
