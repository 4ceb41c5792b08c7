"""The application: its commands, its version and its exit codes."""

import os
import signal
import sys
from contextlib import suppress
from contextvars import copy_context
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from rockflex import __version__
from rockflex.cli import (
    _animate,
    _check,
    _compare,
    _modes,
    _motion,
    _project,
    _reproduce,
    _run,
    _select,
    _study,
    _tornado,
)
from rockflex.cli import _console as console
from rockflex.cli._options import FrameCommand, ReportCommand, RunCommand
from rockflex.foundation.errors import InputError, SolverError, system_error_text
from rockflex.studies._study_kind import KINDS

SERVE_EPILOG = """[bold]Examples[/bold]

rockflex serve

rockflex serve --port 9000 --open"""


def serve(
    port: Annotated[int, typer.Option("--port", "-p", help="TCP port.")] = 8080,
    host: Annotated[
        str, typer.Option(help="Address to listen on. The default accepts only this machine.")
    ] = "127.0.0.1",
    name: Annotated[
        list[str] | None,
        typer.Option(help="Another name by which the page is reached; may be repeated.", show_default=False),
    ] = None,
    root_path: Annotated[
        str, typer.Option(help="Path under which a server in front of it has the page: /rocking.", show_default=False)
    ] = "",
    no_token: Annotated[
        bool, typer.Option("--no-token", help="Open the page to everyone who can reach it, without a token.")
    ] = False,
    open_browser: Annotated[bool, typer.Option("--open", help="Open the page in the browser.")] = False,
) -> None:
    """Serve the web page: structure, earthquake, response, fragility and design."""
    from secrets import token_urlsafe

    from rockflex.web._hosts import is_loopback_host
    from rockflex.web._serve import serve as start

    token = ""
    if not is_loopback_host(host):
        token = "" if no_token else token_urlsafe(24)
        console.print_remark(
            f"Everyone who can reach {host} can use the page: it has no passwords."
            if no_token
            else "The page opens by the address with its token only; who has that can use it. Without: --no-token."
        )

    def announce(address: str) -> None:
        console.print_remark(f"{address} (stop with Ctrl-C)")

    with suppress(KeyboardInterrupt):  # the usual way to stop it
        start(
            port, host, names=name or (), token=token, root_path=root_path, open_browser=open_browser, on_start=announce
        )


EPILOG = """[bold]Examples[/bold]

rockflex motion fema-p695-far-field

rockflex select fema-p695-far-field --target ec8:ag=0.25g,ground=C --count 7 --periods 0.2,2 --records chosen

rockflex modes structure.toml

rockflex run structure.toml el-centro-1940 --model 2DOF-S,MDOF-S --scale 1.5 --out results

rockflex check structure.toml chosen --rule ec8 --limits limits.toml

rockflex compare a.toml b.toml fema-p695-far-field --report compared.html

rockflex tornado structure.toml fema-p695-far-field --parameter period=0.2

rockflex project new pier.rockflex a.toml b.toml chosen --rule ec8

rockflex cloud study.toml --out study

rockflex figures study

rockflex reproduce --out out/paper

[bold]Exit codes[/bold]

0: done; 1: a run could not be solved (in a study only with --strict, which also counts fits that fail), and with
check --strict a limit is exceeded; 2: an input cannot be used; 130: stopped by Ctrl-C."""


class RockflexCommands(TyperGroup):
    """Commands whose errors end in one paragraph on stderr and an exit code: 2 for input, 1 for the solver."""

    def invoke(self, ctx: Any) -> Any:
        """Run the command."""
        try:
            with console.printing_warnings_as_remarks():
                return copy_context().run(super().invoke, ctx)
        except (InputError, SolverError) as error:
            console.print_error(str(error))
            raise typer.Exit(2 if isinstance(error, InputError) else 1) from error
        except (OSError, UnicodeError) as error:
            if isinstance(error, BrokenPipeError):  # its reader has had enough, such as head
                raise
            console.print_error(system_error_text(error))
            raise typer.Exit(2) from error
        except KeyboardInterrupt as stop:
            console.print_remark("Stopped; nothing was written.")
            raise typer.Exit(130) from stop


app = typer.Typer(
    name="rockflex",
    cls=RockflexCommands,
    epilog=EPILOG,
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode="rich",
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)
app.command("run", cls=ReportCommand, epilog=_run.EPILOG, no_args_is_help=True)(_run.run)
app.command("check", cls=RunCommand, epilog=_check.EPILOG, no_args_is_help=True)(_check.check)
app.command("compare", cls=_compare.CompareCommand, epilog=_compare.EPILOG, no_args_is_help=True)(_compare.compare)
app.command("tornado", cls=RunCommand, epilog=_tornado.EPILOG, no_args_is_help=True)(_tornado.tornado)
app.add_typer(_project.app, name="project")
app.command("animate", cls=RunCommand, epilog=_animate.EPILOG, no_args_is_help=True)(_animate.animate)
app.command("modes", cls=FrameCommand, epilog=_modes.EPILOG, no_args_is_help=True)(_modes.modes)
app.command("motion", epilog=_motion.EPILOG)(_motion.motion)
app.command("survey", epilog=_motion.SURVEY_EPILOG, no_args_is_help=True)(_motion.survey)
app.command("select", epilog=_select.EPILOG, no_args_is_help=True)(_select.select)
for kind in KINDS.values():
    app.command(kind.command, epilog=_study.study_command_epilog(kind.command), no_args_is_help=True)(
        _study.study_command(kind)
    )
app.command("figures", epilog=_study.FIGURES_EPILOG, no_args_is_help=True)(_study.figures)
app.command("serve", epilog=SERVE_EPILOG)(serve)
app.command("reproduce", epilog=_reproduce.EPILOG)(_reproduce.reproduce)


def _print_version(asked: bool) -> None:
    if asked:
        typer.echo(f"rockflex {__version__}")
        raise typer.Exit


@app.callback()
def rockflex(
    _: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Seismic response of flexible structures whose base may uplift and rock: exact, and fast."""


def main() -> None:
    """Run the command line; the entry point of ``rockflex`` and ``python -m rockflex``."""
    for stream in (sys.stdout, sys.stderr):
        # A terminal without Greek letters shows question marks instead of a traceback.
        if hasattr(stream, "reconfigure"):
            stream.reconfigure(errors="replace")  # pyright: ignore[reportAttributeAccessIssue]
    with suppress(ValueError):  # outside the main thread
        if signal.getsignal(signal.SIGTERM) == signal.SIG_DFL:
            signal.signal(signal.SIGTERM, _stop)
    code: Any = 0
    try:
        app(prog_name="rockflex")
    except SystemExit as end:
        code = end.code
    raise SystemExit(_flushed(code))


def _stop(*_: object) -> None:
    """End like Ctrl-C, so that temporary files go and locks are released."""
    raise KeyboardInterrupt


def _flushed(code: Any) -> Any:
    """Write what is left for stdout; return the exit code, which tells if that cannot be done."""
    out = sys.stdout
    try:
        out.flush()
    except AttributeError:  # closed from the start
        return code
    except OSError as error:
        with suppress(OSError, ValueError):  # what is left would be tried again when Python ends
            os.dup2(os.open(os.devnull, os.O_WRONLY), out.fileno())
        if isinstance(error, BrokenPipeError):
            return code
        if code == 0:
            console.print_error(f"The output: {system_error_text(error)}")
        return code or 2
    return code
