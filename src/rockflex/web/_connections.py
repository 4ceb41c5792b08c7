"""The limits of connections: a place only while they send, and memory only as far as there is room for all."""

import asyncio
from collections import Counter
from typing import Any

from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from rockflex.web._refusal import Refusal

MAX_CONNECTIONS = 500  # from which on requests are answered with an error alone
MAX_WAITING = 200  # of them without a whole head; more, and the oldest of the address with the most is closed
MAX_REQUESTS_OF_ONE = 200  # of one visitor at once: one whose body is slow has its place for a minute
HEAD_TIMEOUT = 10.0  # s to send the head of a request
FREE_BYTES = 65_536  # of each body that are not counted: a short request is answered in any case
MAX_HELD = 400_000_000  # bytes of all bodies that are received or wait for their answers
MAX_HELD_BY_ONE = 250_000_000  # of one visitor: three folders


class BoundedBodies:
    """Middleware that refuses a body for which there is no room beside those that are held, and requests too many."""

    def __init__(self, app: ASGIApp) -> None:
        self._app, self._held, self._requests = app, Counter[str](), Counter[str]()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer as the application does, and count the bytes of the request until it is answered."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        visitor, size = (scope.get("client") or ("",))[0], 0
        if self._requests[visitor] >= MAX_REQUESTS_OF_ONE:
            errors = {"": "Too many requests of yours wait for their answers. Try again in a minute."}
            await JSONResponse({"errors": errors}, 503)(scope, receive, send)
            return
        self._requests[visitor] += 1

        async def counted() -> Message:
            nonlocal size
            message = await receive()
            more = len(message.get("body", b""))
            size, before = size + more, size
            self._held[visitor] += more
            if more and size > FREE_BYTES and not self._has_room(visitor):
                self._held[visitor] -= more
                size = before
                raise Refusal("The server receives too many files at this moment. Try again in a minute.", 503)
            return message

        try:
            await self._app(scope, counted, send)
        finally:
            self._held[visitor] -= size
            self._requests[visitor] -= 1
            if not self._requests[visitor]:
                del self._held[visitor], self._requests[visitor]

    def _has_room(self, visitor: str) -> bool:
        return self._held[visitor] <= MAX_HELD_BY_ONE and self._held.total() <= MAX_HELD


def patient_protocol() -> type[asyncio.Protocol]:
    """Return the protocol of a server, whose connections end where the head of a request does not arrive in time.

    uvicorn waits for it without an end, also for the rest of a body that was answered before its end, and counts the
    connection among those that may be open.
    """
    from uvicorn.protocols.http.h11_impl import H11Protocol

    waiting = dict[asyncio.Transport, str]()  # those without a whole head, the oldest first, with addresses

    class PatientProtocol(H11Protocol):
        """One connection."""

        _patience: asyncio.TimerHandle | None = None

        def connection_made(self, transport: Any) -> None:
            """Begin to wait for the first request."""
            super().connection_made(transport)
            self._hurry()
            self._stand_by()

        def data_received(self, data: bytes) -> None:
            """Wait for the rest of a head, if it has only begun."""
            super().data_received(data)
            if self._answering():
                self._calm()
            elif self._patience is None:
                self._hurry()

        def on_response_complete(self) -> None:
            """Stand by for the next request."""
            super().on_response_complete()
            if not self._answering() and self in self.connections:
                self._stand_by()

        def connection_lost(self, exc: Exception | None) -> None:
            """Wait no longer."""
            super().connection_lost(exc)
            self._calm()

        def _answering(self) -> bool:
            return bool(self.cycle) and not self.cycle.response_complete  # None before the first request

        def _hurry(self) -> None:
            self._patience = self.loop.call_later(HEAD_TIMEOUT, self._give_up)

        def _stand_by(self) -> None:
            waiting[self.transport] = (self.client or ("",))[0]
            if len(waiting) > MAX_WAITING:
                (address, _), *_ = Counter(waiting.values()).most_common(1)
                oldest = next(each for each, of in waiting.items() if of == address)
                del waiting[oldest]
                oldest.abort()  # one that is being closed may wait for its client to read

        def _calm(self) -> None:
            waiting.pop(self.transport, None)
            if self._patience is not None:
                self._patience.cancel()
                self._patience = None

        def _give_up(self) -> None:
            self._patience = None
            if not self._answering() and not self.transport.is_closing():
                self.transport.close()

    return PatientProtocol
