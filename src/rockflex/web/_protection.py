"""Protection of the server: known host names, and security headers."""

import hashlib
import secrets
import socket
from collections.abc import Iterable
from urllib.parse import parse_qsl, urlencode, urlsplit

from starlette.datastructures import Headers as RequestHeaders
from starlette.datastructures import MutableHeaders
from starlette.requests import cookie_parser
from starlette.responses import PlainTextResponse, RedirectResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from rockflex.web._hosts import is_host_of_all_addresses, is_loopback_host, is_numeric_host

HEADERS = {
    "Content-Security-Policy": "default-src 'self'; img-src 'self' data: blob:; object-src 'none'; base-uri 'none'; "
    "form-action 'none'; frame-ancestors 'none'",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
}
PUBLIC = ("/api/about", "/api/suite/")  # the answers that hold nothing of a visitor
NO_TOKEN = (
    "The page is open to those who have its token only. Open it by the address that rockflex serve printed, with "
    "?token= at its end.\n"
)
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
                path = scope["path"].removeprefix(scope.get("root_path", ""))
                own = path.startswith("/api/") and not path.startswith(PUBLIC)
                # What is kept must be asked for again; what is a visitor's is not kept at all.
                kept = {"Cache-Control": "no-store" if own else "no-cache"}
                MutableHeaders(scope=message).update(HEADERS | kept)
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


class TokenRequired:
    """Middleware that answers only to those who have the token: in the address at first, then in a cookie.

    The address of a visitor who brings it is changed to one without it, which can be shared.

    Parameters
    ----------
    app
        The application.
    token
        The token.
    """

    def __init__(self, app: ASGIApp, token: str) -> None:
        self._app, self._token = app, token
        # Cookies do not tell ports apart, so that of another server on the machine has another name.
        self._cookie = f"rockflex-{hashlib.sha256(token.encode()).hexdigest()[:8]}"

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer as the application does, or refuse."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        query = parse_qsl(scope["query_string"].decode("latin-1"), keep_blank_values=True)
        cookies = cookie_parser(RequestHeaders(scope=scope).get("cookie", ""))
        if any(name == "token" and self._fits(value) for name, value in query):
            rest = urlencode([each for each in query if each[0] != "token"])
            # Relative: a server in front may have another path.
            answer = RedirectResponse(f"./{'?' * bool(rest)}{rest}", 303)
            answer.set_cookie(self._cookie, self._token, httponly=True, samesite="strict")
            await answer(scope, receive, send)
        elif self._fits(cookies.get(self._cookie, "")):
            await self._app(scope, receive, send)
        else:
            await PlainTextResponse(NO_TOKEN, status_code=403)(scope, receive, send)

    def _fits(self, given: str) -> bool:
        return secrets.compare_digest(given.encode(), self._token.encode())
