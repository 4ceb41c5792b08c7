"""Connections that do not wait for ever for their clients, and make room for others."""

from asyncio import TimerHandle, Transport
from operator import attrgetter

from uvicorn.protocols.http.h11_impl import H11Protocol

PATIENCE = 20  # s for the next request to begin and its headers to arrive
MOST = 400  # connections, before those that wait for their clients are closed


class Connection(H11Protocol):
    """A connection of uvicorn with a time limit for headers; beyond `MOST` of them the idlest ones are closed.

    A server alone would keep half a request for ever, and refuse everybody once it has too many.
    """

    since: float = 0.0  # when it was opened, or its last answer was complete
    _limit: TimerHandle | None = None

    def connection_made(self, transport: Transport) -> None:  # type: ignore[override]
        """Begin to wait for a request, and close other connections if there are too many."""
        super().connection_made(transport)
        self._wait()
        if len(self.connections) > MOST:
            waiting = [each for each in self.connections if isinstance(each, Connection) and each.waits]
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
        self._limit = self.loop.call_later(PATIENCE, self._give_up)

    def _give_up(self) -> None:
        if self._idle:
            self.transport.close()
