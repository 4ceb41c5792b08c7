"""Options that several commands share, and options generated from the keys of files."""

import inspect
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, ClassVar, Literal, get_args

import typer
from typer.core import TyperCommand

from rockflex.cli._console import choose_decimal_comma
from rockflex.foundation.descriptions import Described, schema_keys
from rockflex.foundation.errors import InputError
from rockflex.foundation.language import Language
from rockflex.foundation.schema import (
    BoucWenSchema,
    FrameFlags,
    GroundSchema,
    ImpactSchema,
    InitialStateSchema,
    ReportKeys,
    SpringBedSchema,
    command_line_flag,
)
from rockflex.foundation.units import SystemName

FRAME = "Structure by flags (all eight), in place of a file"
GROUND = "Ground: springs under the base, and friction"
ASSUMPTIONS = "Impact, hysteresis, start and sliding"


class FrameCommand(TyperCommand):
    """A command that also takes a frame by flags.

    The options are generated when they are needed, so that ``rockflex --help`` does not wait for them.
    """

    panels: ClassVar[dict[str, tuple[type, ...]]] = {FRAME: (FrameFlags,)}

    @cached_property
    def generated(self) -> list[Any]:
        """The options of all tables, which typer reads from the signature of a function."""
        found = {
            _option_destination(name, key): Annotated[
                _option_type(kind) | None, _option_of_schema_key(table, name, key, panel)
            ]
            for panel, tables in self.panels.items()
            for table in tables
            for name, kind, key in schema_keys(table)
        }

        def function(**_: Any) -> None: ...

        keyword = inspect.Parameter.KEYWORD_ONLY
        parameters = [inspect.Parameter(name, keyword, default=None, annotation=each) for name, each in found.items()]
        function.__signature__ = inspect.Signature(parameters)  # pyright: ignore[reportFunctionMemberAccess]
        function.__annotations__ = found
        app = typer.Typer(add_completion=False)
        app.command()(function)
        return typer.main.get_command(app).params

    def get_params(self, ctx: Any) -> list[Any]:
        """Return the command's own parameters, with the generated ones before its first panel."""
        own = super().get_params(ctx)
        first = next((place for place, each in enumerate(own) if getattr(each, "rich_help_panel", None)), len(own))
        return [*own[:first], *self.generated, *own[first:]]

    def invoke(self, ctx: Any) -> Any:
        """Run the command, with the values that were given by these options in ``ctx.obj``."""
        values = {option.name: ctx.params.pop(option.name) for option in self.generated}
        ctx.obj = {name: value for name, value in values.items() if value is not None}
        return super().invoke(ctx)


class RunCommand(FrameCommand):
    """A command that also takes the options of runs by flags."""

    panels: ClassVar[dict[str, tuple[type, ...]]] = {
        ASSUMPTIONS: (ImpactSchema, BoucWenSchema, InitialStateSchema),
        GROUND: (GroundSchema, SpringBedSchema),
        FRAME: (FrameFlags,),
    }


class ReportCommand(RunCommand):
    """A command that also writes a report."""

    panels: ClassVar[dict[str, tuple[type, ...]]] = {"Head of the report": (ReportKeys,), **RunCommand.panels}


def flag_values(ctx: typer.Context, table: type) -> dict[str, Any]:
    """Return the values that the flags of a table give, by key."""
    flags = ((name, _option_destination(name, key)) for name, _, key in schema_keys(table))
    return {name: ctx.obj[flag] for name, flag in flags if flag in ctx.obj}


def flags_of_tables(*tables: type) -> dict[str, str]:
    """Return the flag of each key of some tables."""
    return {name: command_line_flag(name, key) for table in tables for name, _, key in schema_keys(table)}


def report_format(
    page: Path | None, units: SystemName | None, language: Language | None, *, comma: bool
) -> dict[str, Any]:
    """Return the arguments of `write_report` that ``--output-units``, ``--language`` and ``--decimal-comma`` give.

    Raises
    ------
    InputError
        If there is a language but no page to be written in it.
    """
    if language is not None and page is None:
        raise InputError(
            "--language is that of a report, but none is written. Give the file of a report, or leave it out."
        )
    return {"units": units or "kN", "language": language or "en", "decimal": "," if comma else None}


@contextmanager
def naming_flags_in_errors(flags: Mapping[str, str]) -> Generator[None]:
    """Name the flag in the message of an `InputError` about one of these arguments."""
    try:
        yield
    except InputError as error:
        text = str(error)
        argument, _, rest = text.partition(" ")
        if argument in flags:
            raise InputError(f"{flags[argument]} {rest}", field=error.field) from error
        if (field := error.field or "") in flags:
            message = f"{text} On the command line this is {flags[field]}."
            raise InputError(message, field=field) from error
        raise


def _option_destination(name: str, key: Described) -> str:
    """Return the name of an option, which differs between tables with the same key."""
    return key.flag or name


def _option_type(annotation: Any) -> type:
    kinds = get_args(annotation) or (annotation,)
    return next((kind for kind in (int, float) if kind in kinds), str)


def _option_of_schema_key(table: type, name: str, key: Described, panel: str) -> Any:
    default = getattr(table, name, None)
    words = key.description.removeprefix("the ")
    begins = words[:1].upper() if words[:2].isalpha() else words[:1]  # but not γ or n, which are symbols
    usual = "" if default is None else f"Default: {default:g}."
    sentences = (f"{begins}{words[1:]}{key.unit and f' in {key.unit}'}.", key.hint, usual)
    return typer.Option(
        command_line_flag(name, key),
        metavar=key.metavar or key.unit.upper(),
        help=" ".join(filter(None, sentences)),
        rich_help_panel=panel,
    )


def option(flags: str, metavar: str, words: str, **more: Any) -> Any:
    """Return an option of typer: its flags, separated by blanks, its placeholder, and its help."""
    return typer.Option(*flags.split(), metavar=metavar, help=words, **more)


RECORD_FILES = "Record files"

StructureFile = Annotated[
    Path | None, option("--structure -s", "FILE.toml", "The structure file, if it is not the first argument.")
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
    list[str] | None, option("--motion -m", "MOTION", "A ground motion; may be repeated.", show_default=False)
]
Models = Annotated[
    list[str] | None,
    option(
        "--model",
        "LABEL",
        "Labels, separated by commas. Simplified: 2DOF-S, 3DOF-S, ... MDOF-S; complete: 2DOF-C, 2DOF-C-SI, "
        "MDOF-C, 3DOF-C-SI, 3DOF-C-E, ...; without flexure: rigid, rigid-C; fixed base: fixed, 5DOF-fixed; one "
        "mode that yields: 2DOF-S-BW, 2DOF-C-BW, 1DOF-fixed-BW; with the mass of omitted modes in V_b and M_b: "
        "2DOF-S-R, 5DOF-fixed-R, ... Default: 2DOF-S,MDOF-S,fixed; with a hysteresis "
        "2DOF-S,2DOF-S-BW,1DOF-fixed-BW; with an initial rotation, on springs or with "
        "--ground-friction, those of these that rock.",
        show_default=False,
    ),
]
Scales = Annotated[
    list[str],
    option(
        "--scale", "FACTOR", "Factor on the acceleration, or smallest:largest:step such as 0.5:3:0.25; may be repeated."
    ),
]
FreeVibration = Annotated[
    str, typer.Option(metavar="S|settle", help="Seconds after the record, or settle: until at rest or overturned.")
]
Friction = Annotated[
    float | None,
    option(
        "--friction",
        "MU",
        "Print the friction that each run requires (Eqs. 20-22), and when sliding starts with this coefficient.",
        rich_help_panel=ASSUMPTIONS,
    ),
]
WorkLimit = Annotated[
    str | None,
    option(
        "--work-limit", "S|none", "Longest computing time of one run, in s of one core; none: no limit. Default: 30."
    ),
]
Units = Annotated[
    str | None,
    option(
        "--units",
        "g|m/s2|cm/s2",
        "Unit of the acceleration, if a file has none; or what one count is, such as '2.4e-4 cm/s2'.",
        rich_help_panel=RECORD_FILES,
    ),
]
Dt = Annotated[
    float | None, option("--dt", "S", "Sampling step in s, if a file has none.", rich_help_panel=RECORD_FILES)
]
Vertical = Annotated[
    str | None,
    option(
        "--vertical",
        "FILE|pair",
        "The record of the vertical component, of one motion; or pair: find those of all record files given.",
        rich_help_panel=RECORD_FILES,
    ),
]
OnError = Annotated[
    Literal["raise", "skip"],
    option(
        "--on-error",
        "raise|skip",
        "If files cannot be read: stop and list them all, or skip them.",
        rich_help_panel=RECORD_FILES,
    ),
]
OutputUnits = Annotated[
    SystemName | None,
    option("--output-units", "|".join(get_args(SystemName)), "Units of tables and reports; inputs stay in SI units."),
]
ReportLanguage = Annotated[
    Language | None,
    option("--language", "|".join(get_args(Language)), "Language of the report; tables and messages stay English."),
]
DecimalComma = Annotated[
    bool,
    typer.Option(
        "--decimal-comma",
        callback=choose_decimal_comma,
        help="Write decimal commas in tables and English reports, not in --json and the files of --out.",
    ),
]
Json = Annotated[bool, typer.Option("--json", help="Print only one JSON document, in SI units.")]
Out = Annotated[Path | None, option("--out -o", "DIR", "Write tables and figures to a folder.")]
Force = Annotated[bool, typer.Option("--force", help="Let --out replace earlier results in a folder.")]
ForceBoth = Annotated[
    bool, typer.Option("--force", help="Let --out replace earlier results in a folder, and --report an earlier page.")
]
Report = Annotated[
    Path | None,
    option(
        "--report",
        "FILE.html|pdf|docx",
        "Write a report on one sheet of A4, of one motion at one scale: as HTML, printed by Chromium, or for Word.",
        show_default=False,
    ),
]
Figures = Annotated[
    int, option("--figures", "N", "Write a time series and a figure of each motion if there are at most N.", min=0)
]
