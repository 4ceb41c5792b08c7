"""The keys that structure files, study files, command-line flags and forms of the page share."""

import math
from dataclasses import dataclass
from typing import Annotated, Literal, get_args

from rockflex.foundation.constants import MOST_MODES, MOST_STORIES
from rockflex.foundation.descriptions import PLAIN, Described, one_for_each


def command_line_flag(name: str, key: Described) -> str:
    """Return the option that gives a key on the command line, such as ``--story-height``."""
    return "--" + (key.flag or name).replace("_", "-")


LawName = Literal["simplified", "complete", "restitution", "angular-momentum", "pivot-impulse"]
LAWS: tuple[str, ...] = get_args(LawName)
_QUOTED = [f'"{law}"' for law in LAWS]
IMPACT = Described(
    "the impact law",
    form=f"{', '.join(_QUOTED[:-1])} or {_QUOTED[-1]}",
    metavar="LAW",
    hint=f"One of {', '.join(LAWS[:-1])} and {LAWS[-1]}. Default: each model's own law.",
)
RESTITUTION = Described(
    "the rotation velocity after an impact over that before",
    rule="from 0 to 1",
    note="θ'_after / θ'_before.",
    remedy="It is the ratio of the rotation velocities after and before an impact; more than 1 would gain energy.",
    form="a number from 0 to 1",
    metavar="E",
    hint="From 0 to 1; with --impact restitution, or as measured with --impact angular-momentum.",
)
SHORTEST_EXCURSION = 1e-4  # s: after an impact, the duration of one that counts, unless the law says another
ShortestExcursion = Annotated[float, Described("the shortest duration of an excursion", "s", rule="positive")]


class ImpactSchema:
    """An impact law in place of each model's own, and its coefficient."""

    impact: Annotated[LawName | None, IMPACT]
    restitution: Annotated[float | None, RESTITUTION] = None


@dataclass(frozen=True)
class BoucWenSchema:
    """The fields of `BoucWen`, which flags need before NumPy is loaded."""

    yield_displacement: Annotated[
        float,
        Described(
            "D_y of the first mode",
            "m",
            rule="positive",
            note="Of its coordinate D_1; Γ_1 φ_top,1 D_y at the top.",
            low=1e-6,
            high=100.0,
            metavar="DY",
            hint="Models whose label ends in -BW yield (Eqs. 37-38); all others stay elastic.",
        ),
    ]
    post_yield_ratio: Annotated[
        float,
        Described(
            "stiffness after yielding over that before",
            rule="from 0 to below 1",
            remedy="It is the ratio of the post-yield to the elastic stiffness; for an elastic structure leave "
            "bouc_wen out.",
            low=0.0,
            high=0.99,
            label="Post-yield stiffness ratio α",
            metavar="ALPHA",
        ),
    ] = 0.01
    gamma: Annotated[
        float,
        Described(
            "γ of the hysteresis (Eq. 38)",
            rule="finite",
            note="-γ < β ≤ γ: |z| stays below (γ + β)^(-1/n), and no loop generates energy.",
            low=1e-3,
            high=10.0,
            label="γ",
            flag="bw_gamma",
            metavar="GAMMA",
        ),
    ] = 0.5
    beta: Annotated[
        float,
        Described(
            "β of the hysteresis (Eq. 38)",
            rule="finite",
            low=-10.0,
            high=10.0,
            label="β",
            flag="bw_beta",
            metavar="BETA",
        ),
    ] = 0.5
    exponent: Annotated[
        float,
        Described(
            "n of the hysteresis (Eq. 38)",
            rule="finite",
            note="At least 1; a larger value gives a sharper transition to yielding.",
            form="{}, a number of at least 1",
            low=1.0,
            high=50.0,
            label="Exponent n",
            flag="bw_exponent",
            metavar="N",
            hint="At least 1.",
        ),
    ] = 8.0


class InitialStateSchema:
    """The state at t = 0."""

    initial_rotation: Annotated[
        float | None,
        Described(
            "the rotation at t = 0",
            "rad",
            hint="The structure starts at rest there; without a motion it vibrates freely for --free-vibration.",
        ),
    ] = None


class ReportKeys:
    """The head of a report."""

    title: Annotated[
        str | None, Described("the heading of the report, in quotes", form=PLAIN, flag="report_title", metavar="TEXT")
    ] = None
    project: Annotated[
        str | None, Described("the project, in quotes", form=PLAIN, flag="report_project", metavar="TEXT")
    ] = None
    author: Annotated[
        str | None, Described("the author, in quotes", form=PLAIN, flag="report_author", metavar="TEXT")
    ] = None
    checker: Annotated[
        str | None, Described("who checked it, in quotes", form=PLAIN, flag="report_checker", metavar="TEXT")
    ] = None
    date: Annotated[
        str | None,
        Described("the date, in quotes", form=PLAIN, flag="report_date", metavar="TEXT", hint="Default: today."),
    ] = None


BaseMass = Annotated[float, Described("the mass of the base", "kg", rule="zero or positive", low=0.0, high=1e12)]
HalfWidth = Annotated[float, Described("half the width of the base", "m", rule="positive", low=1e-3, high=1000.0)]
Period = Annotated[float, Described("the first period on a fixed base", "s", rule="positive", low=0.01, high=60.0)]
AspectRatio = Annotated[
    float,
    Described(
        "the effective height over the half width, h*_1/B",
        rule="positive",
        low=0.1,
        high=100.0,
        label="Slenderness h*₁/B",
        metavar="RATIO",
    ),
]
ECCENTRICITY = Described(
    "the distance of the masses to the right of the middle of the base",
    "m",
    low=-1000.0,
    high=1000.0,
    label="Eccentricity e of the base",
    hint="In addition to the eight. Default: 0.",
)
Eccentricity = Annotated[float | None, ECCENTRICITY]


DAMPING_REMEDY = "Give the fraction of critical damping: 2 % is 0.02."
DAMPING_RATIOS = Described(
    "the fraction of critical damping",
    form=one_for_each("mode"),
    in_file=float | list[float],
    low=0.0,
    high=0.99,
    note="From 0 to below 1: one number for all modes, or one for each.",
)
Height = Annotated[float, Described("the height above the base", "m", rule="positive", low=0.01, high=2000.0)]
Modes = Annotated[
    int,
    Described("how many modes to take", rule="whole", within=(1, MOST_MODES), low=1, high=100, label="Modes"),
]


@dataclass(frozen=True)
class FrameSchema:
    """The fields of `Frame`, which flags need before NumPy is loaded."""

    n_stories: Annotated[
        int,
        Described(
            "the number of stories",
            rule="whole",
            within=(1, MOST_STORIES),
            low=1,
            high=200,
            label="Stories",
            flag="stories",
            metavar="N",
        ),
    ]
    story_height: Annotated[
        float,
        Described("the height of a story", "m", rule="positive", note="Floor i is at i L_c.", low=0.1, high=100.0),
    ]
    story_mass: Annotated[float, Described("the mass of each floor", "kg", rule="positive", low=1e-3, high=1e12)]
    base_mass: BaseMass
    stiffness_ratio: Annotated[
        float,
        Described(
            "the ratio of beam to column stiffness",
            rule="zero, positive or infinite",
            remedy="0 is for two cantilever columns, float('inf') for a shear building.",
            note="ρ = (EI_b/L_b)/(2 EI_c/L_c), from 0 (two cantilevers) to infinity (shear building), both included.",
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
        Described(
            "the fraction of critical damping",
            rule="from 0 to below 1",
            remedy=DAMPING_REMEDY,
            note="Of every mode.",
            form="{}, a number such as 0.02",
            low=0.0,
            high=0.99,
            metavar="ZETA",
            hint="0.02 is 2 %.",
        ),
    ]


@dataclass(frozen=True)
class FrameFlags(FrameSchema):
    """A frame and its place on the base, as the command line takes them."""

    eccentricity: Eccentricity = None


_PER_SPRING = "{}, a number or, with springs, one for each"


class GroundSchema:
    """Friction, and the rotary inertia of a base on springs."""

    friction: Annotated[
        float | list[float] | None,
        Described(
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
        Described(
            "the rotary inertia of base and floors about the axis of the masses",
            "kg m²",
            low=0.0,
            high=1e15,
            metavar="KG*M2",
            hint="For a base on springs; 0 for a block, which has its own.",
        ),
    ] = None
    mat_mass: Annotated[
        float | None,
        Described(
            "the mass m of a rigid mat as wide as the base",
            "kg",
            low=1e-3,
            high=1e12,
            hint="Its rotary inertia m (2B)²/12 is used in place of --base-inertia.",
        ),
    ] = None


BREADTH = Described(
    "the dimension of the base perpendicular to the plane of rocking",
    "m",
    rule="positive",
    low=1e-3,
    high=1000.0,
    hint="The base stands on a bed of springs.",
)
SUBGRADE_MODULUS = Described(
    "the modulus of subgrade reaction, pressure over settlement", "N/m³", rule="positive", low=1.0, high=1e14
)
SHEAR_MODULUS = Described(
    "the effective shear modulus of the soil",
    "N/m²",
    rule="positive",
    note="At the strains of the earthquake.",
    low=1.0,
    high=1e14,
    hint="In place of --subgrade-modulus, for a bed with the stiffened ends of ASCE 41.",
)
POISSON_RATIO = Described(
    "the Poisson ratio of the soil",
    note="From 0 to 0.5.",
    low=0.0,
    high=0.5,
    metavar="NU",
    hint="With --shear-modulus.",
)


class SpringBedSchema:
    """A bed of springs under the whole base."""

    breadth: Annotated[float, BREADTH]
    subgrade_modulus: Annotated[float | None, SUBGRADE_MODULUS] = None
    shear_modulus: Annotated[float | None, SHEAR_MODULUS] = None
    poisson_ratio: Annotated[float | None, POISSON_RATIO] = None
    heave_damping_ratio: Annotated[
        float | None,
        Described(
            "the damping of the heave mode over the critical damping",
            low=0.0,
            high=100.0,
            metavar="ZETA",
            hint="0.3 is 30 %.",
        ),
    ] = None
