"""``rockflex serve`` as a command."""

import signal
import socket
import subprocess
import sys
import time
import urllib.request
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager

import pytest

RUN = [sys.executable, "-m", "rockflex", "serve"]
HANG = 60.0  # s: a guard against what never ends


@contextmanager
def served(*command: str) -> Iterator[tuple[subprocess.Popen[str], int]]:
    """The process of a server, and its port."""
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    with subprocess.Popen([*command, "--port", str(port)], stderr=subprocess.PIPE, text=True) as process:
        try:
            for _ in range(200):
                try:
                    assert b"rockflex" in page(port)
                    break
                except OSError:
                    assert process.poll() is None, process.stderr.read()
                    time.sleep(0.1)
            yield process, port
        finally:
            process.kill()


def page(port: int) -> bytes:
    with urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=20) as answer:
        return answer.read()


@pytest.mark.parametrize("how", [signal.SIGINT, signal.SIGTERM])
def test_the_page_is_served_on_loopback_and_stops_cleanly(how) -> None:
    with served(*RUN) as (process, port):
        with socket.socket() as other:
            other.settimeout(1.0)
            # Another address of this machine reaches nothing.
            assert other.connect_ex(("127.0.0.2", port)) != 0
        process.send_signal(how)
        _, said = process.communicate(timeout=HANG)
    assert f"http://127.0.0.1:{port} (stop with Ctrl-C)" in said
    assert "Traceback" not in said


def test_half_a_request_shuts_nobody_out() -> None:
    head = b"POST /api/state HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
    halves = (b"", head, head + b"Content-Length: 50\r\n\r\n{", b"GET / HTTP/1.1\r\nHost: localhost\r\n\r\n")
    with served(*RUN) as (_, port), ExitStack() as held:
        for i in range(620):
            connection = held.enter_context(socket.create_connection(("127.0.0.1", port)))
            connection.sendall(halves[i % len(halves)])
        for _ in range(5):
            assert b"rockflex" in page(port)


def test_half_a_request_is_given_up() -> None:
    program = "import rockflex.web._connection as c; c.PATIENCE = 0.5\nfrom rockflex.cli import main; main()"
    with served(sys.executable, "-c", program, "serve") as (_, port):
        for half in (b"", b"GET / HT", b"GET / HTTP/1.1\r\nHost: localhost\r\nContent-Length: 9\r\n\r\n"):
            with socket.create_connection(("127.0.0.1", port), timeout=HANG) as connection:
                connection.sendall(half)
                while connection.recv(1 << 16):  # until it is closed
                    pass
        assert b"rockflex" in page(port)


def test_a_file_that_is_read_for_ever_does_not_keep_the_server_from_stopping() -> None:
    program = (
        "import time\nimport rockflex.web._app as app\n"
        "def read(*_):\n  print('reading', file=__import__('sys').stderr, flush=True)\n  while True: time.sleep(0.01)\n"
        "app.read_record = read\nfrom rockflex.cli import main; main()"
    )
    with served(sys.executable, "-c", program, "serve") as (process, port), ExitStack() as held:
        connection = held.enter_context(socket.create_connection(("127.0.0.1", port)))
        connection.sendall(
            b"POST /api/upload?name=a.csv HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/octet-stream\r\n"
            b"Content-Length: 1\r\n\r\n1"
        )
        while "reading" not in process.stderr.readline():
            pass
        process.send_signal(signal.SIGINT)
        _, said = process.communicate(timeout=HANG)
    assert "Traceback" not in said


def test_an_address_for_everybody_is_warned_of_and_a_port_checked() -> None:
    done = subprocess.run([*RUN, "--host", "192.0.2.1", "--port", "8080"], capture_output=True, text=True, timeout=60)
    assert done.returncode == 2
    assert "Everyone who can reach 192.0.2.1 can use the page: it has no passwords." in done.stderr
    assert "cannot listen on 192.0.2.1, port 8080" in " ".join(done.stderr.split())


def test_help_loads_no_server() -> None:
    program = "import sys; from rockflex.cli import main; sys.argv = ['rockflex', 'serve', '--help']\ntry: main()\n"
    program += "except SystemExit: print({'starlette', 'uvicorn', 'numba', 'matplotlib'} & sys.modules.keys())"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=60)
    assert "--port" in done.stdout
    assert done.stdout.rstrip().endswith("set()")
