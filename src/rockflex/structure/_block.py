"""The homogeneous rigid block."""

import math

from rockflex._checks import positive, within
from rockflex._computable import computable
from rockflex._errors import InputError
from rockflex._shown import shown
from rockflex.modal import RockingProperties


@computable("The inertia of a block with this half_diagonal and mass")
def rigid_block(slenderness: float, half_diagonal: float, mass: float = 1.0) -> RockingProperties:
    """Return the properties of a homogeneous rectangular block, for the models "rigid" and "rigid-C".

    I_θ = 4/3 m R², B = R sin α, L_0^r = m R cos α; the frequency parameter is p² = 3 g/(4 R). Housner's coefficient
    1 - 2 m B²/I_θ is 1 - 1.5 sin² α (Housner 1963, Bull. Seism. Soc. Am. 53(2), 403-417).

    Parameters
    ----------
    slenderness
        α = atan(b/h) in rad, above 0 and below π/2.
    half_diagonal
        R in m, positive.
    mass
        m in kg, positive; the rotations do not depend on it.

    Raises
    ------
    InputError
        If a value is out of range.

    Examples
    --------
    >>> import rockflex as rf
    >>> block = rf.rigid_block(slenderness=0.25, half_diagonal=3.0)
    >>> round(block.half_width, 3), round(block.resisting_moment, 3)
    (0.742, 7.281)
    """
    alpha = within("slenderness", slenderness, 0.5 * math.pi, "rad")
    if alpha <= 0.0:
        raise InputError(
            f"slenderness must be positive, but {shown(slenderness)} was given. It is atan(b/h) in rad.",
            field="slenderness",
        )
    r, m = positive("half_diagonal", half_diagonal, "m"), positive("mass", mass, "kg")
    return RockingProperties(
        omega=(),
        effective_mass=(),
        effective_height=(),
        top_ordinate=(),
        i_theta=4.0 / 3.0 * m * r**2,
        l0r=m * r * math.cos(alpha),
        m_tot=m,
        half_width=r * math.sin(alpha),
        zeta=(),
        top_height=2.0 * r * math.cos(alpha),
        base_mass=0.0,
    )
