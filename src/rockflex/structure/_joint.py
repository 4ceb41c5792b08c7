"""Horizontal joints of a structure above its base: where they are, and what stands on them."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

from rockflex.foundation.arrays import Array
from rockflex.foundation.checks import checked_finite_vector
from rockflex.foundation.descriptions import Described, described
from rockflex.foundation.values import Value


@described
@dataclass(frozen=True)
class Joint:
    """A horizontal joint above the base at which the upper part can rock on the lower one.

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> import rockflex as rf
    >>> rf.Joint(height=9.0, half_width=1.2)
    Joint(height=9.0, half_width=1.2)
    """

    height: Annotated[
        float,
        Described(
            "the height of the joint above the base",
            "m",
            rule="positive",
            note="A mass at this height stands on the joint.",
            low=0.01,
            high=2000.0,
        ),
    ]
    half_width: Annotated[
        float,
        Described(
            "the distance from the axis of the masses to either edge of the joint",
            "m",
            rule="positive",
            label="B of the joint",
            low=0.001,
            high=1000.0,
        ),
    ]

    def __post_init__(self) -> None:
        """Both numbers are checked by their rules."""


@dataclass(frozen=True, eq=False, init=False)
class JointAbove(Value):
    """A joint of `RockingProperties` with the masses above it; see `Jointed`, which finds these numbers.

    Attributes
    ----------
    height, half_width : float
        Z_j and B_j in m.
    mass : float
        Σ m_i in kg of what stands on the joint; leaning mass does not.
    moment : float
        Σ (m_i + l_i) (z_i - Z_j) in kg m of what is above it.
    inertias : ndarray, shape (j,)
        Σ (m_i + l_i) (z_i - Z_k) (z_i - Z_j) in kg m² over what is above the joint, for the base (Z = 0), for each
        joint between, and for the joint itself.
    effective_height : ndarray, shape (n,)
        Coupling of each mode with the rotation of the joint, as h*_n is with that of the base, in m.
    """

    height: float
    half_width: float
    mass: float
    moment: float
    inertias: Array
    effective_height: Array

    def __init__(
        self,
        height: float,
        half_width: float,
        mass: float,
        moment: float,
        inertias: Sequence[float] | Array,
        effective_height: Sequence[float] | Array,
    ) -> None:
        vars(self).update(
            height=float(height),
            half_width=float(half_width),
            mass=float(mass),
            moment=float(moment),
            inertias=checked_finite_vector("inertias", inertias, "kg m²"),
            effective_height=checked_finite_vector("effective_height", effective_height, "m"),
        )

    def truncated(self, n_modes: int) -> "JointAbove":
        """Return the joint of a model with the first `n_modes` modes."""
        kept = self.effective_height[:n_modes]
        return JointAbove(self.height, self.half_width, self.mass, self.moment, self.inertias, kept)
