"""The ground of ``rockflex run``, from its flags and the structure file."""

import math
from pathlib import Path
from typing import Any

import numpy as np

from rockflex._errors import InputError
from rockflex._schema import BedKeys, GroundKeys
from rockflex.cli._flags import flags_of, naming
from rockflex.modal import Ground, RockingProperties
from rockflex.structure.file import checked
from rockflex.study._ground_table import GroundTable

_INERTIA = {"base_inertia", "mat_mass"}
_FIELDS = {f"ground.{name}": (name, flag) for name, flag in flags_of(GroundKeys).items()} | {
    f"ground.bed.{name}": (name, flag) for name, flag in flags_of(BedKeys).items()
}


def make_ground(
    file: Path | None, in_file: dict[str, Any], flags: dict[str, Any], properties: RockingProperties
) -> tuple[Ground | None, dict[str, Any]]:
    """Combine the ground of a structure file with that of flags, which take precedence.

    Parameters
    ----------
    file, in_file
        The structure file, and its table [ground]; empty without one.
    flags
        Values by flags, named as in `GroundKeys` and `BedKeys`.
    properties
        The structure on the ground.

    Returns
    -------
    Ground or None, dict
        The ground, None if it is rigid and the base cannot slide, and its values as given.

    Raises
    ------
    InputError
        If the values contradict each other or one is out of range.
    """
    if not in_file and not flags:
        return None, {}
    table = checked(GroundTable, _merged(in_file, flags))
    try:
        with naming({key: flag for key, (name, flag) in _FIELDS.items() if name in flags}):
            return table.under(properties), table.model_dump(exclude_none=True)
    except InputError as error:
        if flags:
            raise
        raise InputError(f"{file}, {error}") from error


def ground_remarks(ground: Ground, properties: RockingProperties) -> list[str]:
    """Return the ground under a structure in lines, for the head of a table."""
    lines: list[str] = []
    if ground.springs is not None:
        springs = ground.springs
        ratio = 0.5 * springs.total_damping / math.sqrt(springs.total_stiffness * properties.m_tot)
        lines.append(
            f"Ground: {springs.n} springs, Σk = {springs.total_stiffness:.4g} N/m, Σk x² = "
            f"{springs.rotational_stiffness:.4g} N m/rad, Σc = {springs.total_damping:.4g} N s/m ({ratio:.3g} of "
            f"critical in heave), I_b = {ground.base_inertia:.4g} kg m²"
        )
    if ground.friction is not None:
        least, most = np.min(ground.friction), np.max(ground.friction)
        lines.append(f"Friction: μ = {least:g}" + ("" if least == most else f" to {most:g}"))
    return lines


def _merged(in_file: dict[str, Any], flags: dict[str, Any]) -> dict[str, Any]:
    own = {name: flags[name] for name in flags_of(GroundKeys) if name in flags}
    bed = {name: flags[name] for name in flags_of(BedKeys) if name in flags}
    replaced = _INERTIA if own.keys() & _INERTIA else set[str]()
    merged = {name: value for name, value in in_file.items() if name not in replaced} | own
    if not bed:
        return merged
    if "springs" in merged:
        raise InputError(
            "The ground of the structure file has springs, and the command line gives a bed "
            f"({', '.join(flags_of(BedKeys)[name] for name in bed)}). Leave one of them out."
        )
    merged["bed"] = merged.get("bed", {}) | bed
    if "breadth" not in merged["bed"]:
        raise InputError("A bed of springs needs the breadth of the base. Give --breadth M in m.", field="breadth")
    return merged
