"""Long work in the background, studies and files, while the page shows its progress and may cancel it."""

import logging
import secrets
from collections import OrderedDict
from collections.abc import Callable
from threading import Condition, Event, Thread
from time import monotonic
from typing import Any, Generic, TypeVar

from rockflex.engine.stops import RunStoppedError, check_interruption, stopping_when
from rockflex.foundation.errors import InputError, SolverError
from rockflex.studies._plan import ChunkedPlan
from rockflex.web._refusal import Refusal

MAX_STUDIES = 40  # studies that are remembered
MAX_FILES = 8  # files, until they have arrived
MAX_FILES_WRITTEN = 2  # files written at once: they take long and mostly hold the lock
MAX_OWN = 12  # jobs of a kind that may wait or run at the same time for one visitor
MAX_WAITING = 60  # for all of them
ABANDONED_AFTER = 30.0  # s without a request after which a job stops, because its page was closed


class BackgroundWork:
    """Work of one thread whose progress others read.

    Attributes
    ----------
    status : str
        "waiting", "running", "done", "cancelled" or "failed".
    message : str
        Why it failed.
    errors : dict of str
        The same by the field at fault, if that is known.
    """

    def __init__(self) -> None:
        self.status, self.message = "waiting", ""
        self.errors: dict[str, str] = {}
        self.cancelled, self.seen = Event(), monotonic()

    @property
    def over(self) -> bool:
        """Whether the job has ended."""
        return self.status in ("done", "cancelled", "failed")

    def compute(self) -> None:
        """Work until done, cancelled or forgotten."""
        self.status = "running"
        try:
            with stopping_when(self._unwanted):
                self.work()
            self.status = "done"
        except RunStoppedError:
            self.status = "cancelled"
        except Refusal as error:
            self.errors, self.message, self.status = error.errors, str(error), "failed"
        except (InputError, SolverError) as error:
            self.message, self.status = str(error), "failed"
        except Exception:
            logging.getLogger(__name__).exception("Work in the background of the page failed")
            self.message = "An internal error occurred; the log of the server has the details."
            self.status = "failed"

    def work(self) -> None:
        """Compute the result, and call `check_interruption` often."""
        raise NotImplementedError

    def forget(self) -> None:
        """Drop what takes much memory, because it is no longer wanted."""

    def _unwanted(self) -> bool:
        return self.cancelled.is_set() or monotonic() - self.seen > ABANDONED_AFTER


class RunsJob(BackgroundWork):
    """Many runs, of one kind of page; `runs` of them are done."""

    def __init__(self, kind: str) -> None:
        super().__init__()
        self.kind, self.runs = kind, 0


class StudyJob(RunsJob):
    """A study, computed chunk after chunk; `tables` only grows."""

    def __init__(self, plan: ChunkedPlan, kind: str) -> None:
        super().__init__(kind)
        self.plan = plan
        self.tables: list[Any] = []

    def work(self) -> None:
        """Compute all chunks."""
        for number in range(self.plan.n_chunks):
            check_interruption()
            table = self.plan.chunk(number)
            self.tables.append(table)
            self.runs += table.num_rows


class BackgroundFileJob(BackgroundWork):
    """A file that takes long: `make` returns its name and content, and reports how many parts of how many are done."""

    def __init__(self, make: Callable[[Callable[[int, int], None]], tuple[str, bytes]]) -> None:
        super().__init__()
        self.done, self.total = 0, 0
        self.file: tuple[str, bytes] | None = None
        self._make = make

    def work(self) -> None:
        """Make the file; one that was cancelled meanwhile is dropped."""
        made = self._make(self._report)
        check_interruption()
        self.file = made

    def forget(self) -> None:
        """Drop the file, which has arrived."""
        self.file = None

    def _report(self, done: int, total: int) -> None:
        check_interruption()
        self.done, self.total = done, total


AnyWork = TypeVar("AnyWork", bound=BackgroundWork)


class BackgroundJobs(Generic[AnyWork]):
    """Jobs by token, which cannot be guessed. Few run at a time, so that a core is free for answers.

    The next one is of the visitor whose last one began longest ago, so that nobody waits for all jobs of another.

    Parameters
    ----------
    what
        Their name in messages.
    kept
        How many are remembered.
    at_once
        How many run at a time.
    """

    def __init__(self, what: str, kept: int, at_once: int = 1) -> None:
        self._what, self._kept, self._at_once = what, kept, at_once
        self._jobs: OrderedDict[str, AnyWork] = OrderedDict()
        self._changed = Condition()
        self._queues: OrderedDict[str, list[AnyWork]] = OrderedDict()  # by visitor, who is next first
        self._owners: dict[str, str] = {}
        self._threads: list[Thread] = []
        self._closed = False

    def start(self, job: AnyWork, visitor: str = "") -> str:
        """Queue a job, and return its token."""
        with self._changed:
            active = [token for token, each in self._jobs.items() if not each.over]
            if sum(self._owners[token] == visitor for token in active) >= MAX_OWN:
                message = f"{MAX_OWN} {self._what} of yours wait or run already. Wait for one of them, or cancel it."
                raise Refusal(message, 503)
            if len(active) >= MAX_WAITING:
                raise Refusal(f"The server is busy with other {self._what}. Try again in a minute.", 503)
            token = secrets.token_urlsafe(18)
            self._jobs[token], self._owners[token] = job, visitor
            while len(self._jobs) > self._kept:
                old = next((key for key, each in self._jobs.items() if each.over), None)
                if old is None:
                    break
                del self._jobs[old], self._owners[old]
            if len(self._threads) < self._at_once:  # daemons: what cannot be interrupted does not keep the server up
                self._threads.append(Thread(target=self._run, name=self._what, daemon=True))
                self._threads[-1].start()
            self._queues.setdefault(visitor, []).append(job)
            self._changed.notify()
        return token

    def get(self, token: str) -> AnyWork:
        """Return a job, and record that its page is still open."""
        with self._changed:
            job = self._jobs.get(token)
        if job is None:
            raise Refusal(f"The server does not have these {self._what} (any more). Start again.", 404)
        job.seen = monotonic()
        return job

    def cancel(self, token: str) -> None:
        """Stop a job; completed chunks remain available, but not the file of one that is done."""
        job = self.get(token)
        job.cancelled.set()
        job.forget()
        if job.status == "waiting":
            job.status = "cancelled"

    def close(self) -> None:
        """Stop all jobs."""
        with self._changed:
            for job in self._jobs.values():
                job.cancelled.set()
                if job.status == "waiting":
                    job.status = "cancelled"
            self._closed = True
            self._changed.notify_all()

    def wait(self, seconds: float) -> None:
        """Wait until the threads of a server that ends have ended, but not longer than that."""
        end = monotonic() + seconds
        for each in self._threads:
            each.join(max(end - monotonic(), 0.0))

    def _run(self) -> None:
        while (job := self._next()) is not None:
            job.compute()

    def _next(self) -> AnyWork | None:
        """Wait for a job; None at the end of the server."""
        with self._changed:
            self._changed.wait_for(lambda: self._closed or any(self._queues.values()))
            if self._closed:
                return None
            visitor = next(each for each, jobs in self._queues.items() if jobs)
            job = self._queues[visitor].pop(0)
            self._queues.move_to_end(visitor)
            if len(self._queues) > self._kept:  # visitors without a job, who began longest ago
                for each in [each for each, jobs in self._queues.items() if not jobs][: -self._kept]:
                    del self._queues[each]
            return job
