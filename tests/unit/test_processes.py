"""Other programs end with this one, and their folders with them."""

import os
import signal
import subprocess
import sys
import time

import pytest

HANG = 60.0  # s: a guard against what never ends
BROWSER = """#!/bin/sh
for each in "$@"; do case "$each" in --user-data-dir=*) profile="${each#*=}";; esac; done
(while :; do mkdir -p "$profile"; date > "$profile/$(date +%N)"; done) &
touch "$STARTED"
sleep 1000
"""


@pytest.mark.skipif(os.name == "nt", reason="the browser of this test is a script of a shell")
@pytest.mark.parametrize("how", [signal.SIGINT, None], ids=["Ctrl-C", "a thread"])
def test_a_print_that_is_stopped_leaves_no_profile(tmp_path, how) -> None:
    browser, started, temporary = tmp_path / "browser", tmp_path / "started", tmp_path / "temporary"
    browser.write_text(BROWSER)
    browser.chmod(0o755)
    temporary.mkdir()
    program = "from rockflex.report.run._report_files import page_as_pdf\n"
    if how is None:  # as in the server, whose threads end with it
        program += "import os, threading, time\nthreading.Thread(target=page_as_pdf, args=('',), daemon=True).start()\n"
        program += "while not os.path.exists(os.environ['STARTED']): time.sleep(0.01)\ntime.sleep(0.3)\n"
    else:
        program += "page_as_pdf('')\n"
    given = {"ROCKFLEX_BROWSER": str(browser), "STARTED": str(started), "TMPDIR": str(temporary)}
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    with subprocess.Popen([sys.executable, "-c", program], env=os.environ | given, stderr=subprocess.PIPE) as process:
        signal.signal(signal.SIGINT, before)
        end = time.monotonic() + HANG
        while not started.exists():
            assert time.monotonic() < end
            assert process.poll() in (None, 0)
            time.sleep(0.02)
        if how is not None:
            time.sleep(0.3)
            process.send_signal(how)
        process.communicate(timeout=HANG)
    assert [*temporary.iterdir()] == []
