"""The keys of a frame, and those that other kinds of structure share with it."""

import math
from typing import Annotated

from rockflex._schema._key import WHOLE, Key

BaseMass = Annotated[float, Key("the mass of the base", "kg", low=0.0, high=1e12)]
Period = Annotated[float, Key("the first period on a fixed base", "s", low=0.01, high=60.0)]
AspectRatio = Annotated[
    float,
    Key(
        "the effective height over the half width, h*_1/B",
        low=0.1,
        high=100.0,
        label="Slenderness h*₁/B",
        metavar="RATIO",
    ),
]
Eccentricity = Annotated[
    float | None,
    Key(
        "the distance of the masses to the right of the middle of the base",
        "m",
        low=-1000.0,
        high=1000.0,
        label="Eccentricity e of the base",
        hint="In addition to the eight. Default: 0.",
    ),
]


class FrameKeys:
    """The arguments of `Frame`."""

    n_stories: Annotated[
        int, Key("the number of stories", form=WHOLE, low=1, high=200, label="Stories", flag="stories", metavar="N")
    ]
    story_height: Annotated[float, Key("the height of a story", "m", low=0.1, high=100.0)]
    story_mass: Annotated[float, Key("the mass of each floor", "kg", low=1e-3, high=1e12)]
    base_mass: BaseMass
    stiffness_ratio: Annotated[
        float,
        Key(
            "the ratio of beam to column stiffness",
            form="{}, a number from 0 to inf",
            low=0.0,
            high=math.inf,
            metavar="RHO",
            hint="0: cantilevers; inf: shear building.",
        ),
    ]
    period: Period
    aspect_ratio: AspectRatio
    damping_ratio: Annotated[
        float,
        Key(
            "the fraction of critical damping",
            form="{}, a number such as 0.02",
            low=0.0,
            high=0.99,
            metavar="ZETA",
            hint="0.02 is 2 %.",
        ),
    ]


class FrameFlags(FrameKeys):
    """A frame and its place on the base, as the command line takes them."""

    eccentricity: Eccentricity = None
