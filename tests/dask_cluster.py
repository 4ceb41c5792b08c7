"""A Dask scheduler and workers as processes of their own on the loopback, for tests."""

import os
import re
import subprocess
import sys
import time
from pathlib import Path
from types import TracebackType
from typing import Self

TESTS = Path(__file__).parent


class Cluster:
    """Started and ended as a context; each process can be killed on the way."""

    def __init__(self, folder: Path, workers: int = 2, **environment: str) -> None:
        self.folder, self.count, self.environment = folder, workers, environment
        self.processes: list[subprocess.Popen[bytes]] = []
        self.workers: list[subprocess.Popen[bytes]] = []

    def __enter__(self) -> Self:
        try:
            self.scheduler = self._start("scheduler", "--port", "0", "--no-show")
            self.address = self._printed("scheduler", r"Scheduler at:\s+(tcp://\S+)")
            for _ in range(self.count):
                self.add_worker()
            for number in range(self.count):
                self._printed(f"worker-{number}", r"(Registered to)")
        except BaseException:
            self.__exit__(None, None, None)
            raise
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for process in self.processes:
            process.kill()
        for process in self.processes:
            process.wait()

    def add_worker(self) -> None:
        options = ["--no-nanny", "--nthreads", "1", "--local-directory", str(self.folder)]
        name = f"worker-{len(self.workers)}"
        self.workers.append(self._start("worker", self.address, *options, log=name))

    def _start(self, kind: str, *options: str, log: str = "") -> "subprocess.Popen[bytes]":
        command = [sys.executable, "-m", "dask", kind, "--host", "127.0.0.1", "--no-dashboard", *options]
        path = os.pathsep.join(filter(None, (str(TESTS), os.environ.get("PYTHONPATH"))))
        with (self.folder / f"{log or kind}.log").open("wb") as file:
            process = subprocess.Popen(
                command,
                stdout=file,
                stderr=subprocess.STDOUT,
                env=os.environ | {"PYTHONPATH": path} | self.environment,
                cwd=self.folder,
            )
        self.processes.append(process)
        return process

    def _printed(self, log: str, pattern: str) -> str:
        deadline = time.monotonic() + 60.0
        while time.monotonic() < deadline:
            text = (self.folder / f"{log}.log").read_text()
            if found := re.search(pattern, text):
                return found[1]
            time.sleep(0.05)
        message = f"{log} did not start:\n{text}"
        raise TimeoutError(message)
