"""Hypothesis' profiles; what is computed once is computed on one worker; the cluster that tests share."""

import os
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest
from hypothesis import settings

if TYPE_CHECKING:
    from dask_cluster import Cluster

# No deadline, as a first call may compile; the same examples every time in CI.
settings.register_profile("rockflex", deadline=None)
settings.register_profile("ci", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("ci" if os.environ.get("CI") else "rockflex")


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Give a file's tests to one worker, which computes their fixtures once, with `--dist loadgroup`.

    Those of the web page go together, so that servers and browsers do not keep each other waiting. The marks of
    pytest-xdist 3.8 would say the same, but it writes them where pytest 9.2 no longer reads them (`Item._nodeid`).
    """
    if config.getoption("dist") != "loadgroup":
        return None
    from xdist.scheduler import LoadScopeScheduling

    class ByFile(LoadScopeScheduling):
        """pytest-xdist 3.8 waits for ever after a worker was lost (its issues 1323 and 1327, and pull request 1371)."""

        def _split_scope(self, nodeid: str) -> str:
            file = nodeid.partition("::")[0]
            return "web" if Path(file).parent.name == "web" else file

        def remove_node(self, node: Any) -> str | None:
            """Give the tests of a lost worker to others, except for the one that it died of."""
            units = self.assigned_work.pop(node)
            left = [test for unit in units.values() for test, done in unit.items() if not done]
            if not left:
                return None
            for scope, unit in units.items():
                if rest := {test: False for test, done in unit.items() if not done and test != left[0]}:
                    self.workqueue[scope] = rest
            for other in self.nodes:
                self._reschedule(other)
            return left[0]

        def _reschedule(self, node: Any) -> None:
            """Give a worker two tests at least: it runs its last one only when it knows what follows."""
            if node not in self.registered_collections:  # it replaces one, and has not found the tests yet
                return
            super()._reschedule(node)
            while self.workqueue and not node.shutting_down and self._pending_of(self.assigned_work[node]) < 2:
                self._assign_work_unit(node)

    return ByFile(config, log)


@pytest.fixture(scope="session")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> "Iterator[Cluster]":
    """Two workers of Dask that nothing kills."""
    from dask_cluster import Cluster

    with Cluster(tmp_path_factory.mktemp("dask")) as running:
        yield running
