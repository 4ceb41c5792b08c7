"""What a design costs, in proportion to its width and its forces."""

from dataclasses import dataclass
from typing import Any

from rockflex._checks import positive
from rockflex._errors import InputError


@dataclass(frozen=True)
class DesignCost:
    """Unit costs of a base, its prestress and its dissipators, in any one currency.

    The cost of a design is half_width B + prestress ΣF_0 + dissipator_force ΣF_y, where ΣF_0 is the initial force of
    all tendons, and ΣF_y the yield force of all dissipators and the force of all friction dampers. Only ratios of
    these unit costs decide which design is the cheapest.

    Attributes
    ----------
    half_width : float
        Cost of each metre of the half width B.
    prestress : float
        Cost of each newton of ΣF_0.
    dissipator_force : float
        Cost of each newton of ΣF_y.

    Raises
    ------
    InputError
        If one is negative, or all are zero.

    Examples
    --------
    >>> import rockflex as rf
    >>> cost = rf.DesignCost(half_width=100.0, prestress=2e-5, dissipator_force=1e-4)
    >>> print(f"{cost.of(half_width=2.0, prestress=1e6, dissipator_force=4e5):.4g}")
    260
    """

    half_width: float = 0.0
    prestress: float = 0.0
    dissipator_force: float = 0.0

    def __post_init__(self) -> None:
        vars(self).update(
            half_width=positive("half_width", self.half_width, "cost/m", zero=True),
            prestress=positive("prestress", self.prestress, "cost/N", zero=True),
            dissipator_force=positive("dissipator_force", self.dissipator_force, "cost/N", zero=True),
        )
        if not (self.half_width or self.prestress or self.dissipator_force):
            raise InputError(
                "cost: all unit costs are zero, so that no design is cheaper than another. Give half_width in cost/m, "
                "prestress or dissipator_force in cost/N."
            )

    def of(self, half_width: Any, prestress: Any, dissipator_force: Any) -> Any:
        """Cost of a design, or of each of several in arrays; m, N and N."""
        forces = self.prestress * prestress + self.dissipator_force * dissipator_force
        return self.half_width * half_width + forces
