"""What connections may hold: a place only while they send, and memory only as far as there is room for all."""

import asyncio
from collections import Counter
from functools import lru_cache
from typing import Any

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from rockflex.web._refusal import Refusal

HEAD_TIMEOUT = 10.0  # s to send the head of a request
FREE_BYTES = 65_536  # of each body that are not counted: a short request is answered in any case
MAX_HELD = 400_000_000  # bytes of all bodies that are received or wait for their answers
MAX_HELD_BY_ONE = 250_000_000  # of one visitor: three folders


class BoundedBodies:
    """Middleware that refuses a body for which there is no room beside those that are held already."""

    def __init__(self, app: ASGIApp) -> None:
        self._app, self._held = app, Counter[str]()

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Answer as the application does, and count the bytes of the request until it is answered."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        visitor, size = (scope.get("client") or ("",))[0], 0

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
            if not self._held[visitor]:
                del self._held[visitor]

    def _has_room(self, visitor: str) -> bool:
        return self._held[visitor] <= MAX_HELD_BY_ONE and self._held.total() <= MAX_HELD


@lru_cache(maxsize=1)
def patient_protocol() -> type[asyncio.Protocol]:
    """Return the protocol of the server, whose connections end where the head of a request does not arrive in time.

    uvicorn waits for it without an end, and counts the connection among those that may be open.
    """
    import h11
    from uvicorn.protocols.http.h11_impl import H11Protocol

    class PatientProtocol(H11Protocol):
        """One connection."""

        _patience: asyncio.TimerHandle | None = None

        def connection_made(self, transport: Any) -> None:
            """Begin to wait for the first request."""
            super().connection_made(transport)
            self._wait()

        def data_received(self, data: bytes) -> None:
            """Wait for the rest of a head, if it has only begun."""
            super().data_received(data)
            if self.conn.their_state is not h11.IDLE:
                self._calm()
            elif self._patience is None:
                self._wait()

        def connection_lost(self, exc: Exception | None) -> None:
            """Wait no longer."""
            self._calm()
            super().connection_lost(exc)

        def _wait(self) -> None:
            self._patience = self.loop.call_later(HEAD_TIMEOUT, self._give_up)

        def _calm(self) -> None:
            if self._patience is not None:
                self._patience.cancel()
                self._patience = None

        def _give_up(self) -> None:
            self._patience = None
            if self.conn.their_state is h11.IDLE and not self.transport.is_closing():
                self.transport.close()

    return PatientProtocol
