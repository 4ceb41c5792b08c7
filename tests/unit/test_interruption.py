"""Runs end within a moment once nobody waits for them: alone, on threads, and behind the page."""

import asyncio
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from threading import Event, Timer
from time import monotonic

import numpy as np
import pytest

from builders import make_frame
from rockflex import GroundMotion, simulate, simulate_many
from rockflex.engine.stops import RunStoppedError, stopping_when
from rockflex.studies.parallel import map_runs
from rockflex.web._app import PageServer
from rockflex.web._refusal import Refusal

FRAME = make_frame(n_stories=3, period=0.8, aspect_ratio=6.0)
ASKED, SOON = 0.3, 20.0  # s: when a run is asked to stop, and when it has, on the slowest machine
BUSY = 2.0  # s: what it computes until then at most; 0.05 here, and 10 to 60 if it looked up at the end only


@cache
def long_motion():
    """Seconds of work."""
    return GroundMotion(2.4 * np.random.default_rng(0).standard_normal(12_000_000), 0.005, name="long")


def long_run():
    return simulate(FRAME, long_motion(), "2DOF-C", "peaks", work_limit=None)


def long_runs():
    return simulate_many([FRAME], [long_motion()] * 2, ["2DOF-C"], work_limit=None)


@pytest.fixture(scope="module", autouse=True)
def compiled():
    """Compiling is not what is measured."""
    simulate(FRAME, GroundMotion(long_motion().acceleration[:200], long_motion().dt), "2DOF-C", "peaks")


def test_a_run_that_is_asked_to_stop():
    begun = monotonic()
    expected = pytest.raises(RunStoppedError, match=r"^The run was stopped before its end\.$")
    with expected, stopping_when(lambda: monotonic() - begun > ASKED):
        long_run()
    assert monotonic() - begun < SOON


@pytest.fixture
def own_handler():
    """Python's own answer to Ctrl-C, whatever tests before have put in its place."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("own_handler")
@pytest.mark.parametrize("run", [long_run, long_runs])
def test_an_interrupt(run):
    begun = monotonic()
    Timer(ASKED, os.kill, (os.getpid(), signal.SIGINT)).start()
    with pytest.raises(KeyboardInterrupt):
        run()
    assert monotonic() - begun < SOON


def test_threads_stop_with_the_map_and_with_whoever_started_it():
    def run(_):
        return long_run()

    runs = map_runs(lambda k: long_run() if k else k, [0, 1], 2)
    assert next(runs) == 0
    begun = monotonic()
    runs.close()
    assert monotonic() - begun < SOON
    asked = Event()
    Timer(ASKED, asked.set).start()
    with stopping_when(asked.is_set), pytest.raises(RunStoppedError):
        list(map_runs(run, [1, 2], 2))
    assert monotonic() - begun < 2.0 * SOON


def test_the_page_stops_a_run_that_its_visitor_has_left():
    class Left:
        client = None

        async def is_disconnected(self):
            return monotonic() - begun > ASKED

    begun = monotonic()
    # A browser of other tests may have its event loop in this thread.
    with ThreadPoolExecutor() as pool, pytest.raises(Refusal) as caught:
        pool.submit(lambda: asyncio.run(PageServer().run(Left(), long_run))).result()
    assert caught.value.status == 499
    assert monotonic() - begun < SOON


DEAF = """
import os, signal, time
from threading import Thread, get_ident
import numpy as np
import rockflex as rf

noise, frame = np.random.default_rng(0).standard_normal((2, 1_000_000)), {
    "n_stories": 3, "story_height": 3.0, "story_mass": 40e3, "base_mass": 40e3, "stiffness_ratio": 1.0,
    "aspect_ratio": 6.0, "damping_ratio": 0.02,
}
stiff, record = rf.Frame(**frame, period=1e-8), rf.GroundMotion(noise[0, :12], 0.01)
long = [rf.GroundMotion(each, 0.01, name=str(k)) for k, each in enumerate(noise)]
steep, periods = rf.GroundMotion([0.0, 1.0, 2.0, 3.0, -1.0], 1e4), np.geomspace(0.02, 10.0, 2000)
work = lambda: CALL
clock = time.pthread_getcpuclockid(get_ident())  # of this thread, so that others on the machine do not count


def interrupt():
    time.sleep(0.5)
    sent.append(time.clock_gettime(clock))
    os.kill(os.getpid(), signal.SIGINT)


sent = []
signal.signal(signal.SIGINT, signal.default_int_handler)  # whatever this process was started by ignores it
Thread(target=interrupt).start()
try:
    work()
except KeyboardInterrupt:
    print(time.clock_gettime(clock) - sent[0])
"""


@pytest.mark.slow
@pytest.mark.skipif(not hasattr(time, "pthread_getcpuclockid"), reason="the time of a thread is not known here")
@pytest.mark.parametrize(
    "call",
    [
        "long[0].spectrum(periods)",
        "rf.rotated_spectrum(*long, periods)",
        "steep.sd(1.1e-5, 0.0)",  # a record step of a milliard periods
        'rf.simulate(stiff, record, "fixed", "peaks", work_limit=None)',  # peaks are searched within such samples
        'rf.simulate(stiff, record, "MDOF-S", "peaks", work_limit=None)',
    ],
)
def test_an_interrupt_is_heard_soon_without_the_lock(call) -> None:
    made = subprocess.run(
        [sys.executable, "-c", DEAF.replace("CALL", call)], capture_output=True, text=True, timeout=60, check=True
    )
    assert float(made.stdout) < BUSY


@pytest.mark.slow
def test_a_motion_beyond_all_measure_ends() -> None:
    call = "rf.simulate(rf.Frame(**frame, period=1.0), rf.load_suite('el-centro-1940')[0].scaled(1.5e150), 'fixed')"
    begin, _ = DEAF.split("clock =")
    made = subprocess.run([sys.executable, "-c", begin.replace("CALL", call) + "work()"], timeout=60, check=True)
    assert made.returncode == 0
