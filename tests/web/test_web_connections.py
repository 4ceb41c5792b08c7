"""The server's start, and what its connections may hold."""

import asyncio
import socket
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress

import pytest
import uvicorn

from rockflex import InputError
from rockflex.web import make_app
from rockflex.web._connections import FREE_BYTES, BoundedBodies, patient_protocol
from rockflex.web._refusal import Refusal
from rockflex.web._serve import serve

HANG = 60.0  # s: a guard against what never ends


@pytest.fixture
def port(monkeypatch):
    """The port of a server that waits 0.5 s for the head of a request."""
    monkeypatch.setattr("rockflex.web._connections.HEAD_TIMEOUT", 0.5)
    config = uvicorn.Config(make_app(), port=0, log_level="error", http=patient_protocol(), limit_concurrency=5)
    running = uvicorn.Server(config)
    thread = threading.Thread(target=running.run, daemon=True)
    thread.start()
    while not running.started:
        assert thread.is_alive()
        time.sleep(0.02)
    yield running.servers[0].sockets[0].getsockname()[1]
    running.should_exit = True
    thread.join(10)


def answered(port, *parts, pause=0.0):
    with socket.create_connection(("127.0.0.1", port), timeout=HANG) as connection:
        for each in parts:
            connection.sendall(each)
            time.sleep(pause)
        return connection.recv(100)


WHOLE = b"GET /api/suite/el-centro-1940 HTTP/1.1\r\nHost: localhost\r\n\r\n"


def test_half_a_head_does_not_keep_its_place(port) -> None:
    assert answered(port, WHOLE[:30]) == b""
    assert answered(port) == b""
    held = [socket.create_connection(("127.0.0.1", port), timeout=HANG) for _ in range(8)]
    for each in held:
        each.sendall(WHOLE[:30])
    end = time.monotonic() + HANG
    while not answered(port, WHOLE).startswith(b"HTTP/1.1 200"):
        assert time.monotonic() < end
    for each in held:
        each.close()


@pytest.mark.parametrize(
    ("parts", "pause"),
    [
        ((WHOLE[:30],), 0.0),
        ((WHOLE,), 0.0),  # and then nothing
        ((b"POST /api/upload HTTP/1.1\r\nHost: localhost\r\nContent-Length: 99\r\n\r\n", b"."), 0.2),  # answered early
    ],
    ids=["half a head", "idle", "half a body"],
)
def test_connections_that_wait_leave_places_to_others(port, monkeypatch, parts, pause) -> None:
    monkeypatch.setattr("rockflex.web._connections.HEAD_TIMEOUT", HANG)
    monkeypatch.setattr("rockflex.web._connections.MAX_WAITING", 3)
    held = [socket.create_connection(("127.0.0.1", port), timeout=HANG) for _ in range(8)]
    for part in parts:
        for each in held:
            with suppress(OSError):  # it was closed
                each.sendall(part)
        time.sleep(pause)
    time.sleep(0.2)
    assert answered(port, WHOLE).startswith(b"HTTP/1.1 200")
    for each in held:
        each.close()


def test_a_body_that_never_ends_does_not_keep_its_place_after_the_answer(port) -> None:
    head = b"POST /api/upload HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\n"  # of an unknown type
    with socket.create_connection(("127.0.0.1", port), timeout=5) as connection:
        connection.sendall(head)
        assert connection.recv(4096).startswith(b"HTTP/1.1 415")
        connection.sendall(b".")
        while connection.recv(4096):
            pass


def test_a_head_in_parts_and_a_slow_body_are_answered(port) -> None:
    assert answered(port, WHOLE[:30], WHOLE[30:], pause=0.1).startswith(b"HTTP/1.1 200")
    head = b"POST /api/state HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\nContent-Length: 2\r\n\r\n"
    assert answered(port, head, b"{", b"}", pause=0.7).startswith(b"HTTP/1.1 4")  # no state, but read to its end


def test_bodies_are_bounded_together_and_by_visitor(monkeypatch) -> None:
    monkeypatch.setattr("rockflex.web._connections.MAX_HELD", 10 * FREE_BYTES)
    monkeypatch.setattr("rockflex.web._connections.MAX_HELD_BY_ONE", 6 * FREE_BYTES)

    async def all_of_them():
        free, received = asyncio.Event(), []

        async def app(scope, receive, send):
            received.append(await receive())
            await free.wait()

        bodies = BoundedBodies(app)

        def request(visitor, size):
            async def receive():
                return {"type": "http.request", "body": bytes(size)}

            return asyncio.create_task(bodies({"type": "http", "client": (visitor, 1)}, receive, None))

        kept = [request("a", 5 * FREE_BYTES), request("b", 4 * FREE_BYTES)]
        await asyncio.sleep(0)
        for visitor, size in (("a", 2 * FREE_BYTES), ("c", 3 * FREE_BYTES)):
            with pytest.raises(Refusal) as caught:
                await request(visitor, size)
            assert caught.value.status == 503
        kept.append(request("c", FREE_BYTES))  # a short one is answered in any case
        await asyncio.sleep(0)
        assert len(received) == 3
        free.set()
        await asyncio.gather(*kept)
        await request("c", 6 * FREE_BYTES)

    with ThreadPoolExecutor(1) as pool:  # a browser of other tests may have its event loop in this thread
        pool.submit(lambda: asyncio.run(all_of_them())).result()


def test_one_visitor_leaves_connections_to_others(monkeypatch) -> None:
    monkeypatch.setattr("rockflex.web._connections.MAX_REQUESTS_OF_ONE", 2)

    async def all_of_them():
        free = asyncio.Event()

        async def app(scope, receive, send):
            await free.wait()
            await send({"status": 200})

        bodies = BoundedBodies(app)

        async def request(visitor):
            sent = []

            async def send(message):
                sent.append(message.get("status"))

            await bodies({"type": "http", "client": (visitor, 1)}, None, send)
            return sent[0]

        kept = [asyncio.create_task(request(each)) for each in ("a", "a", "b")]
        await asyncio.sleep(0)
        assert await request("a") == 503
        free.set()
        assert await asyncio.gather(*kept) == [200, 200, 200]
        assert await request("a") == 200

    with ThreadPoolExecutor(1) as pool:
        pool.submit(lambda: asyncio.run(all_of_them())).result()


def free_port():
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return probe.getsockname()[1]


def test_the_port_is_taken_before_the_server_begins(monkeypatch) -> None:
    listens = []

    def run(self, sockets):
        listens.append(sockets[0].getsockopt(socket.SOL_SOCKET, socket.SO_ACCEPTCONN))

    monkeypatch.setattr(uvicorn.Server, "run", run)
    told = []
    with pytest.raises(InputError, match="did not start"):
        serve(free_port(), on_start=told.append)
    assert listens == [1]
    assert told == []


def test_a_second_server_is_refused_although_the_first_answers_nothing_yet() -> None:
    with socket.socket() as first:
        first.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        first.bind(("127.0.0.1", 0))
        first.listen()
        with pytest.raises(InputError, match="cannot listen"):
            serve(first.getsockname()[1])
