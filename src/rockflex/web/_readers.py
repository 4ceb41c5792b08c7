"""Visitors' files are read in processes of their own, which can be ended: after some seconds, or when a visitor leaves.

A process reads one file after another, has a temporary folder of its own that goes with it, and little memory.
"""

import contextlib
import os
import pickle
import shutil
import signal
import subprocess
import sys
import tempfile
import traceback
from collections.abc import Callable
from pathlib import Path
from threading import Event, Lock, Thread
from time import monotonic
from typing import Any, BinaryIO

from rockflex.engine.stops import RunStoppedError, asked_to_stop
from rockflex.foundation.errors import InputError
from rockflex.foundation.language import Language, use_language
from rockflex.foundation.processes import ProcessWithFolder
from rockflex.web._refusal import Refusal

MAX_SECONDS = 5.0  # to read a file
MAX_MEMORY = 2_000_000_000  # bytes of addresses of a process, that of its programs included
POLL = 0.05  # s between two looks at the clock and the visitor
IDLE = 3  # processes that wait for the next file


class _Reader:
    """One process."""

    def __init__(self) -> None:
        paths = {"PYTHONPATH": os.pathsep.join(filter(None, sys.path)), "OPENBLAS_NUM_THREADS": "1"}
        own = ProcessWithFolder(
            lambda folder: [sys.executable, "-m", "rockflex.web._readers", str(folder)],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            env=os.environ | paths,
        )
        process = own.process
        assert process.stdin is not None  # both are pipes
        assert process.stdout is not None
        self._given, self._told = process.stdin, process.stdout
        self.close, self._own = own.close, own
        try:
            pickle.load(self._told)  # it has imported what it needs: only now does the time of a file begin
        except (EOFError, pickle.UnpicklingError) as error:
            self.close()
            raise Refusal("The server could not start to read the file. Try again.", 503) from error

    def read(self, work: tuple[Any, ...], seconds: float) -> tuple[str, Any]:
        """Return how the work ended ("done", "refused", "unusable", "failed", "ended" or "late"), and its result."""
        over, late, asked, begun = Event(), Event(), asked_to_stop(), monotonic()

        def watch() -> None:
            while not over.wait(POLL):
                if asked() or monotonic() - begun > seconds:
                    late.set()
                    self._own.process.kill()
                    return

        watching = Thread(target=watch, name="reader", daemon=True)
        watching.start()
        try:
            pickle.dump(work, self._given)
            self._given.flush()
            return pickle.load(self._told)
        except (EOFError, OSError, pickle.UnpicklingError):
            return ("late" if late.is_set() else "ended"), None
        finally:
            over.set()
            watching.join()


class Readers:
    """The processes, which are started when they are needed; safe for threads."""

    def __init__(self) -> None:
        self._idle = list[_Reader]()
        self._lock, self._closed = Lock(), False

    def read(
        self, field: str, function: Callable[..., Any], *arguments: Any, seconds: float = MAX_SECONDS,
        language: Language | None = None,
    ) -> Any:  # fmt: skip
        """Return what a function of a module returns in a process; messages about the file are about `field`.

        Raises
        ------
        Refusal, InputError
            As the function, or a refusal if it takes more than `seconds` or too much memory.
        RunStoppedError
            If nobody waits for it any more.
        """
        with self._lock:
            reader = self._idle.pop() if self._idle else None
        reader = reader or _Reader()
        ended, found = reader.read((function, arguments, language), seconds)
        with self._lock:
            kept = ended in ("done", "refused", "unusable") and not self._closed and len(self._idle) < IDLE
            if kept:
                self._idle.append(reader)
        if not kept:
            reader.close()
        if ended == "done":
            return found
        if ended == "refused":
            raise Refusal(*found)
        if ended == "unusable":
            raise InputError(found)
        if ended == "failed":
            raise RuntimeError(found)
        if ended == "ended":
            raise Refusal({field: "it takes more memory to be read than the page has. Give a smaller file."}, 413)
        if asked_to_stop()():
            raise RunStoppedError("Nobody waits for the file.")
        message = f"it takes more than {seconds:g} s to be read, which is more than the page takes."
        raise Refusal({field: f"{message} Give a smaller file."}, 413)

    def close(self) -> None:
        """End the processes that wait; those at work end with their file."""
        with self._lock:
            self._closed = True
            idle, self._idle = self._idle, []
        for reader in idle:
            reader.close()


def _serve(given: BinaryIO, told: BinaryIO) -> None:
    """Do the work that comes in, until none can come any more."""

    def answer(kind: str, content: Any) -> None:
        pickle.dump((kind, content), told)
        told.flush()

    answer("ready", None)
    while True:
        try:
            function, arguments, language = pickle.load(given)
        except EOFError:
            return
        try:
            with use_language(language):
                found = function(*arguments)
        except Refusal as error:
            answer("refused", (error.errors, error.status))
        except InputError as error:
            answer("unusable", str(error))
        except MemoryError:
            return
        except Exception:
            answer("failed", traceback.format_exc())
        else:
            answer("done", found)
        function = arguments = found = None  # of which nothing is kept while it waits


def _main() -> None:
    """Read files for the server that started this process, whose end is the end of its pipe."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # Ctrl-C reaches all processes of a terminal; the server tells
    tempfile.tempdir = sys.argv[1]
    with contextlib.suppress(ImportError, ValueError, OSError):  # Windows has none, and others less
        import resource

        resource.setrlimit(resource.RLIMIT_AS, (MAX_MEMORY, MAX_MEMORY))
    with contextlib.suppress(OSError):  # Linux: where memory runs out, it ends rather than the server
        Path("/proc/self/oom_score_adj").write_text("1000")
    told = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what is printed is no answer
    with contextlib.suppress(BrokenPipeError):
        _serve(sys.stdin.buffer, told)
    shutil.rmtree(tempfile.tempdir, ignore_errors=True)  # of a server that was killed


if __name__ == "__main__":
    _main()
