"""Structures in TOML files."""

import tomllib
from pathlib import Path
from typing import Any

from rockflex.foundation.errors import InputError
from rockflex.foundation.files import check_regular_file, checked_file_path, unicode_text
from rockflex.foundation.shown import shortened
from rockflex.structure.file._object_tables import CLASS, structure_from_table
from rockflex.structure.file._structure_entry import StructureEntry
from rockflex.structure.file._structure_tables import Built
from rockflex.structure.file._toml_table import parse_toml_table

_RUN_KEYS = ("impact", "restitution", "bouc_wen", "ground", "report")  # only for `rockflex run`


def read_structure(path: str | Path) -> Built:
    """Return the structure of a TOML file, the same file that the command line reads.

    The file holds one table, whose keys are the arguments of the class: ``[frame]`` (`Frame`), ``[fish_bone]``
    (`FishBone`), ``[wall_frame]`` (`WallFrame`), ``[tapered_tower]`` (`TaperedTower`), ``[cantilever]``
    (`CantileverWithTipMass`), ``[beam]`` (`Beam`, with lists of values at the heights ``z``), ``[lumped]``
    (`LumpedStructure`), ``[matrices]`` (`from_matrices`), ``[modes]`` (`from_modes`), ``[properties]``
    (`RockingProperties`), ``[block]`` (`rigid_block`) or ``[rocking_frame]`` (`rocking_frame`). Tables ``[[elements]]``
    restrain it; their key ``kind`` is "tendon" (`Tendon`), "yielding_dissipator" (`YieldingDissipator`),
    "viscous_damper" (`ViscousDamper`), "friction_damper" (`FrictionDamper`), "strand_tendon" (`strand_tendon`),
    "bar_fuse" (`bar_fuse`), "u_plate_fuse" (`u_plate_fuse`), "flag_shaped_bar" (`FlagShapedBar`), "gap_bar" (`GapBar`),
    "multilinear_bar" (`MultilinearBar`), or the name that another package registers (`ElementLaw`). In place of a
    ``position`` an element takes ``between`` (two floors) or the ``height`` of a tie, with a ``cosine`` (`Attachment`).
    ``leaning_masses`` above all tables is mass on other columns (`Leaning`), a table ``[stories]`` with ``strengths``
    and ``post_yield_ratio`` makes stories yield (`YieldingStories`), a table ``[joints]`` with ``heights`` and
    ``half_widths`` adds joints above the base (`Jointed`), and a number ``eccentricity`` moves the structure from the
    middle of its base (`Eccentric`). A table ``[podium]`` puts columns under it that rock together (`Podium`), and a
    table ``[one_sided]`` with ``restitution`` and ``side`` a wall behind it (`OneSided`). Units are kg, m, s, N and
    rad; paths of matrices are relative to the folder of the file. A file of a `Project` has the key ``class`` above
    all tables, the name of the class, and its arguments.

    Parameters
    ----------
    path
        The file. The keys ``impact``, ``restitution``, ``[bouc_wen]``, ``[ground]`` and ``[report]`` are for ``rockflex
        run`` and are ignored; in Python they are arguments of `simulate` and `write_report`.

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
    >>> length = Path("block.toml").write_text(
    ...     "block = { slenderness = 0.2, half_diagonal = 2.5, mass = 5e3 }")
    >>> round(rf.read_structure("block.toml").resisting_moment)  # m g b in N m
    24362
    """
    file = checked_file_path("path", path)
    content = {key: value for key, value in read_toml_file(file, "structure").items() if key not in _RUN_KEYS}
    if "study" in content:
        raise InputError(f"{file} is the file of a study, but one of a structure is expected. Use load_study(path).")
    if "structures" in content:
        raise InputError(f"{file} is the file of a case, but one of a structure is expected. Use read_case(path).")
    if CLASS in content:
        return structure_from_table(content, str(file))
    return build_structure_in_file(file, parse_toml_table(StructureEntry, content, str(path)))


def read_toml_file(file: Path, kind: str) -> dict[str, Any]:
    """Return the content of a TOML file; `kind` names its expected content in messages.

    Raises
    ------
    InputError
        If the file cannot be read, is not a regular file, or is not TOML.
    """
    check_regular_file(checked_file_path("path", file))
    try:
        return tomllib.loads(unicode_text(file.read_bytes()))
    except FileNotFoundError as error:
        raise InputError(f"The {kind} file {file} does not exist (working directory: {Path.cwd()}).") from error
    except OSError as error:
        raise InputError(f"The {kind} file {file} cannot be read: {error.strerror}.") from error
    except ValueError as error:  # not TOML, or in another encoding
        hint = " Save it as UTF-8." if isinstance(error, UnicodeDecodeError) else ""
        raise InputError(f"{file} is not a valid TOML file: {shortened(str(error))}.{hint}") from error
    except RecursionError as error:
        raise InputError(
            f"{file} is nested too deep to be read: brackets within brackets, more than any {kind} has."
        ) from error


def build_structure_in_file(file: Path, entry: StructureEntry) -> Built:
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
