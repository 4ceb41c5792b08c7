"""Other programs with a temporary folder of their own, both of which end with this process, however it is stopped."""

import contextlib
import os
import signal
import subprocess
import time
import weakref
from collections.abc import Callable, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

_TRIES = 20  # to remove a folder into which a program that was just killed still writes


class ProcessWithFolder:
    """A program, the programs that it starts, and its folder.

    Parameters
    ----------
    command
        Returns the command for a folder, which exists already and may be filled.
    options
        Of `subprocess.Popen`.

    Attributes
    ----------
    folder : Path
    process : subprocess.Popen
    close : callable
        Ends the program and removes the folder.
    """

    def __init__(self, command: Callable[[Path], Sequence[str]], **options: Any) -> None:
        kept = TemporaryDirectory(prefix="rockflex-", ignore_cleanup_errors=True)
        self.folder = Path(kept.name)
        # In a session of its own Ctrl-C does not reach it, and all that it starts can be ended with it.
        self.process: subprocess.Popen[Any] = subprocess.Popen(
            command(self.folder), start_new_session=os.name != "nt", **options
        )
        self.close = weakref.finalize(self, _end, self.process, kept)  # at the latest at the end of this process

    def __enter__(self) -> "ProcessWithFolder":
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _end(process: "subprocess.Popen[Any]", folder: "TemporaryDirectory[str]") -> None:
    if os.name == "nt":
        process.kill()
    else:
        with contextlib.suppress(ProcessLookupError, PermissionError):
            os.killpg(process.pid, signal.SIGKILL)
    for pipe in (process.stdin, process.stdout, process.stderr):
        if pipe is not None:
            with contextlib.suppress(OSError):  # what was not sent
                pipe.close()
    process.wait()
    for _ in range(_TRIES):
        folder.cleanup()
        if not Path(folder.name).exists():
            return
        time.sleep(0.05)
