"""Arguments and options that several commands share."""

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any

import typer

__all__ = [
    "AspectRatio",
    "BaseMass",
    "DampingRatio",
    "Dt",
    "Figures",
    "Force",
    "Json",
    "Out",
    "Period",
    "Stiffness",
    "Stories",
    "StoryHeight",
    "StoryMass",
    "StructureFile",
    "Units",
    "frame_arguments",
]

FRAME = "Structure by flags (all eight), in place of a file"
RECORD_FILES = "Records from files that do not say it themselves"

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
Units = Annotated[
    str | None,
    typer.Option("--units", metavar="g|m/s2|cm/s2", help="Unit of the acceleration.", rich_help_panel=RECORD_FILES),
]
Dt = Annotated[
    float | None,
    typer.Option("--dt", metavar="S", help="Sampling step in s.", rich_help_panel=RECORD_FILES),
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
)


def frame_arguments(values: Sequence[float | None]) -> dict[str, Any]:
    """Name the values of the flags of a frame, in their order, as `Frame` does."""
    return dict(zip(ARGUMENTS, values, strict=True))
