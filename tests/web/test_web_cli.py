"""``rockflex serve`` as a command."""

import socket
import subprocess
import sys
import time
import urllib.request

RUN = [sys.executable, "-m", "rockflex", "serve"]


def test_the_page_is_served_on_loopback_and_stops_cleanly() -> None:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    with subprocess.Popen([*RUN, "--port", str(port)], stderr=subprocess.PIPE, text=True) as process:
        try:
            for _ in range(200):
                try:
                    with urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=5) as answer:
                        assert b"rockflex" in answer.read()
                    break
                except OSError:
                    assert process.poll() is None, process.stderr.read()
                    time.sleep(0.1)
            with socket.socket() as other:
                other.settimeout(1.0)
                # Another address of this machine reaches nothing.
                assert other.connect_ex(("127.0.0.2", port)) != 0
        finally:
            process.terminate()
        _, said = process.communicate(timeout=20)
    assert f"http://127.0.0.1:{port} (stop with Ctrl-C)" in said
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
