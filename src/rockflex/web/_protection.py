"""Protection of the server: known host names, security headers, and limits of waiting connections."""

import socket
from asyncio import TimerHandle, Transport
from collections.abc import Iterable
from operator import attrgetter
from urllib.parse import urlsplit

from starlette.datastructures import Headers as RequestHeaders
from starlette.datastructures import MutableHeaders
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from uvicorn.protocols.http.h11_impl import H11Protocol

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


REQUEST_TIMEOUT = 20  # s for the next request to begin and its headers to arrive
MAX_CONNECTIONS = 400  # connections, before those that wait for their clients are closed


class LimitedConnection(H11Protocol):
    """A connection of uvicorn with a time limit for headers; beyond `MAX_CONNECTIONS` the idlest are closed.

    A server alone would keep half a request for ever, and refuse everybody once it has too many.
    """

    since: float = 0.0  # when it was opened, or its last answer was complete
    _limit: TimerHandle | None = None

    def connection_made(self, transport: Transport) -> None:  # type: ignore[override]
        """Begin to wait for a request, and close other connections if there are too many."""
        super().connection_made(transport)
        self._wait()
        if len(self.connections) > MAX_CONNECTIONS:
            waiting = [each for each in self.connections if isinstance(each, LimitedConnection) and each.waits]
            if waiting:
                idlest = min(waiting, key=attrgetter("since"))
                idlest.transport.abort()
                self.connections.discard(idlest)  # now, so that it does not count against the others

    def on_response_complete(self) -> None:
        """Begin to wait for the next request."""
        super().on_response_complete()
        self._wait()

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop waiting."""
        if self._limit is not None:
            self._limit.cancel()
        super().connection_lost(exc)

    @property
    def waits(self) -> bool:
        """Whether the client has to send or receive something before the server can go on."""
        return self._idle or self.cycle.more_body or self.flow.write_paused

    @property
    def _idle(self) -> bool:
        return not self.cycle or self.cycle.response_complete

    def _wait(self) -> None:
        self.since = self.loop.time()
        if self._limit is not None:
            self._limit.cancel()
        self._limit = self.loop.call_later(REQUEST_TIMEOUT, self._give_up)

    def _give_up(self) -> None:
        if self._idle:
            self.transport.close()
