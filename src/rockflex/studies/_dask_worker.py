"""Code that runs on the workers of a Dask cluster: it stores a plan and computes its chunks."""

import pickle
from functools import cache
from threading import Lock
from time import perf_counter
from typing import Any

from distributed import WorkerPlugin, get_worker

from rockflex.foundation.errors import InputError
from rockflex.foundation.versions import package_versions

PACKAGES = ("rockflex", "numpy", "scipy", "pyarrow", "distributed")  # the numbers or the transport need them


class DaskPlanPlugin(WorkerPlugin):
    """A pickled plan, which Dask sends to every worker, including those that join later.

    If every chunk depended on the plan as a task, all chunks would go to the worker that holds it; and scattered data
    die with their workers.
    """

    def __init__(self, content: bytes) -> None:
        self.content, self.plan, self.lock = content, None, None

    def setup(self, worker: Any) -> None:  # noqa: ARG002
        self.lock = Lock()

    def load(self) -> Any:
        """Return the plan, which is unpickled at the first call."""
        with self.lock or Lock():
            if self.plan is None:
                try:
                    self.plan = pickle.loads(self.content)
                except Exception as error:  # unpickling runs the modules' own code
                    raise InputError(
                        f"The worker {_dask_worker_address()} cannot load the plan ({type(error).__name__}: {error}). "
                        "Start the "
                        "workers in the same environment, from which its modules can be imported."
                    ) from error
            return self.plan


def compute_chunks_on_worker(name: str, numbers: tuple[int, ...], versions: dict[str, str]) -> tuple[list[Any], float]:
    """Return the chunks of the plan stored under `name`, and the seconds they took, if the versions here are right."""
    refuse_other_worker_versions(_dask_worker_address(), worker_package_versions(), versions)
    plugin: Any = get_worker().plugins[name]
    plan, start = plugin.load(), perf_counter()
    results: list[Any] = []
    for number in numbers:
        try:
            results.append(plan.chunk(number))
        except Exception as error:
            error.add_note(f"This was raised by chunk {number} on a worker of the cluster.")
            raise
    return results, perf_counter() - start


@cache
def worker_package_versions() -> dict[str, str]:
    """Return the version of Python and of each package that matters; "none" for one that is not installed."""
    return package_versions(PACKAGES)


def refuse_other_worker_versions(worker: str, there: dict[str, str], here: dict[str, str]) -> None:
    """Raise an `InputError` that names every package whose version differs between a worker and the client."""
    wrong = [f"{name} {there.get(name, 'none')} and not {here[name]}" for name in here if there.get(name) != here[name]]
    if wrong:
        raise InputError(
            f"The worker {worker} has {', '.join(wrong)}. Start the workers in the same environment as this process."
        )


def _dask_worker_address() -> str:
    return get_worker().address
