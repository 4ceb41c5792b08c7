"""The wrappers of structures as keys of a file: the one list of them, from the inside out."""

from collections.abc import Mapping
from typing import Any

from rockflex.foundation.errors import InputError
from rockflex.structure._jointed import Jointed
from rockflex.structure._leaning import Leaning
from rockflex.structure._one_sided import OneSided
from rockflex.structure._podium import Podium
from rockflex.structure._rocking import RockingProperties
from rockflex.structure._structure import Eccentric, InFile, ModifiedStructure
from rockflex.structure._yielding_stories import YieldingStories
from rockflex.structure.file._structure_tables import Built
from rockflex.structure.file._toml_table import TomlTable

_INSIDE_OUT: tuple[type[ModifiedStructure], ...] = (Leaning, YieldingStories, Podium, Jointed, Eccentric, OneSided)
WRAPPERS: Mapping[str, tuple[type[ModifiedStructure], InFile]] = {
    told.key: (kind, told) for kind in _INSIDE_OUT if (told := kind.in_file)
}
"""The class of each wrapper and what it is in a file, by its key."""


def wrapper_arguments(key: str, value: Any) -> dict[str, Any]:
    """Return the arguments of a wrapper for the value of its key: a number, a list or a table."""
    return WRAPPERS[key][1].arguments(value.model_dump() if isinstance(value, TomlTable) else value)


def wrapped(key: str, value: Any, built: Built) -> Built:
    """Return a structure with what the value of a key puts around it.

    Raises
    ------
    InputError
        If it does not fit the structure, or a value is out of range. The message begins with the key or the heading of
        its table; the field is the key, or such as ``"podium.column_width"``.
    """
    kind, told = WRAPPERS[key]
    try:
        if told.floors and isinstance(built, RockingProperties):
            raise InputError(
                f"{key} needs floors, which a [properties] or [block] table does not have. Use [frame], [fish_bone] or "
                "[lumped]; the leaning mass of [properties] is its key leaning_mass.",
                field="structure",
            )
        return kind.around(built, **wrapper_arguments(key, value))
    except InputError as error:
        first = (error.field or "").partition(".")[0]
        place, whole = (key, True) if told.value else (f"[{key}]", first in ("", "structure", told.argument))
        inner = key if whole else f"{key}.{error.field}"
        raise InputError(str(error), place=None if str(error).startswith(place) else place, field=inner) from error
