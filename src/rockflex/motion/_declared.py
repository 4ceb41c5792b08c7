"""The caller's statements about a file: unit, time step and layout."""

from dataclasses import dataclass
from typing import Literal, get_args

from rockflex.foundation.checks import checked_positive
from rockflex.foundation.errors import InputError
from rockflex.foundation.shown import shown
from rockflex.motion._findings import Evidence
from rockflex.motion._units import AccelerationUnit, declared_acceleration_unit

Layout = Literal["columns", "sequence"]


@dataclass(frozen=True)
class Declared:
    """Unit, time step in s and layout that a caller gives, None if not; `common` if for many files.

    A format that states its own unit and step need not agree with what is said of many files.
    """

    units: AccelerationUnit | None = None
    dt: float | None = None
    layout: Layout | None = None
    common: bool = False

    @property
    def unit_evidence(self) -> Evidence[AccelerationUnit] | None:
        """The unit, with the argument that gives it."""
        return None if self.units is None else Evidence(self.units, f"units={str(self.units)!r}")

    @property
    def step_evidence(self) -> Evidence[float] | None:
        """The time step, with the argument that gives it."""
        return None if self.dt is None else Evidence(self.dt, f"dt={shown(self.dt)}")


def declared(units: object = None, dt: object = None, layout: object = None) -> Declared:
    """Return checked arguments of `read_motion`.

    Raises
    ------
    InputError
        If the unit is not known, the step is not positive, or there is no such layout.
    """
    step = None if dt is None else checked_positive("dt", dt, "s")  # pyright: ignore[reportArgumentType]
    if layout not in (None, *get_args(Layout)):
        raise InputError(
            f'layout must be "columns" or "sequence" (values that follow each other in lines of any length), but '
            f"{shown(layout)} was given.",
            field="layout",
        )
    unit = None if units is None else declared_acceleration_unit(units)
    return Declared(unit, step, layout)  # pyright: ignore[reportArgumentType]
