"""Units of acceleration in record files: how they are written, and what they are in m/s²."""

import re
from dataclasses import dataclass

import numpy as np

from rockflex._constants import GRAVITY
from rockflex._errors import InputError
from rockflex._shown import shown

UNITS = {"g": GRAVITY, "m/s2": 1.0, "cm/s2": 0.01, "mm/s2": 1e-3, "mg": 1e-3 * GRAVITY, "in/s2": 0.0254}
LENGTH = re.compile(r"(c|m)?m(?:s-2|/(s|sec)(?:2|/\2))|in(?:s-2|/(s|sec)(?:2|/\3))")
LONGEST = 100  # characters of a unit
FACTOR = re.compile(
    r"\s*+([+-]?+(?:\d++\.?+\d*+|\.\d++)(?:[Ee][+-]?+\d++)?+)\s*+\*?+(?=[\s*a-zA-Z])\s*+(.*)", re.DOTALL
)


@dataclass(frozen=True)
class Unit:
    """A unit of acceleration, or a multiple of one, such as one count of a recorder.

    Parameters
    ----------
    name
        A key of `UNITS`.
    factor
        How many of it the number 1 in the file means.
    """

    name: str
    factor: float = 1.0

    def __str__(self) -> str:
        return self.name if self.factor == 1.0 else f"{self.factor:.12g} {self.name}"

    @property
    def si(self) -> float:
        """The unit in m/s²."""
        return self.factor * UNITS[self.name]


def spelled(text: str) -> str | None:
    """Return the key of `UNITS` for a unit as headers write it, such as cm/sec^2 or gal; None if it is none."""
    plain = re.sub(r"[\s^*·.]", "", text.lower().replace("²", "2").replace("−", "-"))
    if plain in ("g", "mg"):
        return plain
    if plain in ("gal", "gals"):
        return "cm/s2"
    found = LENGTH.fullmatch(plain)
    if found is None:
        return None
    return "in/s2" if plain.startswith("in") else f"{found[1] or ''}m/s2"


def acceleration_in(text: str) -> float | None:
    """Return an acceleration in m/s² that is written with its unit, such as 0.25g or 2.45 m/s2; None without one."""
    found = FACTOR.fullmatch(text) if len(text) < LONGEST else None
    name = found and spelled(found[2])
    return None if not found or name is None else float(found[1]) * UNITS[name]


def declared(units: object) -> Unit:
    """Return the unit that a caller names, with a number before it for a multiple, such as "2.4e-4 cm/s2".

    Raises
    ------
    InputError
        If it is not such a text, or the number is not positive and finite.
    """
    if isinstance(units, str) and len(units) < LONGEST:
        found = FACTOR.fullmatch(units)
        name = spelled(found[2] if found else units)
        factor = float(found[1]) if found else 1.0
        if name is not None and np.isfinite(factor) and factor > 0.0:
            return Unit(name, factor)
    raise InputError(
        f"units must be one of {', '.join(map(repr, UNITS))}, but {shown(units)} was given. If the file holds counts, "
        'write what one count is: units="2.4e-4 cm/s2".',
        field="units",
    )
