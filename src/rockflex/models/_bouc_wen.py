"""The Bouc-Wen hysteresis of a one-mode superstructure (Silva & Stojadinović 2024, Eqs. 37-38)."""

from dataclasses import dataclass

from rockflex.foundation.descriptions import described
from rockflex.foundation.errors import InputError
from rockflex.foundation.schema import BoucWenSchema
from rockflex.foundation.shown import shown


@described
@dataclass(frozen=True)
class BoucWen(BoucWenSchema):
    """A yielding superstructure: ω² [α D + D_y (1 - α) z] replaces ω² D.

    z' = (D' - γ |D'| z |z|^(n-1) - β D' |z|^n) / D_y, both in contact and while rocking.

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> import rockflex as rf
    >>> column = rf.CantileverWithTipMass(
    ...     height=10.0, tip_mass=50e3, bending_stiffness=2e8, base_mass=10e3,
    ...     half_width=1.0, damping_ratio=0.02
    ... )
    >>> law = rf.BoucWen(yield_displacement=0.02)
    >>> response = rf.simulate(column, rf.one_sine_pulse(3.0, 1.0), "2DOF-S",
    ...     bouc_wen=law)
    >>> response.model
    '2DOF-S-BW'
    """

    def __post_init__(self) -> None:
        if self.exponent < 1.0:
            raise InputError(
                f"exponent must be at least 1, but {shown(self.exponent)} was given. 8 gives a sharp yield, 1 a "
                "gradual one.",
                field="exponent",
            )
        if not (self.gamma > 0.0 and abs(self.beta) <= self.gamma and self.gamma + self.beta > 0.0):
            raise InputError(
                f"gamma must be positive and -gamma < beta <= gamma, but gamma={shown(self.gamma)} and "
                f"beta={shown(self.beta)} were given: the spring would return more energy than it absorbs. The "
                "paper uses 0.5 for both.",
                field="gamma",
            )
