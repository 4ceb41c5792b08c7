"""The options of ``rockflex run``, from its flags and the structure file."""

import math
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any, cast

import numpy as np
import typer

from rockflex.cli._options import flag_values, flags_of_tables, naming_flags_in_errors
from rockflex.cli._structures import LoadedStructure
from rockflex.foundation.errors import InputError
from rockflex.foundation.schema import BoucWenSchema, GroundSchema, ImpactSchema, InitialStateSchema, SpringBedSchema
from rockflex.foundation.units import UnitSystem
from rockflex.models._bouc_wen import BoucWen
from rockflex.models._impact import restitution_left
from rockflex.models._label import parse_model
from rockflex.structure._ground import Ground
from rockflex.structure._rocking import RockingProperties
from rockflex.structure.file._toml_table import parse_toml_table
from rockflex.studies._arguments import InitialState, ground_under_structure
from rockflex.studies._case_keys import RunOptionKeys, impact_law_name
from rockflex.studies._ground_tables import GroundTable
from rockflex.studies._prepared_case import RunOptions, yielding_model_labels
from rockflex.studies.running import checked_work_limit

_INERTIA = {"base_inertia", "mat_mass"}
_FIELDS = {f"ground.{name}": (name, flag) for name, flag in flags_of_tables(GroundSchema).items()} | {
    f"ground.bed.{name}": (name, flag) for name, flag in flags_of_tables(SpringBedSchema).items()
}


def lines_about_ground(ground: Ground, properties: RockingProperties, units: UnitSystem) -> list[str]:
    """Return the ground under a structure in lines, for the head of a table."""
    lines: list[str] = []
    if ground.springs is not None:
        springs = ground.springs
        ratio = 0.5 * springs.total_damping / math.sqrt(springs.total_stiffness * properties.m_tot)
        sums = (
            (springs.total_stiffness, units.of("stiffness", "N/m")),
            (springs.rotational_stiffness, units.of("rotational stiffness", "N m/rad")),
            (springs.total_damping, units.of("damping", "N s/m")),
            (ground.base_inertia or 0.0, units.of("inertia", "kg m²")),
        )
        k, turning, c, inertia = (f"{value / unit.size:.4g} {unit.name}" for value, unit in sums)
        lines.append(
            f"Ground: {springs.n} springs, Σk = {k}, Σk x² = {turning}, Σc = {c} ({ratio:.3g} of critical in heave), "
            f"I_b = {inertia}"
        )
    if ground.friction is not None:
        least, most = np.min(ground.friction), np.max(ground.friction)
        lines.append(f"Friction: μ = {least:g}" + ("" if least == most else f" to {most:g}"))
    return lines


def _merged_ground_options(in_file: dict[str, Any], flags: dict[str, Any]) -> dict[str, Any]:
    own = {name: flags[name] for name in flags_of_tables(GroundSchema) if name in flags}
    bed = {name: flags[name] for name in flags_of_tables(SpringBedSchema) if name in flags}
    replaced = _INERTIA if own.keys() & _INERTIA else set[str]()
    merged = {name: value for name, value in in_file.items() if name not in replaced} | own
    if not bed:
        return merged
    if "springs" in merged:
        raise InputError(
            "The ground of the structure file has springs, and the command line gives a bed "
            f"({', '.join(flags_of_tables(SpringBedSchema)[name] for name in bed)}). Leave one of them out."
        )
    merged["bed"] = merged.get("bed", {}) | bed
    if "breadth" not in merged["bed"]:
        raise InputError("A bed of springs needs the breadth of the base. Give --breadth M in m.", field="breadth")
    return merged


USUAL = ("2DOF-S", "MDOF-S", "fixed")
RIGID = ("rigid", "rigid-C")
YIELDING = ("2DOF-S", "2DOF-S-BW", "1DOF-fixed-BW")


def describe_run_options(options: RunOptions, ground: dict[str, Any]) -> dict[str, Any]:
    """Return the options that were given, for a document; `ground` has the values of the ground as they were given."""
    described: dict[str, Any] = {}
    if options.impact is not None:
        described["impact"] = {"law": impact_law_name(options.impact), **asdict(cast("Any", options.impact))}
    if options.bouc_wen is not None:
        described["bouc_wen"] = asdict(options.bouc_wen)
    if options.initial is not None:
        described["initial_rotation"] = options.initial.rotation
    return described | ({"ground": ground} if ground else {})


def lines_about_run_options(options: RunOptions, properties: RockingProperties, units: UnitSystem) -> list[str]:
    """Return the options that were given in lines, for the head of a table of runs of a structure."""
    lines: list[str] = []
    if options.impact is not None:
        e, left = getattr(options.impact, "given_restitution", None), restitution_left(options.impact, properties)
        after = "" if left is None else f", {left[1]:.4g} from one half cycle to the next"
        lines.append(f"Impact: {impact_law_name(options.impact)}{'' if e is None else f', e = {e:g}'}{after}")
    if options.bouc_wen is not None:
        b, (size, unit) = options.bouc_wen, units.of("displacement", "m")
        lines.append(
            f"Hysteresis of -BW: D_y = {b.yield_displacement / size:g} {unit}, α = {b.post_yield_ratio:g}, "
            f"γ = {b.gamma:g}, β = {b.beta:g}, n = {b.exponent:g}"
        )
    if options.initial is not None:
        size, unit = units.of("rotation", "rad")
        lines.append(f"At rest at θ = {options.initial.rotation / size:g} {unit} at t = 0")
    ground = ground_under_structure(properties, options.ground)
    return lines if ground is None else [*lines, *lines_about_ground(ground, properties, units)]


def make_run_options(context: typer.Context, loaded: LoadedStructure) -> tuple[RunOptions, dict[str, Any]]:
    """Combine the options in a structure file with those given by flags, which take precedence.

    Return the options, without free vibration, and the values of the ground as they were given, empty for none.
    """
    law, initial = flag_values(context, ImpactSchema), flag_values(context, InitialStateSchema)
    keys = () if "impact" in law else flags_of_tables(ImpactSchema)
    below = {name: loaded.run_options[name] for name in keys if name in loaded.run_options}
    with naming_flags_in_errors(flags_of_tables(ImpactSchema)):
        chosen = parse_toml_table(RunOptionKeys, {**below, **law}).law()
    with naming_flags_in_errors(flags_of_tables(InitialStateSchema) | {"rotation": "--initial-rotation"}):
        start = InitialState(rotation=initial["initial_rotation"]) if initial else None
    hysteresis = _bouc_wen_of_options(context, loaded)
    base, values = _make_run_ground(context, loaded)
    return RunOptions(impact=chosen, bouc_wen=hysteresis, initial=start, ground=base), values


def _make_run_ground(context: typer.Context, loaded: LoadedStructure) -> tuple[Ground | None, dict[str, Any]]:
    """Return the ground, None if it is rigid and the base cannot slide, and its values as given."""
    flags = flag_values(context, GroundSchema) | flag_values(context, SpringBedSchema)
    in_file = loaded.run_options.get("ground", {})
    if not in_file and not flags:
        return None, {}
    table = parse_toml_table(GroundTable, _merged_ground_options(in_file, flags))
    try:
        with naming_flags_in_errors({key: flag for key, (name, flag) in _FIELDS.items() if name in flags}):
            return table.under(loaded.properties), table.model_dump(exclude_none=True)
    except InputError as error:
        if flags:
            raise
        raise InputError(f"{loaded.file}, {error}") from error


def choose_run_models(
    given: Sequence[str] | None, properties: RockingProperties, options: RunOptions, *, by_flag: bool
) -> list[str]:
    """Return the given labels, split at commas, or the usual ones, after checking that they suit the rest.

    `by_flag` tells that the hysteresis was given on the command line, where a model must use it.
    """
    if given is None:
        usual = USUAL if properties.n_modes else RIGID
        labels: list[str] = [*(usual if options.bouc_wen is None else YIELDING)]
        ground = ground_under_structure(properties, options.ground)
        if ground is not None and not ground.rigid:
            labels = [label for label in labels if parse_model(label).lifts]
        if options.initial is not None:
            labels = [label for label in labels if parse_model(label).lifts]
    else:
        labels = list(dict.fromkeys(label.strip() for item in given for label in item.split(",") if label.strip()))
    if not labels:
        raise InputError("No model was given. Expected labels such as 2DOF-S,MDOF-S,fixed.")
    models, yields = list(map(parse_model, labels)), yielding_model_labels(labels)
    if yields and options.bouc_wen is None:
        raise InputError(
            f"{yields[0]} needs its hysteresis. Give --yield-displacement, or [bouc_wen] in the structure file."
        )
    for model in models:
        tied = options.model_of(model, properties)
        if options.initial is not None:
            options.initial.state(tied)
    if by_flag and not yields:
        raise InputError(
            f"A hysteresis was given, but {', '.join(labels)} do not yield. Models whose label ends in -BW do, such as "
            "2DOF-S-BW, 2DOF-C-BW or 1DOF-fixed-BW: add one, or leave --yield-displacement out."
        )
    return labels


def number_or_word(text: str) -> Any:
    """Return a number where the text is one, and otherwise the text."""
    try:
        return float(text)
    except ValueError:
        return text


def parse_work_limit(given: str | None) -> float | None:
    """Return the limit of computing time in s, None for no limit, or the usual limit if none is given."""
    with naming_flags_in_errors({"work_limit": "--work-limit"}):
        return checked_work_limit("default" if given is None else number_or_word(given))


def _bouc_wen_of_options(context: typer.Context, loaded: LoadedStructure) -> BoucWen | None:
    flags = flag_values(context, BoucWenSchema)
    values = {**loaded.run_options.get("bouc_wen", {}), **flags}
    if not values:
        return None
    if "yield_displacement" not in values:
        raise InputError("The hysteresis needs its yield displacement. Give --yield-displacement DY in m.")
    named = {name: flag for name, flag in flags_of_tables(BoucWenSchema).items() if name in flags}
    try:
        with naming_flags_in_errors(named):
            return BoucWen(**values)
    except InputError as error:
        if flags:
            raise
        raise InputError(f"{loaded.file}, [bouc_wen]: {error}") from error
