"""A map over the chunks of a plan, on the workers of a Dask cluster that the user has started."""
# pyright: reportUnknownParameterType=false
# (pyarrow comes without types)

import gc
import pickle
import time
from collections.abc import Generator, Iterable
from concurrent.futures import CancelledError
from contextlib import contextmanager, suppress
from itertools import islice
from typing import TYPE_CHECKING, Any, Protocol, SupportsIndex
from uuid import uuid4

from rockflex._checks import positive, whole_number
from rockflex._errors import InputError
from rockflex._shown import shown

if TYPE_CHECKING:
    import pyarrow as pa

CONNECT = 10.0  # s
LOOK = 5.0  # s between looks at the cluster while nothing comes
AHEAD = 2  # chunks in flight for each thread of the cluster


class ClusterError(RuntimeError):
    """A cluster failed during the map; earlier chunks are valid, and the rest can be requested again."""


class Chunks(Protocol):
    """Work in numbered chunks; pure, deterministic and picklable."""

    def chunk(self, number: int, /) -> "pa.Table": ...


def map_dask(
    plan: Chunks,
    numbers: Iterable[int],
    address: str,
    *,
    retries: SupportsIndex = 2,
    patience: float = 600.0,
) -> Generator[tuple[int, "pa.Table"]]:
    """Yield each number and ``plan.chunk(number)``, in order of completion, computed on a Dask cluster.

    The plan is sent to every worker once, including workers that join later. If a worker dies, its chunks are computed
    on another; each number is yielded once. The cluster is not contacted before the first value is requested.

    Parameters
    ----------
    plan
        An object with a method `chunk`, which the workers can import.
    numbers
        Numbers of the chunks.
    address
        Address of the scheduler, such as ``"tcp://10.0.0.1:8786"``.
    retries
        How often a chunk that raises an error is tried again.
    patience
        Time in s for which the cluster may be without any worker; may be infinite.

    Raises
    ------
    InputError
        If Dask is not installed, nothing answers at `address`, the plan cannot be sent, or a worker has other versions
        of the packages.
    ClusterError
        If the scheduler is lost, no worker is left for longer than `patience`, or a chunk kills one worker after
        another.
    Exception
        The error of a chunk, with a note that names the chunk.
    """
    again, limit = whole_number("retries", retries, 0), positive("patience", patience, "s", infinite=True)
    if not isinstance(address, str) or not address:  # pyright: ignore[reportUnnecessaryIsInstance]
        raise InputError(
            f'address must be that of a Dask scheduler, such as "tcp://10.0.0.1:8786", but {shown(address)} was given.'
        )
    asked = list(numbers)
    if not asked:
        return
    content, client = _pickled(plan), _connected(address)
    name, done = f"rockflex-{uuid4().hex}", 0
    try:
        from rockflex.parallel._worker import PlanCarrier, compute, installed_versions

        versions = installed_versions()
        with _scheduler_lost(address, done, len(asked)):
            _refuse_workers(client, versions)
            client.register_plugin(PlanCarrier(content), name=name)
        queue, running, alive = iter(asked), dict[Any, int](), time.monotonic()
        while done < len(asked):
            with _scheduler_lost(address, done, len(asked)):
                threads = sum(client.nthreads().values())
                for number in islice(queue, max(AHEAD * threads - len(running), 0)):
                    key = f"{name}-{number}"
                    running[client.submit(compute, name, number, versions, key=key, retries=again)] = number
                finished = [(running.pop(future), *_outcome(future)) for future in _first(client, list(running))]
            now = time.monotonic()
            alive = now if threads else alive
            if now - alive > limit:
                raise ClusterError(
                    f"The Dask scheduler at {address} has had no worker for {limit:g} s; {_count(done, len(asked))}. "
                    "Start workers and run it again."
                )
            for number, table, error in finished:
                if error is not None:
                    raise _explained(error, number, _count(done, len(asked)))
                done += 1
                yield number, table
            finished.clear()
    finally:
        _leave(client, name)


def _refuse_workers(client: Any, versions: dict[str, str]) -> None:
    from rockflex.parallel._worker import installed_versions, refuse_other_versions

    for worker, found in client.run(installed_versions, on_error="return").items():
        if isinstance(found, dict):
            refuse_other_versions(worker, found, versions)
        elif not isinstance(found, OSError):  # which is that of a worker that has died in the meantime
            raise InputError(
                f"The worker {worker} cannot use rockflex: {found}. Start the workers in an environment that has it."
            )


def _leave(client: Any, name: str) -> None:
    """Remove the plan from the workers if the cluster still answers, and disconnect."""
    with suppress(OSError, ValueError, KeyError, CancelledError):  # the plan may not have reached every worker
        if client.status == "running":
            client.unregister_worker_plugin(name)
    with suppress(OSError):
        client.close(timeout=2)


def _pickled(plan: Chunks) -> bytes:
    try:
        return pickle.dumps(plan, protocol=5)
    except (pickle.PicklingError, TypeError, AttributeError) as error:
        raise InputError(
            f"The plan cannot be sent to workers: {error}. Define its class at the top of a module, without lambdas."
        ) from error


def _connected(address: str) -> Any:
    try:
        from distributed import Client
    except ImportError as error:
        raise InputError(
            f"A Dask cluster needs the package {error.name!r}. Install it by pip install 'rockflex[cluster]'."
        ) from error
    # A client that could not connect closes when it is collected. Collected while another one starts, it would wait
    # for ever for a lock that this thread holds. It is therefore collected before, and none while a client starts.
    gc.collect()
    collects = gc.isenabled()
    gc.disable()
    try:
        return Client(address, timeout=CONNECT, set_as_default=False, name="rockflex")
    except (OSError, ValueError, TypeError) as error:
        raise InputError(
            f"No Dask scheduler answers at {shown(address)} ({type(error).__name__}). Start one by `dask scheduler`, "
            'workers by `dask worker ADDRESS`, and give the address that it prints, such as "tcp://10.0.0.1:8786".'
        ) from error
    finally:
        if collects:
            gc.enable()


def _first(client: Any, futures: list[Any]) -> list[Any]:
    """The futures that are done, once one of them is or the time is up."""
    from distributed import wait

    if not futures:  # as there is no worker
        time.sleep(0.1)
        return []
    try:
        with client.as_current():
            ready: Any = wait(futures, timeout=LOOK, return_when="FIRST_COMPLETED")
        return list(ready.done)
    except TimeoutError:
        return []


def _outcome(future: Any) -> tuple[Any, BaseException | None]:
    if future.status == "error":
        return None, future.exception()
    return future.result(), None


def _explained(error: BaseException, number: int, count: str) -> BaseException:
    from distributed import KilledWorker

    if isinstance(error, KilledWorker):
        message = (
            f"Chunk {number} was on one worker after another when it died; {count}. Look for the reason in the "
            "workers' logs, which most often is too little memory, and run it again."
        )
        return ClusterError(message)
    error.add_note(f"This was raised by chunk {number} on a worker of the cluster; {count}.")
    return error


@contextmanager
def _scheduler_lost(address: str, done: int, total: int) -> Generator[None]:
    from distributed.client import ClosedClientError

    try:
        yield
    except (CancelledError, ClosedClientError, OSError) as error:
        raise ClusterError(
            f"The Dask scheduler at {address} was lost ({type(error).__name__}); {_count(done, total)}. What was "
            "stored is kept. Restart the cluster and run it again."
        ) from error


def _count(done: int, total: int) -> str:
    return f"{done} of the {total} chunks requested had come back"
