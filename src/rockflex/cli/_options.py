"""Arguments and options that several commands share."""

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

import typer

FRAME = "Structure by flags (all eight), in place of a file"
ASSUMPTIONS = "Impact, hysteresis, start and sliding"
RECORD_FILES = "Record files"

StructureFile = Annotated[
    Path | None,
    typer.Option(
        "--structure", "-s", metavar="FILE.toml", help="The structure's file, if it is not the first argument."
    ),
]
Stories = Annotated[
    int | None, typer.Option("--stories", metavar="N", help="Number of stories.", rich_help_panel=FRAME)
]
StoryHeight = Annotated[
    float | None, typer.Option("--story-height", metavar="M", help="Height of a story in m.", rich_help_panel=FRAME)
]
StoryMass = Annotated[
    float | None, typer.Option("--story-mass", metavar="KG", help="Mass of each floor in kg.", rich_help_panel=FRAME)
]
BaseMass = Annotated[
    float | None, typer.Option("--base-mass", metavar="KG", help="Mass of the base in kg.", rich_help_panel=FRAME)
]
Stiffness = Annotated[
    float | None,
    typer.Option(
        "--stiffness-ratio",
        metavar="RHO",
        help="Beam to column stiffness: 0 (cantilevers) to inf (shear building).",
        rich_help_panel=FRAME,
    ),
]
Period = Annotated[
    float | None,
    typer.Option("--period", metavar="S", help="First period on a fixed base in s.", rich_help_panel=FRAME),
]
AspectRatio = Annotated[
    float | None,
    typer.Option(
        "--aspect-ratio", metavar="RATIO", help="Effective height over half width, h*_1/B.", rich_help_panel=FRAME
    ),
]
DampingRatio = Annotated[
    float | None,
    typer.Option(
        "--damping-ratio", metavar="ZETA", help="Fraction of critical damping: 0.02 is 2 %.", rich_help_panel=FRAME
    ),
]
Eccentricity = Annotated[
    float | None,
    typer.Option(
        "--eccentricity",
        metavar="M",
        help="How far the masses stand to the right of the middle of the base, in m; beside the eight. Default: 0.",
        rich_help_panel=FRAME,
    ),
]
Impact = Annotated[
    str | None,
    typer.Option(
        "--impact",
        metavar="LAW",
        help="simplified (Eq. 25), complete (Eq. 29) or restitution, in place of each model's own law.",
        rich_help_panel=ASSUMPTIONS,
    ),
]
Restitution = Annotated[
    float | None,
    typer.Option(
        "--restitution",
        metavar="E",
        help="Rotation velocity after an impact over that before, 0 to 1; with --impact restitution.",
        rich_help_panel=ASSUMPTIONS,
    ),
]
YieldDisplacement = Annotated[
    float | None,
    typer.Option(
        "--yield-displacement",
        metavar="DY",
        help="D_y of the first mode in m (Eqs. 37-38). Models whose label ends in -BW yield, all others stay elastic.",
        rich_help_panel=ASSUMPTIONS,
    ),
]
PostYieldRatio = Annotated[
    float | None,
    typer.Option(
        "--post-yield-ratio",
        metavar="ALPHA",
        help="Stiffness after yielding over that before. Default: 0.01.",
        rich_help_panel=ASSUMPTIONS,
    ),
]
BwGamma = Annotated[
    float | None,
    typer.Option("--bw-gamma", metavar="GAMMA", help="γ of Eq. 38. Default: 0.5.", rich_help_panel=ASSUMPTIONS),
]
BwBeta = Annotated[
    float | None,
    typer.Option("--bw-beta", metavar="BETA", help="β of Eq. 38. Default: 0.5.", rich_help_panel=ASSUMPTIONS),
]
BwExponent = Annotated[
    float | None,
    typer.Option("--bw-exponent", metavar="N", help="n of Eq. 38, 1 or more. Default: 8.", rich_help_panel=ASSUMPTIONS),
]
InitialRotation = Annotated[
    float | None,
    typer.Option(
        "--initial-rotation",
        metavar="RAD",
        help="Rotation at t = 0, at rest there. Without a motion: free vibration as long as --free-vibration says.",
        rich_help_panel=ASSUMPTIONS,
    ),
]
Friction = Annotated[
    float | None,
    typer.Option(
        "--friction",
        metavar="MU",
        help="Print the friction that each run needs (Eqs. 20-22), and when sliding would start with this coefficient.",
        rich_help_panel=ASSUMPTIONS,
    ),
]
WorkLimit = Annotated[
    str | None,
    typer.Option(
        "--work-limit",
        metavar="S|none",
        help="The most computing that one run may take, in s of one core; none lifts the limit. Default: 30.",
    ),
]
Units = Annotated[
    str | None,
    typer.Option(
        "--units",
        metavar="g|m/s2|cm/s2",
        help="Unit of the acceleration, if a file has none.",
        rich_help_panel=RECORD_FILES,
    ),
]
Dt = Annotated[
    float | None,
    typer.Option("--dt", metavar="S", help="Sampling step in s, if a file has none.", rich_help_panel=RECORD_FILES),
]
OnError = Annotated[
    Literal["raise", "skip"],
    typer.Option(
        "--on-error",
        metavar="raise|skip",
        help="With files that cannot be read: stop and name them all, or go on with the others.",
        rich_help_panel=RECORD_FILES,
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON document, in SI units, and nothing else.")]
Out = Annotated[Path | None, typer.Option("--out", "-o", metavar="DIR", help="Write tables and figures to a folder.")]
Force = Annotated[bool, typer.Option("--force", help="Let --out replace the results in a folder that is not empty.")]
Figures = Annotated[
    int,
    typer.Option(
        "--figures", metavar="N", min=0, help="Write a series and a figure of each motion where there are at most N."
    ),
]

ARGUMENTS = (
    "n_stories",
    "story_height",
    "story_mass",
    "base_mass",
    "stiffness_ratio",
    "period",
    "aspect_ratio",
    "damping_ratio",
    "eccentricity",
)


def frame_arguments(values: Sequence[float | None]) -> dict[str, Any]:
    """Name the values of the flags of a frame, in their order, as `Frame` and `Eccentric` do."""
    return dict(zip(ARGUMENTS, values, strict=True))
