"""``rockflex serve``: the web page."""

from contextlib import suppress
from typing import Annotated

import typer

EPILOG = """[bold]Examples[/bold]

rockflex serve

rockflex serve --port 9000 --open"""


def serve(
    port: Annotated[int, typer.Option("--port", "-p", help="TCP port.")] = 8080,
    host: Annotated[
        str,
        typer.Option(help="Address to listen on. The default accepts only this machine."),
    ] = "127.0.0.1",
    name: Annotated[
        list[str] | None,
        typer.Option(help="Another name by which the page is reached; may be repeated.", show_default=False),
    ] = None,
    open_browser: Annotated[bool, typer.Option("--open", help="Open the page in the browser.")] = False,
) -> None:
    """Serve the web page: structure, earthquake, response, fragility and design."""
    from rockflex.cli._console import note
    from rockflex.web import serve as start
    from rockflex.web._hosts import address_of, is_loopback

    if not is_loopback(host):
        note(f"Everyone who can reach {host} can use the page: it has no passwords.")
    note(f"{address_of(host, port)} (stop with Ctrl-C)")
    with suppress(KeyboardInterrupt):  # the usual way to stop it
        start(port, host, names=name or (), open_browser=open_browser)
