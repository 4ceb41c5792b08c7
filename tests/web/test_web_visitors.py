"""Visitors beside each other: nobody computes for those who left, and nobody has all places or the whole queue."""

import asyncio
import threading
import time
import tracemalloc
from concurrent.futures import ThreadPoolExecutor
from contextlib import AsyncExitStack
from types import SimpleNamespace

import pytest

from rockflex.web import _app
from rockflex.web._forms import FIRST
from rockflex.web._jobs import MAX_OWN, BackgroundJobs, BackgroundWork
from rockflex.web._refusal import Refusal
from rockflex.web._response import response_view, sketch_view
from rockflex.web._slots import Slots
from rockflex.web._state import parse_page_state
from rockflex.web._uploads import UploadedRecords, read_uploaded_record

HANG = 60.0  # s: a guard against what never ends


def visitor(address, gone=False):
    """A request of a visitor, who may have left."""
    request = SimpleNamespace(client=SimpleNamespace(host=address), gone=gone)

    async def is_disconnected():
        return request.gone

    request.is_disconnected = is_disconnected
    return request


@pytest.mark.parametrize("dt", [1e-6, 1e-5])
def test_a_short_step_is_refused_wherever_it_is_computed_and_takes_no_memory(dt) -> None:
    content = "\n".join(str(0.1 * (i % 3 - 1)) for i in range(1000)).encode()
    uploads = UploadedRecords()
    key = uploads.add(read_uploaded_record("a.txt", content, "g", dt), content, "")
    state = parse_page_state(FIRST | {"record": {"source": "upload", "upload": key}})
    tracemalloc.start()
    try:
        with pytest.raises(Refusal, match="longer time step"):
            response_view(state, uploads)
        for quick in (True, False):
            assert "longer time step" in sketch_view(state, uploads, quick=quick)["note"]
        assert tracemalloc.get_traced_memory()[1] < 20e6
    finally:
        tracemalloc.stop()


def run(work):
    """Run a coroutine in a thread of its own: a browser of other tests may have its event loop in this one."""
    with ThreadPoolExecutor(1) as pool:
        return pool.submit(asyncio.run, work).result()


def test_nothing_is_computed_for_those_who_left_while_they_waited() -> None:
    server, begun, free, done = _app.PageServer(), threading.Event(), threading.Event(), []

    def hold():
        begun.set()
        assert free.wait(HANG)

    async def all_of_them():
        one = Slots(1)
        first = asyncio.create_task(server.run(visitor("a"), hold, one))
        while not begun.is_set():
            await asyncio.sleep(0.01)
        left = [
            asyncio.create_task(server.run(visitor("b", gone=True), lambda: done.append("b"), one)) for _ in range(8)
        ]
        answers = await asyncio.gather(*left, return_exceptions=True)
        assert {each.status for each in answers} == {499}
        last = asyncio.create_task(server.run(visitor("c"), lambda: done.append("c"), one))
        free.set()
        await asyncio.wait_for(asyncio.gather(first, last), HANG)

    run(all_of_them())
    assert done == ["c"]


def test_one_visitor_leaves_a_place_to_others() -> None:
    async def all_of_them():
        slots, one, other = Slots(4), visitor("a"), visitor("b")
        async with AsyncExitStack() as held:
            for _ in range(3):
                await held.enter_async_context(slots.place(one))
            fourth = asyncio.create_task(held.enter_async_context(slots.place(one)))
            await asyncio.wait_for(held.enter_async_context(slots.place(other)), HANG)
            assert not fourth.done()
            fourth.cancel()
        async with slots.place(one):  # all places are free again
            pass
        assert slots._held.total() == 0

    run(all_of_them())


def test_who_took_less_time_comes_first() -> None:
    async def all_of_them():
        one, order = Slots(1), []

        async def work(name, seconds=0.0):
            async with one.place(visitor(name)):
                order.append(name)
                await asyncio.sleep(seconds)

        for name in ("a", "b", "c"):
            await work(name, 0.1)
        await asyncio.gather(work("a", 0.1), work("b"), work("c"), work("new"))
        assert order[3:] == ["a", "new", "b", "c"] or order[3:] == ["a", "new", "c", "b"]

    run(all_of_them())


class Waits(BackgroundWork):
    """A job that notes its beginning, and lasts until it is let go."""

    def __init__(self, name, begun, free):
        super().__init__()
        self.name, self.begun, self.free = name, begun, free

    def work(self):
        self.begun.append(self.name)
        assert self.free.wait(HANG)


def test_all_jobs_of_one_visitor_leave_others_the_next_turn() -> None:
    jobs, begun, free = BackgroundJobs("studies", 40), [], threading.Event()
    for _ in range(MAX_OWN):
        jobs.start(Waits("one", begun, free), "one")
    with pytest.raises(Refusal, match="yours") as caught:
        jobs.start(Waits("one", begun, free), "one")
    assert caught.value.status == 503
    token = jobs.start(Waits("other", begun, free), "other")
    free.set()
    end = time.monotonic() + HANG
    while not jobs.get(token).over:
        assert time.monotonic() < end
        time.sleep(0.01)
    assert begun.index("other") <= 2
    jobs.close()
