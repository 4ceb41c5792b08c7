"""Studies that run in the background, chunk by chunk, while the page shows the results so far."""

import logging
import secrets
from collections import OrderedDict
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field
from threading import Event, Lock
from time import monotonic
from typing import Any

from rockflex._errors import InputError, SolverError
from rockflex.solve import RunStoppedError, stopping_when
from rockflex.study.plan import ChunkedPlan
from rockflex.web._refusal import Refusal

KEPT = 40  # jobs that are remembered
WAITING = 12  # jobs that may wait or run at the same time
FORGOTTEN = 30.0  # s without a request after which a job stops, because its page was closed


@dataclass
class Job:
    """A study that one thread computes and others read; `tables` only grows."""

    plan: ChunkedPlan
    kind: str
    status: str = "waiting"
    message: str = ""
    tables: list[Any] = field(default_factory=list[Any])
    runs: int = 0
    cancelled: Event = field(default_factory=Event)
    seen: float = field(default_factory=monotonic)

    @property
    def over(self) -> bool:
        """Whether the job has ended."""
        return self.status in ("done", "cancelled", "failed")

    def compute(self) -> None:
        """Compute chunk after chunk until done, cancelled or forgotten."""
        self.status = "running"
        try:
            for number in range(self.plan.n_chunks):
                if self.cancelled.is_set() or monotonic() - self.seen > FORGOTTEN:
                    self.status = "cancelled"
                    return
                with stopping_when(self.cancelled.is_set):
                    table = self.plan.chunk(number)
                self.tables.append(table)
                self.runs += table.num_rows
            self.status = "done"
        except RunStoppedError:
            self.status = "cancelled"
        except (InputError, SolverError) as error:
            self.status, self.message = "failed", str(error)
        except Exception:
            logging.getLogger(__name__).exception("A study of the page failed")
            self.status, self.message = "failed", "An internal error occurred; the log of the server has the details."


class Jobs:
    """Jobs by token, which cannot be guessed. One job runs at a time, so that a core is free for answers."""

    def __init__(self) -> None:
        self._jobs: OrderedDict[str, Job] = OrderedDict()
        self._lock = Lock()
        self._pool = ThreadPoolExecutor(1, thread_name_prefix="study")

    def start(self, plan: ChunkedPlan, kind: str) -> str:
        """Queue a job, and return its token.

        Raises
        ------
        Refusal
            If too many jobs are waiting.
        """
        with self._lock:
            if sum(not job.over for job in self._jobs.values()) >= WAITING:
                raise Refusal("The server is busy with other studies. Try again in a minute.", 503)
            token = secrets.token_urlsafe(18)
            job = self._jobs[token] = Job(plan, kind)
            while len(self._jobs) > KEPT:
                old = next((key for key, each in self._jobs.items() if each.over), token)
                del self._jobs[old]
        self._pool.submit(job.compute)
        return token

    def get(self, token: str) -> Job:
        """Return a job, and record that its page is still open.

        Raises
        ------
        Refusal
            If there is no job with that token.
        """
        with self._lock:
            job = self._jobs.get(token)
        if job is None:
            raise Refusal("The server does not have this study (any more). Start it again.", 404)
        job.seen = monotonic()
        return job

    def cancel(self, token: str) -> None:
        """Stop a job; completed chunks remain available."""
        job = self.get(token)
        job.cancelled.set()
        if job.status == "waiting":
            job.status = "cancelled"

    def close(self) -> None:
        """Stop all jobs."""
        with self._lock:
            for job in self._jobs.values():
                job.cancelled.set()
        self._pool.shutdown(wait=False, cancel_futures=True)
