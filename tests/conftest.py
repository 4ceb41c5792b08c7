"""Hypothesis' profiles; what is computed once is computed on one worker; the cluster that tests share."""

import os
from collections.abc import Iterator
from typing import TYPE_CHECKING

import pytest
from hypothesis import settings

if TYPE_CHECKING:
    from dask_cluster import Cluster

# No deadline, as a first call may compile; the same examples every time in CI.
settings.register_profile("rockflex", deadline=None)
settings.register_profile("ci", deadline=None, derandomize=True, print_blob=True)
settings.load_profile("ci" if os.environ.get("CI") else "rockflex")


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "xdist_group(name): on one worker with all others of that name")


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Keep the tests of a fixture of a module or of the session on one worker, which then computes it once."""
    for item in items:
        fixtures = item._fixtureinfo.name2fixturedefs.values() if isinstance(item, pytest.Function) else ()
        ours = [found[-1] for found in fixtures if found[-1].baseid.startswith("tests")]
        wide = sorted(each.argname for each in ours if each.scope == "session")
        narrow = any(each.scope == "module" for each in ours)
        if (wide or narrow) and item.get_closest_marker("xdist_group") is None:
            item.add_marker(pytest.mark.xdist_group(wide[0] if wide else item.path.stem))


@pytest.fixture(scope="session")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> "Iterator[Cluster]":
    """Two workers of Dask that nothing kills."""
    from dask_cluster import Cluster

    with Cluster(tmp_path_factory.mktemp("dask")) as running:
        yield running
