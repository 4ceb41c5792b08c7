"""Start of the web page."""

from typing import TYPE_CHECKING

from rockflex._checks import whole_number
from rockflex._errors import InputError

if TYPE_CHECKING:
    from starlette.applications import Starlette

NEEDED = ("anyio", "starlette", "tomli_w", "uvicorn")


def make_app(host: str = "127.0.0.1") -> "Starlette":
    """Return the page as an ASGI application, for another server.

    Parameters
    ----------
    host
        Address that it will listen on. At a loopback address it answers only to the names 127.0.0.1 and localhost.

    Raises
    ------
    InputError
        If the packages of ``rockflex[web]`` are missing.
    """
    _check_installed()
    from rockflex.web._app import create

    return create(host)


def serve(port: int = 8080, host: str = "127.0.0.1", *, open_browser: bool = False) -> None:
    """Serve the web page until interrupted.

    Parameters
    ----------
    port
        TCP port.
    host
        Address to listen on; the default accepts only this machine. There are no users and passwords: before opening
        it to a network, put a server with authentication in front of it.
    open_browser
        Whether to open the page in the browser of this machine.

    Raises
    ------
    InputError
        If the packages of ``rockflex[web]`` are missing, or the port cannot be opened.
    """
    number = whole_number("port", port, 1, 65535)
    app = make_app(host)
    import socket

    import uvicorn

    listener = socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((host, number))
    except OSError as error:
        listener.close()
        raise InputError(
            f"The page cannot listen on {host}, port {number}: {error.strerror or error}. Choose another --port."
        ) from error
    config = uvicorn.Config(app, log_level="warning", timeout_keep_alive=20, limit_concurrency=500, server_header=False)
    with listener:
        if open_browser:
            import threading
            import webbrowser

            threading.Timer(1.0, webbrowser.open, [f"http://{host}:{number}"]).start()
        uvicorn.Server(config).run(sockets=[listener])


def _check_installed() -> None:
    from importlib.util import find_spec

    missing = [name for name in NEEDED if find_spec(name) is None]
    if missing:
        raise InputError(f"The web page needs {', '.join(missing)}. Install it: pip install 'rockflex[web]'.")
