"""Places for work: few at once, shared among visitors, and given up by those who leave while they wait."""

import asyncio
from collections import Counter
from collections.abc import AsyncGenerator
from contextlib import asynccontextmanager
from threading import Event
from time import monotonic

import anyio
from starlette.requests import Request

from rockflex.web._refusal import Refusal

REMEMBERED = 60.0  # s of work of all visitors, after which what each of them took counts half
WATCH_INTERVAL = 0.2  # s between checks whether a visitor still waits


def visitor_of(request: Request) -> str:
    """Return what tells visitors apart: the address of their machine, behind a proxy as that states it."""
    return "" if request.client is None else request.client.host


class Slots:
    """Places of one kind of work; where there are several, one visitor never has them all.

    Who has fewer places comes first, among them who lately took less time, and among them who came first: short answers
    do not wait for the long ones of several others.

    Parameters
    ----------
    most
        How many works are done at once.
    """

    def __init__(self, most: int) -> None:
        self._most, self._own = most, max(most - 1, 1)
        self._held, self._took = Counter[str](), dict[str, float]()
        self._waiting: list[tuple[str, asyncio.Future[None]]] = []

    @asynccontextmanager
    async def place(self, request: Request) -> AsyncGenerator[Event]:
        """Wait for a place, and yield the event of the visitor's leaving; one who leaves before it is refused."""
        gone, turn = Event(), asyncio.get_running_loop().create_future()
        visitor, waiting = visitor_of(request), (visitor_of(request), turn)

        async def watch() -> None:
            while not await request.is_disconnected():
                await anyio.sleep(WATCH_INTERVAL)
            gone.set()
            turn.cancel()

        self._waiting.append(waiting)
        self._admit()
        watching = asyncio.create_task(watch())
        try:
            try:
                await turn
            except asyncio.CancelledError as error:
                if not gone.is_set():
                    raise
                raise visitor_left() from error
            begun = monotonic()
            try:
                yield gone
            finally:
                self._remember(visitor, monotonic() - begun)
        finally:
            watching.cancel()
            if waiting in self._waiting:
                self._waiting.remove(waiting)
            else:
                self._held[visitor] -= 1
            self._admit()

    def _remember(self, visitor: str, seconds: float) -> None:
        self._took[visitor] = self._took.get(visitor, 0.0) + seconds
        if sum(self._took.values()) > REMEMBERED:
            self._took = {each: time / 2 for each, time in self._took.items() if time > 0.1}

    def _admit(self) -> None:
        while self._held.total() < self._most:
            waiting = [each for each in self._waiting if self._held[each[0]] < self._own and not each[1].cancelled()]
            if not waiting:
                return
            chosen = min(waiting, key=lambda each: (self._held[each[0]], self._took.get(each[0], 0.0)))
            self._waiting.remove(chosen)
            self._held[chosen[0]] += 1
            chosen[1].set_result(None)


def visitor_left() -> Refusal:
    """Return the refusal that nobody reads."""
    return Refusal("The run was stopped because nobody waits for its answer.", 499)
