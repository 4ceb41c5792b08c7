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
    pytest-xdist 3.8 would say the same, but pytest 9.2 does not show them to it.
    """
    if config.getoption("dist") != "loadgroup":
        return None
    from xdist.scheduler import LoadScopeScheduling

    class ByFile(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            file = nodeid.partition("::")[0]
            return "web" if Path(file).parent.name == "web" else file

    return ByFile(config, log)


@pytest.fixture(scope="session")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> "Iterator[Cluster]":
    """Two workers of Dask that nothing kills."""
    from dask_cluster import Cluster

    with Cluster(tmp_path_factory.mktemp("dask")) as running:
        yield running
