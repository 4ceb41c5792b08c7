"""Values that are possible, but look like those of another unit."""

import math
from typing import Any

from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.modal import RockingProperties
from rockflex.structure._based import is_structure
from rockflex.structure._cantilever import CantileverWithTipMass
from rockflex.structure._eccentric import Eccentric
from rockflex.structure._restrained import Restrained

LONGEST_PERIOD = 10.0  # s
_LEAST_TIP = 0.1  # of the mass of its column


def structure_warnings(structure: Any) -> tuple[str, ...]:
    """Return what looks like a wrong unit in a structure, one text each; nothing is refused.

    A first period on a fixed base beyond 10 s, and a mass at the tip of less than a tenth of that of its column,
    such as one given in tonnes. `rockflex modes` and `rockflex run` print these texts.

    Parameters
    ----------
    structure
        Any structure, such as a `Frame`, or a `RockingProperties`.

    Raises
    ------
    InputError
        If it is neither.

    Examples
    --------
    >>> import rockflex as rf
    >>> column = rf.CantileverWithTipMass(
    ...     height=12.0, tip_mass=60.0, mass_per_length=4e3, bending_stiffness=2e9, base_mass=50e3, half_width=1.5,
    ...     damping_ratio=0.02,
    ... )
    >>> for warning in rf.structure_warnings(column):
    ...     print(warning)
    The tip has a mass of 60 kg, less than a tenth of the 48000 kg of its column. Masses are in kg: a tonne is 1000 kg.
    """
    if isinstance(structure, RockingProperties):
        return _of_properties(structure)
    if not is_structure(structure):
        raise InputError(
            f"structure must be a structure, such as a Frame, or RockingProperties, but {shown(structure)} was given.",
            field="structure",
        )
    found = _of_properties(structure.rocking())
    while isinstance(structure, Restrained | Eccentric):
        structure = structure.structure
    if isinstance(structure, CantileverWithTipMass):
        column = structure.mass_per_length * structure.height
        if structure.tip_mass < _LEAST_TIP * column:
            found += (
                f"The tip has a mass of {structure.tip_mass:g} kg, less than a tenth of the {column:g} kg of its "
                "column. Masses are in kg: a tonne is 1000 kg.",
            )
    return found


def _of_properties(properties: RockingProperties) -> tuple[str, ...]:
    if properties.n_modes == 0:
        return ()
    period = 2.0 * math.pi / float(properties.omega[0])
    if period <= LONGEST_PERIOD:
        return ()
    return (
        f"The first period on a fixed base is {period:.4g} s, longer than those of buildings, towers and bridges, "
        f"which stay below {LONGEST_PERIOD:g} s. Check the units: kg, m, s and N, so EI in N m² and no kN.",
    )
