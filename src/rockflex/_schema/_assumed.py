"""The keys of what a run assumes besides its model: impact law, hysteresis and initial state."""

from typing import Annotated, Literal, get_args

from rockflex._schema._key import Key

LawName = Literal["simplified", "complete", "restitution"]
LAWS: tuple[str, ...] = get_args(LawName)
_QUOTED = [f'"{law}"' for law in LAWS]
IMPACT = Key(
    "the impact law",
    form=f"{', '.join(_QUOTED[:-1])} or {_QUOTED[-1]}",
    metavar="LAW",
    hint="One of simplified (Eq. 25), complete (Eq. 29) and restitution. Default: each model's own law.",
)


class ImpactKeys:
    """An impact law in place of each model's own, and its coefficient."""

    impact: Annotated[LawName | None, IMPACT]
    restitution: Annotated[
        float | None,
        Key(
            "the rotation velocity after an impact over that before",
            form="a number from 0 to 1",
            metavar="E",
            hint="From 0 to 1; with --impact restitution.",
        ),
    ] = None


class BoucWenKeys:
    """The arguments of `BoucWen`."""

    yield_displacement: Annotated[
        float,
        Key(
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
        Key(
            "stiffness after yielding over that before",
            low=0.0,
            high=0.99,
            label="Post-yield stiffness ratio α",
            metavar="ALPHA",
        ),
    ] = 0.01
    gamma: Annotated[
        float,
        Key("γ of the hysteresis (Eq. 38)", low=1e-3, high=10.0, label="γ", flag="bw_gamma", metavar="GAMMA"),
    ] = 0.5
    beta: Annotated[
        float,
        Key("β of the hysteresis (Eq. 38)", low=-10.0, high=10.0, label="β", flag="bw_beta", metavar="BETA"),
    ] = 0.5
    exponent: Annotated[
        float,
        Key(
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


class InitialKeys:
    """The state at t = 0."""

    initial_rotation: Annotated[
        float | None,
        Key(
            "the rotation at t = 0",
            "rad",
            hint="The structure starts at rest there; without a motion it vibrates freely for --free-vibration.",
        ),
    ] = None
