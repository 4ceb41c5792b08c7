"""Protection of the server: known host names, and security headers."""

import socket
from collections.abc import Iterable
from urllib.parse import urlsplit

from starlette.datastructures import Headers as RequestHeaders
from starlette.datastructures import MutableHeaders
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from rockflex.web._hosts import is_host_of_all_addresses, is_loopback_host, is_numeric_host

HEADERS = {
    "Content-Security-Policy": "default-src 'self'; img-src 'self' data: blob:; object-src 'none'; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cache-Control": "no-cache",
}
UNKNOWN_HOST = (
    "The page does not answer to this host name. Open it by the address that rockflex serve printed, or start it with "
    "the option --name and the name by which it is reached.\n"
)


class SecurityHeaders:
    """Middleware that adds them to every answer."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer as the application does, with the headers."""

        async def with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                MutableHeaders(scope=message).update(HEADERS)
            await send(message)

        await self._app(scope, receive, with_headers)


class KnownHosts:
    """Middleware that answers only to known host names.

    A foreign page whose own name was made to resolve to this machine sends that name, and must not read the answers.
    An address in numbers cannot be made to resolve to another one.

    Parameters
    ----------
    app
        The application.
    host
        Address that the server listens on. It is known, and so are localhost and all loopback addresses. A server that
        listens on all addresses knows each of them, and the name of the machine.
    names
        Other names by which it is reached.
    """

    def __init__(self, app: ASGIApp, host: str, names: Iterable[str]) -> None:
        self._app = app
        self._everywhere = is_host_of_all_addresses(host)
        own = [socket.gethostname()] if self._everywhere else []
        self._names = {name.lower() for name in ("localhost", host, *own, *names)}

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer as the application does, or refuse a request to or from a foreign name."""
        if scope["type"] == "http":
            given = RequestHeaders(scope=scope)
            hosts = [f"//{each}" for each in given.getlist("host")]
            if not hosts or not all(map(self._knows, [*hosts, *given.getlist("origin")])):
                await PlainTextResponse(UNKNOWN_HOST, status_code=400)(scope, receive, send)
                return
        await self._app(scope, receive, send)

    def _knows(self, url: str) -> bool:
        try:
            name = urlsplit(url).hostname or ""
        except ValueError:
            return False
        return name in self._names or is_loopback_host(name) or (self._everywhere and is_numeric_host(name))
