"""Arguments and options that several commands share."""

from pathlib import Path
from typing import Annotated, Literal

import typer

from rockflex.cli._flags import ASSUMPTIONS

RECORD_FILES = "Record files"

StructureFile = Annotated[
    Path | None,
    typer.Option("--structure", "-s", metavar="FILE.toml", help="The structure file, if it is not the first argument."),
]
Friction = Annotated[
    float | None,
    typer.Option(
        "--friction",
        metavar="MU",
        help="Print the friction that each run requires (Eqs. 20-22), and when sliding starts with this coefficient.",
        rich_help_panel=ASSUMPTIONS,
    ),
]
WorkLimit = Annotated[
    str | None,
    typer.Option(
        "--work-limit",
        metavar="S|none",
        help="Longest computing time of one run, in s of one core; none: no limit. Default: 30.",
    ),
]
Units = Annotated[
    str | None,
    typer.Option(
        "--units",
        metavar="g|m/s2|cm/s2",
        help="Unit of the acceleration, if a file has none; or what one count is, such as '2.4e-4 cm/s2'.",
        rich_help_panel=RECORD_FILES,
    ),
]
Dt = Annotated[
    float | None,
    typer.Option("--dt", metavar="S", help="Sampling step in s, if a file has none.", rich_help_panel=RECORD_FILES),
]
Vertical = Annotated[
    str | None,
    typer.Option(
        "--vertical",
        metavar="FILE|pair",
        help="The record of the vertical component, of one motion; or pair: find those of all record files given.",
        rich_help_panel=RECORD_FILES,
    ),
]
OnError = Annotated[
    Literal["raise", "skip"],
    typer.Option(
        "--on-error",
        metavar="raise|skip",
        help="If files cannot be read: stop and list them all, or skip them.",
        rich_help_panel=RECORD_FILES,
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print only one JSON document, in SI units.")]
Out = Annotated[Path | None, typer.Option("--out", "-o", metavar="DIR", help="Write tables and figures to a folder.")]
Force = Annotated[bool, typer.Option("--force", help="Let --out replace earlier results in a folder.")]
Figures = Annotated[
    int,
    typer.Option(
        "--figures", metavar="N", min=0, help="Write a time series and a figure of each motion if there are at most N."
    ),
]
