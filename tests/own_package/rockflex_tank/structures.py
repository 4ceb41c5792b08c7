"""A tank on a column, as a kind of structure for files."""

from dataclasses import dataclass, field
from functools import cached_property

import rockflex as rf


@dataclass(frozen=True)
class Tank:
    """A full tank of water on a column with a square base."""

    volume: float = field(metadata={"description": "the volume of water", "unit": "m³"})
    height: float = field(metadata={"description": "the height of the water above the base", "unit": "m"})
    column_stiffness: float = field(metadata={"description": "the lateral stiffness of the column", "unit": "N/m"})
    half_width: float = field(metadata={"description": "half the width of the base", "unit": "m"})
    damping_ratio: float = 0.02
    base_mass: float = 20e3
    shell_masses: tuple[float, ...] = field(default_factory=tuple)
    level: str | None = None

    @cached_property
    def assembled(self) -> rf.ModalStructure:
        if self.volume <= 0.0:
            raise rf.InputError(f"volume must be positive, in m³, but {self.volume} was given.", field="volume")
        share = 0.5 if self.level == "half" else 1.0
        mass = 1000.0 * share * self.volume + sum(self.shell_masses)
        return rf.from_matrices(
            mass=[mass], stiffness=[[self.column_stiffness]], heights=[self.height],
            base_mass=self.base_mass, half_width=self.half_width, damping_ratio=self.damping_ratio,
        )  # fmt: skip

    def modal(self, n_modes=None):
        return self.assembled.modal(n_modes)

    def rocking(self, n_modes=None):
        return self.assembled.rocking(n_modes)
