"""Rigid bodies that rock: a block, and a frame of columns under a rigid cap."""

import math
from typing import Annotated, NamedTuple

from rockflex.foundation.checks import checked_whole_number, real_or_nan
from rockflex.foundation.descriptions import Described, described
from rockflex.foundation.errors import InputError
from rockflex.foundation.overflow import explaining_overflow
from rockflex.foundation.shown import shown
from rockflex.structure._rocking import RockingProperties


@described(title="Rigid block")
@explaining_overflow("The inertia of a block with these sizes and this mass")
def rigid_block(
    slenderness: Annotated[
        float | None,
        Described(
            "atan(b/h) of the half sides (or give width and height)",
            "rad",
            note="α, above 0 and below π/2.",
            low=1e-4,
            high=1.5,
        ),
    ] = None,
    half_diagonal: Annotated[
        float | None,
        Described(
            "the distance from the corner to the centre (or give width and height)",
            "m",
            rule="positive",
            note="R.",
            low=1e-3,
            high=1000.0,
        ),
    ] = None,
    mass: Annotated[float, Described("the mass, which rotations do not depend on", "kg", rule="positive")] = 1.0,
    *,
    width: Annotated[
        float | None,
        Described("the width 2 b in the plane of rocking", "m", rule="positive", low=1e-3, high=1000.0),
    ] = None,
    height: Annotated[float | None, Described("the height 2 h", "m", rule="positive", low=1e-3, high=1000.0)] = None,
) -> RockingProperties:
    """Return the properties of a homogeneous rectangular block, for the models "rigid" and "rigid-C".

    I_θ = 4/3 m R², B = R sin α, L_0^r = m R cos α; the frequency parameter is p² = 3 g/(4 R). Housner's coefficient
    1 - 2 m B²/I_θ is 1 - 1.5 sin² α (Housner 1963, Bull. Seism. Soc. Am. 53(2), 403-417). The block is given by its
    `width` and `height`, or by `slenderness` and `half_diagonal`.

    Raises
    ------
    InputError
        If a value is out of range, or the sizes are not given by one of the pairs.

    Examples
    --------
    >>> import rockflex as rf
    >>> cabinet = rf.rigid_block(width=0.6, height=2.0, mass=250.0)
    >>> round(cabinet.half_width, 3), round(cabinet.uplift_acceleration, 3)
    (0.3, 2.943)
    >>> block = rf.rigid_block(slenderness=0.25, half_diagonal=3.0)
    >>> round(block.half_width, 3), round(block.resisting_moment, 3)
    (0.742, 7.281)
    """
    sides = {"width": width, "height": height}
    polar = {"slenderness": slenderness, "half_diagonal": half_diagonal}
    given = [name for name, value in (sides | polar).items() if value is not None]
    if given not in ([*sides], [*polar]):
        raise InputError(
            f"A block is given by width and height in m, or by slenderness in rad and half_diagonal in m, but "
            f"{' and '.join(given) or 'neither'} {'were' if len(given) > 1 else 'was'} given. Write "
            "rigid_block(width=0.6, height=2.0, mass=250.0), for instance.",
            field=given[-1] if given else "width",
        )
    if width is not None and height is not None:
        b, h = 0.5 * width, 0.5 * height
        r, moment = math.hypot(b, h), mass * h
    else:
        alpha = real_or_nan(slenderness)
        if not 0.0 < alpha < 0.5 * math.pi:
            hint = f" An aspect ratio h/b of {alpha:g} is {math.atan(1.0 / alpha):.4g} rad." if alpha > 1.0 else ""
            raise InputError(
                f"slenderness must be above 0 and below π/2 = 1.5708 rad, but {shown(slenderness)} was given. It is "
                f"atan(b/h) of the half sides.{hint}",
                field="slenderness",
            )
        r = half_diagonal or 0.0
        b, h, moment = r * math.sin(alpha), r * math.cos(alpha), mass * r * math.cos(alpha)
    return _body_without_modes(4.0 / 3.0 * mass * r**2, moment, mass, b, 2.0 * h)


@described(title="Rocking frame")
@explaining_overflow("The inertia of a frame with these columns and this cap")
def rocking_frame(
    n_columns: Annotated[
        int, Described("how many columns stand side by side", rule="whole", within=(1, 10_000), low=1, high=10_000)
    ],
    column_width: Annotated[
        float,
        Described("the width 2 b of a column in the plane of rocking", "m", rule="positive", low=1e-3, high=1000.0),
    ],
    column_height: Annotated[
        float, Described("the height 2 h of a column", "m", rule="positive", low=1e-3, high=1000.0)
    ],
    column_mass: Annotated[float, Described("the mass of one column", "kg", rule="positive")],
    cap_mass: Annotated[
        float,
        Described("the mass of the cap and of all that stands on it", "kg", rule="zero or positive"),
    ],
) -> RockingProperties:
    """Return the properties of free-standing columns under a rigid cap, as those of one rigid body.

    The columns rotate together about their edges, and the cap moves sideways and upwards without turning. With
    R² = b² + h² and γ = m_cap/(N m_c) the frame rocks like one block of the slenderness of a column, tan α = b/h, and
    the half diagonal R (1 + 3 γ)/(1 + 2 γ), so a heavier cap makes it more stable. At an impact the rotation keeps

    r = (1 - 1.5 sin² α + 3 γ cos 2α)/(1 + 3 γ)

    of its velocity (Makris & Vassiliou 2013, Earthq. Eng. Struct. Dyn. 42(3), 431-449). For the models "rigid" and
    "rigid-C".

    Raises
    ------
    InputError
        If a value is out of range, or the columns are so squat that r would be negative.

    Notes
    -----
    I_θ = N m_c 4/3 R² + 4 m_cap R², L_0^r = N m_c h + 2 m_cap h, and m_tot is the mass of columns and cap.
    `half_width` is that of the one body: M_r = m_tot g B with B = b (1 + 2 γ)/(1 + γ), and its edges are none of the
    columns'. The top is the cap.

    Examples
    --------
    >>> import rockflex as rf
    >>> frame = rf.rocking_frame(n_columns=4, column_width=1.6,
    ...     column_height=9.6, column_mass=60e3, cap_mass=240e3)
    >>> round(frame.restitution, 4), round(frame.uplift_acceleration, 3)
    (0.9493, 1.635)
    """
    n = checked_whole_number("n_columns", n_columns, 1, 10_000)
    body = body_on_columns(n, column_width, column_height, column_mass, cap_mass)
    return _body_without_modes(body.i_theta, body.l0r, body.m_tot, body.half_width, column_height, body.restitution)


class BodyOnColumns(NamedTuple):
    """Columns under a slab and a building as one body that rocks, with the names of `RockingProperties`."""

    i_theta: float
    l0r: float
    m_tot: float
    half_width: float
    restitution: float


@explaining_overflow("The inertia of columns of this size that rock together")
def body_on_columns(
    n_columns: int, width: float, height: float, column_mass: float, slab_mass: float, building_mass: float = 0.0
) -> BodyOnColumns:
    """Return the body of columns that rock together under a slab, on which a building may stand.

    The restitution is from the momentum about the new pivots; floors of the building are free sideways, so only what
    they rise takes part. Without a building it is that of Makris & Vassiliou (2013).

    Raises
    ------
    InputError
        If the columns are so squat that it would be negative.
    """
    b, h, columns = 0.5 * width, 0.5 * height, n_columns * column_mass
    r2, carried = b**2 + h**2, slab_mass + building_mass
    rolls = columns * (r2 / 3.0 + h**2 - b**2) + 4.0 * slab_mass * (h**2 - b**2) - 4.0 * b**2 * building_mass
    stands = 4.0 / 3.0 * columns * r2 + 4.0 * slab_mass * r2 + 4.0 * b**2 * building_mass
    if rolls < 0.0:
        raise InputError(
            f"column_width must leave some rotation after an impact, but with {width:g} m and column_height = "
            f"{height:g} m the restitution would be {rolls / stands:.4g}. Columns that rock are slender.",
            field="column_width",
        )
    mass = columns + carried
    return BodyOnColumns(
        i_theta=4.0 / 3.0 * columns * r2 + 4.0 * carried * r2,
        l0r=columns * h + 2.0 * carried * h,
        m_tot=mass,
        half_width=b * (columns + 2.0 * carried) / mass,
        restitution=rolls / stands,
    )


def _body_without_modes(
    i_theta: float,
    l0r: float,
    mass: float,
    half_width: float,
    top: float,
    restitution: float | None = None,
) -> RockingProperties:
    """Return a rigid body with its top at some height."""
    return RockingProperties(
        omega=(),
        effective_mass=(),
        effective_height=(),
        top_ordinate=(),
        i_theta=i_theta,
        l0r=l0r,
        m_tot=mass,
        half_width=half_width,
        zeta=(),
        top_height=top,
        base_mass=0.0,
        restitution=restitution,
    )
