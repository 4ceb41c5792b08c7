"""Structures from TOML files."""

import tomllib
from pathlib import Path
from typing import Any

from rockflex._errors import InputError
from rockflex._files import check_regular, path_of
from rockflex._shown import shortened
from rockflex.structure.file._entry import StructureEntry
from rockflex.structure.file._table import checked
from rockflex.structure.file._tables import Built

_FOR_RUNS = ("impact", "restitution", "bouc_wen", "ground")  # only for `rockflex run`


def read_structure(path: str | Path) -> Built:
    """Return the structure of a TOML file, the same file that the command line reads.

    The file holds one table, whose keys are the arguments of the class: ``[frame]`` (`Frame`), ``[fish_bone]``
    (`FishBone`), ``[wall_frame]`` (`WallFrame`), ``[tapered_tower]`` (`TaperedTower`), ``[cantilever]``
    (`CantileverWithTipMass`), ``[beam]`` (`Beam`, with lists of values at the heights ``z``), ``[lumped]``
    (`LumpedStructure`), ``[matrices]`` (`from_matrices`), ``[modes]`` (`from_modes`), ``[properties]``
    (`RockingProperties`) or ``[block]`` (`rigid_block`). Tables ``[[elements]]`` restrain it; their key ``kind`` is
    "tendon" (`Tendon`), "yielding_dissipator" (`YieldingDissipator`), "viscous_damper" (`ViscousDamper`) or
    "friction_damper" (`FrictionDamper`). Tables ``[[tendons]]`` are tendons without that key. A number ``eccentricity``
    above all tables moves the structure from the middle of its base (`Eccentric`). Units are kg, m, s, N and rad; paths
    of matrices are relative to the folder of the file.

    Parameters
    ----------
    path
        The file. The keys ``impact``, ``restitution``, ``[bouc_wen]`` and ``[ground]`` are for ``rockflex run`` and are
        ignored; in Python they are arguments of `simulate`.

    Returns
    -------
    Frame, Beam, ..., Eccentric, Restrained or RockingProperties

    Raises
    ------
    InputError
        If the file cannot be read, a key is unknown or missing, or a value is wrong; the message names file, table
        and key.

    Examples
    --------
    >>> import rockflex as rf
    >>> from pathlib import Path
    >>> length = Path("block.toml").write_text("block = { slenderness = 0.2, half_diagonal = 2.5, mass = 5e3 }")
    >>> round(rf.read_structure("block.toml").resisting_moment)  # m g b in N m
    24362
    """
    file = path_of("path", path)
    content = {key: value for key, value in read_toml(file, "structure").items() if key not in _FOR_RUNS}
    if "study" in content:
        raise InputError(f"{file} is the file of a study, but one of a structure is expected. Use load_study(path).")
    return build_in(file, checked(StructureEntry, content, str(path)))


def read_toml(file: Path, kind: str) -> dict[str, Any]:
    """Return the content of a TOML file; `kind` names its expected content in messages.

    Raises
    ------
    InputError
        If the file cannot be read, is not a regular file, or is not TOML.
    """
    check_regular(file)
    try:
        return tomllib.loads(file.read_text("utf-8"))
    except FileNotFoundError as error:
        raise InputError(f"The {kind} file {file} does not exist (working directory: {Path.cwd()}).") from error
    except OSError as error:
        raise InputError(f"The {kind} file {file} cannot be read: {error.strerror}.") from error
    except ValueError as error:  # not TOML, or not UTF-8
        raise InputError(f"{file} is not a valid TOML file: {shortened(str(error))}.") from error
    except RecursionError as error:
        raise InputError(
            f"{file} is nested too deep to be read: brackets within brackets, more than any {kind} has."
        ) from error


def build_in(file: Path, entry: StructureEntry) -> Built:
    """Build the structure of a file, which messages name.

    Raises
    ------
    InputError
        As `StructureEntry.build`.
    """
    try:
        return entry.build(file.parent)
    except InputError as error:
        raise InputError(f"{file}, {error}") from error
