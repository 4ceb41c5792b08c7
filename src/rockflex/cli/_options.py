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
Arguments = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="STRUCTURE.toml MOTION",
        help="The structure file, then ground motions: suites, records (suite/name), files or directories.",
        show_default=False,
    ),
]
Motions = Annotated[
    list[str] | None,
    typer.Option("--motion", "-m", metavar="MOTION", help="A ground motion; may be repeated.", show_default=False),
]
Models = Annotated[
    list[str] | None,
    typer.Option(
        "--model",
        metavar="LABEL",
        help="Labels, separated by commas. Simplified: 2DOF-S, 3DOF-S, ... MDOF-S; complete: 2DOF-C, 2DOF-C-SI, "
        "MDOF-C, 3DOF-C-SI, 3DOF-C-E, ...; without flexure: rigid, rigid-C; fixed base: fixed, 5DOF-fixed; one "
        "mode that yields: 2DOF-S-BW, 2DOF-C-BW, 1DOF-fixed-BW; with the mass of omitted modes in V_b and M_b: "
        "2DOF-S-R, 5DOF-fixed-R, ... Default: 2DOF-S,MDOF-S,fixed; with a hysteresis "
        "2DOF-S,2DOF-S-BW,1DOF-fixed-BW; with an initial rotation, those of these that rock; on springs or with "
        "--ground-friction, those that are simplified and elastic and rock.",
        show_default=False,
    ),
]
Scales = Annotated[
    list[str],
    typer.Option(
        "--scale",
        metavar="FACTOR",
        help="Factor on the acceleration, or smallest:largest:step such as 0.5:3:0.25; may be repeated.",
    ),
]
FreeVibration = Annotated[
    str,
    typer.Option(metavar="S|settle", help="Seconds after the record, or settle: until at rest or overturned."),
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
ForceBoth = Annotated[
    bool, typer.Option("--force", help="Let --out replace earlier results in a folder, and --report an earlier page.")
]
Report = Annotated[
    Path | None,
    typer.Option(
        "--report",
        metavar="FILE.html",
        help="Write a report on one sheet of A4, of one motion at one scale.",
        show_default=False,
    ),
]
Figures = Annotated[
    int,
    typer.Option(
        "--figures", metavar="N", min=0, help="Write a time series and a figure of each motion if there are at most N."
    ),
]
