"""Options generated from the keys of the frame, the impact law, the hysteresis, the initial state and the ground."""

import inspect
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from functools import cached_property
from typing import Annotated, Any, ClassVar, get_args

import typer
from typer.core import TyperCommand

from rockflex._errors import InputError
from rockflex._schema import (
    BedKeys,
    BoucWenKeys,
    FrameFlags,
    GroundKeys,
    ImpactKeys,
    InitialKeys,
    Key,
    flag_of,
    keys_of,
)

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
            _destination(name, key): Annotated[_kind(kind) | None, _option(table, name, key, panel)]
            for panel, tables in self.panels.items()
            for table in tables
            for name, kind, key in keys_of(table)
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
        """Return the command's own parameters and, before its first panel, those of the tables."""
        own = super().get_params(ctx)
        first = next((place for place, each in enumerate(own) if getattr(each, "rich_help_panel", None)), len(own))
        return [*own[:first], *self.generated, *own[first:]]

    def invoke(self, ctx: Any) -> Any:
        """Run the command, with the values that were given by these options in ``ctx.obj``."""
        values = {option.name: ctx.params.pop(option.name) for option in self.generated}
        ctx.obj = {name: value for name, value in values.items() if value is not None}
        return super().invoke(ctx)


class RunCommand(FrameCommand):
    """A command that also takes the assumptions of runs by flags."""

    panels: ClassVar[dict[str, tuple[type, ...]]] = {
        ASSUMPTIONS: (ImpactKeys, BoucWenKeys, InitialKeys),
        GROUND: (GroundKeys, BedKeys),
        FRAME: (FrameFlags,),
    }


def given(ctx: typer.Context, table: type) -> dict[str, Any]:
    """Return the values that the flags of a table give, by key."""
    flags = ((name, _destination(name, key)) for name, _, key in keys_of(table))
    return {name: ctx.obj[flag] for name, flag in flags if flag in ctx.obj}


def flags_of(*tables: type) -> dict[str, str]:
    """Return the flag of each key of some tables."""
    return {name: flag_of(name, key) for table in tables for name, _, key in keys_of(table)}


@contextmanager
def naming(flags: Mapping[str, str]) -> Generator[None]:
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


def _destination(name: str, key: Key) -> str:
    """Return the name of an option among those of its command, where keys of several tables may be the same."""
    return key.flag or name


def _kind(annotation: Any) -> type:
    kinds = get_args(annotation) or (annotation,)
    return next((kind for kind in (int, float) if kind in kinds), str)


def _option(table: type, name: str, key: Key, panel: str) -> Any:
    default = getattr(table, name, None)
    words = key.description.removeprefix("the ")
    begins = words[:1].upper() if words[:2].isalpha() else words[:1]  # but not γ or n, which are symbols
    usual = "" if default is None else f"Default: {default:g}."
    sentences = (f"{begins}{words[1:]}{key.unit and f' in {key.unit}'}.", key.hint, usual)
    return typer.Option(
        flag_of(name, key),
        metavar=key.metavar or key.unit.upper(),
        help=" ".join(filter(None, sentences)),
        rich_help_panel=panel,
    )
