"""The keys of the ground that are also flags."""

import math
from typing import Annotated

from rockflex._schema._key import Key

_PER_SPRING = "{}, a number or, with springs, one for each"


class GroundKeys:
    """Friction, and the rotary inertia of a base on springs."""

    friction: Annotated[
        float | list[float] | None,
        Key(
            "the Coulomb coefficient between base and ground",
            form=_PER_SPRING,
            low=1e-3,
            high=math.inf,
            flag="ground_friction",
            metavar="MU",
            hint="The base slides on the ground. Default: it cannot.",
        ),
    ] = None
    base_inertia: Annotated[
        float | None,
        Key(
            "the rotary inertia of base and floors about the axis of the masses",
            "kg m²",
            low=1e-6,
            high=1e15,
            metavar="KG*M2",
            hint="For a base on springs.",
        ),
    ] = None
    mat_mass: Annotated[
        float | None,
        Key(
            "the mass m of a rigid mat as wide as the base",
            "kg",
            low=1e-3,
            high=1e12,
            hint="Its rotary inertia m (2B)²/12 is used in place of --base-inertia.",
        ),
    ] = None


class BedKeys:
    """A bed of springs under the whole base."""

    breadth: Annotated[
        float,
        Key(
            "the dimension of the base perpendicular to the plane of rocking",
            "m",
            low=1e-3,
            high=1000.0,
            hint="The base stands on a bed of springs.",
        ),
    ]
    subgrade_modulus: Annotated[
        float | None,
        Key("the modulus of subgrade reaction, pressure over settlement", "N/m³", low=1.0, high=1e14),
    ] = None
    shear_modulus: Annotated[
        float | None,
        Key(
            "the effective shear modulus of the soil",
            "N/m²",
            low=1.0,
            high=1e14,
            hint="In place of --subgrade-modulus, for a bed with the stiffened ends of ASCE 41.",
        ),
    ] = None
    poisson_ratio: Annotated[
        float | None,
        Key("the Poisson ratio of the soil", low=0.0, high=0.5, metavar="NU", hint="With --shear-modulus."),
    ] = None
    heave_damping_ratio: Annotated[
        float | None,
        Key(
            "the damping of the heave mode over the critical damping",
            low=0.0,
            high=100.0,
            metavar="ZETA",
            hint="0.3 is 30 %.",
        ),
    ] = None
