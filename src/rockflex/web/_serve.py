"""Start of the web page."""

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

from rockflex.foundation.checks import checked_whole_number
from rockflex.foundation.errors import InputError
from rockflex.web._hosts import page_address

if TYPE_CHECKING:
    from starlette.applications import Starlette

KEEP_ALIVE = 20  # s for the next request on an open connection
BACKLOG = 128  # connections that wait to be accepted
GRACE = 3  # s for the answers in progress when the server is stopped
ARENAS = -8, 2  # what glibc's malloc.h calls M_ARENA_MAX, and how many pools of memory the threads share


def make_app(host: str = "127.0.0.1", names: Sequence[str] = (), token: str = "") -> "Starlette":
    """Return the page as an ASGI application, for another server.

    Parameters
    ----------
    host
        Address that it will listen on. It answers only to this name, to localhost and to loopback addresses; if it
        listens on all addresses ("0.0.0.0" or "::"), to each of them and to the name of the machine.
    names
        Other names by which it is reached, such as that of a server in front of it.
    token
        If given, it answers only to those who bring it: ``?token=...`` at the end of the first address.
    """
    from rockflex.web._app import create_page_application

    return create_page_application(host, names, token)


def serve(
    port: int = 8080,
    host: str = "127.0.0.1",
    *,
    names: Sequence[str] = (),
    token: str = "",
    root_path: str = "",
    open_browser: bool = False,
    on_start: Callable[[str], object] | None = None,
) -> None:
    """Serve the web page until interrupted.

    A client must send the head of a request within 10 s, and its content within 60 s.

    Parameters
    ----------
    port
        TCP port.
    host
        Address to listen on; the default accepts only this machine. There are no users and passwords: before opening
        it to a network, give a `token`, or put a server with authentication in front of it.
    names, token
        As for `make_app`.
    root_path
        The path under which a server in front of it, which removes that path, has the page: ``"/rocking"``.
    open_browser
        Whether to open the page in the browser of this machine.
    on_start
        Called with the address of the page once it answers.

    Raises
    ------
    InputError
        If the port cannot be opened, or the page does not start.
    """
    number = checked_whole_number("port", port, 1, 65535)
    _let_threads_share_memory()
    app = make_app(host, names, token)
    import signal
    import socket
    from threading import Event, Thread, current_thread, main_thread

    import uvicorn

    from rockflex.web._connections import MAX_CONNECTIONS, patient_protocol

    listener = socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET)
    # Windows would give a port to several servers, and the others to those of which none listens yet.
    exclusive = getattr(socket, "SO_EXCLUSIVEADDRUSE", None)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR if exclusive is None else exclusive, 1)
    try:
        listener.bind((host, number))
        listener.listen(BACKLOG)
    except OSError as error:
        listener.close()
        raise InputError(
            f"The page cannot listen on {host}, port {number}: {error.strerror or error}. Choose another --port."
        ) from error
    config = uvicorn.Config(
        app, log_level="warning", http=patient_protocol(), ws="none", timeout_keep_alive=KEEP_ALIVE,
        limit_concurrency=MAX_CONNECTIONS, timeout_graceful_shutdown=GRACE, server_header=False,
        root_path=root_path.rstrip("/"),
    )  # fmt: skip
    server = uvicorn.Server(config)
    over = Event()  # Python 3.11 takes a thread for ended once a signal has interrupted its join

    def run() -> None:
        try:
            server.run([listener])
        finally:
            over.set()

    # The threads that it starts are daemons as well: none of them, whatever it reads, keeps the process alive.
    running = Thread(target=run, name="server", daemon=True)
    if current_thread() is main_thread():
        signal.signal(signal.SIGTERM, signal.default_int_handler)
    with listener:
        running.start()
        try:
            while not server.started and not over.wait(0.02):
                pass
            if server.started:
                address = page_address(host, number) + (f"/?token={token}" if token else "")
                if on_start is not None:
                    on_start(address)
                if open_browser:
                    import webbrowser

                    # Some browsers of a terminal return only when they are closed.
                    Thread(target=webbrowser.open, args=(address,), daemon=True).start()
            while not over.wait(0.5):
                pass
            if not server.started:
                raise InputError("The page did not start; the lines above say why.")
        finally:
            server.should_exit = True
            over.wait(GRACE + 2.0)


def _let_threads_share_memory() -> None:
    """Limit the pools that threads take memory from: glibc gives each thread one of its own, and little of it back."""
    import ctypes
    import platform

    if platform.libc_ver()[0] == "glibc":
        ctypes.CDLL(None).mallopt(*ARENAS)
