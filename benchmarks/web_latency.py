"""Latency of the web page with many visitors at once: every visitor moves a slider and waits for the response.

    python benchmarks/web_latency.py [--sessions 20] [--seconds 15]

The server runs in a separate process; the measurement is repeated with a cloud of runs in the background. The visitors
are threads of this process, and so share the cores with the server. The time to draw in a browser is not included.
"""

import argparse
import http.client
import json
import random
import socket
import statistics
import subprocess
import sys
import threading
import time
from typing import Any

from rich.console import Console
from rich.table import Table

PAUSE = 0.5  # s between a response and the next move, on average
CLOUD = {"suites": ["fema-p695-far-field"], "scales": [0.5, 1.0, 1.5, 2.0, 3.0, 4.0], "models": ["MDOF-C-SI"]}


class Visitor:
    """One connection to the server."""

    def __init__(self, port: int) -> None:
        self.connection = http.client.HTTPConnection("127.0.0.1", port, timeout=60)

    def get(self, path: str) -> Any:
        """Response to a request without content."""
        self.connection.request("GET", path)
        return json.loads(self.connection.getresponse().read())

    def post(self, path: str, content: Any) -> tuple[Any, float]:
        """Raw response, and the seconds it took."""
        body = json.dumps(content)
        begun = time.perf_counter()
        self.connection.request("POST", path, body, {"Content-Type": "application/json", "Accept-Encoding": "gzip"})
        answer = self.connection.getresponse()
        data = answer.read()
        taken = time.perf_counter() - begun
        if answer.status != 200:
            raise RuntimeError(f"{path} answered {answer.status}: {data[:200]!r}")
        return data, taken


def session(port: int, number: int, until: float, times: dict[str, list[float]]) -> None:
    """Move the slider of the scale, and occasionally visit the other tabs."""
    chance = random.Random(number)
    visitor = Visitor(port)
    state = visitor.get("/api/about")["state"]
    while time.perf_counter() < until:
        time.sleep(chance.uniform(0.0, 2.0 * PAUSE))
        state["scale"] = round(chance.uniform(0.2, 3.0), 3)
        kind = chance.choices(("response", "record", "structure"), (8, 1, 1))[0]
        if kind == "structure":
            state["structure"]["cantilever"]["height"] = round(chance.uniform(8.0, 16.0), 3)
        times[kind].append(visitor.post(f"/api/{kind}", {"state": state})[1])


def measure(sessions: int, seconds: float, *, cloud: bool) -> tuple[dict[str, list[float]], int]:
    """Latencies by kind of request, and the runs of the cloud in the background."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    server = subprocess.Popen(
        [sys.executable, "-m", "rockflex", "serve", "--port", str(port)], stderr=subprocess.DEVNULL
    )
    try:
        first = reach(port)
        state = first.get("/api/about")["state"]
        for kind in ("response", "record", "structure"):
            first.post(f"/api/{kind}", {"state": state})  # compiled, and read from disk
        token = ""
        if cloud:
            asked = state | {"cloud": state["cloud"] | CLOUD}
            token = json.loads(plain(first.post("/api/study/cloud", {"state": asked})[0]))["token"]
        times: dict[str, list[float]] = {"response": [], "record": [], "structure": []}
        until = time.perf_counter() + seconds
        threads = [threading.Thread(target=session, args=(port, n, until, times)) for n in range(sessions)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        done = 0
        if token:
            done = json.loads(plain(first.post(f"/api/study/cloud/{token}", {"state": asked})[0]))["done"]
        return times, done
    finally:
        server.terminate()
        server.wait(20)


def plain(data: bytes) -> bytes:
    """Decompressed response."""
    import gzip

    return gzip.decompress(data) if data[:2] == b"\x1f\x8b" else data


def reach(port: int) -> Visitor:
    """Wait until the server responds."""
    for _ in range(300):
        try:
            visitor = Visitor(port)
            visitor.get("/api/about")
            return visitor
        except OSError:
            time.sleep(0.1)
    raise RuntimeError("The server did not start.")


def table(sessions: int = 20, seconds: float = 15.0) -> Table:
    """Latencies without and with a cloud."""
    shown = Table("", "answers", "per second", "median", "95 %", "longest", title=f"latency in ms, {sessions} visitors")
    for cloud in (False, True):
        times, done = measure(sessions, seconds, cloud=cloud)
        beside = f", beside a cloud ({done} runs done)" if cloud else ""
        for kind, values in times.items():
            if len(values) < 2:
                continue
            ordered = sorted(values)
            typical = (statistics.median(ordered), ordered[int(0.95 * (len(ordered) - 1))], ordered[-1])
            rate = f"{len(values) / seconds:.1f}"
            shown.add_row(f"{kind}{beside}", str(len(values)), rate, *(f"{1e3 * value:.0f}" for value in typical))
    return shown


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--sessions", type=int, default=20)
    parser.add_argument("--seconds", type=float, default=15.0)
    given = parser.parse_args()
    Console().print(table(given.sessions, given.seconds))


if __name__ == "__main__":
    main()
