"""The keys that structure files, study files, command-line flags and forms of the page share."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any, Literal, get_args, get_type_hints

NUMBER, WHOLE, PLAIN = "{}, a number{unit}", "{}, a whole number", "{}"


@dataclass(frozen=True)
class SchemaKey:
    """The metadata of a field, inside ``Annotated``; its name, type and default are those of the field.

    Attributes
    ----------
    description
        Completes the sentence "it must be ...".
    unit
        SI unit, or empty.
    form
        How the value is written, with the description in place of ``{}`` and " in <unit>" in place of ``{unit}``.
    label
        The name in a form, where it is not the key itself.
    low, high
        The smallest and the largest number that the page accepts; None for any of a reasonable size.
    flag, metavar
        The option and its placeholder on the command line, where they are not the key and its unit.
    page
        What the page says in place of `expected`, where a file may hold what a form cannot.
    hint
        What the help of the option says besides the description, the unit and the default.
    """

    description: str
    unit: str = ""
    form: str = NUMBER
    label: str = ""
    low: float | None = None
    high: float | None = None
    flag: str = ""
    metavar: str = ""
    hint: str = ""
    page: str = ""

    @property
    def expected(self) -> str:
        """Return the description of a valid value, and its form in a file."""
        return self.form.format(self.description, unit=self.unit and f" in {self.unit}")


def one_for_each(what: str) -> str:
    """Return the form of a number, or of one for each of many."""
    return f"{{}}, a number or one for each {what}"


def schema_keys(table: type) -> Iterator[tuple[str, Any, SchemaKey]]:
    """Yield the name, the type and the key of each field of a class whose annotations hold keys."""
    for name, annotation in get_type_hints(table, include_extras=True).items():
        kind, key = get_args(annotation)
        yield name, kind, key


def command_line_flag(name: str, key: SchemaKey) -> str:
    """Return the option that gives a key on the command line, such as ``--story-height``."""
    return "--" + (key.flag or name).replace("_", "-")


LawName = Literal["simplified", "complete", "restitution"]
LAWS: tuple[str, ...] = get_args(LawName)
_QUOTED = [f'"{law}"' for law in LAWS]
IMPACT = SchemaKey(
    "the impact law",
    form=f"{', '.join(_QUOTED[:-1])} or {_QUOTED[-1]}",
    metavar="LAW",
    hint="One of simplified (Eq. 25), complete (Eq. 29) and restitution. Default: each model's own law.",
)


class ImpactSchema:
    """An impact law in place of each model's own, and its coefficient."""

    impact: Annotated[LawName | None, IMPACT]
    restitution: Annotated[
        float | None,
        SchemaKey(
            "the rotation velocity after an impact over that before",
            form="a number from 0 to 1",
            metavar="E",
            hint="From 0 to 1; with --impact restitution.",
        ),
    ] = None


class BoucWenSchema:
    """The arguments of `BoucWen`."""

    yield_displacement: Annotated[
        float,
        SchemaKey(
            "D_y of the first mode",
            "m",
            low=1e-6,
            high=100.0,
            metavar="DY",
            hint="Models whose label ends in -BW yield (Eqs. 37-38); all others stay elastic.",
        ),
    ]
    post_yield_ratio: Annotated[
        float,
        SchemaKey(
            "stiffness after yielding over that before",
            low=0.0,
            high=0.99,
            label="Post-yield stiffness ratio α",
            metavar="ALPHA",
        ),
    ] = 0.01
    gamma: Annotated[
        float,
        SchemaKey("γ of the hysteresis (Eq. 38)", low=1e-3, high=10.0, label="γ", flag="bw_gamma", metavar="GAMMA"),
    ] = 0.5
    beta: Annotated[
        float,
        SchemaKey("β of the hysteresis (Eq. 38)", low=-10.0, high=10.0, label="β", flag="bw_beta", metavar="BETA"),
    ] = 0.5
    exponent: Annotated[
        float,
        SchemaKey(
            "n of the hysteresis (Eq. 38)",
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
        SchemaKey(
            "the rotation at t = 0",
            "rad",
            hint="The structure starts at rest there; without a motion it vibrates freely for --free-vibration.",
        ),
    ] = None


class ReportKeys:
    """What the head of a report says."""

    title: Annotated[
        str | None, SchemaKey("the heading of the report, in quotes", form=PLAIN, flag="report_title", metavar="TEXT")
    ] = None
    project: Annotated[
        str | None, SchemaKey("the project, in quotes", form=PLAIN, flag="report_project", metavar="TEXT")
    ] = None
    author: Annotated[
        str | None, SchemaKey("the author, in quotes", form=PLAIN, flag="report_author", metavar="TEXT")
    ] = None
    checker: Annotated[
        str | None, SchemaKey("who checked it, in quotes", form=PLAIN, flag="report_checker", metavar="TEXT")
    ] = None
    date: Annotated[
        str | None,
        SchemaKey("the date, in quotes", form=PLAIN, flag="report_date", metavar="TEXT", hint="Default: today."),
    ] = None


BaseMass = Annotated[float, SchemaKey("the mass of the base", "kg", low=0.0, high=1e12)]
Period = Annotated[float, SchemaKey("the first period on a fixed base", "s", low=0.01, high=60.0)]
AspectRatio = Annotated[
    float,
    SchemaKey(
        "the effective height over the half width, h*_1/B",
        low=0.1,
        high=100.0,
        label="Slenderness h*₁/B",
        metavar="RATIO",
    ),
]
Eccentricity = Annotated[
    float | None,
    SchemaKey(
        "the distance of the masses to the right of the middle of the base",
        "m",
        low=-1000.0,
        high=1000.0,
        label="Eccentricity e of the base",
        hint="In addition to the eight. Default: 0.",
    ),
]


class FrameSchema:
    """The arguments of `Frame`."""

    n_stories: Annotated[
        int,
        SchemaKey("the number of stories", form=WHOLE, low=1, high=200, label="Stories", flag="stories", metavar="N"),
    ]
    story_height: Annotated[float, SchemaKey("the height of a story", "m", low=0.1, high=100.0)]
    story_mass: Annotated[float, SchemaKey("the mass of each floor", "kg", low=1e-3, high=1e12)]
    base_mass: BaseMass
    stiffness_ratio: Annotated[
        float,
        SchemaKey(
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
        SchemaKey(
            "the fraction of critical damping",
            form="{}, a number such as 0.02",
            low=0.0,
            high=0.99,
            metavar="ZETA",
            hint="0.02 is 2 %.",
        ),
    ]


class FrameFlags(FrameSchema):
    """A frame and its place on the base, as the command line takes them."""

    eccentricity: Eccentricity = None


_PER_SPRING = "{}, a number or, with springs, one for each"


class GroundSchema:
    """Friction, and the rotary inertia of a base on springs."""

    friction: Annotated[
        float | list[float] | None,
        SchemaKey(
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
        SchemaKey(
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
        SchemaKey(
            "the mass m of a rigid mat as wide as the base",
            "kg",
            low=1e-3,
            high=1e12,
            hint="Its rotary inertia m (2B)²/12 is used in place of --base-inertia.",
        ),
    ] = None


class SpringBedSchema:
    """A bed of springs under the whole base."""

    breadth: Annotated[
        float,
        SchemaKey(
            "the dimension of the base perpendicular to the plane of rocking",
            "m",
            low=1e-3,
            high=1000.0,
            hint="The base stands on a bed of springs.",
        ),
    ]
    subgrade_modulus: Annotated[
        float | None,
        SchemaKey("the modulus of subgrade reaction, pressure over settlement", "N/m³", low=1.0, high=1e14),
    ] = None
    shear_modulus: Annotated[
        float | None,
        SchemaKey(
            "the effective shear modulus of the soil",
            "N/m²",
            low=1.0,
            high=1e14,
            hint="In place of --subgrade-modulus, for a bed with the stiffened ends of ASCE 41.",
        ),
    ] = None
    poisson_ratio: Annotated[
        float | None,
        SchemaKey("the Poisson ratio of the soil", low=0.0, high=0.5, metavar="NU", hint="With --shear-modulus."),
    ] = None
    heave_damping_ratio: Annotated[
        float | None,
        SchemaKey(
            "the damping of the heave mode over the critical damping",
            low=0.0,
            high=100.0,
            metavar="ZETA",
            hint="0.3 is 30 %.",
        ),
    ] = None
